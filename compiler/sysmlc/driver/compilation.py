"""One compile: inputs -> graph -> passes -> back ends, as a value that is still in memory."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct, field

from sysmlc.backends.base import DERIVED, Backend, EmitOptions, InputFile
from sysmlc.config import Config
from sysmlc.diagnostics import Coverage, Diagnostic, Place, Sink, Subject
from sysmlc.diagnostics.suppress import suppress
from sysmlc.driver import faults, registry
from sysmlc.driver.inputs import unit_root
from sysmlc.driver.overlays import store_all
from sysmlc.driver.places import Locator
from sysmlc.driver.reading import Reading, read_unit
from sysmlc.driver.withhold import withheld_artefacts
from sysmlc.frontends.base import DiagramReader, Frontend
from sysmlc.ir import Graph
from sysmlc.overlay import SUFFIX
from sysmlc.passes.base import Pass
from sysmlc.sources import Source, SourceError
from sysmlc.support.output import Artefact, Output
from sysmlc.support.suggestions import did_you_mean

if TYPE_CHECKING:
    from sysmlc.sources.schema import Schemas


class Observer:
    """What wants to know how a compilation goes on; this one does nothing with it."""

    def step(self, what: str, number: int, total: int) -> None:
        """Called before step ``number`` (from 0) of ``total``."""

    def after(self, what: str, graph: Graph) -> None:
        """Called with the graph after a pass, and with ``read`` after the front ends."""

    def fault(self, where: str, trace: str) -> None:
        """Called with the Python traceback of a fault of ours."""


class Request(Struct, frozen=True):
    """What one compilation is asked for.

    ``backends`` may be empty (``check``). ``frontends`` and ``passes`` are None for the real
    ones; tests give their own.
    """

    inputs: tuple[Path, ...]
    config: Config = field(default_factory=Config)
    backends: tuple[Backend, ...] = ()
    templates: Path | None = None
    strict_input: bool = False
    diagrams: str = DERIVED
    overlays: tuple[Path, ...] = ()
    """Overlays that are named; those beside the inputs are found."""
    verify_each: bool = False
    frontends: tuple[Frontend, ...] | None = None
    passes: tuple[Pass, ...] | None = None
    schemas: "Schemas | None" = None
    """Schemas that the inputs are validated against; None: they are not."""
    library: str = ""
    """Where the model library of SysML v2 is; empty where it is usually found."""
    excluded: tuple[Path, ...] = ()
    """Real paths that are skipped in folders, because they belong to other compile units."""

    def pipeline(self) -> tuple[Pass, ...]:
        """The passes in order. Raises ConfigError for options that no pass has."""
        if self.passes is not None:
            return self.passes
        return tuple(registry.passes(self.config.passes))


class Compilation(Struct, frozen=True):
    """What came out: the refined graph, findings in the order of places, and artefacts."""

    root: Path
    graph: Graph
    diagnostics: tuple[Diagnostic, ...]
    coverage: Coverage
    inputs: tuple[InputFile, ...]
    artefacts: tuple[Artefact, ...] = ()
    withheld: Mapping[str, tuple[Diagnostic, ...]] = field(default_factory=dict)
    sources: tuple[Source, ...] = ()
    is_complete: bool = True
    """Whether every input could be read; if not, nothing old is removed."""

    def written(self) -> list[Artefact]:
        """The artefacts that are not withheld, sorted by path."""
        return [artefact for artefact in self.artefacts if artefact.path not in self.withheld]

    def exit_code(self, strict: bool = False) -> int:
        """0 clean; 1 the model is wrong (with ``strict`` also warnings); 2 we failed."""
        return faults.exit_code(self.diagnostics, strict)


class Opened(Struct, frozen=True):
    """The bytes of one unit's inputs, and what was found while they were collected."""

    root: Path
    reading: Reading
    sink: Sink
    frontends: tuple[Frontend, ...]
    drawings: tuple[Source, ...] = ()
    """What lies beside the inputs and holds the diagrams of authors, when they are wanted."""
    name: str = ""
    """Name of the unit, safe as a folder name and unique among the units of one request."""

    def first_file(self) -> str:
        """Return the name of the first source, without the entry of an archive, or ``.``."""
        sources = self.reading.sources()
        return sources[0].name.partition("!")[0] if sources else "."

    def inputs(self) -> tuple[InputFile, ...]:
        """All that was read, as the outputs name it."""
        models = [(one.source, one.frontend.name) for one in self.reading.recognised]
        laid = [(one.source, "overlay") for one in self.reading.overlays]
        drawn = [(one, "diagrams") for one in self.drawings]
        return tuple(
            InputFile(one.name, one.sha256, what) for one, what in (*models, *laid, *drawn)
        )


