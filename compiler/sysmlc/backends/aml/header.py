"""What CAEX states about any object beside its structure: description, version, origin."""

import re

from sysmlc.backends.aml.context import Context
from sysmlc.backends.aml.node import Node, parse_fragment
from sysmlc.backends.aml.rules import ADDED
from sysmlc.ir import Edge, Element, Kind, list_items

_DEFAULT_DATE = "1970-01-01T00:00:00Z"
"""Written where the schema requires a date and the source has none.

It is constant because outputs must not depend on the day.
"""
_WRITING_DATE = "LastWritingDateTime"
_DATE = re.compile(r"(\d{4}-\d\d-\d\d)(?:[T ](\d\d:\d\d:\d\d(?:\.\d+)?)(Z|[+-]\d\d:\d\d)?)?$")
_SOURCE_DOCUMENT = "SourceDocumentInformation"
_REQUIRED_ATTRIBUTES = {
    _SOURCE_DOCUMENT: {
        "OriginName": "sysmlc",
        "OriginID": "sysmlc",
        "OriginVersion": "",
        _WRITING_DATE: _DEFAULT_DATE,
    },
    "SourceObjectInformation": {"OriginID": ""},
}
"""XML attributes that the schema of CAEX 3.0 requires, with the values written by default."""
_REQUIRED_IN_REVISION = {"RevisionDate": _DEFAULT_DATE, "AuthorName": ""}
"""Children that the schema requires in a Revision, with the texts written by default."""
_REVISION = ("RevisionDate", "OldVersion", "NewVersion", "AuthorName", "Comment")
"""Children of a Revision in the order of the schema."""
_WRITER_HEADER = {
    "OriginName": "WriterName",
    "OriginID": "WriterID",
    "OriginVendor": "WriterVendor",
    "OriginVendorURL": "WriterVendorURL",
    "OriginVersion": "WriterVersion",
    "OriginRelease": "WriterRelease",
    _WRITING_DATE: _WRITING_DATE,
    "OriginProjectTitle": "WriterProjectTitle",
    "OriginProjectID": "WriterProjectID",
}
"""XML attributes of CAEX 3.0 and the elements of CAEX 2.15 that hold the same.

The WriterHeader of CAEX 2.15 is defined in AutomationML Part 1 (2014).
"""


def write_header(context: Context, element: Element, node: Node) -> None:
    """Add comments, version, copyright, change mode and further XML of an element to its node."""
    _write_comments(context, element, node)
    for name, tag in (("version", "Version"), ("copyright", "Copyright")):
        if name in element.attrs:
            node.add_text(tag, str(element.attrs[name]))
    if "change_mode" in element.attrs:
        node.attributes["ChangeMode"] = str(element.attrs["change_mode"])
    for child in context.graph.owned(element):
        if child.kind is Kind.METADATA and "xml" in child.attrs:
            _write_metadata(context, child, node)


def write_semantics(element: Element, node: Node) -> None:
    """Add the references to dictionaries of terms."""
    for path in list_items(element.attrs.get("semantics")):
        node.add(Node("RefSemantic", {"CorrespondingAttributePath": str(path)}))


def add_description(context: Context, comment: Element, node: Node) -> None:
    """Add a comment to the Description; CAEX allows only one, so comments are joined."""
    body = str(comment.attrs.get("body", ""))
    description = next((child for child in node.children if child.tag == "Description"), None)
    context.written.add(comment.id)
    if description is None:
        node.add_text("Description", body)
    else:
        description.text = f"{description.text}\n\n{body}"
        context.losses.record_approximation(comment, "a further comment", "part of the Description")


def _write_comments(context: Context, element: Element, node: Node) -> None:
    """Add the comments that the element owns, and those elsewhere that refer to it."""
    graph = context.graph
    comments = [child for child in graph.owned(element) if child.kind is Kind.COMMENT]
    owned = [comment for comment in comments if not graph.targets(comment, Edge.REFERENCES)]
    referring = [
        source
        for source in graph.sources(element, Edge.REFERENCES)
        if _is_general_comment(context, source)
    ]
    for comment in [*owned, *referring]:
        if comment.id not in context.written:
            add_description(context, comment, node)
        if comment in referring:
            context.mark_edge(Edge.REFERENCES, comment, element)


