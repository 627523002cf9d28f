"""Derive the token graphs of a model in IR text."""

from sysmlc.analyses.activities import Activities
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.ir.verify import verify
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.passes.guards import Guards


def derive_token_graphs(text: str, **options):
    """Read names as guards and run the analysis; return the token graphs and the diagnostics."""
    graph, sink = parse_text(text), Sink()
    assert verify(graph) == []
    Guards().run(graph, sink)
    Activities(**options).run(graph, sink)
    return list(graph.derived(TokenGraph)), sink


def derive_token_graph(text: str, **options) -> TokenGraph:
    """Return the token graph of the only activity."""
    (token_graph,), _ = derive_token_graphs(text, **options)
    return token_graph


def list_edges(graph: TokenGraph) -> list[str]:
    """Return the variable of each edge, with an asterisk if it has a token at the start."""
    return [f"{'*' * edge.marked}{edge.variable}" for edge in graph.edges]


def name_inputs(graph: TokenGraph) -> list[str]:
    """Return the names of the input variables."""
    return [variable.name for variable in graph.inputs]
