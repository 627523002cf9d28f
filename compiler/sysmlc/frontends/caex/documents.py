"""Files of other languages that a plant refers to (IEC 62714-3 and -4): recorded, never loaded."""

import re
from collections.abc import Iterator

from sysmlc.diagnostics import Place
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.sources import Source
from sysmlc.sources.encoding import codec

_REFERENCE = re.compile(
    r"""<(?:[\w.-]+:)?Attribute\b[^>]*\bName\s*=\s*["']refURI["'][^>]*>(.*?)</""", re.DOTALL
)
_VALUE = re.compile(r"<(?:[\w.-]+:)?Value[^>]*>([^<]*)$")
_FILE = re.compile(r"^[^#]*\.\w{1,8}(#|$)")
"""What has a suffix: other texts are names and ids in the language of a tool."""
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")


def lower(
    context: Context,
    node: Node,
    document: Document,
    owner: str,
    port: str,
    subkind: str,
    said: dict[str, AttrValue],
) -> None:
    """Add the document that an interface names; without a reference there is none."""
    href = said.get("value.refURI")
    if not href:
        return
    id = context.free(f"{owner}/{node.name}#document", node)
    made = Element(id, Kind.DOCUMENT, node.name, owner, node.ordinal, document.name)
    made.attrs.update(subkind=subkind, href=str(href).strip())
    if said.get("value.MIMEType"):
        made.attrs["media_type"] = said["value.MIMEType"]
    context.graph.add(made)
    context.graph.connect(Edge.REFERENCES, id, port)


def mentioned(source: Source) -> Iterator[tuple[str, Place]]:
    """Local files that references to external data name, each with its place."""
    mark, name = codec(source.data)
    text = source.data[mark:].decode(name, "replace") if b"refURI" in source.data else ""
    for match in _REFERENCE.finditer(text):
        value = _VALUE.search(match[1])
        path = value[1].strip() if value else ""
        local = path.removeprefix("file://") if path.startswith("file:///") else path
        if _FILE.search(local) and not _SCHEME.match(local):
            before = text[: match.start()].encode(name, "replace")
            yield local.lstrip("/"), Place(source.name, offset=mark + len(before))