def _is_general_comment(context: Context, element: Element) -> bool:
    """Whether the element is a comment that no instance owns.

    Comments of instances are about features of their class; ``instances.py`` writes them.
    """
    owner = context.graph.owner(element)
    return element.kind is Kind.COMMENT and (owner is None or owner.kind is not Kind.INSTANCE)


def _write_metadata(context: Context, element: Element, node: Node) -> None:
    fragment = parse_fragment(str(element.attrs["xml"]))
    context.written.add(element.id)
    for target in context.graph.targets(element, Edge.REFERENCES):
        context.mark_edge(Edge.REFERENCES, element, target)
    _complete_fragment(context, element, fragment)
    node.add(fragment)


def _complete_fragment(context: Context, element: Element, node: Node) -> None:
    """Add what the schema of CAEX 3.0 requires and the source, often CAEX 2.15, lacks."""
    if node.tag == _SOURCE_DOCUMENT:
        _normalise_date(context, element, node)
    for name, value in _REQUIRED_ATTRIBUTES.get(node.tag, {}).items():
        if name not in node.attributes:
            node.attributes[name] = value
            _note_addition(context, element, name, value)
    if node.tag == "Revision":
        _complete_revision(context, element, node)


def _complete_revision(context: Context, element: Element, node: Node) -> None:
    parts = {child.tag: child for child in node.children}
    for name, value in _REQUIRED_IN_REVISION.items():
        if name not in parts:
            parts[name] = Node(name, text=value)
            _note_addition(context, element, name, value)
    rest = [child for child in node.children if child.tag not in _REVISION]
    node.children = rest + [parts[name] for name in _REVISION if name in parts]


def _normalise_date(context: Context, element: Element, node: Node) -> None:
    """Write the date in the form of XML Schema; replace a text that is no date."""
    text = node.attributes.get(_WRITING_DATE)
    if text is None:
        return
    match = _DATE.match(text.strip())
    date = f"{match[1]}T{match[2] or '00:00:00'}{match[3] or ''}" if match else _DEFAULT_DATE
    if date != text:
        node.attributes[_WRITING_DATE] = date
        context.losses.record_approximation(element, f"the date '{text}'", f"'{date}'")


def _note_addition(context: Context, element: Element, what: str, value: str) -> None:
    context.losses.record(ADDED, element, element=element.name, what=what, value=value)


def write_source_document(context: Context, document: Element | None, root: Node) -> None:
    """Add the SourceDocumentInformation, which CAEX 3.0 requires, unless the file has one.

    It names the writer in the WriterHeader of a file in CAEX 2.15, else sysmlc.
    """
    if any(child.tag == _SOURCE_DOCUMENT for child in root.children):
        return
    node = Node(_SOURCE_DOCUMENT)
    writer = _read_writer_header(root)
    for name, old_name in _WRITER_HEADER.items():
        if writer.get(old_name):
            node.attributes[name] = writer[old_name]
    if document is not None:
        _normalise_date(context, document, node)
        _note_addition(
            context, document, _SOURCE_DOCUMENT, node.attributes.get("OriginName", "sysmlc")
        )
    node.attributes = _REQUIRED_ATTRIBUTES[_SOURCE_DOCUMENT] | node.attributes
    root.add(node)


def _read_writer_header(root: Node) -> dict[str, str]:
    """Return the texts in the first WriterHeader below any AdditionalInformation."""
    queue = [child for child in root.children if child.tag == "AdditionalInformation"]
    while queue:
        node = queue.pop(0)
        if node.tag == "WriterHeader":
            return {child.tag: child.text.strip() for child in node.children}
        queue += node.children
    return {}
