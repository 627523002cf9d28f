"""Lowers the rows of a document to elements of the graph, in one walk in document order."""

from sysmlc.diagnostics import Verdict
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
from sysmlc.frontends.xmi.elements import add_element
from sysmlc.frontends.xmi.folded_elements import is_reference, lower_reference
from sysmlc.frontends.xmi.unit import File, RowHandler
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


def lower_document(file: File) -> None:
    """Lower one document; references and applications of stereotypes are left for later steps."""
    document = file.document
    row = 0
    # The elements below `xmi:XMI` are the roots; without it, the only root is the document element.
    if namespaces.is_xmi(document.namespace(0)):
        file.verdicts[0] = Verdict.MAPPED
        row = 1
    root_parent = row - 1
    while row < len(document):
        is_root = document.parents[row] == root_parent
        row = _lower_root(file, row) if is_root else _lower_row(file, row)


def _lower_root(file: File, row: int) -> int:
    document = file.document
    namespace, feature = document.namespace(row), document.features[row]
    if namespaces.is_uml(namespace):
        return _lower_element(file, row, document.types[row] or feature)
    is_settings = namespaces.is_settings(namespace)
    if is_settings and not papyrus.is_package_namespace(document, row):
        return file.mark_subtree(row, Verdict.IGNORED_NOTATION)
    if not namespace or namespaces.is_xmi(namespace):
        return _lower_row(file, row)
    file.applications.append(row)
    return document.ends[row]


def _lower_row(file: File, row: int) -> int:
    """Lower one row; return the next row of the walk."""
    document = file.document
    feature = document.features[row]
    if feature in vocabulary.NOTATION_FEATURES:
        return _lower_notation(file, row)
    file.element_ids[row] = file.element_ids[document.parents[row]]
    file.verdicts[row] = Verdict.MAPPED
    if is_reference(file, row):
        return lower_reference(file, row)
    handler = _FEATURES.get(feature)
    if handler is not None and _is_value(file, row, feature):
        handler(file, row)
        return document.ends[row]
    type_name = document.types[row]
    if not type_name and _is_text(file, row, feature):
        lower_text(file, row, feature)
        return document.ends[row]
    return _lower_element(file, row, type_name or metaclasses.DEFAULT_TYPES.get(feature, ""))


def _lower_element(file: File, row: int, type_name: str) -> int:
    handler = _TYPES.get(type_name)
    if handler is not None:
        handler(file, row)
        return file.next_row(row)
    mapped = metaclasses.kind_of(type_name)
    if mapped is None or not add_element(file, row, *mapped, type_name):
        return file.mark_subtree(row, Verdict.UNSUPPORTED)
    return row + 1


def _is_value(file: File, row: int, feature: str) -> bool:
    """Whether the row is a value, not an element of the same feature (a pin, a constraint)."""
    if feature in _ALWAYS_VALUES:
        return True
    type_name = file.document.types[row]
    if type_name:
        return type_name in metaclasses.VALUE_TYPES
    if feature != "value":
        return feature not in metaclasses.DEFAULT_TYPES
    owner = file.find_owner(row)
    return owner is not None and (owner.kind is Kind.SLOT or owner.subkind == "value")


def _is_text(file: File, row: int, feature: str) -> bool:
    """Whether the row contains only text: an attribute that is written as a child."""
    document = file.document
    if feature in metaclasses.DEFAULT_TYPES or document.ends[row] != row + 1:
        return False
    return all("}" in name for name in document.attributes[row])


# -- notation and extensions of tools --------------------------------------------------------------


def _lower_notation(file: File, row: int) -> int:
    """Ignore notation and settings of a tool, except the content that tools keep there."""
    document = file.document
    end = file.mark_subtree(row, Verdict.IGNORED_NOTATION)
    if document.features[row] == "eAnnotations":
        papyrus.record_ecore_namespaces(file, row)
    elif document.features[row] == "Extension":
        _lower_bounds_in_extension(file, row)
    if document.parents[row] == 0:
        _lower_libraries_in_extension(file, row)
    return end


def _lower_bounds_in_extension(file: File, row: int) -> None:
    """Lower the multiplicities of pins and edges, which MagicDraw keeps in an extension."""
    document = file.document
    if not file.elements[document.parents[row]]:
        return
    for model in document.children(row, "modelExtension"):
        for child in document.children(model):
            if document.features[child] in ("lowerValue", "upperValue"):
                _FEATURES[document.features[child]](file, child)


def _lower_libraries_in_extension(file: File, row: int) -> None:
    """Lower the primitive types and profiles that Enterprise Architect keeps in its extension."""
    document = file.document
    for feature in vocabulary.EXTENSION_CONTENT:
        for holder in document.children(row, feature):
            child, end = holder + 1, document.ends[holder]
            while child < end:
                is_root = namespaces.is_uml(document.namespace(child))
                child = _lower_root(file, child) if is_root else _lower_row(file, child)


# -- comments of rows that are no elements ---------------------------------------------------------


def restore_comments(file: File) -> None:
    """Add the comments inside values, events and the like, whose handlers lower the whole content.

    Such a comment belongs to the nearest element above it. Call this before the references of the
    unit are resolved.
    """
    document = file.document
    rows = [row for row, feature in enumerate(document.features) if feature == "ownedComment"]
    for row in rows:
        is_omitted = file.verdicts[row] is Verdict.MAPPED and not file.elements[row]
        if is_omitted and not is_reference(file, row):
            add_element(file, row, Kind.COMMENT, "", "Comment")
            for child in document.children(row):
                if is_reference(file, child):
                    lower_reference(file, child)
                elif document.features[child] == "body":
                    lower_text(file, child, "body")
