"""What a compilation notes, so that parts of it can be done again when a literal is another one."""

from collections.abc import Iterable, Mapping
from hashlib import sha256

from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.reads import Literal, Reads, Value
from sysmlc.ir.rows import Rows, rows
from sysmlc.ir.seen import see_again
from sysmlc.output import Artefact
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Made:
    """A file by its path: the back end, a digest of its trace, and what the trace begins with."""

    path: str
    backend: str
    trace: str
    about: str


@dataclass(frozen=True, slots=True)
class Recorded:
    """The graph that passes and back ends saw, and who asked for what.

    ``literals`` are attributes that are words of the texts; ``asked`` are literals, by file and
    place, that mean more. ``readers`` has, for each attribute, who asked for it; ``stored`` and
    ``used`` who kept and who asked for derived values, by module; ``heard`` a digest of what each
    pass and back end reported.
    """

    graph: Rows
    literals: tuple[Literal, ...]
    asked: tuple[tuple[str, int], ...]
    readers: Mapping[Value, tuple[str, ...]]
    stored: Mapping[str, tuple[str, ...]]
    used: Mapping[str, tuple[str, ...]]
    heard: Mapping[str, str]
    made: tuple[Made, ...]


class Recording:
    """Notes who is at work, from the front ends to the last back end."""

    def __init__(self, graph: Graph, sink: Sink) -> None:
        self._graph = graph
        self._sink = sink
        self._reads = graph.reads = Reads()
        self._heard: dict[str, list[Diagnostic]] = {}
        self._seen: Rows | None = None
        self._at = (0, 0)
        self._artefacts: tuple[Artefact, ...] = ()

    def begin(self, reader: str, is_repeatable: bool) -> None:
        """From now on ``reader`` is at work; one that is repeatable leaves the graph as it is."""
        self._reads.reader = reader
        if is_repeatable and self._seen is None and self._reads.literals:
            self._seen = rows(self._graph)
            self._at = self._state()
            see_again(self._graph, self._seen)
        if self._seen is not None:
            self._sink.listen(self._heard.setdefault(reader, []))

    def end(self, artefacts: Iterable[Artefact]) -> None:
        """Nobody is at work any more; these files were made."""
        self._sink.listen(None)
        self._graph.reads = None
        self._artefacts = tuple(artefacts)

    def recorded(self) -> Recorded | None:
        """What was noted; None when nothing can be done again: a later pass changed the graph."""
        reads, seen = self._reads, self._seen
        if seen is None or self._at != self._state() or not _is_as_kept(self._graph):
            return None
        return Recorded(
            graph=seen,
            literals=tuple(
                one
                for one in reads.literals
                if one.id in self._graph and (one.id, one.key) not in reads.rewritten
            ),
            asked=tuple(sorted(reads.asked)),
            readers={value: tuple(readers) for value, readers in reads.readers.items()},
            stored={module: tuple(who) for module, who in reads.stored.items()},
            used={module: tuple(who) for module, who in reads.used.items()},
            heard={reader: digest_of_findings(found) for reader, found in self._heard.items()},
            made=tuple(made(one) for one in self._artefacts),
        )

    def _state(self) -> tuple[int, int]:
        """Another one when the graph was changed in between."""
        return len(self._graph), self._graph.changes


def _is_as_kept(graph: Graph) -> bool:
    """Whether a graph of its rows is like the graph, also in the order of each kind."""
    of_kind: dict[Kind, list[Element]] = {}
    for one in graph:
        of_kind.setdefault(one.kind, []).append(one)
    known = {kind: graph.of_kind(kind) for kind in Kind}
    return not len(graph.pending) and {k: ones for k, ones in known.items() if ones} == of_kind


def made(artefact: Artefact) -> Made:
    """What is noted of a file."""
    trace = sha256("\n".join(artefact.trace).encode()).hexdigest()
    about = artefact.trace[0] if artefact.trace else ""
    return Made(artefact.path, artefact.backend, trace, about)


def digest_of_findings(found: Iterable[Diagnostic]) -> str:
    """Equal for the same findings, in whatever order and however often."""
    told = "\n".join(sorted({repr(_told(one)) for one in found}))
    return sha256(told.encode("utf-8", "surrogatepass")).hexdigest()


def _told(one: Diagnostic) -> tuple[object, ...]:
    """What a finding says, without values of our own: ``repr`` takes longer for them."""
    about, place = one.subject, one.subject.place
    where = place and (place.file, place.ordinal, place.offset, place.line, place.column)
    return one.rule.code, one.message, about.name, about.id, where, one.notes, one.help
