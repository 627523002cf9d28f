"""The interface of back ends, and the counter of what an output does not express.

A back end has a name and ``emit``, which reads the graph and never changes it.
"""

import posixpath
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from msgspec import Struct

from sysmlc.diagnostics import Diagnostic, Place, Rule, Sink
from sysmlc.ir import Element, Graph
from sysmlc.ir.compare.titles import spell_kind
from sysmlc.support import resources
from sysmlc.support.output import Artefact, Output


class InputFile(Struct, frozen=True):
    """One input as the outputs name it: path relative to the unit's root, and its SHA-256."""

    path: str
    sha256: str
    language: str


Locate = Callable[[Iterable[Place]], Mapping[Place, Place]]
"""Maps each place that can be found to the same place with its line and column."""


def _locate_nothing(places: Iterable[Place]) -> Mapping[Place, Place]:
    """Return each place unchanged; the default if the source files are not available."""
    return {place: place for place in places}


DIAGRAMS = ("derived", "author", "both")
"""Diagrams that a user can select: those derived from the model, those drawn by its authors."""
DERIVED, AUTHOR, BOTH = DIAGRAMS


class EmitOptions(Struct, frozen=True):
    """What a back end gets beside the graph: options of the user, and facts of the compilation."""

    templates: Path | None = None
    """Folder of templates that replace shipped ones."""
    inputs: tuple[InputFile, ...] = ()
    locate: Locate = _locate_nothing
    diagrams: str = DERIVED
    faulty: frozenset[str] = frozenset()
    """Ids of the elements with errors; a back end may mark them."""
    diagnostics: tuple[Diagnostic, ...] = ()
    """For a back end with ``is_last``: the diagnostics so far, sorted by location."""
    artefacts: tuple[Artefact, ...] = ()
    """For a back end with ``is_last``: the files of the back ends before it that will be written,
    sorted by path; ``Artefact.backend`` names the back end."""


class Backend(Protocol):
    """Writes one kind of output from the graph of a compile unit.

    A back end with the further member ``is_last = True`` runs after the others, and its options
    contain their files and the diagnostics.
    """

    name: str
    summary: str
    is_default: bool
    needs: tuple[str, ...]
    """Names of the analyses whose results ``emit`` reads (``Graph.derived``)."""

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add files to *output*, and report what the target cannot express."""


def name_compile_unit(graph: Graph, options: EmitOptions) -> str:
    """Return the name of the first input without its suffix, else the name of the first root.

    A library of sysmlc, which ``--emit sysml`` writes beside a model, names no model.
    """
    # The path of an input in an archive is ``archive!entry``.
    files = [posixpath.basename(file.path.partition("!")[0]) for file in options.inputs]
    models = [file for file in files if not resources.path("metamodels", file).is_file()]
    for file_name in models or files:
        return file_name.partition(".")[0] or file_name
    return next((root.name for root in graph.roots() if root.name), "model")


# -- losses ------------------------------------------------------------------------------------

_Key = tuple[str, tuple[tuple[str, str], ...]]
"""Code of the rule, and the sorted facts of its message."""


# No slots: dataclass(slots=True) replaces the class, so super() in its methods would fail.
@dataclass
class LossCounter:
    """Losses of one output, counted by rule and facts.

    A model may lose the same kind of information in thousands of elements: one diagnostic states
    the number and the first element.
    """

    graph: Graph
    _counts: dict[_Key, tuple[Rule, Element, int]] = field(default_factory=dict, init=False)
    """The rule, the first element and the number of elements."""

    def record(self, loss: Rule, element: Element, /, **facts: str) -> None:
        """Count a loss of *element*; *facts* fill the placeholders of the message."""
        key = (loss.code, tuple(sorted(facts.items())))
        _, first, count = self._counts.get(key, (loss, element, 0))
        self._counts[key] = (loss, first, count + 1)

    def report(self, sink: Sink) -> None:
        """Report one diagnostic for each combination of rule and facts."""
        for loss, first, facts in self.list_losses():
            sink.report(loss, self.graph.subject(first), notes=(), help="", cause="", **facts)

    def list_losses(self) -> list[tuple[Rule, Element, dict[str, object]]]:
        """Return each loss with its first element and the facts of its message."""
        return [
            (loss, first, {"count": count, **_put_into_words(pairs)})
            for (_, pairs), (loss, first, count) in self._counts.items()
        ]


def _put_into_words(facts: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return facts of a loss with kinds and attributes of the graph in words: ``object node``."""
    return {
        key: spell_kind(fact).replace("_", " ") if key in _GRAPH_FACTS else fact
        for key, fact in facts
    }


_GRAPH_FACTS = frozenset({"kind", "owner", "target", "attribute"})
"""Facts of losses that are kinds or attributes of the graph."""
