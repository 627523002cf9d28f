"""One compile in memory: inputs -> graph -> passes -> analyses -> back ends."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from traceback import format_exc
from typing import TYPE_CHECKING

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.analyses import analysis
from sysmlc.backends.base import DERIVED, Backend, EmitOptions, InputFile
from sysmlc.config import Config
from sysmlc.diagnostics import Coverage, Diagnostic, Place, Rule, Sink, Subject
from sysmlc.diagnostics.locations import complete_places
from sysmlc.diagnostics.sink import suppress
from sysmlc.driver import faults, registry
from sysmlc.driver.ignore_comments import drop_ignored
from sysmlc.driver.inputs import find_unit_root, recognise
from sysmlc.driver.reading import Reading, load_companions, read_unit, store_refinements
from sysmlc.driver.validation import validate
from sysmlc.driver.withholding import find_withheld_artefacts
from sysmlc.frontends.base import DiagramReader, Frontend
from sysmlc.ir import Graph
from sysmlc.ir.verify import verify
from sysmlc.overlay import SUFFIX
from sysmlc.passes.pipeline import Pass
from sysmlc.sources import Roots, Source, SourceError
from sysmlc.support.counts import count as count_nouns
from sysmlc.support.interpreter import describe_error
from sysmlc.support.output import Artefact, Output
from sysmlc.support.suggestions import did_you_mean

if TYPE_CHECKING:
    from sysmlc.sources.user_schemas import Schemas


class Observer:
    """Receives the progress of a compilation. The base class ignores it."""

    def step(self, what: str, number: int, total: int) -> None:
        """Called before step ``number`` (from 0) of ``total``."""

    def after(self, what: str, graph: Graph) -> None:
        """Called with the graph after a pass, and with ``read`` after the front ends."""

    def fault(self, where: str, trace: str) -> None:
        """Called with the Python traceback of an internal fault."""


class Request(Struct, frozen=True):
    """The inputs and options of one compilation.

    ``backends`` may be empty (``check``). ``frontends`` and ``passes`` are None for those of the
    registry; tests pass their own.
    """

    inputs: tuple[Path, ...]
    config: Config = field(default_factory=Config)
    backends: tuple[Backend, ...] = ()
    templates: Path | None = None
    strict_input: bool = False
    diagrams: str = DERIVED
    overlays: tuple[Path, ...] = ()
    """Overlays that the user names, in addition to those that lie beside the inputs."""
    verify_each: bool = False
    frontends: tuple[Frontend, ...] | None = None
    passes: tuple[Pass, ...] | None = None
    schemas: "Schemas | None" = None
    """Schemas to validate the inputs against; None for no validation."""
    library: str = ""
    """Path of the SysML v2 standard library; empty for the installed one."""
    excluded: tuple[Path, ...] = ()
    """Real paths that a search of folders skips, because they belong to other compile units."""
    finds_siblings: bool = False
    """Whether files that a named file needs are looked for in its project (SysML v2)."""

    def load_passes(self, sink: Sink) -> tuple[Pass, ...]:
        """Return the passes in order; report the plug-ins that cannot be used.

        Raises ConfigError for options that no pass has.
        """
        if self.passes is not None:
            return self.passes
        report = partial(faults.report_ignored_plug_in, sink)
        return tuple(registry.load_passes(self.config.passes, report))


class Compilation(Struct, frozen=True):
    """The refined graph, the diagnostics sorted by location, and the artefacts."""

    root: Path
    graph: Graph
    diagnostics: tuple[Diagnostic, ...]
    coverage: Coverage
    inputs: tuple[InputFile, ...]
    artefacts: tuple[Artefact, ...] = ()
    withheld: Mapping[str, tuple[Diagnostic, ...]] = field(default_factory=dict)
    sources: tuple[Source, ...] = ()
    is_complete: bool = True
    """Whether every input was read. If not, files of earlier runs are not removed."""

    def list_published(self) -> list[Artefact]:
        """Return the artefacts that are not withheld, sorted by path."""
        return [artefact for artefact in self.artefacts if artefact.path not in self.withheld]

    def exit_code(self, strict: bool = False) -> int:
        """Return 0 (clean), 1 (errors, with *strict* also warnings) or 2 (no result)."""
        return faults.compute_exit_code(self.diagnostics, strict)


class OpenedUnit(Struct, frozen=True):
    """A compile unit whose files have been read but not parsed.

    ``sink`` has the diagnostics about files that could not be read.
    """

    root: Path
    reading: Reading
    sink: Sink
    frontends: tuple[Frontend, ...]
    drawings: tuple[Source, ...] = ()
    """Files beside the inputs that contain the authors' diagrams, if these are wanted."""
    name: str = ""
    """Name of the unit, safe as a folder name and unique among the units of one request."""

    def first_file(self) -> str:
        """Return the name of the first source, without the entry of an archive, or ``.``."""
        sources = self.reading.sources()
        return sources[0].name.partition("!")[0] if sources else "."

    def inputs(self) -> tuple[InputFile, ...]:
        """Return all files that were read, with their language, as the outputs name them."""
        models = [(item.source, item.frontend.name) for item in self.reading.recognised]
        overlays = [(overlay.source, "overlay") for overlay in self.reading.overlays]
        drawings = [(source, "diagrams") for source in self.drawings]
        return tuple(
            InputFile(source.name, source.sha256, language)
            for source, language in (*models, *overlays, *drawings)
        )


