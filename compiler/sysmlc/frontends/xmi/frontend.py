"""The front end for UML and SysML v1 in XMI."""

import gc
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from sysmlc.diagnostics import Coverage, Place, Sink, Subject
from sysmlc.frontends.xmi import account, applications, behaviour, detect, links, lowering, rules
from sysmlc.frontends.xmi.document import Document, read
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.ir import Graph
from sysmlc.sources import Fault, Source, SourceError


class XmiFrontend:
    """Reads UML 2 and SysML v1 models in XMI: Papyrus, MagicDraw/Cameo, and what is like them."""

    name = "xmi"

    def detect(self, source: Source) -> float:
        """How sure it is, from 0 to 1, that the source is UML in XMI."""
        return detect.score(source)

    def links(self, source: Source) -> Sequence[str]:
        """The files that its hrefs name."""
        return links.links(source)

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; references are left for the pass ``resolve``.

        A damaged file is reported and left out. Raises SourceError for what exceeds the
        limits. The graph does not depend on the order of the files.
        """
        ordered = sorted(sources, key=lambda source: source.name)
        with _no_collection():
            documents = [d for source in ordered if (d := _read(source, sink)) is not None]
            _lower(documents, graph, sink, coverage)


def _lower(documents: list[Document], graph: Graph, sink: Sink, coverage: Coverage) -> None:
    unit = Unit(documents, graph)
    contexts = [lowering.lower(unit, lowered, sink) for lowered in unit.files]
    for context in contexts:
        applications.note_namespaces(context)
        context.finish()
    for context in contexts:
        applications.lower(context)
        behaviour.finish(context)
    unit.flush()
    for context in contexts:
        account.account(context, sink, coverage)


@contextmanager
def _no_collection() -> Iterator[None]:
    """Hold the cyclic garbage collector: nothing that is made here dies before the end."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def _read(source: Source, sink: Sink) -> Document | None:
    try:
        return read(source)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(source.name, place=Place(source.name, offset=problem.offset))
        sink.report(rules.MALFORMED, subject, file=source.name, problem=problem.message)
        return None
