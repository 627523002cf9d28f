"""Diagrams as their authors drew them, for the pass ``views``, from the files of all tools."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TypeVar

from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.frontends.xmi.diagrams import enterprise_architect, magicdraw, papyrus
from sysmlc.frontends.xmi.diagrams.magicdraw import ShapeReader
from sysmlc.ir.pending import Drawing
from sysmlc.sources import Source, SourceError

_T = TypeVar("_T")

UNREADABLE = rule(
    "SM161",
    "unreadable-diagrams",
    Severity.WARNING,
    "the diagrams in '{file}' cannot be read: {problem}",
    help="open and save the model again in the modelling tool",
)


def list_companions(name: str) -> list[str]:
    """Return the names of the files beside a model that hold its diagrams."""
    archive, is_entry, _ = name.partition("!")
    if is_entry:
        return [f"{archive}!{magicdraw.ENTRY_PREFIX}*"]
    stem, dot, suffix = name.rpartition(".")
    return [stem + papyrus.SUFFIX] if dot and suffix == "uml" else []


def read_diagrams(
    models: Sequence[Source], companions: Sequence[Source], sink: Sink
) -> list[Drawing]:
    """Return the diagrams of the models; *companions* are the files and entries beside them."""
    files = {source.name: source for source in companions}
    return [drawing for model in models for drawing in _read_model(model, files, sink)]


def _read_model(model: Source, files: Mapping[str, Source], sink: Sink) -> Iterator[Drawing]:
    # The reader of the model reports a damaged model.
    with suppress(SourceError):
        yield from magicdraw.read_diagrams(
            model, lambda name: _read_shapes(model, name, files, sink)
        )
    with suppress(SourceError):
        yield from enterprise_architect.read_diagrams(model)
    for name in list_companions(model.name):
        if name in files:
            yield from _read_notation(files[name], model, sink)


def _read_notation(notation: Source, model: Source, sink: Sink) -> list[Drawing]:
    empty: list[Drawing] = []
    return _read_or_report(lambda: list(papyrus.read_diagrams(notation, model)), empty, sink)


def _read_shapes(model: Source, entry: str, files: Mapping[str, Source], sink: Sink) -> ShapeReader:
    archive, mark, _ = model.name.partition("!")
    source = files.get(f"{archive}{mark}{entry}")
    if source is None:
        return ShapeReader()
    return _read_or_report(lambda: magicdraw.read_shapes(source), ShapeReader(), sink)


def _read_or_report(read: Callable[[], _T], default: _T, sink: Sink) -> _T:
    """Return the result of *read*, or report a damaged file and return *default*."""
    try:
        return read()
    except SourceError as problem:
        subject = Subject(problem.file, place=Place(problem.file, offset=problem.offset))
        sink.report(UNREADABLE, subject, file=problem.file, problem=problem.message)
        return default
