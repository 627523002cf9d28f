"""``sysmlc synth``: whether a contract can be kept."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options
from sysmlc.values import dataclass, replace

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings
    from sysmlc.config import Config
    from sysmlc.diagnostics import Sink, Subject
    from sysmlc.diagnostics.render import Finding
    from sysmlc.logic.contract import Contract
    from sysmlc.sources import Source
    from sysmlc.synthesis.decide import Options, Place

_GIBIBYTE = 1 << 30
_PLACE = re.compile(r"(?P<file>.*):(?P<line>\d+):(?P<column>\d+)")


@click.command(
    "synth",
    short_help="Say whether a contract can be kept.",
    epilog="""\b
Examples:
  sysmlc synth gate.contract.json --realizable
  sysmlc synth plant.uml -c Plant::Gate --realizable
  sysmlc synth amba.tlsf --realizable --time-limit 60

Exit codes: 0 realizable, 1 unrealizable, 2 outside GR(1), beyond a limit,
or the work could not be done.""",
)
@click.argument("file", type=click.Path(path_type=Path), metavar="FILE")
@click.option("-c", "--component", default="", metavar="NAME", help="Only this component.")
@click.option("--realizable", "is_decided_only", is_flag=True, help="Decide, write nothing.")
@click.option("--from", "language", default="", metavar="FORM", help="Form of the file.")
@click.option(
    "--engine",
    type=click.Choice(("cudd", "autoref")),
    help="Library of decision diagrams.  [default: cudd if it is there]",
)
@click.option("--time-limit", "seconds", type=float, default=0.0, metavar="S", help="CPU seconds.")
@click.option("--memory", type=float, default=0.0, metavar="GIB", help="GiB for the diagrams.")
@click.option("--nodes", type=int, default=0, metavar="N", help="Nodes of diagrams at once.")
@options.reporting
@options.reading
@click.pass_context
def command(
    ctx: click.Context,
    /,
    file: Path,
    component: str,
    is_decided_only: bool,
    language: str,
    engine: str | None,
    seconds: float,
    memory: float,
    nodes: int,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Decide whether there is a system that keeps the contracts in FILE.

    FILE is a model or a contract, in one of the forms of docs/synthesis.md.
    """
    from sysmlc.cli import session
    from sysmlc.cli.progress import Progress
    from sysmlc.synthesis import Limits
    from sysmlc.synthesis.decide import Options

    if not is_decided_only:
        session.fail("controllers are not written yet; --realizable decides")
    settings = session.Settings(**given)
    config = session.load_config((file,), settings.config)
    progress = Progress(settings.verbose)
    limits = Limits(nodes, int(memory * _GIBIBYTE), seconds)
    read = _contracts(file, language, config, settings)
    try:
        ctx.exit(_decided(read, component, settings, Options(engine or "", limits, progress.note)))
    except ImportError as problem:
        session.fail(f"the library of decision diagrams cannot be loaded: {problem}")
    finally:
        progress.clear()


@dataclass(frozen=True, slots=True)
class _Read:
    """The contracts of a file, and how findings about them find their places."""

    contracts: "tuple[Contract, ...]"
    sink: "Sink"
    place: "Place"
    findings: "tuple[Finding, ...]"
    sources: "tuple[Source, ...]"
    root: Path


def _decided(read: _Read, component: str, settings: "Settings", options: "Options") -> int:
    from sysmlc.cli import session
    from sysmlc.diagnostics.render import make_report
    from sysmlc.synthesis.decide import decide

    chosen = _chosen(read.contracts, component) if read.contracts else ()
    verdicts = [decide(one, read.place, read.sink, options) for one in chosen]
    found = session.named(read.root, make_report(read.sink, read.sources).findings)
    session.show([*read.findings, *found], settings)
    for verdict in verdicts:
        click.echo(verdict.text(), err=not session.says_more(settings))
    return max((verdict.exit_code for verdict in verdicts), default=2)


def _chosen(contracts: "tuple[Contract, ...]", component: str) -> "tuple[Contract, ...]":
    from sysmlc.cli.session import fail
    from sysmlc.suggest import did_you_mean

    names = [one.component for one in contracts]
    found = tuple(one for one in contracts if component in ("", one.component))
    if not found:
        fail(f"no component '{component}'; {did_you_mean(component, names)}")
    return found


def _contracts(file: Path, language: str, config: "Config", settings: "Settings") -> _Read:
    from sysmlc.driver.inputs import SUFFIXES

    is_model = file.is_dir() or file.suffix.lower() in SUFFIXES
    if is_model and not language:
        return _of_model(file, config, settings)
    return _of_text(file, language, config)


def _of_model(file: Path, config: "Config", settings: "Settings") -> _Read:
    from sysmlc.cli import session
    from sysmlc.diagnostics import Sink
    from sysmlc.logic.contract import Contract

    made = session.compile_unit((file,), config, settings)
    findings = tuple(session.findings(made, only_errors=not settings.verbose))

    def place(origin: str) -> "Subject":
        from sysmlc.diagnostics import Subject

        element = made.graph.get(origin)
        return Subject() if element is None else made.graph.subject(element)

    contracts = made.graph.derived(Contract) if made.exit_code() < 2 else ()
    if not contracts and made.exit_code() < 2:
        session.fail(f"'{file}' has no behaviour and no requirement that gives a contract")
    return _Read(tuple(contracts), Sink(config.rules), place, findings, made.sources, made.root)


def _of_text(file: Path, language: str, config: "Config") -> _Read:
    from sysmlc.cli.session import fail
    from sysmlc.diagnostics import Sink
    from sysmlc.logic import formats
    from sysmlc.sources import Source

    if language and not (language in formats.FORMS and formats.FORMS[language].is_read):
        known = ", ".join(name for name, form in formats.FORMS.items() if form.is_read)
        fail(f"'{language}' is no form that is read; known are {known}")
    try:
        source = Source(file.as_posix(), file.read_bytes())
        text = source.data.decode("utf-8-sig")
    except OSError as problem:
        fail(f"cannot read '{file}': {problem.strerror}")
    except UnicodeDecodeError:
        fail(f"'{file}' is neither a model that is known nor a text in UTF-8")
    sink = Sink(config.rules)
    name = file.name.partition(".")[0]
    read = formats.read(text, source.name, sink, language)
    contracts = tuple(one if one.component else replace(one, component=name) for one in read)
    return _Read(contracts, sink, _from_text, (), (source,), Path.cwd())


def _from_text(origin: str) -> "Subject":
    from sysmlc.diagnostics import Place, Subject

    found = _PLACE.fullmatch(origin)
    if found is None:
        return Subject()
    place = Place(found["file"], line=int(found["line"]), column=int(found["column"]))
    return Subject(place=place)
