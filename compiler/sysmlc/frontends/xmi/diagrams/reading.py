"""Authors' diagrams of all tools, for the pass ``views``; read only when they are asked for."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TypeVar

from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.frontends.xmi.diagrams import enterprise_architect as drawings_ea
from sysmlc.frontends.xmi.diagrams import magicdraw as drawings_magicdraw
from sysmlc.frontends.xmi.diagrams import papyrus as drawings_papyrus
from sysmlc.frontends.xmi.diagrams.shapes import Shapes
from sysmlc.ir.drawing import Drawing
from sysmlc.sources import Source, SourceError

_T = TypeVar("_T")

UNREADABLE = rule(
    "SM161",
    "unreadable-diagrams",
    Severity.WARNING,
    "the diagrams in '{file}' cannot be read: {problem}",
    why="The model is read, but the diagrams as their author drew them are not all there.",
    help="open and save the model again in the modelling tool",
    wrong="<notation:Diagram><children></notation:Diagram>",
    right="<notation:Diagram><children/></notation:Diagram>",
)


def companions(name: str) -> list[str]:
    """Names of what lies beside a model and holds its diagrams (``Frontend.companions``)."""
    archive, is_entry, _ = name.partition("!")
    if is_entry:
        return [f"{archive}!{drawings_magicdraw.ENTRY}*"]
    stem, dot, suffix = name.rpartition(".")
    return [stem + drawings_papyrus.SUFFIX] if dot and suffix == "uml" else []


def read(models: Sequence[Source], beside: Sequence[Source], sink: Sink) -> list[Drawing]:
    """The diagrams of the models; ``beside`` are the files and entries that go with them."""
    files = {source.name: source for source in beside}
    return [one for model in models for one in _of_model(model, files, sink)]


def _of_model(model: Source, files: Mapping[str, Source], sink: Sink) -> Iterator[Drawing]:
    # A model that is damaged has been reported by those who read it whole.
    with suppress(SourceError):
        yield from drawings_magicdraw.drawings(
            model, lambda name: _shapes(model, name, files, sink)
        )
    with suppress(SourceError):
        yield from drawings_ea.drawings(model)
    for name in companions(model.name):
        if name in files:
            yield from _notation(files[name], model, sink)


def _notation(notation: Source, model: Source, sink: Sink) -> list[Drawing]:
    nothing: list[Drawing] = []
    return _told(lambda: list(drawings_papyrus.drawings(notation, model)), nothing, sink)


def _shapes(model: Source, entry: str, files: Mapping[str, Source], sink: Sink) -> Shapes:
    archive, mark, _ = model.name.partition("!")
    source = files.get(f"{archive}{mark}{entry}")
    if source is None:
        return Shapes()
    return _told(lambda: drawings_magicdraw.shapes(source), Shapes(), sink)


def _told(read: Callable[[], _T], otherwise: _T, sink: Sink) -> _T:
    """What could be read, or a finding about what is damaged."""
    try:
        return read()
    except SourceError as problem:
        place = Place(problem.file, offset=problem.offset)
        subject = Subject(problem.file, place=place)
        sink.report(UNREADABLE, subject, file=problem.file, problem=problem.message)
        return otherwise
