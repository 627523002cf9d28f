"""From the rows of a document to elements of the graph: one walk in document order."""

from collections.abc import Callable

from sysmlc.diagnostics import Sink, Verdict
from sysmlc.frontends.xmi import (
    behaviour,
    expressions,
    interactions,
    metaclasses,
    namespaces,
    structure,
    templates,
    usecases,
    vocabulary,
)
from sysmlc.frontends.xmi import value_features as value_rows
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.making import make
from sysmlc.frontends.xmi.unit import Lowered, Unit

_Reader = Callable[[Context, int], None]

_FEATURES: dict[str, _Reader] = (
    value_rows.FEATURES | behaviour.FEATURES | interactions.FEATURES | templates.FEATURES
)
_TYPES: dict[str, _Reader] = (
    expressions.TYPES
    | structure.TYPES
    | behaviour.TYPES
    | interactions.TYPES
    | templates.TYPES
    | usecases.TYPES
)


def lower(unit: Unit, lowered: Lowered, sink: Sink) -> Context:
    """Lower one document; stereotype applications and references are left for later."""
    context = Context(unit, lowered, sink)
    document = lowered.document
    row = 0
    if namespaces.is_xmi(document.namespace(0)):
        context.verdicts[0] = Verdict.MAPPED
        row = 1
    root_parent = row - 1
    while row < len(document):
        is_root = document.parents[row] == root_parent
        row = _root(context, row) if is_root else _row(context, row)
    return context


def _root(context: Context, row: int) -> int:
    document = context.document
    namespace = document.namespace(row)
    feature = document.features[row]
    if namespaces.is_uml(namespace):
        return _element(context, row, document.types[row] or feature, feature)
    if namespaces.is_settings(namespace) and not _names_package(context, row):
        return context.subtree(row, Verdict.IGNORED_NOTATION)
    if not namespace or namespaces.is_xmi(namespace):
        return _row(context, row)
    context.applications.append(row)
    return document.ends[row]


def _names_package(context: Context, row: int) -> bool:
    return (
        "nsURI" in context.document.attributes[row]
        and "base_Package" in (context.document.attributes[row])
    )


def _row(context: Context, row: int) -> int:
    document = context.document
    feature = document.features[row]
    values = document.attributes[row]
    if feature in vocabulary.NOTATION_FEATURES:
        return _notation(context, row)
    context.gids[row] = context.gids[document.parents[row]]
    context.verdicts[row] = Verdict.MAPPED
    if "href" in values or document.idref_key in values:
        return structure.reference(context, row, feature)
    special = _FEATURES.get(feature)
    if special is not None and structure.is_value(context, row, feature):
        special(context, row)
        return document.ends[row]
    type_name = document.types[row]
    if type_name:
        return _element(context, row, type_name, feature)
    if structure.is_text(context, row, feature):
        context.text(row, feature)
        return document.ends[row]
    return _element(context, row, metaclasses.DEFAULT_TYPES.get(feature, ""), feature)


def _notation(context: Context, row: int) -> int:
    end = structure.notation(context, row)
    if context.document.parents[row] == 0:
        if context.document.attributes[row].get("extender") == "Enterprise Architect":
            context.extensions.append(row)
        _content_of_extension(context, row)
    return end


def _content_of_extension(context: Context, row: int) -> None:
    """Enterprise Architect keeps the primitive types and profiles that it uses beside the model."""
    document = context.document
    for feature in vocabulary.EXTENSION_CONTENT:
        for holder in document.children(row, feature):
            child, end = holder + 1, document.ends[holder]
            while child < end:
                is_root = namespaces.is_uml(document.namespace(child))
                child = _root(context, child) if is_root else _row(context, child)


def _element(context: Context, row: int, type_name: str, feature: str) -> int:
    reader = _TYPES.get(type_name)
    if reader is not None:
        reader(context, row)
        return context.next_row(row)
    kind = metaclasses.kind_of(type_name)
    if kind is None or not make(context, row, kind[0], kind[1], type_name, feature):
        return context.subtree(row, Verdict.UNSUPPORTED)
    return row + 1
