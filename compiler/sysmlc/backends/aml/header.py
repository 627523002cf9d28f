"""What CAEX says about any object beside its structure: description, version, origin."""

import re

from sysmlc.backends.aml.book import Book
from sysmlc.backends.aml.node import Node, parsed
from sysmlc.backends.aml.rules import ADDED, APPROXIMATED
from sysmlc.ir import Edge, Element, Kind

_DATE = "1970-01-01T00:00:00Z"
"""Written where the schema wants a date and nobody gives one: files must not depend on the day."""
_WRITTEN = "LastWritingDateTime"
_TIME = re.compile(r"(\d{4}-\d\d-\d\d)(?:[T ](\d\d:\d\d:\d\d(?:\.\d+)?)(Z|[+-]\d\d:\d\d)?)?$")
REQUIRED = {
    "SourceDocumentInformation": {
        "OriginName": "sysmlc",
        "OriginID": "sysmlc",
        "OriginVersion": "",
        "LastWritingDateTime": _DATE,
    },
    "SourceObjectInformation": {"OriginID": ""},
}
"""Attributes that the schema of CAEX 3.0 wants, and what is written where none is known."""
_TEXTS = {"RevisionDate": _DATE, "AuthorName": ""}
"""The same for what a Revision holds, in the order of the schema."""
_REVISION = ("RevisionDate", "OldVersion", "NewVersion", "AuthorName", "Comment")
_WRITER = {
    "OriginName": "WriterName",
    "OriginID": "WriterID",
    "OriginVendor": "WriterVendor",
    "OriginVendorURL": "WriterVendorURL",
    "OriginVersion": "WriterVersion",
    "OriginRelease": "WriterRelease",
    "LastWritingDateTime": "LastWritingDateTime",
    "OriginProjectTitle": "WriterProjectTitle",
    "OriginProjectID": "WriterProjectID",
}
"""What the header of CAEX 2.15 calls the same (AutomationML Part 1, 2014)."""


def write(book: Book, element: Element, node: Node) -> None:
    """Add what is told of an element to its node."""
    _comments(book, element, node)
    for name, tag in (("version", "Version"), ("copyright", "Copyright")):
        if name in element.attrs:
            node.say(tag, str(element.attrs[name]))
    if "change_mode" in element.attrs:
        node.attributes["ChangeMode"] = str(element.attrs["change_mode"])
    for one in book.graph.owned(element):
        if one.kind is Kind.METADATA and "xml" in one.attrs:
            _metadata(book, one, node)


def semantics(element: Element, node: Node) -> None:
    """Add the references to dictionaries of terms."""
    found = element.attrs.get("semantics")
    for path in found if isinstance(found, tuple) else ():
        node.add(Node("RefSemantic", {"CorrespondingAttributePath": str(path)}))


def describe(book: Book, comment: Element, node: Node) -> None:
    """Add a comment as the description; CAEX has one, so that several become one."""
    body = str(comment.attrs.get("body", ""))
    known = next((c for c in node.children if c.tag == "Description"), None)
    book.said.add(comment.id)
    if known is None:
        node.say("Description", body)
    else:
        known.text = f"{known.text}\n\n{body}"
        said = "a further comment"
        book.losses.note(APPROXIMATED, comment, said=said, written="part of the Description")


def _comments(book: Book, element: Element, node: Node) -> None:
    graph = book.graph
    own = [c for c in graph.owned(element) if c.kind is Kind.COMMENT]
    about = [c for c in graph.sources(element, Edge.REFERENCES) if _is_about(book, c)]
    for comment in [*(c for c in own if not graph.targets(c, Edge.REFERENCES)), *about]:
        if comment.id not in book.said:
            describe(book, comment, node)
        if comment in about:
            book.say(Edge.REFERENCES, comment, element)


def _is_about(book: Book, comment: Element) -> bool:
    """Whether a comment is about what it refers to wherever that is, not in one instance."""
    owner = book.graph.owner(comment)
    return comment.kind is Kind.COMMENT and (owner is None or owner.kind is not Kind.INSTANCE)


def _metadata(book: Book, element: Element, node: Node) -> None:
    made = parsed(str(element.attrs["xml"]))
    book.said.add(element.id)
    for target in book.graph.targets(element, Edge.REFERENCES):
        book.say(Edge.REFERENCES, element, target)
    complete(book, element, made)
    node.add(made)


def complete(book: Book, element: Element, node: Node) -> None:
    """Add what the schema wants and the source does not say."""
    if node.tag == "SourceDocumentInformation":
        _dated(book, element, node)
    for name, value in REQUIRED.get(node.tag, {}).items():
        if name not in node.attributes:
            node.attributes[name] = value
            _added(book, element, name, value)
    if node.tag == "Revision":
        known = {child.tag: child for child in node.children}
        for name, value in _TEXTS.items():
            if name not in known:
                known[name] = Node(name, text=value)
                _added(book, element, name, value)
        rest = [c for c in node.children if c.tag not in _REVISION]
        node.children = rest + [known[name] for name in _REVISION if name in known]


def _dated(book: Book, element: Element, node: Node) -> None:
    """Write the date as XML Schema does; one that is none is left out."""
    text = node.attributes.get(_WRITTEN)
    if text is None:
        return
    found = _TIME.match(text.strip())
    made = f"{found[1]}T{found[2] or '00:00:00'}{found[3] or ''}" if found else _DATE
    if made != text:
        node.attributes[_WRITTEN] = made
        facts = {"said": f"the date '{text}'", "written": f"'{made}'"}
        book.losses.note(APPROXIMATED, element, **facts)


def _added(book: Book, element: Element, what: str, value: str) -> None:
    facts = {"element": element.name, "what": what, "value": value}
    book.losses.note(ADDED, element, **facts)


def source_document(book: Book, element: Element | None, root: Node) -> None:
    """Say who wrote the file, as CAEX 3.0 wants: the writer that CAEX 2.15 names, else we."""
    if any(child.tag == "SourceDocumentInformation" for child in root.children):
        return
    node = Node("SourceDocumentInformation")
    writer = _writer(root)
    for name, old in _WRITER.items():
        if writer.get(old):
            node.attributes[name] = writer[old]
    if element is not None:
        _dated(book, element, node)
        what = "SourceDocumentInformation"
        known = node.attributes.get("OriginName", "sysmlc")
        book.losses.note(ADDED, element, element=element.name, what=what, value=known)
    node.attributes = REQUIRED[node.tag] | node.attributes
    root.add(node)


def _writer(root: Node) -> dict[str, str]:
    waiting = [child for child in root.children if child.tag == "AdditionalInformation"]
    while waiting:
        node = waiting.pop(0)
        if node.tag == "WriterHeader":
            return {child.tag: child.text.strip() for child in node.children}
        waiting += node.children
    return {}