def open_unit(request: Request) -> Opened:
    """Read the inputs of a request, and what they refer to, as one unit; parse nothing.

    ``units.open_units`` partitions the files of a folder into several units.
    """
    sink = Sink(request.config.rules)
    frontends = request.frontends or tuple(registry.frontends(request.library))
    root = unit_root((*request.inputs, *request.overlays), request.config.folder)
    models = [path for path in request.inputs if not path.name.endswith(SUFFIX)]
    laid = [path for path in request.inputs if path.name.endswith(SUFFIX)]
    overlays = (*request.overlays, *laid)
    reading = read_unit(models, root, frontends, sink, overlays, request.excluded)
    return Opened(root, reading, sink, frontends, load_drawings(request, reading, root, sink))


def load_drawings(request: Request, reading: Reading, root: Path, sink: Sink) -> tuple[Source, ...]:
    if request.diagrams == DERIVED:
        return ()
    from sysmlc.driver.drawings import beside

    return beside(reading, root, sink)


def compile_model(
    request: Request, observer: Observer | None = None, opened: Opened | None = None
) -> Compilation:
    """Compile one unit. Model faults are in the result; nothing is written.

    Raises ConfigError for options that a pass does not have.
    """
    run = _Run(request, observer or Observer(), opened or open_unit(request))
    return run.compilation()


