"""Expressions and values of the model as SysML v2 expressions over the names of the text.

A text that is not an expression of sysmlc's grammar, or that contains an unknown name, has no
expression: the caller decides what the text becomes instead.
"""

import re

from sysmlc.backends.sysml.library import find_quantity, find_unit_name
from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.printing import quote_name, quote_string
from sysmlc.backends.sysml.references import format_reference, is_path_accessible
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir import expressions as syntax
from sysmlc.ir.expressions import POSTFIX, PRECEDENCE, UNARY
from sysmlc.ir.query import bounds, generals, type_of
from sysmlc.ir.query.classifiers import unit_of
from sysmlc.logic.expressions.parsing import tree_of

_NUMBERS = frozenset({"Integer", "Real", "UnlimitedNatural", "Number"})
_ARITHMETIC = frozenset("+-*/%")
SIGNS = {"bound": "=", "initial": ":=", "default": "default =", "default initial": "default :="}
"""Words before a value, by its kind."""


_QUALIFIED_NAME = re.compile(r"(?:\w+::)+(?:\w+|'[^'\\]+')")
"""The name of a unit in a library, in which only the last segment may need quotes."""


class UnknownNameError(ValueError):
    """A name in an expression denotes no member of the text."""


# -- expressions ---------------------------------------------------------------------------------


def format_expression(writer: Writer, scope: Member | None, text: str) -> str | None:
    """Return the text as an expression of SysML v2; None if it is invalid or names are unknown."""
    try:
        return print_expression(writer, scope, _read_tree(writer, scope, text))
    except (syntax.ExpressionError, UnknownNameError, RecursionError):
        return None


def _read_tree(writer: Writer, scope: Member | None, text: str) -> syntax.Expression:
    """Return the tree of a text; the names of a multiplicity or a time are resolved here."""
    namespaces = () if scope is None else (scope, *scope.namespaces)
    users = (namespace.element for namespace in namespaces if namespace.element is not None)
    user, tree = next(users, None), tree_of(text)
    return tree if user is None else writer.plan.resolver.resolve(user, tree)


def print_expression(writer: Writer, scope: Member | None, tree: syntax.Expression) -> str:
    """Return the SysML v2 text of an expression. Raises UnknownNameError."""
    return _ExpressionPrinter(writer.plan, scope).print(tree, 0)


def is_condition(writer: Writer, scope: Member | None, text: str) -> bool:
    """Whether a text is an expression whose value may be Boolean."""
    try:
        return _may_be_boolean(writer, scope, _read_tree(writer, scope, text))
    except (syntax.ExpressionError, UnknownNameError, RecursionError):
        return False


def _may_be_boolean(writer: Writer, scope: Member | None, tree: syntax.Expression) -> bool:
    match tree:
        case syntax.Literal(value):
            return isinstance(value, bool)
        case syntax.Unary(op):
            return op == "not"
        case syntax.Binary(op):
            return op not in _ARITHMETIC
        case syntax.Conditional(_, then, otherwise):
            return all(_may_be_boolean(writer, scope, branch) for branch in (then, otherwise))
        case syntax.Name() | syntax.Member():
            member = resolve_name(writer, scope, tree)
            return member is None or member.element is None or _has_boolean_type(writer, member)
    return True


def _has_boolean_type(writer: Writer, member: Member) -> bool:
    """Whether a feature is Boolean by its type and its default, as far as they are known."""
    element = member.element
    if element is None or member.shape.keyword not in ("attribute", "ref"):
        return element is None
    default = element.attrs.get("default", True)
    type_ = type_of(writer.graph, element)
    if type_ is None:
        return isinstance(default, bool)
    family = [type_, *generals(writer.graph, type_)]
    return isinstance(default, bool | str) and any(general.name == "Boolean" for general in family)


def resolve_name(writer: Writer, scope: Member | None, tree: syntax.Expression) -> Member | None:
    """Return the member that a name, or a chain of names, denotes. Raises UnknownNameError."""
    return _ExpressionPrinter(writer.plan, scope).print_chain(tree)[1]


