"""Trees of KerML and SysML v2 as lines, and the diagnostics about the texts they come from."""

from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.language.text import parse
from sysmlc.language.tree import Node


def outline(node: Node, depth: int = 0) -> list[str]:
    """Return a line for each element below *node*.

    A line has the membership, role, visibility, metaclass, names, attributes and relations.
    """
    lines = []
    for member in node.members:
        lines.append("  " * depth + format_element(member))
        lines.extend(outline(member, depth + 1))
    return lines


def format_element(node: Node) -> str:
    parts = [node.membership or "-", node.role and f"({node.role})", node.visibility, node.kind]
    parts += [node.short_name and f"<{node.short_name}>", node.name]
    parts += [f"{name}={value}" for name, value in sorted(node.attributes.items())]
    parts += [f"{relation.kind}->{relation.reference}" for relation in node.relations]
    return " ".join(part for part in parts if part)


def parse_outline(text: str, language: str = "sysml") -> list[str]:
    """Return the outline of a text that has no diagnostics."""
    lines, diagnostics = parse_with_diagnostics(text, language)
    assert diagnostics == []
    return lines


def parse_with_diagnostics(text: str, language: str = "sysml") -> tuple[list[str], list[str]]:
    """Return the outline of a text, and its diagnostics as ``line:column code message``."""
    sink = Sink()
    document = parse(text, "m.sysml", language, sink)
    return outline(document.root), [_format(text, diagnostic) for diagnostic in sink]


def list_diagnostics(text: str, language: str = "sysml") -> list[str]:
    """Return the diagnostics about a text as ``line:column code message``."""
    return parse_with_diagnostics(text, language)[1]


def list_advice(text: str, language: str = "sysml") -> list[str]:
    """Return the help of each diagnostic about a text."""
    sink = Sink()
    parse(text, "m.sysml", language, sink)
    return [diagnostic.help for diagnostic in sink]


def _format(text: str, diagnostic: Diagnostic) -> str:
    before = text.encode()[: diagnostic.subject.place.offset].decode()
    location = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
    return f"{location} {diagnostic.rule.code} {diagnostic.message}"


def list_node_values(root: Node) -> list[tuple[object, ...]]:
    """Return what each node of a tree states, in order; positions in the text do not count."""
    values, stack = [], [(root, 0)]
    while stack:
        node, depth = stack.pop()
        attributes = {name: _normalise(value) for name, value in node.attributes.items()}
        relations = [(relation.kind, relation.reference.chain) for relation in node.relations]
        names = (node.name, node.short_name)
        membership = (node.membership, node.role, node.visibility)
        values.append((depth, node.kind, *names, *membership, attributes, relations))
        stack.extend((member, depth + 1) for member in reversed(node.members))
    return values


def _normalise(value: object) -> object:
    # The formatter makes the line ends of a file equal, also those within a comment.
    return value.replace("\r\n", "\n") if isinstance(value, str) else value
