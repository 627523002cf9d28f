"""The interface of analyses, the table of the shipped ones, and the selection of those to run."""

from collections.abc import Iterable
from importlib import import_module
from typing import ClassVar, Protocol, cast

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind


class Analysis(Protocol):
    """A computation from the graph, which it does not change.

    An analysis is a frozen value whose fields are its options. It runs after the passes, if a back
    end, a command or a program asks for its result (``analyse``).
    """

    name: ClassVar[str]

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the result in the graph (``Graph.store``), and report faults of the model.

        A result that carries its own findings reports none; they have the severities of *sink*.
        """


class _Entry(Struct, frozen=True):
    target: str
    """Module and class of the analysis."""
    needs: tuple[str, ...] = ()
    """Names of the analyses that run first: it reads their results or relies on their reports."""
    library: str = ""
    """Package without which the analysis has no result; empty if it needs no package."""
    plays_games: bool = False
    """Whether it runs only if it is named: it may take long, and its result carries its findings
    and has no options in a configuration."""


_ANALYSES = {
    "activities": _Entry("sysmlc.analyses.activities:Activities"),
    # Recipes draw the token graphs again, without reports: ``activities`` reports the faults.
    "recipe": _Entry("sysmlc.analyses.recipe:Recipe", ("activities",)),
    "platform": _Entry("sysmlc.analyses.platform:Platform", ("recipe",)),
    "robots": _Entry("sysmlc.analyses.robots:Robots", library="Floors"),
    "contracts": _Entry("sysmlc.analyses.contracts:Contracts", ("activities", "robots")),
    "verdicts": _Entry("sysmlc.analyses.verdicts:Verdicts", ("contracts",), plays_games=True),
    "controllers": _Entry(
        "sysmlc.analyses.controllers:Controllers", ("contracts",), plays_games=True
    ),
}
"""The table of analyses. An analysis is imported when it runs for the first time."""
NAMES = tuple(_ANALYSES)
"""All analyses, each after those that it needs."""
CHECKED = tuple(name for name, entry in _ANALYSES.items() if not entry.plays_games)
"""The analyses that report the findings of ``sysmlc check``."""


def load(name: str) -> Analysis:
    """Import and return the analysis of this name with its default options.

    Raises KeyError for an unknown name.
    """
    module, _, class_name = _ANALYSES[name].target.partition(":")
    return cast("Analysis", getattr(import_module(module), class_name)())


def expand(names: Iterable[str]) -> list[str]:
    """Return the names of these analyses and of those that they need, in the order to run them.

    Raises KeyError for an unknown name.
    """
    worklist, selected = list(names), set[str]()
    while worklist:
        name = worklist.pop()
        if name not in selected:
            selected.add(name)
            worklist += _ANALYSES[name].needs
    return [name for name in NAMES if name in selected]


def has_result(name: str, graph: Graph) -> bool:
    """Whether an analysis can have a result: the graph contains the library that it is about."""
    library = _ANALYSES[name].library
    return not library or any(p.name == library for p in graph.of_kind(Kind.PACKAGE))


def analyse(graph: Graph, step: Analysis, sink: Sink) -> tuple[object, ...]:
    """Bring the result of an analysis up to date, and before it the results that it needs.

    The analysis runs unless the graph has its result already. A result becomes outdated when the
    graph changes, when another result is computed with other options, and when an analysis that it
    needs runs with other options. Needed analyses keep the options with which they ran before.
    Returns what the result depends on.
    """
    dependencies: tuple[object, ...] = (step, graph.revision)
    for name in _ANALYSES[step.name].needs:
        if has_result(name, graph):
            earlier = graph.analysed.get(name, (None,))[0]
            needed = load(name) if earlier is None else cast("Analysis", earlier)
            dependencies += analyse(graph, needed, sink)
    if graph.analysed.get(step.name) != dependencies:
        step.run(graph, sink)
        graph.analysed[step.name] = dependencies
    return dependencies