class _ExpressionPrinter:
    """Prints expressions in one scope, with the fewest parentheses."""

    def __init__(self, plan: Plan, scope: Member | None) -> None:
        self._plan = plan
        self._scope = scope

    def print(self, tree: syntax.Expression, precedence: int) -> str:
        """Return the text of an operand of an operator with this precedence."""
        text, own_precedence = self._print_node(tree)
        return f"({text})" if own_precedence < precedence else text

    def print_chain(self, tree: syntax.Expression) -> tuple[str, Member | None]:
        """Return the text of a name or a chain of names, and the member that it denotes."""
        if isinstance(tree, syntax.Name):
            member = self._plan.find(self._plan.graph.get(tree.element))
            if member is None or not self._may_name(tree, member):
                raise UnknownNameError("::".join(tree.path))
            text = format_reference(self._plan, self._scope, member)
            if text is None:
                raise UnknownNameError(member.name)
            return text, member
        if isinstance(tree, syntax.Member):
            base, base_member = (
                self.print_chain(tree.base)
                if isinstance(tree.base, syntax.Name | syntax.Member)
                else (self.print(tree.base, POSTFIX), None)
            )
            feature = self._plan.find(self._plan.graph.get(tree.element))
            if feature is None or (base_member is not None and not base_member.shape.is_usage):
                # A definition or a package has no values of its features.
                raise UnknownNameError(tree.name)
            return f"{base}.{quote_name(feature.name)}", feature
        return self.print(tree, POSTFIX), None

    def _may_name(self, tree: syntax.Name, member: Member) -> bool:
        """Whether a name may denote the member here; parameters of an event need a payload."""
        is_literal = member.element is not None and member.element.kind is Kind.ENUMERATION_LITERAL
        is_plain = len(tree.path) == 1 and not is_literal
        return not is_plain or is_path_accessible(self._plan, self._scope, member)

    def _print_node(self, tree: syntax.Expression) -> tuple[str, int]:  # noqa: PLR0911 - a return for each kind
        """Return the text of an expression, and the precedence of its outermost operator."""
        match tree:
            case syntax.Literal(value):
                return _print_literal(value), POSTFIX
            case syntax.Name() | syntax.Member():
                text, member = self.print_chain(tree)
                if member is not None and not member.shape.is_usage:
                    # A definition or a package has no value.
                    raise UnknownNameError(member.name)
                return text, POSTFIX
            case syntax.Call(function, args):
                arguments = ", ".join(self.print(arg, 0) for arg in args)
                return f"{self.print_chain(function)[0]}({arguments})", POSTFIX
            case syntax.Index(base, index):
                return f"{self.print(base, POSTFIX)}#({self.print(index, 0)})", POSTFIX
            case syntax.Unary(op, operand):
                sign = "not " if op == "not" else op
                return f"{sign}{self.print(operand, UNARY)}", UNARY
            case syntax.Binary():
                return self._print_binary(tree)
            case syntax.Conditional(condition, then, otherwise):
                test, first, second = (
                    self.print(condition, 2),
                    self.print(then, 1),
                    self.print(otherwise, 1),
                )
                return f"if {test} ? {first} else {second}", 0

    def _print_binary(self, tree: syntax.Binary) -> tuple[str, int]:
        precedence = PRECEDENCE[tree.op]
        is_right_associative = tree.op == "implies"
        left = self.print(tree.left, precedence + is_right_associative)
        right = self.print(tree.right, precedence + (not is_right_associative))
        return f"{left} {tree.op} {right}", precedence


def _print_literal(value: bool | float | str) -> str:
    if isinstance(value, str):
        return quote_string(value)
    return str(value).lower()


# -- values --------------------------------------------------------------------------------------


def format_bounds(writer: Writer, scope: Member | None, multiplicity: str) -> str | None:
    """Return a multiplicity in brackets; None if a bound is neither a number nor an expression."""
    if bounds(multiplicity) is not None:
        return f"[{multiplicity}]"
    limits = [format_expression(writer, scope, part) for part in multiplicity.split("..")]
    return f"[{'..'.join(str(limit) for limit in limits)}]" if all(limits) else None


