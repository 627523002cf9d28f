"""Checks of a resolved model: constraints of the specification that say what is well formed."""

from sysmlc.diagnostics import Sink
from sysmlc.language.names import Model


def check(model: Model, sink: Sink) -> None:
    """Report what in the documents of the model breaks a constraint of the specification."""
    from sysmlc.language.checks import families

    for document in model.documents:
        for node in model.nodes(document):
            families.check(model, document, node, sink)
