"""Small contracts for tests, a line a variable or a conjunct.

``env a: bool``, ``sys n: 0..3``, ``sys c: red green`` declare; ``assume always a -> a'`` and
``promise recurs n=3`` are conjuncts; ``at first``, ``always`` and ``recurs`` are the classes.
"""

from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.infix import parse_formula

CLASSES = {"at first": Class.INIT, "always": Class.SAFETY, "recurs": Class.LIVENESS}
SIDES = {"assume": [], "promise": []}


def contract(text: str, name: str = "c") -> Contract:
    """The contract of the lines."""
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    variables = [declared(line) for line in lines if line.split()[0] in ("env", "sys")]
    sides = {
        side: tuple(
            conjunct(line.removeprefix(f"{side} "), variables)
            for line in lines
            if line.startswith(f"{side} ")
        )
        for side in SIDES
    }
    return Contract(name, "", tuple(variables), sides["assume"], sides["promise"])


def declared(line: str) -> Variable:
    head, _, values = line.partition(":")
    owner, name = head.split()
    return Variable(name, Owner(owner), domain(values.strip()))


def domain(text: str):
    if text == "bool":
        return BooleanDomain()
    if ".." in text:
        return IntegerDomain(*map(int, text.split("..")))
    return EnumerationDomain(tuple(text.split()))


def conjunct(text: str, variables: list[Variable]) -> Conjunct:
    known = {one.name: one.domain for one in variables}
    for words, class_ in CLASSES.items():
        if text.startswith(f"{words} "):
            formula = text.removeprefix(f"{words} ")
            return Conjunct(parse_formula(formula, known), class_, "", formula)
    return Conjunct(parse_formula(text, known), Class.OTHER, "", text)
