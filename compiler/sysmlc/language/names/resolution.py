"""Every reference of a model is resolved; what leads nowhere, or in a circle, is reported."""

import gc
import sys
from collections.abc import Sequence

from sysmlc.diagnostics import Sink, Subject
from sysmlc.language.library import SHIPPED, Library
from sysmlc.language.names.model import Model, root
from sysmlc.language.names.rules import CYCLE, NO_STANDARD_LIBRARY, TOO_DEEP
from sysmlc.language.names.unresolved import report, subject
from sysmlc.language.tree import Document, Node, Relation

_DEPTH = 20_000
"""Names lead to names that lead to names: how deep Python may call itself meanwhile."""


def resolve(documents: Sequence[Document], library: Library, sink: Sink) -> Model:
    """The model of the documents with every reference resolved; what leads nowhere is reported."""
    model = Model(documents, library)
    resolve_all(model, sink)
    return model


def resolve_all(model: Model, sink: Sink) -> None:
    """Resolve every reference that is not yet, and report all that lead nowhere."""
    collecting, depth = gc.isenabled(), sys.getrecursionlimit()
    gc.disable()
    sys.setrecursionlimit(max(depth, _DEPTH))
    try:
        for document in model.documents:
            # The bundled core lacks units that sysmlc's own libraries refer to. That is no fault of
            # the model, and SM207 reports the missing library.
            is_foreign = model.library.is_core and document.path.startswith(SHIPPED)
            _resolve(document, model, Sink() if is_foreign else sink)
        for document in model.documents:
            _settle(document, model)
        _report_cycles(model, sink)
        if model.library.is_core:
            _report_missing_library(model, sink)
    finally:
        sys.setrecursionlimit(depth)
        if collecting:
            gc.enable()


def _resolve(document: Document, model: Model, sink: Sink) -> None:
    for node in model.nodes(document):
        for relation in node.relations:
            if relation.reference.target is None:
                _resolve_one(document, node, relation, model, sink)


def _resolve_one(
    document: Document, node: Node, relation: Relation, model: Model, sink: Sink
) -> None:
    if relation.reference in model.lookup.abandoned:
        return
    try:
        if model.lookup.target(node, relation) is None:
            report(model, document, node, relation, sink)
    except RecursionError:
        model.lookup.abandon()
        place = subject(document, node, relation.reference.start)
        sink.report(TOO_DEEP, place, name=str(relation.reference))


def _settle(document: Document, model: Model) -> None:
    """Find out what leads through many elements while Python may still call itself that deep."""
    lookup = model.lookup
    for node in model.nodes(document):
        try:
            if node.relations:
                lookup.generals(node)
            lookup.by_position(node)
        except RecursionError:
            lookup.abandon()


def _report_cycles(model: Model, sink: Sink) -> None:
    told: set[Node] = set()
    for node in model.lookup.cycles:
        document, circle = model.document(node), model.lookup.circle(node)
        if document in model.documents and told.isdisjoint({node, *circle}):
            told.update((node, *circle))
            names = " and ".join(f"'{model.name(one)}'" for one in circle)
            place = subject(document, node, node.name_start)
            through = f" through {names}" if names else ""
            sink.report(CYCLE, place, name=model.name(node) or node.kind, through=through)


def _report_missing_library(model: Model, sink: Sink) -> None:
    """Report that the bundled core replaces the standard library, if a name of the library is used.

    The diagnostic has no location: the installation lacks something, not a line of the model.
    """
    core = {document.root for document in model.library.loaded()}
    targets = (
        relation.reference.target
        for document in model.documents
        for node in model.nodes(document)
        for relation in node.relations
    )
    if any(target is not None and root(target) in core for target in targets):
        sink.report(NO_STANDARD_LIBRARY, Subject())
