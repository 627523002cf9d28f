"""Search in the bytes of a file: is it AutomationML, and to which other files does it refer?

The unit decides with these answers which files are parsed at all.
"""

import re
from collections.abc import Iterator
from html import unescape

from sysmlc.diagnostics import Place
from sysmlc.sources import Source
from sysmlc.sources.encoding import codec

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


def score_source(source: Source) -> float:
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


def list_external_references(source: Source) -> list[str]:
    """Return the files that external references name, each once and in order.

    References in a package (``.amlx``) lead to other parts of it, which are read with it.
    """
    if "!" in source.name:
        return []
    mark, encoding = codec(source.data)
    text = source.data[mark:].decode(encoding, "replace")
    matches = (_PATH.search(tag) for tag in _EXTERNAL_REFERENCE.findall(text))
    return list(dict.fromkeys(unescape(match[1] or match[2]) for match in matches if match))


def has_hierarchy(source: Source) -> bool:
    """Whether the file has an instance hierarchy; in UTF-16 every other byte is zero."""
    return _HIERARCHY.search(source.data.replace(b"\0", b"")) is not None


def iter_external_documents(source: Source) -> Iterator[tuple[str, Place]]:
    """Yield the local files that references to external data name, with their locations."""
    if b"refURI" not in source.data:
        return
    mark, encoding = codec(source.data)
    text = source.data[mark:].decode(encoding, "replace")
    for match in _REF_URI.finditer(text):
        value = _VALUE.search(match[1])
        path = value[1].strip() if value else ""
        local = path.removeprefix("file://") if path.startswith("file:///") else path
        if _FILE.search(local) and not _SCHEME.match(local):
            before = text[: match.start()].encode(encoding, "replace")
            yield local.lstrip("/"), Place(source.name, offset=mark + len(before))
