"""Text of a contract file, and a contract that is collected while a text is read.

Every fault is reported. A contract with a fault is omitted from the result, so that no step after
the reader works on half a contract.
"""

from bisect import bisect_right
from collections.abc import Callable, Iterator
from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify, convert_to_class
from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, Owner, Source, Variable
from sysmlc.logic.formats import rules
from sysmlc.logic.formula import Formula, Op
from sysmlc.logic.infix import FormulaReader
from sysmlc.logic.printing import print_formula
from sysmlc.logic.syntax import Cursor, FormulaError, Syntax

SIDES = {Owner.ENVIRONMENT: "assumptions", Owner.SYSTEM: "guarantees"}
"""The conjuncts that each owner promises."""
SECTION_NAMES = {
    (side, class_): side if class_ is Class.OTHER else f"{class_} {side}"
    for side in SIDES.values()
    for class_ in Class
}
"""What messages call the conjuncts of one side and class."""


class SpecificationFile(Struct, frozen=True):
    """The text of a file, its path, and the sink for diagnostics about it."""

    text: str
    path: str
    sink: Sink
    line_starts: tuple[int, ...]
    appended: "tuple[tuple[int, SpecificationFile], ...]" = ()
    """Files whose texts follow the text of this file, each with the offset where it begins."""
    include: tuple[Path, ...] = ()
    """Folders that imports may lead into, besides that of the file."""

    @classmethod
    def from_text(cls, text: str, path: str, sink: Sink) -> "SpecificationFile":
        """Return a file with the offsets of its lines."""
        line_starts = [0]
        line_starts.extend(offset + 1 for offset, char in enumerate(text) if char == "\n")
        return cls(text, path, sink, tuple(line_starts))

    def append(self, text: str, path: str) -> "SpecificationFile":
        """Return this file followed by the text of another file, which keeps its locations."""
        start = len(self.text) + 1
        other = SpecificationFile.from_text(text, path, self.sink)
        return replace(self, text=f"{self.text}\n{text}", appended=(*self.appended, (start, other)))

    def locate(self, offset: int) -> tuple[str, int, int]:
        """Return the path of the file that contains a character, its line and column from 1."""
        for start, other in reversed(self.appended):
            if offset >= start:
                return other.locate(offset - start)
        line = bisect_right(self.line_starts, offset)
        return self.path, line, offset - self.line_starts[line - 1] + 1

    def origin_at(self, offset: int) -> str:
        """Return a location as the origin of a conjunct: ``file:line:column``."""
        path, line, column = self.locate(offset)
        return f"{path}:{line}:{column}"

    def report(self, rule: Rule, offset: int, **facts: str) -> None:
        """Report a rule about the character at the offset."""
        path, line, column = self.locate(offset)
        place = Place(path, line=line, column=column)
        printable: dict[str, object] = {
            # JSON can escape lone surrogates, which UTF-8 cannot encode.
            name: fact.encode("utf-8", "replace").decode("utf-8")
            for name, fact in facts.items()
        }
        self.sink.report(rule, Subject(place=place), notes=(), help="", cause="", **printable)


