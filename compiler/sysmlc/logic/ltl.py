"""Reader of formulas: the neutral form that ``printing`` writes, and SPIN's spelling of LTL."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING

from sysmlc import resources
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var

if TYPE_CHECKING:
    from lark import Lark, Token, Tree

_TEMPORAL = {"G": Op.ALWAYS, "[]": Op.ALWAYS, "F": Op.EVENTUALLY, "<>": Op.EVENTUALLY}
_TEMPORAL["X"] = Op.NEXT
_UNTIL = {"U": Op.UNTIL, "R": Op.RELEASE, "V": Op.RELEASE, "W": Op.WEAK_UNTIL}
_ORDERS = (Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE)
_ARITHMETIC = (Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD)


class FormulaError(ValueError):
    """Text that is no formula over the variables."""


def parse_formula(text: str, variables: Mapping[str, Domain]) -> Formula:
    """Read a formula; a name is a variable, or a literal when an enumeration asks for it.

    Raises FormulaError when the text is no formula or names what is neither.
    """
    from lark.exceptions import UnexpectedInput

    try:
        tree = _parser().parse(text)
    except UnexpectedInput as error:
        place = error.pos_in_stream or 0
        raise FormulaError(f"'{text[place : place + 20]}' is not expected here") from None
    return _checked(_build(_only(tree), variables), variables)


@cache
def _parser() -> "Lark":
    from lark import Lark

    return Lark(resources.text("grammars", "ltl.lark"), parser="lalr", maybe_placeholders=False)


def _only(tree: "Tree[Token]") -> "Tree[Token]":
    return _nodes(tree)[0]


def _nodes(tree: "Tree[Token]") -> "list[Tree[Token]]":
    return [child for child in tree.children if not isinstance(child, str)]


def _words(tree: "Tree[Token]") -> list[str]:
    return [str(child) for child in tree.children if isinstance(child, str)]


def _build(tree: "Tree[Token]", variables: Mapping[str, Domain]) -> Formula:
    rule = str(tree.data)
    if rule in _ATOMS:
        return _ATOMS[rule](*_words(tree))
    args = [_build(node, variables) for node in _nodes(tree)]
    if rule in _CONNECTIVES:
        return _CONNECTIVES[rule](*args)
    return _operator(_words(tree)[0], args, variables)


def _operator(word: str, args: list[Formula], variables: Mapping[str, Domain]) -> Formula:
    if word in _TEMPORAL:
        return Apply(_TEMPORAL[word], tuple(args))
    if word in _UNTIL:
        return Apply(_UNTIL[word], tuple(args))
    op = Op("=" if word == "==" else word)
    left, right = args
    if op in _ORDERS:
        left, right = _named(left, right, variables), _named(right, left, variables)
    return f.compare(op, left, right)


def _named(side: Formula, other: Formula, variables: Mapping[str, Domain]) -> Formula:
    if not isinstance(side, Var) or not isinstance(other, Var):
        return side
    domain = variables.get(other.name)
    is_literal = isinstance(domain, EnumerationDomain) and side.name in domain.literals
    return Const(side.name) if is_literal else side


def _checked(formula: Formula, variables: Mapping[str, Domain]) -> Formula:
    for variable in f.variables(formula):
        if variable.name not in variables:
            raise FormulaError(f"'{variable.name}' is neither a variable nor a literal")
    _expect_truth(formula, variables)
    return formula


def _expect_truth(formula: Formula, variables: Mapping[str, Domain]) -> None:
    match formula:
        case Var(name) if not isinstance(variables[name], BooleanDomain):
            raise FormulaError(f"'{name}' is not Boolean")
        case Const(value) if not isinstance(value, bool):
            raise FormulaError(f"'{value}' is not Boolean")
        case Apply(op) if op in _ARITHMETIC:
            raise FormulaError("a number stands where a condition is expected")
        case Apply(op, args) if op not in _ORDERS:
            for arg in args:
                _expect_truth(arg, variables)


_ATOMS: dict[str, Callable[..., Formula]] = {
    "name": Var,
    "primed": lambda name: Var(name, primed=True),
    "integer": lambda digits: Const(int(digits)),
    "true": lambda _: f.TRUE,
    "false": lambda _: f.FALSE,
}
_CONNECTIVES: dict[str, Callable[..., Formula]] = {
    "negate": f.negate,
    "both": f.both,
    "either": f.either,
    "implies": f.implies,
    "iff": f.iff,
}
