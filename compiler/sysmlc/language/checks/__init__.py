"""Checks of a resolved model: the constraints of the specifications on well-formed models."""

from sysmlc.diagnostics import Sink
from sysmlc.language.checks.registry import check_node
from sysmlc.language.names import Model


def check(model: Model, sink: Sink) -> None:
    """Report everything in the documents of the model that breaks a constraint."""
    for document in model.documents:
        for node in model.nodes(document):
            check_node(model, document, node, sink)
