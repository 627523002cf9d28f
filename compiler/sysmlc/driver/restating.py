"""Parts of a compilation done again, on the graph of that time with other values."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TypeVar, cast

from sysmlc.backends.base import EmitOptions, InputFile
from sysmlc.backends.base import InParts as FilesInParts
from sysmlc.diagnostics import Diagnostic, Place, Sink
from sysmlc.driver import registry
from sysmlc.driver.compilation import Request
from sysmlc.driver.readers import EMIT, PASS, Reader, reader
from sysmlc.driver.recording import Made, Recorded, digest_of_findings, made
from sysmlc.ir import AttrValue, Graph
from sysmlc.ir.reads import Reads, Value
from sysmlc.ir.rows import Row, graph_of
from sysmlc.output import Output
from sysmlc.passes.base import InParts, Pass
from sysmlc.passes.pipeline import DERIVING, NAMES
from sysmlc.values import replace

_T = TypeVar("_T")
_Derived = tuple[object, str]
"""What was derived, and a digest of what was reported."""


class LostError(Exception):
    """More than some files would be another one, or nobody knows what: all has to be compiled."""


def restated(
    known: Recorded,
    changed: Mapping[Value, AttrValue],
    request: Request,
    inputs: tuple[InputFile, ...],
) -> tuple[dict[str, str], Recorded]:
    """The texts of files, by path, that may be others when attributes have other values.

    ``inputs`` are what files of that time name. With them comes what would be recorded now: who
    did not run again has the same questions. Raises LostError, also when findings, the paths of
    files or their traces would be others.
    """
    readers = {reader(who) for value in changed for who in known.readers[value]}
    if any(who.what not in (PASS, EMIT) for who in readers):
        raise LostError
    parts = sorted(
        (one for one in readers if one.what == PASS and one.part), key=lambda one: repr(one)
    )
    again = _Again(known, request, inputs)
    before = [again.derived(one) for one in parts]
    again.give(changed)
    after = [again.derived(one) for one in parts]
    for one, old, new in zip(parts, before, after, strict=True):
        if old != new:
            readers |= again.follow(one, old, new)
    texts = dict(again.files({again.able(one) for one in readers.difference(parts)}))
    return texts, again.recorded(changed)


class _Partial(Graph):
    """A graph without what passes derived, but for those that ran again."""

    missing: Collection[str] = ()
    """Modules of types of which there were derived values."""
    alone: Mapping[str, Sequence[object]] = MappingProxyType({})
    """By module, the derived values of elements that are looked at one by one."""

    def derived(self, type_: type[_T]) -> Sequence[_T]:
        if type_.__module__ in self.alone:
            return cast("Sequence[_T]", self.alone[type_.__module__])
        self._ask(type_.__module__)
        return super().derived(type_)

    def has_derived(self, module: str) -> bool:
        self._ask(module)
        return super().has_derived(module)

    def _ask(self, module: str) -> None:
        if module in self.missing:
            raise LostError


class _Again:
    """Passes and back ends that run a second time."""

    def __init__(self, known: Recorded, request: Request, inputs: tuple[InputFile, ...]) -> None:
        self._known = known
        self._request = request
        self._options = EmitOptions(request.templates, inputs, _nowhere, request.diagrams)
        self._graph = _Partial()
        graph_of(known.graph, self._graph)
        self._reads = self._graph.reads = Reads()
        for literal in known.literals:
            self._reads.watch(self._graph[literal.id], literal)
        self._stored = {module: {*map(reader, by)} for module, by in known.stored.items()}
        self._used = {module: {*map(reader, by)} for module, by in known.used.items()}
        self._done: set[Reader] = set()
        self._alone: dict[str, list[object]] = {}
        self._followed: set[Reader] = set()

    def give(self, changed: Mapping[Value, AttrValue]) -> None:
        """Set the attributes."""
        for (id, key), value in changed.items():
            self._graph.set(self._graph[id], **{key: value})
        self._reads.rewritten.clear()

    def recorded(self, changed: Mapping[Value, AttrValue]) -> Recorded:
        """What is known of the graph with these values: who asked before, and who did now."""
        known, now = self._known, self._reads
        if now.rewritten:
            raise LostError
        return replace(
            known,
            graph=(_with(known.graph[0], changed), known.graph[1]),
            readers=_joined(known.readers, now.readers),
            stored=_joined(known.stored, now.stored),
            used=_joined(known.used, now.used),
        )

    def derived(self, who: Reader) -> tuple[object, str]:
        """What a pass derives for one element, and a digest of what it reports."""
        step, element = self._pass(who), self._graph.get(who.part)
        if not isinstance(step, InParts) or element is None:
            raise LostError
        self._expect(who)
        self._reads.reader = f"{who.what} {who.name} {who.part}"
        sink, heard = _listening()
        found = step.part(self._graph, element, sink)
        return found, digest_of_findings(heard)

    def follow(self, who: Reader, old: _Derived, new: _Derived) -> set[Reader]:
        """Who runs again where a pass derives something else for one element.

        That is the part that follows, where the value is all that comes of the element, else the
        whole pass. Raises LostError where it reports something else.
        """
        if old[1] != new[1]:
            raise LostError
        step, element = self._pass(who), self._graph[who.part]
        if not isinstance(step, InParts) or None in (old[0], new[0]):
            return {who.whole}
        if type(old[0]) is not type(new[0]) or not step.is_apart(self._graph, element):
            return {who.whole}
        found: set[Reader] = set()
        for user in self._users(who.whole):
            if user.what == PASS:
                part = Reader(PASS, user.name, who.part)
                then = self._pass(user)
                if not isinstance(then, InParts) or then.follows != who.name:
                    return {who.whole}
                made = [self._from(part, one[0]) for one in (old, new)]
                if made[0] != made[1]:
                    found |= self.follow(part, *made)
            else:
                then_made = registry.load_backends([user.name])[0]
                if not isinstance(then_made, FilesInParts) or then_made.follows != who.name:
                    return {who.whole}
                found.add(Reader(EMIT, user.name, f"{who.name} {who.part}"))
                self._alone.setdefault(type(new[0]).__module__, []).append(new[0])
        self._followed |= found
        return found

    def able(self, who: Reader) -> Reader:
        """Who can run again: a part that needs what a pass derived needs all, unless it follows."""
        if who.what != EMIT or not who.part or who in self._followed:
            return who
        backend = registry.load_backends([who.name])[0]
        if not isinstance(backend, FilesInParts) or not backend.follows:
            return who
        value = self._value(backend.follows, who.part.partition(" ")[2])
        if value is None:
            return who.whole
        self._alone.setdefault(type(value).__module__, []).append(value)
        self._followed.add(who)
        return who

    def _value(self, name: str, id: str) -> object:
        """What a pass derives for one element; None where that is not all that comes of it."""
        step, element = self._pass(Reader(PASS, name)), self._graph.get(id)
        if not isinstance(step, InParts) or element is None:
            return None
        if not step.is_apart(self._graph, element):
            return None
        before = self._value(step.follows, id) if step.follows else None
        who = Reader(PASS, name, id)
        try:
            return self.derived(who)[0] if before is None else self._from(who, before)[0]
        except LostError:
            return None

    def _from(self, who: Reader, value: object) -> _Derived:
        """What a pass derives for one element of what another pass derived for it."""
        self._graph.alone = {type(value).__module__: [value]}
        try:
            return self.derived(who)
        finally:
            self._graph.alone = MappingProxyType({})

    def files(self, affected: set[Reader]) -> Iterator[tuple[str, str]]:
        """The texts that come out where these run again, and who asks for what they derive."""
        for name in NAMES:
            if (step := Reader(PASS, name)) in affected:
                self._run(step)
                affected |= self._users(step)
        emitting = sorted({one.name for one in affected if one.what == EMIT})
        for name in emitting:
            whole = Reader(EMIT, name)
            ours = [whole] if whole in affected else [one for one in affected if one.whole == whole]
            for one in ours:
                yield from self._part(one) if one.part else self._emitted(one)

    # -- passes --------------------------------------------------------------------------------

    def _pass(self, who: Reader) -> Pass:
        if who.name not in DERIVING:
            raise LostError
        return registry.one_pass(who.name, self._request.config.passes)

    def _run(self, who: Reader) -> None:
        """Run a pass, and first those that derived what it asks for."""
        if who in self._done:
            return
        self._done.add(who)
        step = self._pass(who)
        self._prepare(who)
        self._reads.reader = f"{who.what} {who.name}"
        sink, heard = _listening()
        step.run(self._graph, sink)
        self._compare(who, heard)

    def _prepare(self, who: Reader) -> None:
        for module, by in self._used.items():
            if who in {one.whole for one in by}:
                for maker in sorted(self._stored.get(module, ()), key=lambda one: one.order):
                    if maker.what == PASS and maker.order < who.order:
                        self._run(maker)
        self._expect(who)

    def _expect(self, who: Reader) -> None:
        """What was derived before, by whom did not run again, is missing."""
        self._graph.missing = {
            module
            for module, by in self._stored.items()
            if any(one.order < who.order and one.whole not in self._done for one in by)
        }

    def _users(self, who: Reader) -> set[Reader]:
        """Who asked for what a pass derives."""
        modules = [module for module, by in self._stored.items() if who in by]
        found = {one.whole for module in modules for one in self._used.get(module, ())}
        if any(one.what not in (PASS, EMIT) for one in found):
            raise LostError
        return found - {who}

    def _compare(self, who: Reader, heard: list[Diagnostic]) -> None:
        if digest_of_findings(heard) != self._known.heard.get(f"{who.what} {who.name}"):
            raise LostError

    # -- back ends -----------------------------------------------------------------------------

    def _emitted(self, who: Reader) -> Iterator[tuple[str, str]]:
        """All that a back end writes: the same files with the same traces."""
        self._prepare(who)
        self._reads.reader = f"{who.what} {who.name}"
        output = Output()
        sink, heard = _listening()
        registry.load_backends([who.name])[0].emit(self._graph, output, sink, self._options)
        self._compare(who, heard)
        found = output.artefacts()
        known = {one for one in self._known.made if one.backend == who.name}
        if {*map(made, found)} != known:
            raise LostError
        yield from ((one.path, one.text) for one in found)

    def _part(self, who: Reader) -> Iterator[tuple[str, str]]:
        """The files about one thing: which is which of that time is told by the trace."""
        backend = registry.load_backends([who.name])[0]
        if not isinstance(backend, FilesInParts):
            raise LostError
        self._expect(who)
        self._reads.reader = f"{who.what} {who.name} {who.part}"
        if who in self._followed:
            self._graph.alone = self._alone
        found = list(backend.part(self._graph, who.part, self._options))
        self._graph.alone = MappingProxyType({})
        ours = {_of_kind(made(one)): one.text for one in found}
        kinds, about = {kind for kind, _ in ours}, who.part.partition(" ")[2]
        known = {
            _of_kind(one): one.path
            for one in self._known.made
            if one.backend == who.name and one.about == about and _of_kind(one)[0] in kinds
        }
        if ours.keys() != known.keys() or len(ours) != len(found):
            raise LostError
        yield from ((known[one], text) for one, text in ours.items())


def _of_kind(one: Made) -> tuple[str, str]:
    """What kind of file it is, as its name ends, and what it tells of."""
    name, _, last = one.path.rpartition(".")
    return f"{name.rpartition('.')[2]}.{last}", one.trace


def _with(rows: Sequence[Row], changed: Mapping[Value, AttrValue]) -> list[Row]:
    """Elements with other values."""
    of: dict[str, dict[str, AttrValue]] = {}
    for (id, key), value in changed.items():
        of.setdefault(id, {})[key] = value
    return [(*one[:-1], one[-1] | of[one[0]]) if one[0] in of else one for one in rows]


def _joined(
    before: Mapping[_T, Iterable[str]], now: Mapping[_T, Iterable[str]]
) -> dict[_T, tuple[str, ...]]:
    return {
        one: tuple(dict.fromkeys([*before.get(one, ()), *now.get(one, ())]))
        for one in (*before, *(one for one in now if one not in before))
    }


def _listening() -> tuple[Sink, list[Diagnostic]]:
    sink, heard = Sink(), list[Diagnostic]()
    sink.listen(heard)
    return sink, heard


def _nowhere(_places: object) -> Mapping[Place, Place]:
    raise LostError