class _Run:
    """The state of one compilation while it goes on."""

    def __init__(self, request: Request, observer: Observer, opened: Opened) -> None:
        self._request = request
        self._observer = observer
        self._sink = opened.sink
        self._coverage = Coverage()
        self._graph = Graph()
        self._output = Output()
        self._frontends = opened.frontends
        self._passes = request.pipeline()
        self._root = opened.root
        self._reading = opened.reading
        self._drawings = opened.drawings
        self._inputs = opened.inputs()
        self._done = 0

    def compilation(self) -> Compilation:
        reading, inputs = self._reading, self._inputs
        broken = not self._read(reading)
        self._validate(reading)
        store_all(reading.overlays, self._graph)
        broken = not all(self._refine(step) for step in self._passes) or broken
        emitted = [] if broken else self._emit(inputs, reading)
        if self._request.strict_input:
            self._report_unsupported()
        diagnostics = self._findings()
        withheld = withheld_artefacts(emitted, self._graph, diagnostics)
        return Compilation(
            root=self._root,
            graph=self._graph,
            diagnostics=diagnostics,
            coverage=self._coverage,
            inputs=inputs,
            artefacts=tuple(emitted),
            withheld=withheld,
            sources=self._sources(reading),
            is_complete=reading.is_complete
            and not broken
            and not any(map(_cuts_short, diagnostics)),
        )

    def _read(self, reading: Reading) -> bool:
        done = True
        for frontend in self._frontends:
            sources = [r.source for r in reading.recognised if r.frontend is frontend]
            if sources:
                self._step(f"read {len(sources)} {frontend.name}")
                done &= self._guarded(
                    f"front end {frontend.name}",
                    lambda f=frontend, s=sources: f.read(  # type: ignore[misc]
                        s, self._graph, self._sink, self._coverage
                    ),
                )
                done &= self._request.diagrams == DERIVED or self._draw(frontend, sources)
        return self._settled("read") and done

    def _validate(self, reading: Reading) -> None:
        schemas = self._request.schemas
        if schemas is not None:
            from sysmlc.driver.validation import validate

            self._guarded("schemas", lambda: validate(reading.recognised, schemas, self._sink))

    def _draw(self, frontend: Frontend, sources: list[Source]) -> bool:
        return not isinstance(frontend, DiagramReader) or self._guarded(
            f"diagrams of {frontend.name}",
            lambda: frontend.drawings(sources, self._drawings, self._graph, self._sink),
        )

    def _refine(self, step: Pass) -> bool:
        self._step(f"pass {step.name}")
        done = self._guarded(f"pass {step.name}", lambda: step.run(self._graph, self._sink))
        return self._settled(step.name) and done

    def _settled(self, what: str) -> bool:
        self._observer.after(what, self._graph)
        if not self._request.verify_each:
            return True
        from sysmlc.ir.verify import verify

        problems = verify(self._graph)
        for problem in problems:
            self._sink.report(faults.INVALID_GRAPH, Subject(), where=what, problem=problem)
        return not problems

    def _sources(self, reading: Reading) -> tuple[Source, ...]:
        """Everything that findings and traces may point into."""
        laid = (one.source for one in reading.overlays)
        return (*reading.sources(), *laid, *self._drawings)

    def _emit(self, inputs: tuple[InputFile, ...], reading: Reading) -> list[Artefact]:
        locate = Locator(self._sources(reading))
        request = self._request
        options = EmitOptions(request.templates, inputs, locate, request.diagrams)
        failed: set[str] = set()
        for backend in self._request.backends:
            self._step(f"emit {backend.name}")
            before = {artefact.path for artefact in self._output.artefacts()}
            if not self._guarded(
                f"back end {backend.name}",
                lambda b=backend: b.emit(  # type: ignore[misc]
                    self._graph, self._output, self._sink, options
                ),
            ):
                failed |= {a.path for a in self._output.artefacts()} - before
        return [a for a in self._output.artefacts() if a.path not in failed]

    def _guarded(self, where: str, act: Callable[[], None]) -> bool:
        """Run our own or a plug-in's code; a fault in it becomes a finding, not a traceback."""
        try:
            act()
        except SourceError as problem:
            faults.report_unreadable(problem, self._sink)
            return True
        except MemoryError:
            raise
        except Exception as problem:
            from traceback import format_exc

            self._observer.fault(where, format_exc())
            text = f"{type(problem).__name__}: {problem}"
            self._sink.report(faults.INTERNAL_FAULT, Subject(), where=where, problem=text)
            return False
        return True

    def _step(self, what: str) -> None:
        total = 1 + len(self._passes) + len(self._request.backends)
        self._observer.step(what, self._done, total)
        self._done += 1

    def _report_unsupported(self) -> None:
        for file in self._coverage.files():
            number = file.totals()["unsupported"]
            if number:
                subject = Subject(file.file, place=Place(file.file, ordinal=0))
                self._sink.report(
                    faults.UNSUPPORTED, subject, number=number, file=file.file, all=file.elements
                )

    def _findings(self) -> tuple[Diagnostic, ...]:
        left, unused = suppress(self._sink, self._request.config.suppress)
        late = Sink(self._request.config.rules)
        for entry in unused:
            late.report(
                faults.UNUSED_SUPPRESSION, Subject(), name=entry.rule, element=entry.element
            )
        for name, advice in self._unknown_level_elements():
            late.report(
                faults.UNKNOWN_LEVEL_ELEMENT, Subject(), help="{advice}", name=name, advice=advice
            )
        own = (found for found in left if not self._is_about_library(found))
        return tuple(sorted([*own, *late], key=_by_place))

    def _is_about_library(self, found: Diagnostic) -> bool:
        """Whether it is about what a library is like, which who only uses it cannot mend."""
        element = self._graph.get(found.subject.id or None)
        return element is not None and element.attrs.get("library") is True

    def _unknown_level_elements(self) -> Iterator[tuple[str, str]]:
        """Names in ``[recipe.levels]`` that no element of the unit has, each with advice."""
        levels = self._request.config.passes.get("recipe", {}).get("levels")
        if not isinstance(levels, dict):
            return
        unknown = [name for name in levels if not self._is_known(name)]
        names = {self._graph.qualified_name(one) for one in self._graph} if unknown else set()
        for name in unknown:
            yield name, did_you_mean(name, names)

    def _is_known(self, name: str) -> bool:
        """Whether an element has the id or the qualified name; few have the last part of it."""
        last = name.rpartition("::")[2]
        alike = (one for one in self._graph if (one.name or f"<{one.kind}>").endswith(last))
        return name in self._graph or any(self._graph.qualified_name(one) == name for one in alike)


def _cuts_short(found: Diagnostic) -> bool:
    """Whether the finding means that part of the unit was not read."""
    is_about_file = not found.subject.id and found.subject.place is not None
    return found.is_error and is_about_file and found.rule.code.startswith("SM1")


def _by_place(found: Diagnostic) -> tuple[object, ...]:
    place = found.subject.place
    where = ("", 0, 0, 0, 0) if place is None else _position(place)
    return (where, found.rule.code, found.message, found.subject.name, found.subject.id)


def _position(place: Place) -> tuple[object, ...]:
    return (place.file, place.ordinal, place.offset, place.line, place.column)
