"""SPIN's LTL: one formula with ``[]``, ``<>`` and propositions such as ``{state==Idle}``.

SPIN 6 reads ``&& || -> <->`` from left to right with one precedence, so the reader refuses formulas
that mix them without parentheses. A file may end with Spot's lines ``.inputs`` and ``.outputs``;
without them every variable is read as an output, which is reported.
"""

import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import PurePath

from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
)
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.lowering import (
    TooManyValuesError,
    eliminate_arithmetic,
    index_domains,
    rename_ambiguous_literals,
)
from sysmlc.logic.formats.spot import (
    blank_partition,
    list_partition,
    read_implication,
    read_partition,
)
from sysmlc.logic.formats.writing import NotExpressibleError, apply_lowering
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.infix import FormulaReader, Term
from sysmlc.logic.printing import print_literal
from sysmlc.logic.syntax import NEUTRAL, FormulaError

# -- reading ---------------------------------------------------------------------------------------

SYNTAX = replace(NEUTRAL, comment=r"/\*[\s\S]*?\*/|//[^\n]*")
_EQUAL_PRECEDENCE = frozenset([Op.AND, Op.OR, Op.IMPLIES, Op.IFF])
_EQUALITY = re.compile(r"\{\s*([^\W\d]\w*)\s*==\s*(-?\w+)\s*\}")
# A proposition is matched whole, so that no names are found inside it.
_NAME_OR_PROPOSITION = re.compile(r"\{[^{}]*\}|[^\W\d]\w*|[\s\S]")
_MOST_NAMED = 8
"""Most variables without an owner that a diagnostic names."""


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract, named after the file, or nothing if a fault was reported."""
    draft = ContractDraft(file, "SPIN")
    text = blank_partition(file.text)
    owners = read_partition(file.text)
    without_owner = []
    for name, domain in _infer_domains(text).items():
        if name not in owners:
            without_owner.append(name)
        draft.declare(name, 0, owners.get(name, Owner.SYSTEM), domain)
    if without_owner:
        file.report(rules.OWNER_NOT_SAID, 0, names=", ".join(without_owner[:_MOST_NAMED]))
    read_implication(draft, text, SYNTAX, _SpinReader)
    return draft.build(PurePath(file.path).stem.removesuffix(".spin"))


def _infer_domains(text: str) -> dict[str, Domain]:
    """Return the variables of the formula with the values that it compares them with."""
    values: dict[str, dict[str, None]] = {}
    for equality in _EQUALITY.finditer(text):
        values.setdefault(equality.group(1), {})[equality.group(2)] = None
    without_comments = re.sub(SYNTAX.comment, " ", text)
    words = {*SYNTAX.prefix, *SYNTAX.infix, *SYNTAX.booleans}
    names = dict.fromkeys(
        name
        for name in _NAME_OR_PROPOSITION.findall(without_comments)
        if name[0].isidentifier() and name not in words
    )
    inferred = {name: _infer_domain(list(compared)) for name, compared in values.items()}
    return inferred | {name: BooleanDomain() for name in names if name not in inferred}


def _infer_domain(values: list[str]) -> Domain:
    """Return the range from 0 to the largest number, or the enumeration of the names.

    A name that is the only value gets a second one: otherwise its comparison would always be true.
    """
    numbers = [int(value) for value in values if re.fullmatch(r"-?\d{1,18}", value)]
    if len(numbers) == len(values):
        return IntegerDomain(min(0, *numbers), max(1, *numbers))
    if len(values) == 1:
        values = [*values, f"not_{values[0]}".replace("-", "_")]
    return EnumerationDomain(tuple(values))


class _SpinReader(FormulaReader):
    """Reads formulas of SPIN; rejects those that SPIN and other tools read differently."""

    _previous_op: Op | None = None
    """The connective before, inside the same brackets."""

    def _read_brackets(self) -> Term:
        outer_op, self._previous_op = self._previous_op, None
        term = super()._read_brackets()
        self._previous_op = outer_op
        return term

    def _read_infix(self, op: Op, left: Term) -> Term:
        offset = self.cursor.next.offset
        if op in _EQUAL_PRECEDENCE:
            if self._previous_op not in (None, op):
                raise FormulaError("parentheses must say what belongs together here", offset)
            self._previous_op = op
        return super()._read_infix(op, left)


# -- writing ---------------------------------------------------------------------------------------

_INFIX = {
    Op.AND: "&&",
    Op.OR: "||",
    Op.IMPLIES: "->",
    Op.IFF: "<->",
    Op.UNTIL: "U",
    Op.RELEASE: "V",
    Op.WEAK_UNTIL: "W",
}
_PREFIX = {Op.NOT: "!", Op.NEXT: "X ", Op.ALWAYS: "[]", Op.EVENTUALLY: "<>"}
_PROPOSITION = re.compile(r"!?(X )?(\{[^{}]*\}|\w+)")
_SPIN_NAME = re.compile(r"[a-z_]\w*")
MAX_PROPOSITIONS = 20_000
"""Most propositions to which one comparison may be expanded."""
_CACHED_COMPARISONS = 1 << 14
_CACHED_PRINTERS = 64
# Machines of one kind have the same variables and comparisons.


class TooLargeError(Exception):
    """A comparison over so many values that its formula would be useless."""


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract without arithmetic. Raises NotExpressibleError."""
    return apply_lowering(rename_ambiguous_literals(contract), format_name, eliminate_arithmetic)


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as one formula with the owners of the variables below it."""
    renamed = rename_ambiguous_literals(contract)
    try:
        formula = print_spin(renamed).rstrip("\n")
    except TooLargeError:
        raise NotExpressibleError(format_name, str(TooManyValuesError())) from None
    return "\n".join([formula, *list_partition(renamed), ""])


def print_spin(contract: Contract) -> str:
    """Return ``(assumptions) -> (guarantees)``. Raises TooLargeError."""
    printer = _create_printer(tuple(index_domains(contract).items()))
    assumptions = printer.print_conjunction(contract.assumptions)
    guarantees = printer.print_conjunction(contract.guarantees)
    return f"({assumptions}) -> ({guarantees})\n"


class SpinPrinter:
    """Prints formulas over some variables, each formula once.

    Tools read ``{x==3}`` as an opaque proposition. Comparisons and arithmetic are therefore
    expanded over the values of the variables, and X stands before the proposition of a primed
    variable.
    """

    def __init__(self, variable_domains: Mapping[str, Domain]) -> None:
        self._domains = variable_domains
        self._texts: dict[Formula, str] = {}

    def print_conjunction(self, conjuncts: Iterable[Conjunct]) -> str:
        """Return the conjunction of the conjuncts. Raises TooLargeError."""
        return " && ".join(map(self.print_conjunct, conjuncts)) or "true"

    def print_conjunct(self, conjunct: Conjunct) -> str:
        """Return a conjunct with the temporal operators of its class. Raises TooLargeError."""
        text = self.print_formula(conjunct.formula)
        match conjunct.class_:
            case Class.SAFETY:
                return f"[]({text})"
            case Class.LIVENESS:
                return f"[]<>({text})"
            case _:
                return f"({text})"

    def print_formula(self, formula: Formula) -> str:
        """Return the formula. Raises TooLargeError."""
        text = self._texts.get(formula)
        if text is None:
            text = self._texts[formula] = self._print(formula)
        return text

    def _print(self, formula: Formula) -> str:
        match formula:
            case Const(value):
                return print_literal(value)
            case Var(name):
                return _print_proposition(formula, True, self._domains[name])
            case Apply(op, args) if op in _INFIX:
                return f" {_INFIX[op]} ".join(map(self._print_operand, args))
            case Apply(op, args) if op in _PREFIX:
                return f"{_PREFIX[op]}{self._print_operand(args[0])}"
            case _:
                names = dict.fromkeys(variable.name for variable in f.variables(formula))
                pairs = tuple((name, self._domains[name]) for name in names)
                return _print_comparison(formula, pairs)

    def _print_operand(self, formula: Formula) -> str:
        text = self.print_formula(formula)
        if not isinstance(formula, Apply) or formula.op in _PREFIX:
            return text
        return text if _PROPOSITION.fullmatch(text) else f"({text})"


@lru_cache(_CACHED_PRINTERS)
def _create_printer(variables: tuple[tuple[str, Domain], ...]) -> SpinPrinter:
    return SpinPrinter(dict(variables))


@lru_cache(_CACHED_COMPARISONS)
def _print_comparison(formula: Formula, pairs: tuple[tuple[str, Domain], ...]) -> str:
    """Return a comparison expanded over the values of its variables. Raises TooLargeError."""
    variable_domains = dict(pairs)
    variables = list(dict.fromkeys(f.variables(formula)))
    count = 1
    for variable in variables:
        count *= domains.size(variable_domains[variable.name])
    if count > MAX_PROPOSITIONS:
        raise TooLargeError
    match formula:
        case Apply(Op.NE, (Var(name) as variable, Const(value))) if value in domains.values(
            variable_domains[name]
        ):
            text = _print_proposition(variable, value, variable_domains[name])
            return f"!({text})" if " " in text else f"!{text}"
        case _:
            return _print_cases(compile_evaluation(formula), variables, {}, {}, variable_domains)


def _print_cases(
    evaluation: Evaluation,
    variables: list[Var],
    current: dict[str, Literal],
    following: dict[str, Literal],
    variable_domains: Mapping[str, Domain],
) -> str:
    """Return the valuations that make the comparison true; the first variable is the outermost."""
    if not variables:
        return print_literal(bool(evaluation(current, following)))
    variable, *rest = variables
    domain = variable_domains[variable.name]
    cases: list[str] = []
    for value in domains.values(domain):
        extended = {variable.name: value}
        before = current if variable.primed else current | extended
        after = following | extended if variable.primed else following
        case = _print_cases(evaluation, rest, before, after, variable_domains)
        if case == "false":
            continue
        proposition = _print_proposition(variable, value, domain)
        if case != "true":
            case = f"({case})" if " || " in case else case
            proposition = f"({proposition} && {case})"
        cases.append(proposition)
    if not cases:
        return "false"
    is_valid = len(cases) == domains.size(domain) and not any("&&" in case for case in cases)
    return "true" if is_valid else " || ".join(cases)


def _print_proposition(variable: Var, value: Literal, domain: Domain) -> str:
    """Return the proposition that a variable has a value."""
    if isinstance(domain, BooleanDomain):
        # Names of SPIN's propositions begin with a small letter.
        is_name = _SPIN_NAME.fullmatch(variable.name)
        text = variable.name if is_name else f"{{{variable.name}==1}}"
        text = text if value else f"!{text}"
    else:
        text = f"{{{variable.name}=={print_literal(value)}}}"
    return f"X {text}" if variable.primed else text
