"""Contracts of a file, be it a model, one of our contracts or a specification of another tool."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.cli import terminal
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from sysmlc.cli.session import Settings
    from sysmlc.config import Config
    from sysmlc.diagnostics import Sink, Subject
    from sysmlc.diagnostics.render import Finding
    from sysmlc.logic.contract import Composite, Contract
    from sysmlc.sources import Source
    from sysmlc.synthesis.decision import Place

_PLACE = re.compile(r"(?P<file>.*):(?P<line>\d+):(?P<column>\d+)")


class ContractFile(Struct, frozen=True):
    """The contracts of a file, and how findings about them find their places."""

    contracts: "tuple[Contract, ...]"
    composites: "tuple[Composite, ...]"
    sink: "Sink"
    place: "Place"
    findings: "tuple[Finding, ...]"
    sources: "tuple[Source, ...]"
    root: Path
    is_whole: bool = True
    """Whether every contract of the file could be read."""


def chosen(
    contracts: "tuple[Contract, ...]", component: str, composites: "Sequence[Composite]" = ()
) -> "tuple[Contract, ...]":
    """The contracts of one component, or all when none is named; ends the process for another.

    A block that only has parts (``composites``) is a component, too.
    """
    from sysmlc.cli.session import fail
    from sysmlc.support.suggestions import did_you_mean

    names = [one.component for one in contracts] + [one.component for one in composites]
    found = tuple(one for one in contracts if component in ("", one.component))
    if component and component not in names:
        fail(f"no component '{component}'; {did_you_mean(component, names)}")
    return found


def read_contracts(
    file: Path, language: str, config: "Config", settings: "Settings"
) -> ContractFile:
    """The contracts of a file, with what was found on the way; ends the process where it must.

    ``language`` is the form of the text; empty takes it from name and content.
    """
    from sysmlc.driver.inputs import SUFFIXES

    is_model = file.is_dir() or file.suffix.lower() in SUFFIXES
    if is_model and not language:
        return _of_model(file, config, settings)
    return _of_text(file, language, config)


def _of_model(file: Path, config: "Config", settings: "Settings") -> ContractFile:
    from sysmlc.cli import reports, session
    from sysmlc.diagnostics import Sink
    from sysmlc.logic.composition.derivation import compose
    from sysmlc.logic.contract import Contract

    made = session.compile_unit((file,), config, settings)
    findings = tuple(reports.list_findings(made, only_errors=not settings.verbose))

    def place(origin: str) -> "Subject":
        from sysmlc.diagnostics import Subject

        element = made.graph.get(origin)
        return Subject() if element is None else made.graph.subject(element)

    contracts = made.graph.derived(Contract) if made.exit_code() < 2 else ()
    if not contracts and not findings and made.exit_code() < 2:
        session.fail(f"'{file}' has no behaviour and no requirement that gives a contract")
    sink = Sink(config.rules)
    composites = compose(made.graph, contracts, sink)
    return ContractFile(
        tuple(contracts), tuple(composites), sink, place, findings, made.sources, made.root
    )


def _of_text(file: Path, language: str, config: "Config") -> ContractFile:
    from sysmlc.cli.session import fail
    from sysmlc.diagnostics import Sink
    from sysmlc.logic import formats
    from sysmlc.sources import Source, SourceError
    from sysmlc.sources.limits import DOCUMENT_LIMITS
    from sysmlc.sources.whole import read_whole

    if language and not (language in formats.FORMS and formats.FORMS[language].is_read):
        known = ", ".join(name for name, form in formats.FORMS.items() if form.is_read)
        fail(f"'{language}' is no form that is read; known are {known}")
    try:
        name = escape_undecodable(file.as_posix())
        source = Source(name, read_whole(file, name, DOCUMENT_LIMITS))
        text = source.data.decode("utf-8-sig") + _parts_beside(file, source.data)
    except SourceError as problem:
        fail(f"cannot read '{problem.file}': {problem.message}")
    except UnicodeDecodeError:
        fail(f"'{file}' is neither a model that is known nor a text in UTF-8")
    sink = Sink(config.rules)
    name = file.name.partition(".")[0]
    read = formats.read(text, source.name, sink, language)
    contracts = tuple(one if one.component else replace(one, component=name) for one in read)
    is_whole = not sink.has_errors()
    return ContractFile(contracts, (), sink, _from_text, (), (source,), Path.cwd(), is_whole)


def _parts_beside(file: Path, formula: bytes) -> str:
    """What the ``.part`` file beside a formula says of who decides, unless the formula says it.

    A link out of the project root is not followed. Raises SourceError and UnicodeDecodeError.
    """
    from sysmlc.config import find_project_root
    from sysmlc.sources import Roots
    from sysmlc.sources.limits import DOCUMENT_LIMITS
    from sysmlc.sources.whole import read_whole

    parts = file.with_suffix(".part")
    if file.suffix != ".ltl" or re.search(rb"^\s*\.(in|out)puts\b", formula, re.MULTILINE):
        return ""
    if not parts.is_file() or not Roots((find_project_root(file),)).allows(parts):
        return ""
    content = read_whole(parts, parts.as_posix(), DOCUMENT_LIMITS)
    return "\n" + content.decode("utf-8-sig")


def _from_text(origin: str) -> "Subject":
    from sysmlc.diagnostics import Place, Subject

    found = _PLACE.fullmatch(origin)
    if found is None:
        return Subject()
    place = Place(found["file"], line=int(found["line"]), column=int(found["column"]))
    return Subject(place=place)


def show(read: ContractFile, settings: "Settings", lines: "Iterable[str]") -> None:
    """Show the findings about a file and its contracts, then a line for each contract."""
    from sysmlc.cli import reports
    from sysmlc.diagnostics.render import make_report

    found = reports.localize(read.root, make_report(read.sink, read.sources).findings)
    reports.print_findings([*read.findings, *found], settings)
    for line in lines:
        terminal.echo(line, err=not reports.allows_sentences(settings))
