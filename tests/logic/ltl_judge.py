"""Formulas as Lark reads them from grammars/ltl.lark: the reader by precedence is held to it."""

from functools import cache

from lark import Lark

from sysmlc.logic import formula as f
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.support import resources

TEMPORAL = {"G": Op.ALWAYS, "[]": Op.ALWAYS, "F": Op.EVENTUALLY, "<>": Op.EVENTUALLY, "X": Op.NEXT}
UNTIL = {"U": Op.UNTIL, "R": Op.RELEASE, "V": Op.RELEASE, "W": Op.WEAK_UNTIL}
JOINS = {
    "negate": f.negate,
    "both": f.both,
    "either": f.either,
    "implies": f.implies,
    "iff": f.iff,
}
ATOMS = {
    "name": Var,
    "primed": lambda name: Var(name, primed=True),
    "integer": lambda digits: Const(int(digits)),
    "true": lambda _: f.TRUE,
    "false": lambda _: f.FALSE,
}


@cache
def parser():
    return Lark(
        resources.read_text("grammars", "ltl.lark"), parser="lalr", maybe_placeholders=False
    )


def judge(text):
    """The formula, with enumerations' literals as variables. Raises lark's UnexpectedInput."""
    return build(nodes(parser().parse(text))[0])


def nodes(tree):
    return [child for child in tree.children if not isinstance(child, str)]


def build(tree):
    words = [str(child) for child in tree.children if isinstance(child, str)]
    if tree.data in ATOMS:
        return ATOMS[tree.data](*words)
    args = [build(node) for node in nodes(tree)]
    if tree.data in JOINS:
        return JOINS[tree.data](*args)
    word = words[0]
    op = TEMPORAL.get(word) or UNTIL.get(word) or Op("=" if word == "==" else word)
    return Apply(op, tuple(args))
