"""Name resolution: the elements that names denote, and the generals of elements.

``resolve`` resolves every reference of a model, and reports unresolved names and cycles.
"""

import sys
from collections.abc import Sequence

from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.language.library import SHIPPED, Library
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.model import Model
from sysmlc.language.names.unresolved import report_unresolved
from sysmlc.language.tree import Document, Node, Reference, Relation, find_root, make_subject
from sysmlc.support.interpreter import pause_garbage_collection

__all__ = ["TOO_DEEP", "Model", "resolve", "resolve_all"]


CYCLE = rule(
    "SM206",
    "specialization-cycle",
    Severity.WARNING,
    "'{name}' specialises itself{through}",
    help="remove one specialisation of the cycle",
)
NO_STANDARD_LIBRARY = rule(
    "SM207",
    "no-standard-library",
    Severity.WARNING,
    "the standard library of SysML v2 is not installed; the core that sysmlc bundles replaces it",
    help=(
        "if names of the library are missing, get the library's files from the SysML v2 release "
        "and name their folder with --library PATH or the environment variable SYSML_LIBRARY_PATH"
    ),
)
TOO_DEEP = rule(
    "SM208",
    "names-too-deep",
    Severity.ERROR,
    "'{name}' is resolved through too many other names",
    help="refer to the element directly",
)
HIDDEN = rule(
    "SM241",
    "hidden-meaning",
    Severity.INFO,
    "'{name}' is found although the nearest '{first}' has no '{second}'{others}",
    help="import the element itself, or begin with '$::', so that every tool finds it",
)
SPLIT_PACKAGE = rule(
    "SM243",
    "package-in-several-files",
    Severity.INFO,
    "{files} declare a package '{name}' each; its members are looked up in all of them",
    help="declare a package in one file, or give the packages different names",
)

_RECURSION_LIMIT = 20_000
"""Recursion limit during resolution: names lead to names that lead to further names."""

_PACKAGES = kinds_of("Package")
_MAX_FILES = 4
"""Files with a package of the same name that a finding lists."""


def resolve(documents: Sequence[Document], library: Library, sink: Sink) -> Model:
    """Return the model of the documents with every reference resolved; report unresolved names."""
    model = Model(documents, library)
    resolve_all(model, sink)
    return model


# Resolution creates no garbage but many objects, which would trigger collections.
@pause_garbage_collection()
def resolve_all(model: Model, sink: Sink) -> None:
    """Resolve every reference that is not yet resolved, and report unresolved names."""
    recursion_limit = sys.getrecursionlimit()
    # Names resolve by recursion, and a chain of aliases may be as long as a program writes it.
    sys.setrecursionlimit(max(recursion_limit, _RECURSION_LIMIT))
    try:
        for document in model.documents:
            # The bundled core lacks units that sysmlc's own libraries refer to. That is no fault of
            # the model, and SM207 reports the missing library.
            is_foreign = model.library.is_core and document.path.startswith(SHIPPED)
            _resolve_document(document, model, Sink() if is_foreign else sink)
        for document in model.documents:
            _resolve_generals(document, model)
        _report_cycles(model, sink)
        _report_hidden_meanings(model, sink)
        _report_split_packages(model, sink)
        if model.library.is_core:
            _report_missing_library(model, sink)
    finally:
        sys.setrecursionlimit(recursion_limit)


def _resolve_document(document: Document, model: Model, sink: Sink) -> None:
    for node in model.nodes(document):
        for relation in node.relations:
            if relation.reference.target is None:
                _resolve_relation(document, node, relation, model, sink)


def _resolve_relation(
    document: Document, node: Node, relation: Relation, model: Model, sink: Sink
) -> None:
    if relation.reference in model.lookup.abandoned_references:
        return
    try:
        if model.lookup.target(node, relation) is None:
            report_unresolved(model, document, node, relation, sink)
    # Thousands of aliases in a row, which no modeller writes.
    except RecursionError:
        model.lookup.abandon()
        place = make_subject(document, node, relation.reference.start)
        sink.report(TOO_DEEP, place, name=str(relation.reference))


def _resolve_generals(document: Document, model: Model) -> None:
    """Compute the generals of all nodes while the recursion limit is raised."""
    lookup = model.lookup
    for node in model.nodes(document):
        try:
            if node.relations:
                lookup.generals(node)
            lookup.redefined_by_position(node)
        except RecursionError:
            lookup.abandon()


def _report_cycles(model: Model, sink: Sink) -> None:
    reported: set[Node] = set()
    for node in model.lookup.cycles:
        document, cycle = model.document(node), model.lookup.find_cycle_path(node)
        if document in model.documents and reported.isdisjoint({node, *cycle}):
            reported.update((node, *cycle))
            names = " and ".join(f"'{model.name(element)}'" for element in cycle)
            place = make_subject(document, node, node.name_start)
            through = f" through {names}" if names else ""
            sink.report(CYCLE, place, name=model.name(node) or node.kind, through=through)


def _report_hidden_meanings(model: Model, sink: Sink) -> None:
    """Report the first use of each name whose nearest meaning lacks the next part, by document."""
    uses: dict[tuple[str, str], list[tuple[Node, Reference]]] = {}
    for reference, node in model.lookup.hidden_references.items():
        document = model.document(node)
        if document in model.documents and reference.target is not None:
            key = document.path, reference.chain[0][0]
            uses.setdefault(key, []).append((node, reference))
    for same_name in uses.values():
        node, reference = min(same_name, key=lambda use: use[1].start)
        document, names = model.document(node), reference.chain[0]
        if document is None:
            continue
        count = len(same_name) - 1
        sink.report(
            HIDDEN,
            make_subject(document, node, reference.start),
            name="::".join(names),
            first=names[0],
            second=names[1],
            others=f" ({count} more such names in this file)" if count else "",
        )


def _report_split_packages(model: Model, sink: Sink) -> None:
    """Report each root package that several files declare, once, at the first declaration."""
    packages: dict[str, dict[str, tuple[Document, Node]]] = {}
    for document in model.documents:
        for member in document.root.members:
            if member.kind in _PACKAGES and member.name and not document.path.startswith(SHIPPED):
                packages.setdefault(member.name, {}).setdefault(document.path, (document, member))
    for name, declarations in packages.items():
        if len(declarations) > 1:
            document, package = next(iter(declarations.values()))
            files = ", ".join(f"'{path}'" for path in list(declarations)[:_MAX_FILES])
            more = len(declarations) - _MAX_FILES
            files += f" and {more} more files" if more > 0 else ""
            subject = make_subject(document, package, package.name_start)
            sink.report(SPLIT_PACKAGE, subject, name=name, files=files)


def _report_missing_library(model: Model, sink: Sink) -> None:
    """Report that the bundled core replaces the standard library, if a name of the library is used.

    The diagnostic has no location: the installation lacks something, not a line of the model.
    """
    core = {document.root for document in model.library.loaded_documents()}
    targets = (
        relation.reference.target
        for document in model.documents
        for node in model.nodes(document)
        for relation in node.relations
    )
    if any(target is not None and find_root(target) in core for target in targets):
        sink.report(NO_STANDARD_LIBRARY, Subject())
