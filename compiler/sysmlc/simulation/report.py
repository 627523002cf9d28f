"""Reports of played scenarios: as text, as JUnit XML, and as a sequence diagram."""

from collections.abc import Iterator, Mapping

from lxml import etree
from msgspec import Struct, field

from sysmlc.logic.formula import Literal
from sysmlc.logic.machines.interpreter import Valuation
from sysmlc.logic.quantities import Quantity, StepQuantities, show_numbers
from sysmlc.support.counts import count
from sysmlc.support.escapes import escape_invisible, replace_illegal_in_xml
from sysmlc.support.plantuml_text import escape_line
from sysmlc.support.xml_text import print_element

ShownValues = Mapping[str, Literal | Quantity]


class Difference(Struct, frozen=True):
    """The first value that differs from the expected one; steps and lines count from 1."""

    step: int
    variable: str
    expected: Literal
    actual: Literal | None
    line: int

    def __str__(self) -> str:
        expected, actual = show_value(self.expected), show_value(self.actual)
        return f"step {self.step}: {self.variable} is {actual}, expected {expected}"


class Result(Struct, frozen=True):
    """Result of one scenario.

    ``trace`` is a run of the diagram that shows the expected values, or the run that comes closest.
    ``is_valid`` is false for a scenario that was not played, ``is_decided`` for one with more runs
    than were followed; a diagnostic says why.
    """

    name: str
    component: str
    line: int
    trace: tuple[Valuation, ...] = ()
    difference: Difference | None = None
    inputs: frozenset[str] = field(default_factory=frozenset)
    is_valid: bool = True
    is_decided: bool = True
    numbers: tuple[StepQuantities, ...] = ()
    """Numbers in place of regions, for each step of the run; empty without regions."""
    range_text: str = ""
    """The assumed ranges at whose bounds the run has values, as a phrase behind the verdict."""

    @property
    def passed(self) -> bool:
        """Whether some run of the diagram shows every expected value."""
        return self.is_valid and self.is_decided and self.difference is None


class Report(Struct, frozen=True):
    """The results of all scenarios of a file."""

    file: str
    results: tuple[Result, ...]

    @property
    def passed(self) -> bool:
        """Whether there are scenarios and all of them passed."""
        return bool(self.results) and all(result.passed for result in self.results)

    def as_text(self) -> str:
        """Return one line for each scenario, and the number that passed."""
        lines = [line for result in self.results for line in self._iter_result_lines(result)]
        passed = sum(result.passed for result in self.results)
        return (
            "\n".join([*lines, f"{passed} of {count(len(self.results), 'scenario')} passed"]) + "\n"
        )

    def _iter_result_lines(self, result: Result) -> Iterator[str]:
        title = escape_invisible(f"{result.component}: {result.name}")
        if result.passed:
            yield f"passed  {title} ({count(len(result.trace), 'step')}){result.range_text}"
        elif not result.is_decided:
            yield f"not decided {title}"
        elif result.difference is None:
            yield f"invalid {title}"
        else:
            yield f"FAILED  {title}{result.range_text}"
            difference = escape_invisible(str(result.difference))
            yield f"        {self.file}:{result.difference.line}: {difference}"

    def as_junit(self) -> str:
        """Return the report as JUnit XML."""
        # The report has no times, so that equal runs give equal bytes.
        failures = sum(result.difference is not None for result in self.results)
        errors = sum(not (r.is_valid and r.is_decided) for r in self.results)
        counts = {"tests": len(self.results), "failures": failures, "errors": errors}
        attributes = {name: str(number) for name, number in counts.items()}
        root = etree.Element("testsuites", attributes)
        suite = etree.SubElement(root, "testsuite", {"name": self._xml_file, **attributes})
        for result in self.results:
            self._add_case(suite, result)
        return print_element(root)

    @property
    def _xml_file(self) -> str:
        return replace_illegal_in_xml(self.file)[0]

    def _add_case(self, suite: "etree._Element", result: Result) -> None:
        position = {"file": self._xml_file, "line": str(result.line)}
        names = {
            "classname": replace_illegal_in_xml(result.component)[0],
            "name": replace_illegal_in_xml(result.name)[0],
        }
        case = etree.SubElement(suite, "testcase", {**names, **position})
        if result.difference is not None:
            message = replace_illegal_in_xml(str(result.difference))[0]
            failure = etree.SubElement(case, "failure", {"message": message})
            failure.text = f"{self._xml_file}:{result.difference.line}: {message}"
        elif not result.is_valid:
            etree.SubElement(case, "error", {"message": "the scenario is not valid"})
        elif not result.is_decided:
            etree.SubElement(case, "error", {"message": "the scenario is not decided"})

    def sequence_diagram(self) -> str:
        """Return the first failing run, else the first run, as a PlantUML diagram.

        Each change of a variable is a message: from the environment for inputs, from the component
        for outputs. The text is empty if no scenario could be played.
        """
        results_with_trace = [result for result in self.results if result.trace]
        failed = [result for result in results_with_trace if result.difference is not None]
        shown = next(iter([*failed, *results_with_trace]), None)
        return "" if shown is None else "\n".join(_iter_diagram_lines(shown)) + "\n"


def show_value(value: Literal | Quantity | None) -> str:
    """Return a value as scenarios spell it."""
    if isinstance(value, bool):
        return str(value).lower()
    return "unknown" if value is None else str(value)


# -- the diagram -------------------------------------------------------------------------------


def _iter_diagram_lines(result: Result) -> Iterator[str]:
    yield "@startuml"
    yield f"title {escape_line(result.name)}"
    yield "hide footbox"
    yield "participant environment"
    yield f'participant "{escape_line(result.component)}" as component'
    previous: ShownValues = {}
    steps = map(show_numbers, result.trace, result.numbers or ({},) * len(result.trace))
    for number, valuation in enumerate(steps, 1):
        messages = list(_iter_message_lines(result, previous, valuation))
        is_failing = result.difference is not None and result.difference.step == number
        if messages or is_failing:
            yield f"== step {number} =="
        yield from messages
        if is_failing:
            yield from _iter_note_lines(result)
        previous = valuation
    yield "@enduml"


def _iter_message_lines(result: Result, before: ShownValues, after: ShownValues) -> Iterator[str]:
    """Yield a message for each value that differs from the previous step, inputs first.

    Before the first step all values count as false.
    """
    changed = [name for name in after if after[name] != before.get(name, False)]
    for name in sorted(changed, key=lambda name: name not in result.inputs):
        arrow = "environment -> component" if name in result.inputs else "component -> environment"
        yield f"{arrow} : {escape_line(name)} = {escape_line(show_value(after[name]))}"


def _iter_note_lines(result: Result) -> Iterator[str]:
    assert result.difference is not None
    difference = result.difference
    yield "note over component #FFDDDD"
    yield f"  {escape_line(difference.variable)} is {escape_line(show_value(difference.actual))}"
    yield f"  expected: {escape_line(show_value(difference.expected))}"
    yield "end note"
