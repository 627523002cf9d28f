"""Formulas as Lark parses them with grammars/ltl.lark, the oracle for ``logic.infix``."""

from functools import cache

from lark import Lark

from sysmlc.logic import formula as f
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.support import resources

TEMPORAL = {"G": Op.ALWAYS, "[]": Op.ALWAYS, "F": Op.EVENTUALLY, "<>": Op.EVENTUALLY, "X": Op.NEXT}
UNTIL = {"U": Op.UNTIL, "R": Op.RELEASE, "V": Op.RELEASE, "W": Op.WEAK_UNTIL}
CONNECTIVES = {
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
def create_parser():
    return Lark(
        resources.read_text("grammars", "ltl.lark"), parser="lalr", maybe_placeholders=False
    )


def parse_with_grammar(text):
    """Return the formula with literals of enumerations as variables.

    Raises lark's UnexpectedInput.
    """
    return build_formula(child_nodes(create_parser().parse(text))[0])


def child_nodes(tree):
    return [child for child in tree.children if not isinstance(child, str)]


def build_formula(tree):
    words = [str(child) for child in tree.children if isinstance(child, str)]
    if tree.data in ATOMS:
        return ATOMS[tree.data](*words)
    args = [build_formula(node) for node in child_nodes(tree)]
    if tree.data in CONNECTIVES:
        return CONNECTIVES[tree.data](*args)
    word = words[0]
    op = TEMPORAL.get(word) or UNTIL.get(word) or Op("=" if word == "==" else word)
    return Apply(op, tuple(args))
