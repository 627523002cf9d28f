"""Trees of KerML and SysML v2 as lines, and small interchange files to make them from."""

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import read
from sysmlc.language.tree import Node
from sysmlc.sources import Source

_HEAD = (
    '<sysml:Namespace xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:sysml="https://www.omg.org/spec/SysML/20250201" xmi:id="root">'
)


def interchange(content):
    """An interchange file with this content of its root namespace."""
    return f"{_HEAD}{content}</sysml:Namespace>"


def owning(kind, attributes="", content="", membership="OwningMembership", said=""):
    """An element and the membership that owns it, as interchange files write them."""
    return (
        f'<ownedRelationship xsi:type="sysml:{membership}" {said}>'
        f'<ownedRelatedElement xsi:type="sysml:{kind}" {attributes}>{content}'
        "</ownedRelatedElement></ownedRelationship>"
    )


def relating(kind, attributes, content=""):
    """A relationship that an element owns."""
    start = f'<ownedRelationship xsi:type="sysml:{kind}" {attributes}>'
    return f"{start}{content}</ownedRelationship>"


def reading(content, path="m.sysmlx"):
    """The document of a root namespace with this content, and the messages about it."""
    return reading_file(interchange(content), path)


def reading_file(text, path="m.sysmlx"):
    sink = Sink()
    document = read(Source(path, text.encode()), sink)
    return document, [f"{found.rule.code} {found.message}" for found in sink]


def outline(node: Node, depth: int = 0) -> list[str]:
    """One line for each element below: membership, role, metaclass, names, facts, relations."""
    lines = []
    for member in node.members:
        lines.append("  " * depth + line(member))
        lines.extend(outline(member, depth + 1))
    return lines


def line(node: Node) -> str:
    parts = [node.membership or "-", node.role and f"({node.role})", node.visibility, node.kind]
    parts += [node.short_name and f"<{node.short_name}>", node.name]
    parts += [f"{name}={value}" for name, value in sorted(node.attributes.items())]
    parts += [f"{one.kind}->{one.reference}" for one in node.relations]
    return " ".join(part for part in parts if part)
