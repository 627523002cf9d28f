"""What came of scenarios: as text, as JUnit XML, and as a sequence diagram."""

from collections.abc import Iterator
from xml.etree import ElementTree

from msgspec import Struct, field

from sysmlc.logic.formula import Literal
from sysmlc.support.escapes import escape_invisible
from sysmlc.support.plantuml_text import plain

Valuation = dict[str, Literal]


class Difference(Struct, frozen=True):
    """The first value that is not as expected; steps count from 0, lines from 1."""

    step: int
    variable: str
    expected: Literal
    found: Literal | None
    line: int

    def __str__(self) -> str:
        expected, found = _show(self.expected), _show(self.found)
        return f"step {self.step}: {self.variable} is {found}, expected {expected}"


class Result(Struct, frozen=True):
    """One scenario. ``trace`` is a run that shows the expected values, or comes nearest."""

    name: str
    component: str
    line: int
    trace: tuple[Valuation, ...] = ()
    difference: Difference | None = None
    inputs: frozenset[str] = field(default_factory=frozenset)
    is_valid: bool = True

    @property
    def passed(self) -> bool:
        """Whether some run of the diagram shows everything that is expected."""
        return self.is_valid and self.difference is None


class Report(Struct, frozen=True):
    """The results of all scenarios of a file."""

    file: str
    results: tuple[Result, ...]

    @property
    def passed(self) -> bool:
        """Whether there are scenarios and all of them passed."""
        return bool(self.results) and all(result.passed for result in self.results)

    def text(self) -> str:
        """One line a scenario, and how many passed."""
        lines = [line for result in self.results for line in self._lines(result)]
        passed = sum(result.passed for result in self.results)
        return "\n".join([*lines, f"{passed} of {len(self.results)} scenarios passed"]) + "\n"

    def _lines(self, result: Result) -> Iterator[str]:
        what = escape_invisible(f"{result.component}: {result.name}")
        if result.passed:
            yield f"passed  {what} ({_steps(len(result.trace))})"
        elif result.difference is None:
            yield f"invalid {what}"
        else:
            yield f"FAILED  {what}"
            difference = escape_invisible(str(result.difference))
            yield f"        {self.file}:{result.difference.line}: {difference}"

    def junit(self) -> str:
        """JUnit XML without times, so that the same run gives the same bytes."""
        failures = sum(result.difference is not None for result in self.results)
        errors = sum(not result.is_valid for result in self.results)
        counts = {"tests": len(self.results), "failures": failures, "errors": errors}
        attributes = {name: str(number) for name, number in counts.items()}
        root = ElementTree.Element("testsuites", attributes)
        suite = ElementTree.SubElement(root, "testsuite", {"name": self.file, **attributes})
        for result in self.results:
            self._add_case(suite, result)
        ElementTree.indent(root)
        text = ElementTree.tostring(root, encoding="unicode")
        return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'

    def _add_case(self, suite: ElementTree.Element, result: Result) -> None:
        place = {"file": self.file, "line": str(result.line)}
        names = {"classname": _clean(result.component), "name": _clean(result.name)}
        case = ElementTree.SubElement(suite, "testcase", {**names, **place})
        if result.difference is not None:
            message = _clean(str(result.difference))
            failure = ElementTree.SubElement(case, "failure", {"message": message})
            failure.text = f"{self.file}:{result.difference.line}: {message}"
        elif not result.is_valid:
            ElementTree.SubElement(case, "error", {"message": "the scenario is not valid"})

    def sequence_diagram(self) -> str:
        """The first failing run (the first run when none fails) as a PlantUML diagram.

        It has one message for each variable that changes: from the environment for inputs,
        from the component for the others. Empty when nothing was run.
        """
        run = [result for result in self.results if result.trace]
        failed = [result for result in run if result.difference is not None]
        chosen = next(iter([*failed, *run]), None)
        return "" if chosen is None else "\n".join(_diagram(chosen)) + "\n"


def _clean(text: str) -> str:
    """The text without characters that XML forbids."""
    return "".join(c for c in text if c in "\t\n" or (c >= " " and not "\ud800" <= c <= "\udfff"))


def _steps(number: int) -> str:
    return "1 step" if number == 1 else f"{number} steps"


def _show(value: Literal | None) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "unknown" if value is None else str(value)


# -- the diagram -------------------------------------------------------------------------------


def _diagram(result: Result) -> Iterator[str]:
    yield "@startuml"
    yield f"title {plain(result.name)}"
    yield "hide footbox"
    yield "participant environment"
    yield f'participant "{plain(result.component)}" as component'
    before: Valuation = {}
    for number, now in enumerate(result.trace):
        messages = list(_messages(result, before, now))
        failed = result.difference is not None and result.difference.step == number
        if messages or failed:
            yield f"== step {number} =="
        yield from messages
        if failed:
            yield from _note(result)
        before = now
    yield "@enduml"


def _messages(result: Result, before: Valuation, now: Valuation) -> Iterator[str]:
    """What differs from the step before; at first, what is not false."""
    changed = [name for name in now if now[name] != before.get(name, False)]
    for name in sorted(changed, key=lambda name: name not in result.inputs):
        arrow = "environment -> component" if name in result.inputs else "component -> environment"
        yield f"{arrow} : {plain(name)} = {plain(_show(now[name]))}"


def _note(result: Result) -> Iterator[str]:
    assert result.difference is not None
    difference = result.difference
    yield "note over component #FFDDDD"
    yield f"  {plain(difference.variable)} is {plain(_show(difference.found))}"
    yield f"  expected: {plain(_show(difference.expected))}"
    yield "end note"
