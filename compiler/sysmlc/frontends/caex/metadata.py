"""What CAEX says about elements beside their structure: descriptions, revisions, origin."""

import re
from collections.abc import Iterator
from html import escape

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.libraries import mark
from sysmlc.ir import Edge, Element, Kind

_CAPITAL = re.compile(r"(?<=[a-z0-9])([A-Z])")
_KEPT = frozenset(
    {
        "Revision",
        "AdditionalInformation",
        "SourceObjectInformation",
        "SourceDocumentInformation",
        "WriterHeader",
    }
)


_SAID = _KEPT | {"Copyright", "Description", "RefSemantic", "Version"}
"""All that is said about the element around it."""


def lower(context: Context, document: Document) -> None:
    """Add what is said about the elements of a file; those of the file itself are read before."""
    for node in map(document.node, _holders(document)):
        element = context.graph.get(node.element)
        if element is None:
            continue
        if element.kind is not Kind.DOCUMENT and not _is_of_class(element, node):
            _texts(context, node, element)
        for row in document.children(node.row):
            if document.tags[row] in _SAID:
                _child(context, document, document.node(row), element)


def _is_of_class(element: Element, node: Node) -> bool:
    """Whether the row repeats the port of a class, of which it says nothing (``members``)."""
    is_there = element.ordinal in (node.ordinal, -1)
    return element.kind is Kind.PORT and not (is_there and element.name == node.name)


def _holders(document: Document) -> list[int]:
    """Rows that something is said about: few of a large file."""
    parents = document.parents
    rows: set[int] = set()
    for tag in _SAID:
        rows.update(parents[row] for row in document.tagged(tag, 0, len(parents)))
    rows |= {row for row, values in enumerate(document.attributes) if "ChangeMode" in values}
    rows.update(document.texts["Description"], document.texts["Version"])
    return sorted(rows)


def _texts(context: Context, node: Node, element: Element) -> None:
    for text in node.all_texts("Description") if node.texts or node.children else ():
        if text.strip():
            _comment(context, element, text)
    version = node.text("Version") if node.texts or node.children else None
    if version and "version" not in element.attrs:
        context.graph.set(element, version=version)
    change = node.attributes.get("ChangeMode", "")
    if change and change != "state":
        context.graph.set(element, change_mode=change)


def _comment(context: Context, element: Element, text: str) -> None:
    owner = element.id if element.kind not in (Kind.IMPORT,) else element.owner
    id = f"{element.id}/Description"
    if id not in context.graph:
        comment = Element(id, Kind.COMMENT, "", owner, element.ordinal, element.source)
        comment.attrs["body"] = text.strip()
        context.graph.add(comment)


def _child(context: Context, document: Document, node: Node, element: Element) -> None:
    if node.verdict is not None:
        return
    if node.tag in ("Copyright", "Description", "Version"):
        mark(node)
        if node.tag == "Copyright":
            context.graph.set(element, copyright=_text(node) or None)
    elif node.tag == "RefSemantic":
        mark(node)
        path = node.attributes.get("CorrespondingAttributePath", "")
        known = element.attrs.get("semantics", ())
        if path and isinstance(known, tuple):
            context.graph.set(element, semantics=(*known, path))
    elif node.tag in _KEPT:
        _keep(context, document, node, element)


def _keep(context: Context, document: Document, node: Node, element: Element) -> None:
    id = context.free(f"{element.id}/{node.tag}", node)
    made = Element(id, Kind.METADATA, node.tag, element.id, node.ordinal, document.name)
    for key, value in _flat(node):
        known = made.attrs.get(key)
        made.attrs[key] = value if known is None else f"{known}\n{value}"
    made.attrs["xml"] = _as_written(node)
    context.graph.add(made)
    context.graph.connect(Edge.REFERENCES, made.id, element.id)
    mark(node, Verdict.MAPPED)


def _as_written(top: Node) -> str:
    """The node as XML without namespaces, for the way back to CAEX."""
    parts: list[str] = []
    waiting: list[Node | str] = [top]
    while waiting:
        one = waiting.pop()
        if isinstance(one, str):
            parts.append(one)
            continue
        values = (f" {k.rpartition('}')[2]}={_quoted(v)}" for k, v in one.attributes.items())
        texts = one.texts or {}
        folded = (
            f"<{tag}>{escape(text, quote=False)}</{tag}>" for tag, text in texts.items() if tag
        )
        own = escape(texts.get("", ""), quote=False).strip()
        parts.append(f"<{one.tag}{''.join(values)}>{own}{''.join(folded)}")
        waiting += [f"</{one.tag}>", *reversed(one.children)]
    return "".join(parts)


_SPACES = str.maketrans({"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def _quoted(value: str) -> str:
    """A value of an attribute; ``quoteattr`` of the library imports networking for it: 17 ms."""
    plain = escape(value, quote=False).translate(_SPACES)
    if '"' not in plain:
        return f'"{plain}"'
    return f"'{plain}'" if "'" not in plain else '"' + plain.replace('"', "&quot;") + '"'


def _flat(top: Node) -> Iterator[tuple[str, str]]:
    """Attributes and texts below the node, named by their path."""
    waiting = [(top, "")]
    while waiting:
        node, prefix = waiting.pop()
        for name, value in node.attributes.items():
            yield f"{prefix}{_snake(name.rpartition('}')[2])}", value
        for tag, text in (node.texts or {}).items():
            if text.strip():
                yield (
                    f"{prefix}{_snake(tag)}" if tag else prefix.rstrip(".") or "text",
                    text.strip(),
                )
        waiting += [(child, f"{prefix}{_snake(child.tag)}.") for child in reversed(node.children)]


def _snake(name: str) -> str:
    return _CAPITAL.sub(r"_\1", name).lower()


def _text(node: Node) -> str:
    return (node.texts or {}).get("", "").strip()
