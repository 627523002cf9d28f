"""Small contracts for tests, with one line for each variable and each conjunct.

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


def parse_contract(text: str, name: str = "c") -> Contract:
    """Parse the lines of *text* into a contract."""
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    variables = [parse_variable(line) for line in lines if line.split()[0] in ("env", "sys")]
    sides = {
        side: tuple(
            parse_conjunct(line.removeprefix(f"{side} "), variables)
            for line in lines
            if line.startswith(f"{side} ")
        )
        for side in SIDES
    }
    return Contract(name, "", tuple(variables), sides["assume"], sides["promise"])


def parse_variable(line: str) -> Variable:
    head, _, values = line.partition(":")
    owner, name = head.split()
    return Variable(name, Owner(owner), parse_domain(values.strip()))


def parse_domain(text: str):
    if text == "bool":
        return BooleanDomain()
    if ".." in text:
        return IntegerDomain(*map(int, text.split("..")))
    return EnumerationDomain(tuple(text.split()))


def parse_conjunct(text: str, variables: list[Variable]) -> Conjunct:
    domains = {variable.name: variable.domain for variable in variables}
    for words, class_ in CLASSES.items():
        if text.startswith(f"{words} "):
            formula = text.removeprefix(f"{words} ")
            return Conjunct(parse_formula(formula, domains), class_, "", formula)
    return Conjunct(parse_formula(text, domains), Class.OTHER, "", text)
