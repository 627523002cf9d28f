"""Numbers in scenarios: inputs and expected values of features whose variables are regions."""

from collections.abc import Iterable

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.domains import contains, describe, regions_of, values
from sysmlc.logic.quantities import NumberReader, Numbers
from sysmlc.simulation.report import show_value
from sysmlc.simulation.scenario import SHAPE, VALUE, Entry, Scenario, Step


class ScenarioNumbers:
    """The regions and the numbers of features in the steps of a scenario.

    A number lasts until the scenario states another one. ``is_valid`` is false after a fault, which
    is reported.
    """

    def __init__(
        self,
        scenario: Scenario,
        own: Iterable[Variable],
        variables: Iterable[Variable],
        defaults: Numbers,
        sink: Sink,
    ) -> None:
        """Read the numbers in a scenario.

        *variables* are those of the component with their names in formulas, *own* those without,
        *defaults* the numbers that features have at the start.
        """
        self.is_valid = True
        self._scenario = scenario
        self._sink = sink
        self._reader = NumberReader(own)
        self._variables = {variable.name: variable for variable in variables}
        single = (v for v in self._variables.values() if len(v.term) == 1)
        self._keys = self._reader.keys | {v.name: v.term[0][0] for v in single}
        self._numbers = dict(defaults)
        self._given: set[str] = set()
        steps: list[Step] = []
        numbers: list[Numbers] = []
        for step in scenario.steps:
            steps.append(replace(step, inputs=self._locate_inputs(step), expect=self._expect(step)))
            numbers.append(dict(self._numbers))
        self.scenario = replace(scenario, steps=tuple(steps))
        """The scenario with regions in place of numbers."""
        self.numbers: tuple[Numbers, ...] = tuple(numbers)
        """The numbers of the inputs in each step."""

    def _locate_inputs(self, step: Step) -> tuple[Entry, ...]:
        entries: list[Entry] = []
        stated: dict[str, Entry] = {}
        for entry in step.inputs:
            key = self._keys.get(entry.name)
            if key is None or self._is_region(entry):
                self._given.add(entry.name)
                self._numbers.pop(key or "", None)
                entries.append(entry)
                continue
            number = self._reader.read(key, show_value(entry.value))
            if number is None:
                self._report_value(entry, self._reader.describe(key))
            else:
                self._numbers[key] = number
                stated[key] = entry
        for variable, region in self._reader.find_regions(self._numbers):
            locations = [stated[key] for key, _ in variable.term if key in stated]
            entry = locations[0] if locations else Entry(variable.name, "", step.location)
            if region is None and locations:
                single = self._reader.describe(variable.term[0][0])
                is_single = len(variable.term) == 1
                self._report_value(entry, single if is_single else describe(variable.domain))
            elif region is not None and (locations or variable.name not in self._given):
                entries.append(Entry(variable.name, region, entry.location))
        self._report_missing(stated)
        return tuple(entries)

    def _report_missing(self, stated: dict[str, Entry]) -> None:
        for variable, missing in self._reader.list_missing(stated, self._numbers):
            if variable.name in self._given:
                continue
            entry = next(stated[key] for key, _ in variable.term if key in stated)
            names = " and ".join(f"'{key}'" for key in missing)
            sum_ = variable.wording or variable.name
            self._sink.report(
                SHAPE,
                self._scenario.subject(entry.location),
                where=f"'{entry.name}'",
                problem=f"the model compares '{sum_}', and {names} has no number",
                advice=f"give {names} a number, too; ",
            )
            self.is_valid = False

    def _expect(self, step: Step) -> tuple[Entry, ...]:
        return tuple(map(self._expect_entry, step.expect))

    def _expect_entry(self, entry: Entry) -> Entry:
        """Return an expected value with the region of a number.

        A region with several numbers does not show that an output has the expected one. An output
        that never has the number differs from it.
        """
        variable = self._variables.get(entry.name)
        regions = None if variable is None else regions_of(variable.domain)
        key = self._keys.get(entry.name)
        if variable is None or regions is None or key is None or self._is_region(entry):
            return entry
        number = self._reader.read(key, show_value(entry.value))
        index = None if number is None else regions.find(number)
        is_input = variable.owner is Owner.ENVIRONMENT
        if number is None or (index is None and is_input):
            self._report_value(entry, self._reader.describe(key))
        elif index is not None and not is_input and not regions.is_point(index):
            self._report_value(entry, describe(variable.domain))
        value = entry.value if index is None else values(variable.domain)[index]
        return replace(entry, value=value, text=show_value(entry.value))

    def _is_region(self, entry: Entry) -> bool:
        variable = self._variables.get(entry.name)
        return variable is not None and contains(variable.domain, entry.value)

    def _report_value(self, entry: Entry, domain: str) -> None:
        subject = self._scenario.subject(entry.location)
        self._sink.report(
            VALUE, subject, value=show_value(entry.value), name=entry.name, domain=domain
        )
        self.is_valid = False