def open_unit(request: Request) -> OpenedUnit:
    """Read the inputs of a request and the files that they refer to as one unit; parse nothing.

    ``units.open_units`` partitions the files of a folder into several units.
    """
    sink = Sink(request.config.rules)
    frontends = _load_frontends(request, sink)
    root = find_unit_root((*request.inputs, *request.overlays), request.config.folder)
    models = [path for path in request.inputs if not path.name.endswith(SUFFIX)]
    named_overlays = [path for path in request.inputs if path.name.endswith(SUFFIX)]
    overlays = (*request.overlays, *named_overlays)
    reading = read_unit(
        models,
        root,
        frontends,
        sink,
        overlays,
        request.excluded,
        finds_siblings=request.finds_siblings,
    )
    return OpenedUnit(root, reading, sink, frontends, load_drawings(request, reading, root, sink))


def open_texts(texts: Mapping[str, str | bytes], request: Request) -> OpenedUnit:
    """Return the unit of texts in memory, by the name of the file that each stands for.

    References to other files lead to external stubs, because nothing is read from disk.
    """
    sink = Sink(request.config.rules)
    frontends = _load_frontends(request, sink)
    sources = [
        Source(name, text.encode(errors="surrogatepass") if isinstance(text, str) else text)
        for name, text in sorted(texts.items())
    ]
    recognised = tuple(recognise(sources, frontends, faults.UNRECOGNISED, sink))
    reading = Reading(recognised, len(recognised) == len(sources), Roots(()))
    return OpenedUnit(Path.cwd(), reading, sink, frontends)


def _load_frontends(request: Request, sink: Sink) -> tuple[Frontend, ...]:
    report = partial(faults.report_ignored_plug_in, sink)
    return request.frontends or tuple(registry.load_frontends(request.library, report))


def load_drawings(request: Request, reading: Reading, root: Path, sink: Sink) -> tuple[Source, ...]:
    """Load the files that contain the authors' diagrams, unless only derived ones are wanted."""
    if request.diagrams == DERIVED:
        return ()
    return load_companions(reading, root, sink)


def compile_model(
    request: Request,
    observer: Observer | None = None,
    opened: OpenedUnit | None = None,
    analyses: Iterable[str] = analysis.CHECKED,
) -> Compilation:
    """Compile one unit. The result has the diagnostics; nothing is written to disk.

    *analyses* names those whose results are wanted, in addition to those that the back ends need;
    the analyses that they need run as well. Raises ConfigError for options that a pass does not
    have.
    """
    observer, opened = observer or Observer(), opened or open_unit(request)
    names = analysis.expand([*analyses, *registry.list_needs(request.backends)])
    return _CompilationRun(request, observer, opened, names).compile()


