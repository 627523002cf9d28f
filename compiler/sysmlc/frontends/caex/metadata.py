"""Descriptions, versions, origins and other statements about the elements of a file."""

import re
from collections.abc import Iterator
from html import escape

from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.ir import Edge, Element, Graph, Kind

_CAPITAL = re.compile(r"(?<=[a-z0-9])([A-Z])")

_METADATA_TAGS = frozenset(
    {
        "Revision",
        "AdditionalInformation",
        "SourceObjectInformation",
        "SourceDocumentInformation",
        "WriterHeader",
    }
)
"""Elements that become Metadata, with their XML for the way back to CAEX."""
_STATEMENT_TAGS = _METADATA_TAGS | {"Copyright", "Description", "RefSemantic", "Version"}
"""All elements that describe the element around them."""


def lower_metadata(context: Context, document: Document) -> None:
    """Add the statements about the elements of a file; its header is lowered before."""
    for node in map(document.node, _find_described_rows(document)):
        element = context.graph.get(node.element_id)
        if element is None:
            continue
        if element.kind is not Kind.DOCUMENT and not _repeats_port(element, node):
            _lower_texts(context.graph, node, element)
        for row in document.child_rows(node.row):
            if document.tags[row] in _STATEMENT_TAGS:
                _lower_statement(context, document, document.node(row), element)


def _repeats_port(element: Element, node: Node) -> bool:
    """Whether the row repeats the port of a class; ``members`` lowers its description."""
    is_declaration = element.ordinal in (node.ordinal, -1)
    return element.kind is Kind.PORT and not (is_declaration and element.name == node.name)


def _find_described_rows(document: Document) -> list[int]:
    """Return the rows with statements: few of a large file."""
    parents = document.parents
    rows: set[int] = set()
    for tag in _STATEMENT_TAGS:
        rows.update(parents[row] for row in document.iter_rows(tag, 0, len(parents)))
    rows |= {row for row, values in enumerate(document.attributes) if "ChangeMode" in values}
    rows.update(document.texts["Description"], document.texts["Version"])
    return sorted(rows)


def _lower_texts(graph: Graph, node: Node, element: Element) -> None:
    """Add descriptions as comments, and set version and change mode of an element."""
    has_content = bool(node.texts or node.children)
    if has_content:
        for text in node.child_texts("Description"):
            if text.strip():
                _add_comment(graph, element, text)
    version = node.child_text("Version") if has_content else None
    if version and "version" not in element.attrs:
        graph.set(element, version=version)
    change = node.attributes.get("ChangeMode", "")
    # "state" is the default of the schema: nothing was changed.
    if change and change != "state":
        graph.set(element, change_mode=change)


def _add_comment(graph: Graph, element: Element, text: str) -> None:
    owner = element.owner if element.kind is Kind.IMPORT else element.id
    id = f"{element.id}/Description"
    if id not in graph:
        comment = Element(id, Kind.COMMENT, "", owner, element.ordinal, element.source)
        comment.attrs["body"] = text.strip()
        graph.add(comment)


def _lower_statement(context: Context, document: Document, node: Node, element: Element) -> None:
    """Lower a statement about *element*, unless it was lowered with the element."""
    if node.verdict is not None:
        return
    if node.tag in _METADATA_TAGS:
        _add_metadata(context, document, node, element)
        return
    node.mark_subtree()
    if node.tag == "Copyright":
        context.graph.set(element, copyright=node.own_text.strip() or None)
    elif node.tag == "RefSemantic":
        path = node.attributes.get("CorrespondingAttributePath", "")
        semantics = element.attrs.get("semantics", ())
        if path and isinstance(semantics, tuple):
            context.graph.set(element, semantics=(*semantics, path))


def _add_metadata(context: Context, document: Document, node: Node, element: Element) -> None:
    """Add Metadata with the values, whose keys are their paths, and the source text of the XML."""
    id = context.make_unique(f"{element.id}/{node.tag}", node)
    metadata = Element(id, Kind.METADATA, node.tag, element.id, node.ordinal, document.name)
    for key, value in _iter_values(node):
        present = metadata.attrs.get(key)
        metadata.attrs[key] = value if present is None else f"{present}\n{value}"
    metadata.attrs["xml"] = _print_xml(node)
    context.graph.add(metadata)
    context.graph.connect(Edge.REFERENCES, metadata.id, element.id)
    node.mark_subtree()


def _iter_values(top: Node) -> Iterator[tuple[str, str]]:
    """Yield the XML attributes and texts of a node and its descendants, each with its path."""
    stack = [(top, "")]
    while stack:
        node, prefix = stack.pop()
        for name, value in node.attributes.items():
            yield f"{prefix}{_to_snake_case(name.rpartition('}')[2])}", value
        for tag, text in node.texts.items():
            if text.strip():
                own_key = prefix.rstrip(".") or "text"
                yield f"{prefix}{_to_snake_case(tag)}" if tag else own_key, text.strip()
        children = reversed(node.children)
        stack += [(child, f"{prefix}{_to_snake_case(child.tag)}.") for child in children]


def _to_snake_case(name: str) -> str:
    return _CAPITAL.sub(r"_\1", name).lower()


# -- XML -------------------------------------------------------------------------------------------

_WHITE_SPACE = str.maketrans({"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def _print_xml(top: Node) -> str:
    """Return the node as XML without namespaces."""
    parts: list[str] = []
    stack: list[Node | str] = [top]
    while stack:
        node = stack.pop()
        if isinstance(node, str):
            parts.append(node)
            continue
        attributes = (
            f" {name.rpartition('}')[2]}={quote_attribute(value)}"
            for name, value in node.attributes.items()
        )
        texts = node.texts
        folded = (
            f"<{tag}>{escape(text, quote=False)}</{tag}>" for tag, text in texts.items() if tag
        )
        content = escape(texts.get("", ""), quote=False).strip()
        parts.append(f"<{node.tag}{''.join(attributes)}>{content}{''.join(folded)}")
        stack += [f"</{node.tag}>", *reversed(node.children)]
    return "".join(parts)


def quote_attribute(value: str) -> str:
    """Return the value of an XML attribute in quotes.

    ``xml.sax.saxutils.quoteattr`` does the same, but importing it takes 17 ms.
    """
    text = escape(value, quote=False).translate(_WHITE_SPACE)
    if '"' not in text:
        return f'"{text}"'
    return f"'{text}'" if "'" not in text else '"' + text.replace('"', "&quot;") + '"'