def format_value(
    writer: Writer, scope: Member | None, feature: Element, holder: Element, key: str = "value"
) -> str:
    """Return the value that attribute *key* of *holder* gives to a feature; empty for none."""
    value = holder.attrs.get(key)
    if value is None and key not in holder.attrs:
        return ""
    instance = writer.graph.get(str(holder.attrs.get(f"{key}_instance", "")))
    if instance is not None:
        name = writer.refer_to(scope, holder, Edge.REFERENCES, instance)
        return name or quote_string(instance.name)
    if f"{key}_language" in holder.attrs and isinstance(value, str):
        expression = format_expression(writer, scope, value)
        if expression is not None:
            return expression
    unit = holder.attrs.get(f"{key}_unit")
    if isinstance(unit, tuple) and isinstance(value, tuple):
        numbers = zip(value, unit, strict=True)
        return f"({', '.join(_format_quantity(writer, scope, *number) for number in numbers)})"
    if isinstance(unit, str):
        return _format_quantity(writer, scope, value, unit)
    return format_literal(writer, scope, feature, value)


def _format_quantity(
    writer: Writer, scope: Member | None, value: AttrValue, unit: AttrValue
) -> str:
    """Return a number, or several numbers in parentheses, with the unit that the value states."""
    number = f"({', '.join(map(repr, value))})" if isinstance(value, tuple) else repr(value)
    return f"{number} [{_refer_to_unit(writer, scope, str(unit))}]" if unit else number


def _refer_to_unit(writer: Writer, scope: Member | None, unit: str) -> str:
    """Return the name of a unit of the model or of a library, or the expression of a unit."""
    element = writer.graph.get(unit)
    if element is not None:
        name = writer.refer_to(scope, element, Edge.REFERENCES, element)
        return name or quote_name(element.name)
    if not _QUALIFIED_NAME.fullmatch(unit):
        return unit
    return writer.refer_to_library(scope, unit.replace("'", ""))


def format_literal(writer: Writer, scope: Member | None, feature: Element, value: AttrValue) -> str:
    """Return a value as a literal of the type of the feature."""
    if isinstance(value, tuple):
        return f"({', '.join(format_literal(writer, scope, feature, item) for item in value)})"
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return _format_number(writer, scope, feature, value)
    return _format_text(writer, scope, feature, value)


def _format_number(writer: Writer, scope: Member | None, feature: Element, value: float) -> str:
    """Return a number with its unit: that of the value, else that of the feature's type."""
    type_ = type_of(writer.graph, feature)
    text = repr(value)
    if text in ("inf", "-inf", "nan"):
        return quote_string(text)
    if type_ is None or find_quantity(writer.graph, type_) is None:
        return text
    unit = find_unit_name(unit_of(writer.graph, type_))
    return text if unit is None else f"{text} [{writer.refer_to_library(scope, unit)}]"


def _format_text(writer: Writer, scope: Member | None, feature: Element, text: str) -> str:
    """Return a text as an enumeration literal or number if the type allows it, else as a string."""
    type_ = type_of(writer.graph, feature)
    family = [] if type_ is None else [type_, *generals(writer.graph, type_)]
    for general in family:
        literal = _find_literal(writer.graph, general, text)
        if literal is not None:
            name = writer.refer_to(scope, feature, Edge.REFERENCES, literal)
            return name or quote_string(text)
        is_number_type = general.name in _NUMBERS and general.attrs.get("external")
        if is_number_type and _is_number(text):
            number = float(text) if "." in text else int(text)
            return _format_number(writer, scope, feature, number)
    return quote_string(text)


def _find_literal(graph: Graph, type_: Element, name: str) -> Element | None:
    """Return the literal of an enumeration by its name; None for any other type."""
    if type_.kind is not Kind.ENUMERATION:
        return None
    literals = (item for item in graph.owned(type_) if item.kind is Kind.ENUMERATION_LITERAL)
    return next((literal for literal in literals if literal.name == name), None)


def _is_number(text: str) -> bool:
    return text.isascii() and text.replace(".", "", 1).isdigit() and not text.endswith(".")
