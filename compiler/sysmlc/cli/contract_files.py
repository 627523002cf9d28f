"""Read contracts: of a model, a contract file, or a specification of another tool."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.cli import terminal
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from sysmlc.backends.base import InputFile
    from sysmlc.cli.session import Settings
    from sysmlc.config import Config
    from sysmlc.diagnostics import Sink, Subject
    from sysmlc.diagnostics.renderers import Finding
    from sysmlc.ir import Graph
    from sysmlc.logic.contract import Contract
    from sysmlc.sources import Source


class ContractFile(Struct, frozen=True):
    """The contracts of a model or of a contract file."""

    graph: "Graph"
    """The graph of the model; for a contract file it has no elements, only contracts."""
    sink: "Sink"
    findings: "tuple[Finding, ...]"
    """The findings of the compilation."""
    sources: "tuple[Source, ...]"
    inputs: "tuple[InputFile, ...]"
    root: Path
    is_whole: bool = True
    """Whether every contract of the file could be read."""
    reasons: "Mapping[str, str]" = {}
    """Why a requirement is in no contract, by the id of the requirement."""

    @property
    def contracts(self) -> "tuple[Contract, ...]":
        """All contracts."""
        from sysmlc.logic.contract import Contract

        return tuple(self.graph.derived(Contract))

    def place(self, origin: str) -> "Subject":
        """Return what diagnostics about the origin of a contract or conjunct are about."""
        from sysmlc.logic.contract import locate_origin

        return locate_origin(self.graph, origin)


def split_operand(text: str) -> tuple[Path, str]:
    """Return the file and the component, or an empty text, of ``FILE`` or ``FILE#COMPONENT``."""
    if Path(text).exists():
        return Path(text), ""
    file, _, component = text.partition("#")
    return Path(file), component


def select_contracts(contracts: "tuple[Contract, ...]", component: str) -> "tuple[Contract, ...]":
    """Return the contracts of *component*, or all contracts if it is empty.

    Exits with code 2 if the name is unknown.
    """
    from sysmlc.cli.session import fail
    from sysmlc.support.suggestions import did_you_mean

    if not component:
        return contracts
    names = [contract.component for contract in contracts]
    if component not in names:
        fail(f"no component '{component}'; {did_you_mean(component, names)}")
    return tuple(contract for contract in contracts if contract.component == component)


def read_contracts(
    files: tuple[Path, ...], language: str, config: "Config", settings: "Settings"
) -> ContractFile:
    """Read the contracts of the models of one compile unit, or of one contract file.

    Exits with code 2 if there is no contract.
    """
    from sysmlc.cli.session import fail
    from sysmlc.driver.inputs import list_suffixes
    from sysmlc.driver.registry import load_foreign_frontends

    # A compilation reports the plug-ins that are ignored.
    suffixes = list_suffixes(load_foreign_frontends(note=lambda _: None))
    if not language and all(f.is_dir() or f.suffix.lower() in suffixes for f in files):
        return _read_model(files, config, settings)
    if len(files) > 1:
        fail("several files must all be models; name one contract file at a time")
    return _read_specification(files[0], language, config, settings.include)


def _read_model(files: tuple[Path, ...], config: "Config", settings: "Settings") -> ContractFile:
    from sysmlc.cli import reports, session
    from sysmlc.diagnostics import Sink
    from sysmlc.logic.contract import Contract

    compilation = session.compile_unit(files, config, settings)
    findings = tuple(reports.list_findings(compilation, only_errors=not settings.verbose))
    if compilation.exit_code() == 2:
        compilation.graph.store(Contract, ())
    elif not compilation.graph.derived(Contract) and not findings:
        names = ", ".join(f"'{file}'" for file in files)
        verb = "has" if len(files) == 1 else "have"
        session.fail(f"{names} {verb} no behaviour and no requirement that gives a contract")
    return ContractFile(
        compilation.graph,
        Sink(config.rules),
        findings,
        compilation.sources,
        compilation.inputs,
        compilation.root,
        reasons={
            diagnostic.subject.id: diagnostic.message
            for diagnostic in compilation.diagnostics
            if diagnostic.rule.code in ("SM522", "SM523")
        },
    )


def _read_specification(
    file: Path, language: str, config: "Config", include: tuple[Path, ...]
) -> ContractFile:
    from sysmlc.backends.base import InputFile
    from sysmlc.cli.session import fail
    from sysmlc.diagnostics import Sink
    from sysmlc.ir import Graph
    from sysmlc.logic import formats
    from sysmlc.logic.contract import Contract
    from sysmlc.sources import Source, SourceError
    from sysmlc.sources.files import read_whole
    from sysmlc.sources.source import DOCUMENT_LIMITS

    if language and not (language in formats.FORMATS and formats.FORMATS[language].is_read):
        readable = ", ".join(name for name, form in formats.FORMATS.items() if form.is_read)
        fail(f"'{language}' is not a supported format; supported are {readable}")
    try:
        name = escape_undecodable(file.as_posix())
        source = Source(name, read_whole(file, name, DOCUMENT_LIMITS))
        text = source.data.decode("utf-8-sig") + _read_part_file(file, source.data)
    except SourceError as problem:
        fail(f"cannot read '{problem.file}': {problem.message}")
    except UnicodeDecodeError:
        fail(f"'{file}' is neither a model that is known nor a text in UTF-8")
    sink = Sink(config.rules)
    name = file.name.partition(".")[0]
    read = formats.read(text, source.name, sink, language, include)
    graph = Graph()
    graph.store(
        Contract,
        (
            contract if contract.component else replace(contract, component=name)
            for contract in read
        ),
    )
    is_whole = not sink.has_errors()
    inputs = (InputFile(source.name, source.sha256, "contract"),)
    return ContractFile(graph, sink, (), (source,), inputs, Path.cwd(), is_whole)


def _read_part_file(file: Path, formula: bytes) -> str:
    """Return the text of the ``.part`` file that declares the variables of an ``.ltl`` file.

    The result is empty if the formula declares its variables itself.
    """
    from sysmlc.config import find_project_root
    from sysmlc.sources import Roots
    from sysmlc.sources.files import read_whole
    from sysmlc.sources.source import DOCUMENT_LIMITS

    parts = file.with_suffix(".part")
    if file.suffix != ".ltl" or re.search(rb"^\s*\.(in|out)puts\b", formula, re.MULTILINE):
        return ""
    # A link in an untrusted project must not lead to a file outside of it.
    if not parts.is_file() or not Roots((find_project_root(file),)).allows(parts):
        return ""
    content = read_whole(parts, parts.as_posix(), DOCUMENT_LIMITS)
    return "\n" + content.decode("utf-8-sig")


def show_results(
    read: ContractFile,
    settings: "Settings",
    lines: "Iterable[str]",
    details: "Mapping[str, object] | None" = None,
    refusals: "Sequence[Finding]" = (),
) -> None:
    """Print the findings about a file and its contracts, then a line for each contract.

    The format JSON contains the *details*, such as the verdicts about requirements. *refusals* are
    the reasons why no results were written.
    """
    from sysmlc.cli import reports

    reports.print_findings([*list_findings(read), *refusals], settings, dict(details or {}))
    for line in lines:
        terminal.echo(line, err=not reports.allows_sentences(settings))


def list_findings(read: ContractFile) -> "list[Finding]":
    """Return the findings about a file and its contracts."""
    from sysmlc.cli import reports
    from sysmlc.diagnostics.renderers import make_report

    findings = reports.localize(read.root, make_report(read.sink, read.sources).findings)
    return [*read.findings, *findings]