class _CompilationRun:
    """The state of one compilation: read, validate, refine, analyse, emit."""

    def __init__(
        self, request: Request, observer: Observer, opened: OpenedUnit, analyses: Sequence[str]
    ) -> None:
        self._request = request
        self._observer = observer
        self._sink = opened.sink
        self._coverage = Coverage()
        self._graph = Graph()
        self._output = Output()
        self._frontends = opened.frontends
        self._passes = request.load_passes(opened.sink)
        self._analyses = analyses
        self._root = opened.root
        self._reading = opened.reading
        self._drawings = opened.drawings
        self._inputs = opened.inputs()
        self._step_number = 0

    def compile(self) -> Compilation:
        """Run all steps. After an internal fault no back end runs."""
        reading, inputs = self._reading, self._inputs
        # The front end of a plug-in may have failed when the files were read.
        is_broken = any(d.rule is faults.PLUG_IN_STOP for d in self._sink)
        is_broken = not self._read(reading) or is_broken
        schemas = self._request.schemas
        if schemas is not None:
            self._run_guarded("schemas", lambda: validate(reading.recognised, schemas, self._sink))
        store_refinements(reading.overlays, self._graph)
        # all() stops at the first step with a fault: later steps rely on its result.
        is_broken = not all(map(self._refine, self._passes)) or is_broken
        self._analyses = [n for n in self._analyses if analysis.has_result(n, self._graph)]
        is_broken = is_broken or not all(map(self._analyse, self._analyses))
        artefacts = [] if is_broken else self._emit(inputs, reading)
        if self._request.strict_input:
            self._report_unsupported()
        diagnostics = self._list_diagnostics()
        withheld = find_withheld_artefacts(artefacts, self._graph, diagnostics)
        diagnostics = _select_reported(diagnostics, reading)
        return Compilation(
            root=self._root,
            graph=self._graph,
            diagnostics=diagnostics,
            coverage=self._coverage,
            inputs=inputs,
            artefacts=tuple(artefacts),
            withheld=withheld,
            sources=self._list_sources(reading),
            is_complete=reading.is_complete
            and not is_broken
            and not any(map(_is_about_missing_part, diagnostics)),
        )

    def _read(self, reading: Reading) -> bool:
        """Run the front ends; return whether none of them had an internal fault."""
        succeeded = True
        for frontend in self._frontends:
            sources = [r.source for r in reading.recognised if r.frontend is frontend]
            if sources:
                self._begin_step(f"read {len(sources)} {frontend.name}")
                succeeded &= self._run_guarded(
                    f"front end {frontend.name}",
                    lambda f=frontend, s=sources: f.read(  # type: ignore[misc]
                        s, self._graph, self._sink, self._coverage
                    ),
                    frontend,
                )
                succeeded &= self._request.diagrams == DERIVED or self._read_diagrams(
                    frontend, sources
                )
        return self._check_graph("read") and succeeded

    def _read_diagrams(self, frontend: Frontend, sources: list[Source]) -> bool:
        return not isinstance(frontend, DiagramReader) or self._run_guarded(
            f"diagrams of {frontend.name}",
            lambda: frontend.read_drawings(sources, self._drawings, self._graph, self._sink),
            frontend,
        )

    def _refine(self, step: Pass) -> bool:
        self._begin_step(f"pass {step.name}")
        succeeded = self._run_guarded(
            f"pass {step.name}", lambda: step.run(self._graph, self._sink), step
        )
        return self._check_graph(step.name) and succeeded

    def _analyse(self, name: str) -> bool:
        self._begin_step(f"analysis {name}")
        step = registry.load_analysis(name, self._request.config.passes)
        succeeded = self._run_guarded(
            f"analysis {name}", lambda: analysis.analyse(self._graph, step, self._sink)
        )
        return self._check_graph(name) and succeeded

    def _check_graph(self, step: str) -> bool:
        """Show the graph to the observer and, with ``verify_each``, verify it."""
        self._observer.after(step, self._graph)
        if not self._request.verify_each:
            return True

        problems = verify(self._graph)
        for problem in problems:
            self._sink.report(faults.INVALID_GRAPH, Subject(), where=step, problem=problem)
        return not problems

    def _list_sources(self, reading: Reading) -> tuple[Source, ...]:
        """Return all sources that diagnostics and traces may point into."""
        overlays = (overlay.source for overlay in reading.overlays)
        return (*reading.sources(), *overlays, *self._drawings)

    def _emit(self, inputs: tuple[InputFile, ...], reading: Reading) -> list[Artefact]:
        locate = partial(complete_places, self._list_sources(reading))
        request = self._request
        faulty = frozenset(d.subject.id for d in self._sink if d.is_error and d.subject.id)
        options = EmitOptions(request.templates, inputs, locate, request.diagrams, faulty)
        failed: set[str] = set()
        for backend in sorted(request.backends, key=_is_last):
            self._begin_step(f"emit {backend.name}")
            written = [a for a in self._output.artefacts() if a.path not in failed]
            if _is_last(backend):
                diagnostics = self._list_diagnostics()
                withheld = find_withheld_artefacts(written, self._graph, diagnostics)
                options = replace(
                    options,
                    diagnostics=_select_reported(diagnostics, reading),
                    artefacts=tuple(a for a in written if a.path not in withheld),
                )
            if not self._run_guarded(
                f"back end {backend.name}",
                lambda b=backend, o=options: b.emit(  # type: ignore[misc]
                    self._graph, self._output, self._sink, o
                ),
                backend,
                faults.PLUG_IN_FAULT,
                faults.OUTPUT_WITHOUT_PACKAGE,
            ):
                before = {artefact.path for artefact in written}
                failed |= {a.path for a in self._output.artefacts()} - before
        return [a for a in self._output.artefacts() if a.path not in failed]

    def _run_guarded(
        self,
        where: str,
        run: Callable[[], object],
        step: object = None,
        plug_in_rule: Rule = faults.PLUG_IN_STOP,
        package_rule: Rule = faults.MISSING_PACKAGE,
    ) -> bool:
        """Run a step; return whether it had no internal fault.

        An exception in it becomes a diagnostic, because no model may cause a traceback. It is
        reported by *plug_in_rule* if *step* belongs to a plug-in, and by *package_rule* if a
        package that sysmlc needs is missing.
        """
        try:
            run()
        except SourceError as problem:
            # A damaged file is a fault of the input: the other files are still compiled.
            faults.report_unreadable(problem, self._sink)
            return True
        # The command reports the limit; here a diagnostic would need memory as well.
        except MemoryError:
            raise
        except Exception as problem:
            self._observer.fault(where, format_exc())
            text = describe_error(problem)
            source = registry.describe_source(step, problem)
            package = faults.find_missing_package(problem)
            rule = package_rule if package else faults.INTERNAL_FAULT
            if source:
                rule = plug_in_rule
            self._sink.report(
                rule, Subject(), where=where, problem=text, source=source, package=package
            )
            return False
        return True

    def _begin_step(self, description: str) -> None:
        total = 1 + len(self._passes) + len(self._analyses) + len(self._request.backends)
        self._observer.step(description, self._step_number, total)
        self._step_number += 1

    def _report_unsupported(self) -> None:
        for file in self._coverage.files():
            count = file.totals()["unsupported"]
            if count:
                subject = Subject(file.file, place=Place(file.file, ordinal=0))
                self._sink.report(
                    faults.UNSUPPORTED,
                    subject,
                    number=count,
                    file=file.file,
                    all=count_nouns(file.elements, "element"),
                )

    def _list_diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return the diagnostics that are not suppressed, sorted by location."""
        remaining, unused = suppress(self._sink, self._request.config.suppress)
        configuration = Sink(self._request.config.rules)
        for entry in unused:
            place = entry.file if entry.element == "*" else entry.element
            configuration.report(
                faults.UNUSED_SUPPRESSION, Subject(), name=entry.rule, element=place
            )
        for name, advice in self._find_unknown_level_elements():
            configuration.report(
                faults.UNKNOWN_LEVEL_ELEMENT, Subject(), help="{advice}", name=name, advice=advice
            )
        about_model = (
            diagnostic for diagnostic in remaining if not self._is_about_library(diagnostic)
        )
        accepted = drop_ignored(about_model, self._graph, Sink(self._request.config.rules))
        return tuple(sorted([*accepted, *configuration], key=_sort_key))

    def _is_about_library(self, diagnostic: Diagnostic) -> bool:
        """Whether a diagnostic is about a library, which its users cannot change."""
        element = self._graph.get(diagnostic.subject.id or None)
        return element is not None and element.attrs.get("library") is True

    def _find_unknown_level_elements(self) -> Iterator[tuple[str, str]]:
        """Yield the names in ``[recipe.levels]`` that no element of the unit has, with advice."""
        levels = self._request.config.passes.get("recipe", {}).get("levels")
        # The option is absent: the registry refuses other types.
        if not isinstance(levels, dict):
            return
        unknown = [name for name in levels if not self._is_known(name)]
        names = {self._graph.qualified_name(e) for e in self._graph} if unknown else set()
        for name in unknown:
            yield name, did_you_mean(name, names)

    def _is_known(self, name: str) -> bool:
        """Whether an element has *name* as its id or qualified name."""
        # Few elements have the last part of the name, and qualified names are slow to compute.
        last = name.rpartition("::")[2]
        candidates = (e for e in self._graph if (e.name or f"<{e.kind}>").endswith(last))
        return name in self._graph or any(
            self._graph.qualified_name(element) == name for element in candidates
        )


def _is_last(backend: Backend) -> bool:
    return getattr(backend, "is_last", False)


def _select_reported(
    diagnostics: tuple[Diagnostic, ...], reading: Reading
) -> tuple[Diagnostic, ...]:
    """Return the diagnostics without those about siblings, which are reported for these files."""
    siblings = reading.list_sibling_sources()
    return tuple(d for d in diagnostics if file_of(d) not in siblings)


def _is_about_missing_part(diagnostic: Diagnostic) -> bool:
    """Whether a diagnostic means that part of the unit was not read, or an output is missing."""
    is_internal = diagnostic.rule is faults.INTERNAL_FAULT
    if is_internal or diagnostic.rule.code in faults.INSTALLATION_FAULTS:
        return True
    is_about_file = not diagnostic.subject.id and diagnostic.subject.place is not None
    return diagnostic.is_error and is_about_file and diagnostic.rule.code.startswith("SM1")


def file_of(diagnostic: Diagnostic) -> str:
    """Return the name of the file that a diagnostic is about; empty if it is about none."""
    place = diagnostic.subject.place
    return "" if place is None else place.file


def _sort_key(diagnostic: Diagnostic) -> tuple[object, ...]:
    """Return the location of a diagnostic, then its code, message and element."""
    subject = diagnostic.subject
    place = subject.place or Place("")
    position = (place.file, place.ordinal, place.offset, place.line, place.column)
    return (position, diagnostic.rule.code, diagnostic.message, subject.name, subject.id)
