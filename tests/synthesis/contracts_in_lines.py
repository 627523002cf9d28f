"""Small contracts for tests, with one line for each variable and each conjunct.

``env a: bool``, ``sys n: 0..3``, ``sys c: red green`` declare; ``assume always a -> a'`` and
``promise recurs n=3`` are conjuncts; ``at first``, ``always`` and ``recurs`` are the classes.
``env t: number 18 22 K`` is a number in kelvin: below_18_K, _18_K_to_22_K or from_22_K;
``number 18 Integer`` has the Integers below 18 and from 18 on.
"""

from fractions import Fraction

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
from sysmlc.logic.domains import make_region_domain
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.regions import Cut, Regions, split_line

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
    domain = parse_domain(values.strip())
    term = ((name, Fraction(1)),) if values.split()[0] == "number" else ()
    return Variable(name, Owner(owner), domain, term=term)


def parse_domain(text: str):
    if text == "bool":
        return BooleanDomain()
    if ".." in text:
        return IntegerDomain(*map(int, text.split("..")))
    first, *words = text.split()
    if first != "number":
        return EnumerationDomain((first, *words))
    cuts = [Cut(Fraction(word)) for word in words if not word.isalpha()]
    unit = "".join(word for word in words if word.isalpha() and word != "Integer")
    is_integral = "Integer" in words
    return make_region_domain(Regions(split_line(cuts), unit, is_integral, symbol=unit))


def parse_conjunct(text: str, variables: list[Variable]) -> Conjunct:
    domains = {variable.name: variable.domain for variable in variables}
    for words, class_ in CLASSES.items():
        if text.startswith(f"{words} "):
            formula = text.removeprefix(f"{words} ")
            return Conjunct(parse_formula(formula, domains), class_, "", formula)
    return Conjunct(parse_formula(text, domains), Class.OTHER, "", text)


def describe_elevator(floors: int) -> str:
    """Return the text of a contract: each call is answered at its floor with the door open.

    The calls are declared above the floor. The door opens only where a call was made.
    """
    calls = range(floors)
    neighbours = [[m for m in (n - 1, n, n + 1) if m in calls] for n in calls]
    lines = [f"env call{n}: bool" for n in calls]
    lines += [f"sys floor: 0..{floors - 1}", "sys open: bool", "promise at first floor=0"]
    lines.append("promise always open | open' -> floor'=floor")
    for n in calls:
        moves = " | ".join(f"floor'={m}" for m in neighbours[n])
        lines += [
            f"assume always call{n} & !(floor={n} & open) -> call{n}'",
            f"promise always floor={n} -> {moves}",
            f"promise always open' & floor'={n} -> call{n}'",
            f"promise recurs call{n} -> floor={n} & open",
        ]
    idle = " & ".join(f"!call{n}" for n in calls)
    lines.append(f"promise always {idle} -> floor'=floor")
    return "\n".join(lines)
