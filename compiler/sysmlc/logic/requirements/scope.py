"""Resolves the names in a requirement to features of its subject or variables of a behaviour."""

import re
from collections.abc import Iterable, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Element, Graph, query
from sysmlc.ir.expressions import Binary, dotted_name
from sysmlc.logic.components.names import ComponentNames, Meaning
from sysmlc.logic.components.objects import ComponentError
from sysmlc.logic.composition.free_outputs import find_owner
from sysmlc.logic.contract import (
    BooleanDomain,
    Contract,
    Domain,
    EnumerationDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import contains
from sysmlc.logic.expressions.compared_texts import COMPARISON, MAX_LENGTH, parse_comparison
from sysmlc.logic.expressions.context import Context, context_of, find_literal
from sysmlc.logic.expressions.elaboration import check_enumeration
from sysmlc.logic.expressions.features import Feature
from sysmlc.logic.expressions.linear import Number
from sysmlc.logic.expressions.number_formulas import compare_regions
from sysmlc.logic.expressions.symbols import ElaborationError, Symbol, find_symbol
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Var, prime, var, variable_names
from sysmlc.logic.requirements.statements import (
    find_redefining_operation,
    list_component_names,
)
from sysmlc.logic.simplification import rebuild
from sysmlc.logic.syntax import FormulaError
from sysmlc.support.counts import list_first
from sysmlc.support.suggestions import find_similar

_NAME = re.compile(
    r"(?:[^\W\d]\w*\.)*(?:running|finished)\([^()]+\)"
    r"|[^\W\d]\w*(?:::[^\W\d]\w*)+"
    r"|[^\W\d]\w*(?:(?:\.|\#\(\d+\)\.)[^\W\d]\w*)*"
)
"""A name in a formula: of an action, qualified, dotted, or plain."""
_MAX_NAMES = 12
"""Most names that a message lists."""
_SELF = ("self", "this")
"""Words for the subject in KerML, OCL and Alf."""
_COMPONENT = re.compile(r"\s+shall\b", re.IGNORECASE)
"""What follows the name of the component in a structured requirement."""


class Scope(Struct, frozen=True):
    """What the names in the formulas about a subject denote: its variables and constants."""

    context: Context
    variables: Mapping[str, Variable]
    constants: Mapping[str, Literal]
    names: ComponentNames | None = None
    """Names of actions, states and parts; None if the subject has no behaviour to describe."""
    component_names: tuple[str, ...] = ()
    """Names by which formulas and structured requirements may call the subject."""
    tick_seconds: float = 1.0
    """Length of a step."""

    @property
    def domains(self) -> dict[str, Domain]:
        """The domains of all names that a formula in temporal logic may use."""
        features = self.context.features.values()
        domains = {
            feature.variable: feature.domain for feature in features if feature.domain is not None
        }
        return domains | {name: variable.domain for name, variable in self.variables.items()}

    def find_symbol(self, name: str, element: str = "") -> Symbol | None:
        """Return what a dotted name in an expression denotes, or None.

        The name of the subject may precede the name of the feature. A constant has the id
        *element*.
        """
        if element in self.context.enumerations.constants_by_id:
            return find_literal(self.context, name, element)
        meaning, feature = self._find_meaning(name), self.find_feature(name)
        quantity = None if feature is None else feature.number
        if meaning is not None:
            is_number = isinstance(meaning.domain, EnumerationDomain) and meaning.domain.regions
            if quantity is None and is_number and isinstance(meaning.formula, Var):
                quantity = Number(meaning.formula.name)
            return Symbol(meaning.formula, meaning.domain, quantity=quantity)
        if feature is not None:
            constant = self.constants.get(feature.variable)
            formula = var(feature.variable) if constant is None else Const(constant)
            several = feature.has_several_values
            return Symbol(formula, feature.domain, has_several_values=several, quantity=quantity)
        variable = self.variables.get(name)
        if variable is None:
            return find_literal(self.context, name, element)
        return Symbol(var(name), variable.domain)

    def find_feature(self, name: str) -> Feature | None:
        """Return the feature with this name, or with the name behind that of the subject."""
        features = self.context.features
        return features.get(name) or features.get(self._drop_subject(name))

    def _find_meaning(self, name: str) -> Meaning | None:
        """Return what a name denotes in the component; the name of the subject may precede it."""
        if self.names is None:
            return None
        rest = self._drop_subject(name)
        return self.names.find(name) or (self.names.find(rest) if rest else None)

    def _drop_subject(self, name: str) -> str:
        """Return the name without that of the subject; empty if another name is the first one."""
        opening = name.rfind("(") + 1
        for start in dict.fromkeys((0, opening)):
            first, _, rest = name[start:].partition(".")
            if first in (*self.component_names, *_SELF):
                return name[:start] + rest
        return ""

    def list_names(self, kind: str = "running") -> list[str]:
        """List the names that formulas about the subject may use; *kind* is asked of actions."""
        features = self.context.features.values()
        variables = (feature.variable for feature in features if feature.domain is not None)
        names = self.variables if self.names is None else self.names.list_names(kind)
        return list(dict.fromkeys((*variables, *names)))

    def describe_names(self) -> str:
        """Return the list of names for a message, shortened if there are many."""
        names = list_first(self.list_names(), _MAX_NAMES)
        return names or "none: the subject has no features"

    def _describe_unknown(self, name: str) -> str:
        """Return the message about a dotted name, or one of an action, that denotes nothing."""
        is_action = name.endswith(")")
        kind = "finished" if "finished(" in name else "running"
        advice = self.suggest_name(self._drop_subject(name) or name, kind)
        sort = "action" if is_action else "feature, value, state or event"
        return "; ".join(
            filter(None, (f"'{name}' denotes no {sort} of '{self.context.name}'", advice))
        )

    def suggest_name(self, name: str, kind: str = "running") -> str:
        """Return advice on what an unknown name probably means; empty without an idea."""
        names = self.list_names(kind)
        last = re.split(r"::|\.", name)[-1]
        machine = f"{name}.state"
        literals = (name for name in self.context.enumerations.literals if "::" in name)
        if similar := find_similar(name, [*names, *literals]):
            candidates = [similar]
        elif self.names is not None and self.names.find(machine):
            candidates = [machine]
        else:
            candidates = [f"{k}={last}" for k in names if contains(self.find_domain(k), last)]
            candidates += [k for k in names if k.endswith(f".{name}") or k.startswith(f"{name}.")]
            candidates += [last] * (last in names)
        return f"did you mean '{candidates[0]}'?" if candidates else ""

    def find_domain(self, name: str) -> Domain:
        """Return the values of one of the names that ``list_names`` lists."""
        symbol = self.find_symbol(name)
        return BooleanDomain() if symbol is None or symbol.domain is None else symbol.domain

    def replace_names(self, text: str) -> tuple[str, dict[str, Meaning]]:
        """Replace names that are no variables (``tank.filling``, ``running(pick)``) by variables.

        The second result tells what the new variables mean. A variable is padded with blanks to the
        length of the name, so that columns in messages are those of *text*; they are not if a
        variable is longer than the name. Raises FormulaError for a name with several meanings.
        """
        meanings: dict[str, Meaning] = {}
        if len(text) <= MAX_LENGTH:
            text = COMPARISON.sub(lambda match: self._replace_comparison(match, meanings), text)
        return _NAME.sub(lambda match: self._replace_name(match, meanings), text), meanings

    def _replace_comparison(self, match: re.Match[str], meanings: dict[str, Meaning]) -> str:
        """Replace a comparison of numbers without a finite domain by a variable."""
        expression = parse_comparison(match[0])
        if not isinstance(expression, Binary):
            return match[0]
        try:
            formula = compare_regions(expression, self.find_symbol)
            self._check_types(expression)
        except (ComponentError, ElaborationError) as error:
            raise FormulaError(str(error), match.start()) from None
        if formula is None:
            return match[0]
        variable = f"__{len(meanings)}"
        meanings[variable] = Meaning(formula, BooleanDomain(), match[0].strip())
        return variable.ljust(len(match[0]))

    def _check_types(self, expression: Binary) -> None:
        """Raise ElaborationError if a comparison is about values of two enumerations."""
        domains: list[Domain | None] = []
        for side in (expression.left, expression.right):
            literal = find_literal(self.context, dotted_name(side) or "")
            symbol = literal or find_symbol(side, self.find_symbol)
            domains.append(None if symbol is None else symbol.domain)
        left, right = domains
        # Literals such as ``Door::open`` have the type; those that stand alone take any.
        if left is not None and right is not None and left == right:
            check_enumeration(expression.right, right, left)

    def _replace_name(self, match: re.Match[str], meanings: dict[str, Meaning]) -> str:
        name = match[0]
        if name in meanings or _COMPONENT.match(match.string, match.end()):
            return name
        try:
            meaning = self._find_meaning(name)
        except ComponentError as problem:
            raise FormulaError(str(problem), match.start()) from None
        is_plain = name.isidentifier()
        if meaning is None:
            feature = self.find_feature(name)
            if feature is not None and feature.has_several_values:
                raise FormulaError(f"'{name}' has several values", match.start())
            if is_plain:
                return name
            literal = find_literal(self.context, name)
            if feature is None and literal is not None and isinstance(literal.formula, Const):
                return str(literal.formula.value).ljust(len(name))
            if feature is None:
                raise FormulaError(self._describe_unknown(name), match.start())
            return feature.variable.ljust(len(name))
        # The component may receive more events than its state machine alone.
        own = self.variables.get(name)
        is_own = own is not None and own.domain == meaning.domain
        if is_plain and (is_own or isinstance(meaning.formula, Const)):
            return name
        variable = f"__{len(meanings)}"
        meanings[variable] = replace(meaning, name=name)
        return variable.ljust(len(name))

    def substitute_constants(self, formula: Formula) -> Formula:
        """Replace constants by their values, also where they are primed."""
        match formula:
            case Var(name) if name in self.constants:
                return Const(self.constants[name])
            case Apply(op, args):
                return rebuild(op, tuple(self.substitute_constants(arg) for arg in args))
            case _:
                return formula

    def select_variables(self, formulas: Iterable[Formula]) -> tuple[Variable, ...]:
        """Return the variables of the formulas, in the order in which the subject declares them."""
        names = variable_names(*formulas)
        return tuple(variable for name, variable in self.variables.items() if name in names)

    def is_about_inputs(self, formula: Formula) -> bool:
        """Whether the formula has variables, and the environment decides all of them."""
        owners = {self.variables[name].owner for name in variable_names(formula)}
        return owners == {Owner.ENVIRONMENT}


def replace_meanings(formula: Formula, meanings: Mapping[str, Meaning]) -> Formula:
    """Replace the variables that stand for names by what the names mean."""
    match formula:
        case Var(name, primed) if name in meanings:
            meaning = meanings[name].formula
            return prime(meaning) if primed else meaning
        case Apply(op, args):
            return rebuild(op, tuple(replace_meanings(arg, meanings) for arg in args))
        case _:
            return formula


def restore_names(formula: Formula, meanings: Mapping[str, Meaning]) -> Formula:
    """Replace the variables that stand for names by the names themselves."""
    match formula:
        case Var(name, primed) if name in meanings:
            return Var(meanings[name].name, primed)
        case Apply(op, args):
            return Apply(op, tuple(restore_names(arg, meanings) for arg in args))
        case _:
            return formula


def make_scope(
    graph: Graph,
    subject: Element,
    behaviour: Contract | None,
    assumed_range: tuple[int, int],
    tick_seconds: float,
) -> Scope:
    """Return the scope of a subject; *behaviour* is its contract if it has a behaviour.

    *tick_seconds* is the length of a step.
    """
    context = context_of(
        graph,
        query.definition_of(graph, subject),
        assumed_range,
        find_redefining_operation(graph, subject),
    )
    scope = scope_of(context, () if behaviour is None else behaviour.variables)
    names = list_component_names(graph, subject)
    return replace(scope, component_names=names, tick_seconds=tick_seconds)


def scope_of(context: Context, behaviour_variables: Iterable[Variable]) -> Scope:
    """Return the scope of a subject; variables of its behaviour hide its features."""
    constants: dict[str, Literal] = {}
    feature_variables: dict[str, Variable] = {}
    for feature in context.features.values():
        if feature.is_constant and feature.default is not None:
            constants[feature.variable] = feature.default
        elif feature.domain is not None:
            feature_variables[feature.variable] = feature.make_variable(find_owner(feature))
    by_name = {variable.name: variable for variable in behaviour_variables}
    return Scope(context, feature_variables | by_name, constants)
