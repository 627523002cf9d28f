"""Members of a namespace have different names (KerML 8.3.2.4)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

DUPLICATE = rule(
    "SM280",
    "same-name",
    Severity.WARNING,
    "'{owner}' has {count} members with the name '{name}'",
    why="A name leads to one member, so the others cannot be referred to (KerML 1.0, "
    "validateNamespaceDistinguishability).",
    help="give them different names, or leave one out",
    wrong="package Plant {\n    part gate;\n    action gate;\n}\n",
    right="package Plant {\n    part gate;\n    action openGate;\n}\n",
)


def check(model: Model, node: Node) -> Iterator[Found]:
    """Report members that another member has the name or the short name of."""
    named: dict[str, list[Node]] = {}
    for member in node.members:
        for name in {member.name, member.short} - {None}:
            named.setdefault(str(name), []).append(member)
    for name, members in named.items():
        for member in members if len(members) > 1 else ():
            count = {"owner": name_of(model, node), "count": str(len(members)), "name": name}
            yield Found(DUPLICATE, member.name_start, count)


CHECKS = ((kinds_of("Namespace"), check),)
