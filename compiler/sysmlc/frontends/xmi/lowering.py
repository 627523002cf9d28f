"""Lowers the rows of a document to elements of the graph, in one walk in document order."""

from sysmlc.diagnostics import Sink, Verdict
from sysmlc.frontends.xmi import (
    behaviour,
    folded_elements,
    interactions,
    metaclasses,
    namespaces,
    papyrus,
    templates,
    value_features,
    vocabulary,
)
from sysmlc.frontends.xmi.attributes import lower_text
from sysmlc.frontends.xmi.context import Context, RowHandler
from sysmlc.frontends.xmi.elements import add_element
from sysmlc.frontends.xmi.folded_elements import is_reference, lower_reference
from sysmlc.frontends.xmi.unit import LoweredDocument, Unit
from sysmlc.ir import Kind

_FEATURES: dict[str, RowHandler] = (
    value_features.FEATURES | behaviour.FEATURES | interactions.FEATURES | templates.FEATURES
)
"""Handlers of values, by feature."""
_TYPES: dict[str, RowHandler] = (
    value_features.TYPES
    | folded_elements.TYPES
    | behaviour.TYPES
    | interactions.TYPES
    | templates.TYPES
)
"""Handlers of elements, by metaclass; the tables of ``metaclasses`` say how others are lowered."""

_ALWAYS_VALUES = frozenset(
    """
    lowerValue upperValue lower upper defaultValue joinSpec upperBound specification clause handler
    endData weight nameExpression
    """.split()  # noqa: SIM905 - a list of words
)
"""Features whose content is a value whatever its metaclass."""


def lower_document(unit: Unit, file: LoweredDocument, sink: Sink) -> Context:
    """Lower one document; references and applications of stereotypes are left for later steps."""
    context = Context(unit, file, sink)
    document = file.document
    row = 0
    # The elements below `xmi:XMI` are the roots; without it, the only root is the document element.
    if namespaces.is_xmi(document.namespace(0)):
        context.verdicts[0] = Verdict.MAPPED
        row = 1
    root_parent = row - 1
    while row < len(document):
        is_root = document.parents[row] == root_parent
        row = _lower_root(context, row) if is_root else _lower_row(context, row)
    return context


def _lower_root(context: Context, row: int) -> int:
    document = context.document
    namespace, feature = document.namespace(row), document.features[row]
    if namespaces.is_uml(namespace):
        return _lower_element(context, row, document.types[row] or feature)
    is_settings = namespaces.is_settings(namespace)
    if is_settings and not papyrus.is_package_namespace(document, row):
        return context.mark_subtree(row, Verdict.IGNORED_NOTATION)
    if not namespace or namespaces.is_xmi(namespace):
        return _lower_row(context, row)
    context.applications.append(row)
    return document.ends[row]


def _lower_row(context: Context, row: int) -> int:
    """Lower one row; return the next row of the walk."""
    document = context.document
    feature = document.features[row]
    if feature in vocabulary.NOTATION_FEATURES:
        return _lower_notation(context, row)
    context.element_ids[row] = context.element_ids[document.parents[row]]
    context.verdicts[row] = Verdict.MAPPED
    if is_reference(context, row):
        return lower_reference(context, row)
    handler = _FEATURES.get(feature)
    if handler is not None and _is_value(context, row, feature):
        handler(context, row)
        return document.ends[row]
    type_name = document.types[row]
    if not type_name and _is_text(context, row, feature):
        lower_text(context, row, feature)
        return document.ends[row]
    return _lower_element(context, row, type_name or metaclasses.DEFAULT_TYPES.get(feature, ""))


def _lower_element(context: Context, row: int, type_name: str) -> int:
    handler = _TYPES.get(type_name)
    if handler is not None:
        handler(context, row)
        return context.next_row(row)
    mapped = metaclasses.kind_of(type_name)
    if mapped is None or not add_element(context, row, *mapped, type_name):
        return context.mark_subtree(row, Verdict.UNSUPPORTED)
    return row + 1


def _is_value(context: Context, row: int, feature: str) -> bool:
    """Whether the row is a value, not an element of the same feature (a pin, a constraint)."""
    if feature in _ALWAYS_VALUES:
        return True
    type_name = context.document.types[row]
    if type_name:
        return type_name in metaclasses.VALUE_TYPES
    if feature != "value":
        return feature not in metaclasses.DEFAULT_TYPES
    owner = context.find_owner(row)
    return owner is not None and (owner.kind is Kind.SLOT or owner.subkind == "value")


def _is_text(context: Context, row: int, feature: str) -> bool:
    """Whether the row contains only text: an attribute that is written as a child."""
    document = context.document
    if feature in metaclasses.DEFAULT_TYPES or document.ends[row] != row + 1:
        return False
    return all("}" in name for name in document.attributes[row])


# -- notation and extensions of tools --------------------------------------------------------------


def _lower_notation(context: Context, row: int) -> int:
    """Ignore notation and settings of a tool, except the content that tools keep there."""
    document = context.document
    end = context.mark_subtree(row, Verdict.IGNORED_NOTATION)
    if document.features[row] == "eAnnotations":
        papyrus.record_ecore_namespaces(context, row)
    elif document.features[row] == "Extension":
        _lower_bounds_in_extension(context, row)
    if document.parents[row] == 0:
        if document.attributes[row].get("extender") == "Enterprise Architect":
            context.extensions.append(row)
        _lower_libraries_in_extension(context, row)
    return end


def _lower_bounds_in_extension(context: Context, row: int) -> None:
    """Lower the multiplicities of pins and edges, which MagicDraw keeps in an extension."""
    document = context.document
    if not context.elements[document.parents[row]]:
        return
    for model in document.children(row, "modelExtension"):
        for child in document.children(model):
            if document.features[child] in ("lowerValue", "upperValue"):
                _FEATURES[document.features[child]](context, child)


def _lower_libraries_in_extension(context: Context, row: int) -> None:
    """Lower the primitive types and profiles that Enterprise Architect keeps in its extension."""
    document = context.document
    for feature in vocabulary.EXTENSION_CONTENT:
        for holder in document.children(row, feature):
            child, end = holder + 1, document.ends[holder]
            while child < end:
                is_root = namespaces.is_uml(document.namespace(child))
                child = _lower_root(context, child) if is_root else _lower_row(context, child)


# -- comments of rows that are no elements ---------------------------------------------------------


def restore_comments(context: Context) -> None:
    """Add the comments inside values, events and the like, whose handlers lower the whole content.

    Such a comment belongs to the nearest element above it. Call this before the references of the
    unit are resolved.
    """
    document = context.document
    rows = [row for row, feature in enumerate(document.features) if feature == "ownedComment"]
    for row in rows:
        is_omitted = context.verdicts[row] is Verdict.MAPPED and not context.elements[row]
        if is_omitted and not is_reference(context, row):
            add_element(context, row, Kind.COMMENT, "", "Comment")
            for child in document.children(row):
                if is_reference(context, child):
                    lower_reference(context, child)
                elif document.features[child] == "body":
                    lower_text(context, child, "body")
