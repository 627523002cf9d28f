"""Run the pass ``recipe`` on a model in IR text."""

import recipe_samples as samples
from sysmlc.analyses.recipe import Recipe
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, parse_text
from sysmlc.recipe.model import FlowGraph, Model, Node


def run_recipe(text: str, **options: object) -> tuple[Graph, Sink]:
    """Run the pass; return the graph and the diagnostics."""
    graph, sink = parse_text(text), Sink()
    Recipe(**options).run(graph, sink)
    return graph, sink


def derive_model(text: str, **options: object) -> Model:
    """Return the only recipe model of a text."""
    graph, _ = run_recipe(text, **options)
    (model,) = graph.derived(Model)
    return model


def derive_service_graph(
    *steps: str, nodes: str = samples.NODES, **parts: str
) -> tuple[dict[str, Node], FlowGraph]:
    """Return the service graph of the sample with these flows, and its nodes by their short ids."""
    model = derive_model(samples.task(nodes=nodes, steps=steps or samples.STEPS, **parts))
    graph = model.service_graphs[0]
    return {shorten_id(node.id): node for node in graph.nodes}, graph


def shorten_id(id: str) -> str:
    """Return the last name of a qualified name."""
    return id.rpartition("::")[2]


def print_application(id: str, stereotype: str, tags: str = "") -> str:
    """Return an application of the shipped profile, to insert at the child of the element."""
    return (
        f'Application {id}.{stereotype} stereotype="{stereotype}"'
        f' namespace="urn:sysmlc:profile:1" {tags}\n          -> subject {id}'
    )
