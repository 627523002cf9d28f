"""Recorded runs of a component: the values of its variables, step by step, as CSV or JSON.

A CSV file has a line with names and then a line for each step. A JSON file has a list of objects,
or an object whose member ``steps`` is such a list. Columns that are not variables of the contract,
such as times of a log, are ignored. Real features have numbers, with or without unit.
"""

import csv
import io
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from msgspec import Struct

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.documents import DocumentError, parse_json
from sysmlc.logic.contract import BooleanDomain, Contract, IntegerDomain, Variable
from sysmlc.logic.domains import contains, describe
from sysmlc.logic.formats import rules
from sysmlc.logic.formula import Literal
from sysmlc.logic.quantities import NumberReader
from sysmlc.sources import Source
from sysmlc.support.counts import count
from sysmlc.support.suggestions import did_you_mean

_MAX_DIGITS = 20
"""Python refuses to convert thousands of digits; no range of a model needs more than these."""
_BOOLEANS: Mapping[str, bool] = {"true": True, "false": False, "1": True, "0": False}


class RecordedRun(Struct, frozen=True):
    """The values of each step, with the line of the step in the file."""

    steps: tuple[Mapping[str, Literal], ...]
    lines: tuple[int, ...]
    missing: frozenset[str]
    """Variables of the contract that the file does not contain."""
    missing_columns: frozenset[str]
    """Names whose values the file lacks: those variables, and for sums of numbers the features."""
    ignored: tuple[str, ...]
    """Names in the file that are not variables of the contract."""


class _RunFileError(Exception):
    """A fault of the file, with its line."""

    def __init__(self, reason: str, line: int) -> None:
        super().__init__(reason)
        self.line = line


class _Row(Struct, frozen=True):
    """The values of one step as the file spells them."""

    line: int
    cells: Mapping[str, object]


def read_run(source: Source, contract: Contract, sink: Sink) -> RecordedRun | None:
    """Return the run in a file; report the first fault and return None if there is one."""
    try:
        text = source.data.decode("utf-8-sig")
        rows = _read_json(text) if source.name.lower().endswith(".json") else _read_csv(text)
        return _convert_rows(rows, contract)
    except _RunFileError as fault:
        _report(source, sink, str(fault), fault.line)
    except UnicodeDecodeError:
        _report(source, sink, "it is not a text in UTF-8", 1)
    except RecursionError:
        _report(source, sink, "it is nested too deeply", 1)
    return None


def _report(source: Source, sink: Sink, fault: str, line: int) -> None:
    subject = Subject(place=Place(source.name, line=line, column=1))
    sink.report(rules.RECORDED_RUN_FAULT, subject, fault=fault)


def _convert_rows(rows: list[_Row], contract: Contract) -> RecordedRun:
    declared = {variable.name: variable for variable in contract.variables}
    if not rows:
        raise _RunFileError("it has no step", 1)
    for name, wording in contract.wordings.items():
        if name in rows[0].cells and wording in rows[0].cells:
            raise _RunFileError(f"'{wording}' and '{name}' are one variable", 1)
    variables = {wording: name for name, wording in contract.wordings.items()}
    rows = [
        _Row(row.line, {variables.get(name, name): cell for name, cell in row.cells.items()})
        for row in rows
    ]
    names = rows[0].cells.keys()
    numbers = _NumberColumns(contract.variables, names)
    if declared.keys().isdisjoint(names) and not numbers.keys:
        advice = did_you_mean(next(iter(names), ""), list(declared))
        raise _RunFileError(
            f"none of its names is a variable of '{contract.component}'; {advice}", 1
        )
    steps: list[Mapping[str, Literal]] = []
    for row in rows:
        if row.cells.keys() != names:
            differing = min(row.cells.keys() ^ names)
            raise _RunFileError(f"not each step has a value for '{differing}'", row.line)
        steps.append(
            {
                name: _convert_cell(cell, declared[name], row.line)
                for name, cell in row.cells.items()
                if name in declared and name not in numbers.keys
            }
            | numbers.convert(row)
        )
    missing = frozenset(name for name in declared if any(name not in step for step in steps))
    return RecordedRun(
        tuple(steps),
        tuple(row.line for row in rows),
        missing,
        frozenset(column for name in missing for column in numbers.list_missing(declared[name])),
        tuple(name for name in names if name not in declared and name not in numbers.keys),
    )