class ContractDraft:
    """Collects the variables and conjuncts of one contract while its text is read."""

    def __init__(self, file: SpecificationFile, language: str) -> None:
        self.file = file
        self.language = language
        """What messages call the language of the file."""
        self.is_broken = False
        self.variables: dict[str, Variable] = {}
        self.domains: dict[str, Domain] = {}
        self._conjuncts: dict[Owner, list[Conjunct]] = {owner: [] for owner in Owner}

    def declare(self, name: str, offset: int, owner: Owner, domain: Domain) -> None:
        """Add a variable; report a name that is declared already."""
        if name in self.variables:
            self.report_fault(rules.DECLARED_TWICE, offset, name=name)
            return
        self.variables[name] = Variable(name, owner, domain)
        self.domains[name] = domain

    def report_fault(self, rule: Rule, offset: int, **facts: str) -> None:
        """Report a fault, which omits the contract from the result."""
        self.is_broken = True
        self.file.report(rule, offset, **facts)

    def report_not_understood(self, offset: int, reason: str) -> None:
        """Report text that does not follow the grammar of the language."""
        self.report_fault(rules.NOT_UNDERSTOOD, offset, form=self.language, reason=reason)

    def report_outside(self, offset: int, what: str) -> None:
        """Report a construct of the language that this reader does not support."""
        self.report_fault(rules.OUTSIDE, offset, what=what, form=self.language)

    def read_statement(self, cursor: Cursor, read: Callable[[], None], *ends: str) -> None:
        """Call *read*; if it fails, report the fault and continue behind the next of the ends."""
        try:
            read()
        except FormulaError as error:
            self.report_not_understood(error.offset, str(error))
            cursor.skip_past(*ends)

    def read_formula(self, owner: Owner, class_: Class, read: Callable[[], None]) -> bool:
        """Call *read* for formulas of a section; report a failure, return whether it succeeded."""
        try:
            read()
        except FormulaError as error:
            section = SECTION_NAMES[SIDES[owner], class_]
            self.report_fault(rules.WRONG_FORMULA, error.offset, section=section, reason=str(error))
            return False
        return True

    def add(
        self,
        owner: Owner,
        class_: Class,
        formula: Formula,
        offset: int,
        text: str = "",
        source: Source = Source.AUTHOR,
    ) -> None:
        """Add a conjunct whose section determines its class; report one that cannot have it."""
        step = convert_to_class(formula, class_)
        if step is None:
            reason = "it looks further than one step"
            if class_ is Class.INIT:
                reason = "it refers to the next step"
            self._report_wrong_class(owner, class_, formula, offset, reason)
        elif step != f.TRUE:
            origin = self.file.origin_at(offset)
            self._conjuncts[owner].append(Conjunct(step, class_, origin, text, source=source))

    def add_classified(self, owner: Owner, class_: Class, formula: Formula, offset: int) -> None:
        """Add the conjuncts of a formula in LTL; report those that are not of the class."""
        for actual_class, part in classify(formula):
            if actual_class is class_:
                self.add(owner, class_, part, offset)
            else:
                reason = f"it is of class {actual_class}"
                self._report_wrong_class(owner, class_, formula, offset, reason)

    def _report_wrong_class(
        self, owner: Owner, class_: Class, formula: Formula, offset: int, reason: str
    ) -> None:
        self.report_fault(
            rules.WRONG_CLASS,
            offset,
            formula=print_formula(formula),
            section=SECTION_NAMES[SIDES[owner], class_],
            reason=reason,
        )

    def add_ltl(self, owner: Owner, formula: Formula, offset: int) -> None:
        """Add the conjuncts of a formula in LTL, whose operators determine their classes."""
        for class_, part in classify(formula):
            # Formats that demand a formula in each section write "true" for no conjuncts.
            if part != f.TRUE:
                conjunct = Conjunct(part, class_, self.file.origin_at(offset))
                self._conjuncts[owner].append(conjunct)

    def add_derived(self, owner: Owner, conjunct: Conjunct) -> None:
        """Add a conjunct that another conjunct needs, such as the definition of a history bit."""
        self._conjuncts[owner].append(conjunct)

    def build(self, name: str, origin: str = "") -> tuple[Contract, ...]:
        """Return the contract, or nothing if a fault was reported."""
        if self.is_broken:
            return ()
        assumptions, guarantees = (tuple(self._conjuncts[owner]) for owner in Owner)
        variables = tuple(self.variables.values())
        return (Contract(name, origin, variables, assumptions, guarantees),)


def read_conjuncts(
    reader: FormulaReader, syntax: Syntax, *ends: str
) -> Iterator[tuple[Formula, int]]:
    """Yield the conjuncts of a formula up to one of the ends, each with its offset.

    A formula that is not a conjunction is yielded whole. Raises FormulaError.
    """
    cursor = reader.cursor
    start, conjuncts = cursor.mark(), []
    while True:
        offset = cursor.next.offset
        term = reader.read_term(syntax.precedence[Op.AND] + 1)
        conjuncts.append((reader.require_boolean(term), offset))
        if not cursor.accept("&", "&&", "/\\"):
            break
    if not cursor.is_next(*ends) and not cursor.is_at_end:
        # An operator that binds more weakly than "and" follows: `a & b -> c` has one conjunct.
        cursor.reset(start)
        conjuncts = [(reader.read_formula(), cursor.next.offset)]
    yield from conjuncts
