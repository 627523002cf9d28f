"""Small interchange files of KerML and SysML v2, and the trees that are read from them."""

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import read
from sysmlc.language.tree import Document
from sysmlc.sources import Source

_HEAD = (
    '<sysml:Namespace xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:sysml="https://www.omg.org/spec/SysML/20250201" xmi:id="root">'
)


def write_file(content: str) -> str:
    """Return an interchange file whose root namespace has *content*."""
    return f"{_HEAD}{content}</sysml:Namespace>"


def write_member(
    kind: str,
    attributes: str = "",
    content: str = "",
    membership: str = "OwningMembership",
    membership_attributes: str = "",
) -> str:
    """Return an element within the membership that owns it."""
    return (
        f'<ownedRelationship xsi:type="sysml:{membership}" {membership_attributes}>'
        f'<ownedRelatedElement xsi:type="sysml:{kind}" {attributes}>{content}'
        "</ownedRelatedElement></ownedRelationship>"
    )


def write_relationship(kind: str, attributes: str, content: str = "") -> str:
    """Return a relationship that an element owns."""
    start = f'<ownedRelationship xsi:type="sysml:{kind}" {attributes}>'
    return f"{start}{content}</ownedRelationship>"


def read_content(content: str) -> tuple[Document, list[str]]:
    """Read a file whose root namespace has *content*; return its document and the messages."""
    return read_text(write_file(content))


def read_text(text: str) -> tuple[Document, list[str]]:
    """Return the document of an interchange file, and the messages about it."""
    sink = Sink()
    document = read(Source("m.sysmlx", text.encode()), sink)
    return document, list_messages(sink)


def list_messages(sink: Sink) -> list[str]:
    """Return the diagnostics as ``code message``."""
    return [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in sink]
