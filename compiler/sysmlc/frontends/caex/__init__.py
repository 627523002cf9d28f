"""Front end for AutomationML: CAEX 2.15 and 3.0 (IEC 62424).

Searches in the bytes detect the format and find references and the kind of a file, because the
compile unit needs these to decide which files are parsed.
"""

import re
from collections.abc import Iterator, Sequence
from html import unescape

from sysmlc.diagnostics import Coverage, Place, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.ir import Graph
from sysmlc.sources import Source
from sysmlc.sources.xml import find_codec

_HEAD = 1 << 14
"""Bytes that are searched for the root element."""
_ROOT = re.compile(rb"<(?:[\w.-]+:)?CAEXFile[\s>/]")
_FIRST_ELEMENT = re.compile(rb"<(?![?!])")
_HIERARCHY = re.compile(rb"<(?:[\w.-]+:)?InstanceHierarchy\b")

_EXTERNAL_REFERENCE = re.compile(r"<(?:[\w.-]+:)?ExternalReference\b[^>]*")
_PATH = re.compile(r"""\bPath\s*=\s*(?:"([^"]+)|'([^']+))""")

_REF_URI = re.compile(
    r"""<(?:[\w.-]+:)?Attribute\b[^>]*\bName\s*=\s*["']refURI["'][^>]*>(.*?)</""", re.DOTALL
)
_VALUE = re.compile(r"<(?:[\w.-]+:)?Value[^>]*>([^<]*)$")
_FILE = re.compile(r"^[^#]*\.\w{1,8}(#|$)")
"""Paths with a suffix: a refURI without one is a name or an id in the language of a tool."""
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")


class CaexFrontend:
    """Reads AutomationML: CAEX 2.15 and 3.0, and files that mix them."""

    name = "caex"
    is_folder_unit = False

    def detect(self, source: Source) -> float:
        """Return how certain it is, from 0 to 1, that the source is AutomationML.

        1 when the first element is a CAEXFile, 0.3 when one is in the head of a damaged file. The
        namespace does not matter: it differs between versions and tools, and hybrids exist.
        """
        head = source.data[:_HEAD].replace(b"\0", b"")
        root = _ROOT.search(head)
        if root is None:
            return 0.0
        first = _FIRST_ELEMENT.search(head)
        return 1.0 if first is not None and first.start() == root.start() else 0.3

    def links(self, source: Source) -> Sequence[str]:
        """Return the files that external references name, each once and in order.

        References in a package (``.amlx``) lead to other parts of it, which are read with it.
        """
        if "!" in source.name:
            return []
        mark, encoding = find_codec(source.data)
        text = source.data[mark:].decode(encoding, "replace")
        matches = (_PATH.search(tag) for tag in _EXTERNAL_REFERENCE.findall(text))
        return list(dict.fromkeys(unescape(match[1] or match[2]) for match in matches if match))

    def read_names(self, source: Source) -> FileNames:
        """Return no names; a file without an instance hierarchy is marked as a library.

        Files refer to one another by path only.
        """
        # In UTF-16 every other byte is zero.
        has_hierarchy = _HIERARCHY.search(source.data.replace(b"\0", b"")) is not None
        return FileNames(is_library=not has_hierarchy)

    def list_attachments(self, source: Source) -> Sequence[tuple[str, Place]]:
        """Return the local files of other languages that the source refers to, unread."""
        return list(_iter_external_documents(source))

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; see ``reading.read`` and docs/automationml.md."""
        from sysmlc.frontends.caex import reading

        reading.read(sources, graph, sink, coverage)


def _iter_external_documents(source: Source) -> Iterator[tuple[str, Place]]:
    """Yield the local files that references to external data name, with their locations."""
    if b"refURI" not in source.data:
        return
    mark, encoding = find_codec(source.data)
    text = source.data[mark:].decode(encoding, "replace")
    for match in _REF_URI.finditer(text):
        value = _VALUE.search(match[1])
        path = value[1].strip() if value else ""
        local = path.removeprefix("file://") if path.startswith("file:///") else path
        if _FILE.search(local) and not _SCHEME.match(local):
            before = text[: match.start()].encode(encoding, "replace")
            yield local.lstrip("/"), Place(source.name, offset=mark + len(before))


FRONTEND = CaexFrontend()
