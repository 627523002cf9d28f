"""Checks of a resolved model: constraints of the specification that say what is well formed."""

from sysmlc.diagnostics import Sink
from sysmlc.diagnostics.relay import Relay
from sysmlc.language.names import Model


def check(model: Model, sink: Sink) -> None:
    """Report what in the documents of the model breaks a constraint of the specification.

    Nodes in which nothing was found are noted as sound in the model, and not checked again.
    """
    from sysmlc.language.checks import families

    relay, lookup, sound = Relay(sink), model.lookup, model.sound
    for document in model.documents:
        for node in model.nodes(document):
            if node not in sound:
                before = len(relay.reports) + lookup.cuts
                families.check(model, document, node, relay)
                if len(relay.reports) + lookup.cuts == before:
                    sound.add(node)