class _NumberColumns:
    """The columns with numbers of features, and the variables whose regions they decide."""

    def __init__(self, variables: Iterable[Variable], names: Iterable[str]) -> None:
        self._variables = {variable.name: variable for variable in variables}
        self._reader = NumberReader(self._variables.values())
        self.keys = {name: self._reader.keys[name] for name in names if name in self._reader.keys}
        """The features with a column, by the name of the column."""

    def list_missing(self, variable: Variable) -> list[str]:
        """List the features without column of a sum; the name of any other variable."""
        keys = [key for key, _ in variable.term if key not in self.keys.values()]
        return keys if len(variable.term) > 1 else [variable.name]

    def convert(self, row: _Row) -> dict[str, Literal]:
        """Return the regions of the variables about the features. Raises _RunFileError."""
        texts = {name: str(row.cells[name]).strip() for name in self.keys}
        numbers: dict[str, Fraction] = {}
        regions: dict[str, Literal] = {}
        for name, key in self.keys.items():
            number, variable = self._reader.read(key, texts[name]), self._variables.get(name)
            if number is not None:
                numbers[key] = number
            elif variable is not None and contains(variable.domain, texts[name]):
                regions[name] = texts[name]
            else:
                raise _refuse(texts[name], name, self._reader.describe(key), row.line)
        for variable, region in self._reader.find_regions(numbers):
            if region is None:
                own = {key for key, _ in variable.term}
                stated = ", ".join(texts[name] for name, key in self.keys.items() if key in own)
                domain = describe(variable.domain)
                raise _refuse(stated, variable.wording or variable.name, domain, row.line)
            regions[variable.name] = region
        return regions


def _refuse(text: str, name: str, domain: str, line: int) -> _RunFileError:
    return _RunFileError(f"{text!r} is not a value of '{name}', which takes {domain}", line)


def _convert_cell(cell: object, variable: Variable, line: int) -> Literal:
    """Return the value of a cell; integers outside of the range are left to the monitor."""
    text = str(cell).lower() if isinstance(cell, bool) else str(cell).strip()
    match variable.domain:
        case BooleanDomain():
            if text.lower() in _BOOLEANS:
                return _BOOLEANS[text.lower()]
        case IntegerDomain():
            if len(text) <= _MAX_DIGITS and text.removeprefix("-").isdecimal():
                return int(text)
        case domain:
            if text in domain.literals:
                return text
    raise _refuse(text, variable.name, describe(variable.domain), line)


# -- CSV -------------------------------------------------------------------------------------------


def _read_csv(text: str) -> list[_Row]:
    separator = max(",;\t", key=text.partition("\n")[0].count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    try:
        lines = [(reader.line_num, cells) for cells in reader if cells]
    except csv.Error as error:
        raise _RunFileError(f"it is not CSV: {error}", reader.line_num) from None
    if not lines:
        return []
    names = [name.strip() for name in lines[0][1]]
    repeated = next((name for name in names if names.count(name) > 1), None)
    if repeated is not None:
        raise _RunFileError(f"the name '{repeated}' occurs twice in the first line", 1)
    return list(_build_csv_rows(names, lines[1:]))


def _build_csv_rows(names: list[str], lines: Iterable[tuple[int, list[str]]]) -> Iterator[_Row]:
    for line, cells in lines:
        if len(cells) != len(names):
            values, expected = count(len(cells), "value"), count(len(names), "name")
            reason = f"the line has {values}, the first line {expected}"
            raise _RunFileError(reason, line)
        yield _Row(line, dict(zip(names, cells, strict=True)))


# -- JSON ------------------------------------------------------------------------------------------


def _read_json(text: str) -> list[_Row]:
    try:
        document = parse_json(text)
    except DocumentError as error:
        raise _RunFileError(error.problem, error.spot.line) from None
    for name, spot in document.repeated:
        raise _RunFileError(f"the member '{name}' occurs twice", spot.line)
    steps = (document.get("steps") or document).items
    if steps is None:
        raise _RunFileError("it is not a list of steps, nor an object with the member 'steps'", 1)
    rows = []
    for number, step in enumerate(steps, 1):
        if step.entries is None:
            reason = f"step {number} is not an object with a value for each variable"
            raise _RunFileError(reason, step.spot.line)
        for name, spot in step.repeated:
            raise _RunFileError(f"the name '{name}' occurs twice in step {number}", spot.line)
        cells = {name: value.as_json() for name, value in step.entries.items()}
        rows.append(_Row(step.spot.line, cells))
    return rows
