"""A contract while its text is read: what was declared and said, and what was wrong with it."""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Rule
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify, convert_to_class
from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, Owner, Variable
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import SECTIONS
from sysmlc.logic.formats.file import File
from sysmlc.logic.formula import Formula, Op
from sysmlc.logic.infix import Reader
from sysmlc.logic.printing import print_formula
from sysmlc.logic.spelling import Cursor, FormulaError, Syntax

SIDE = {Owner.ENVIRONMENT: "assumptions", Owner.SYSTEM: "guarantees"}


class Draft:
    """Collects one contract; ``form`` is what messages call the language."""

    def __init__(self, file: File, form: str) -> None:
        self.file = file
        self.form = form
        self.is_broken = False
        self.variables: dict[str, Variable] = {}
        self.domains: dict[str, Domain] = {}
        self._sides: dict[Owner, list[Conjunct]] = {owner: [] for owner in Owner}

    def declare(self, name: str, at: int, owner: Owner, domain: Domain) -> None:
        """Add a variable; a name that is there already is reported."""
        if name in self.variables:
            self.fault(rules.DECLARED_TWICE, at, name=name)
            return
        self.variables[name] = Variable(name, owner, domain)
        self.domains[name] = domain

    def fault(self, rule: Rule, at: int, **facts: str) -> None:
        """Report what is wrong with the contract; it is not among the results then."""
        self.is_broken = True
        self.file.report(rule, at, **facts)

    def statement(self, cursor: Cursor, read: Callable[[], None], *ends: str) -> None:
        """Read something; when it is not understood, report it and go on behind its end."""
        try:
            read()
        except FormulaError as error:
            self.fault(rules.NOT_UNDERSTOOD, error.at, form=self.form, reason=str(error))
            cursor.skip_behind(*ends)

    def formula(self, owner: Owner, class_: Class, read: Callable[[], None]) -> bool:
        """Read a formula of a section; whether it was understood, else it is reported."""
        try:
            read()
        except FormulaError as error:
            section = SECTIONS[SIDE[owner], class_]
            self.fault(rules.WRONG_FORMULA, error.at, section=section, reason=str(error))
            return False
        return True

    def add(self, owner: Owner, class_: Class, formula: Formula, at: int, text: str = "") -> None:
        """Add a conjunct whose class is said by where it stands."""
        step = convert_to_class(formula, class_)
        if step is None:
            reason = "it looks further than one step"
            reason = "it speaks of the next step" if class_ is Class.INIT else reason
            section, shown = SECTIONS[SIDE[owner], class_], print_formula(formula)
            self.fault(rules.WRONG_CLASS, at, formula=shown, section=section, reason=reason)
        elif step != f.TRUE:
            self._sides[owner].append(Conjunct(step, class_, self.file.origin(at), text))

    def add_classified(self, owner: Owner, class_: Class, formula: Formula, at: int) -> None:
        """Add the conjuncts of a formula whose operators must say the class of its section."""
        for found, part in classify(formula):
            if found is class_:
                self.add(owner, class_, part, at)
                continue
            section, shown = SECTIONS[SIDE[owner], class_], print_formula(formula)
            reason = f"it is of class {found}"
            self.fault(rules.WRONG_CLASS, at, formula=shown, section=section, reason=reason)

    def add_ltl(self, owner: Owner, formula: Formula, at: int) -> None:
        """Add the conjuncts of a formula in LTL, whose operators say their classes."""
        for class_, part in classify(formula):
            if part != f.TRUE:
                self._sides[owner].append(Conjunct(part, class_, self.file.origin(at)))

    def add_made(self, owner: Owner, conjunct: Conjunct) -> None:
        """Add a conjunct that is made for another one."""
        self._sides[owner].append(conjunct)

    def contracts(self, name: str, origin: str = "") -> tuple[Contract, ...]:
        """The contract, or nothing when something was wrong with it."""
        if self.is_broken:
            return ()
        assumptions, guarantees = (tuple(self._sides[owner]) for owner in Owner)
        variables = tuple(self.variables.values())
        return (Contract(name, origin, variables, assumptions, guarantees),)


def joined(reader: Reader, syntax: Syntax, *ends: str) -> Iterator[tuple[Formula, int]]:
    """The conjuncts of a formula up to one of the ends, each with its place.

    Raises FormulaError.
    """
    cursor = reader.cursor
    start, found = cursor.mark(), []
    while True:
        at = cursor.next.at
        found.append((reader.truth(reader.part(syntax.strength[Op.AND] + 1)), at))
        if not cursor.took("&", "&&", "/\\"):
            break
    if not cursor.has(*ends) and cursor.next.kind != "end":
        cursor.back_to(start)
        found = [(reader.formula(), cursor.next.at)]
    yield from found
