"""Dependencies by their meaning: satisfaction, verification, derivation, allocation, or none.

Some dependencies are written inside their client. ``prewrite_dependencies`` writes their lines
before all other members, because the client must contain them when it is written itself.
"""

from collections.abc import Callable

from sysmlc.backends.sysml.declarations import is_referential_owner, list_visibility
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import (
    format_qualified_name,
    format_reference,
    is_path_accessible,
)
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Kind

_KEYWORDS_BY_ROLE = {
    "trace": "trace",
    "copy": "copies",
    "satisfy": "satisfies",
    "verify": "verifies",
    "derive": "derives",
    "allocate": "allocates",
    "conform": "conforms",
    "expose": "exposes",
}
"""Keywords of the library ``SysMLC`` for dependencies that SysML v2 cannot express otherwise."""
_KEYWORDS_BY_SUBKIND = {
    "realization": "realization",
    "component-realization": "realization",
    "substitution": "substitution",
    "usage": "usage",
    "abstraction": "abstraction",
    "manifestation": "manifestation",
    "deployment": "deployment",
    "role-binding": "roleBinding",
    "internal-link": "internalLink",
    "ppr": "processLink",
    "succession": "orderLink",
}
_SATISFYING = frozenset({"part def", "item def", "action def", "state def", "occurrence def"})
"""Keywords of definitions that may state which requirements they satisfy."""

_MAY_BE_INSIDE_CLIENT = frozenset({"satisfy", "not satisfy", "verify", "allocate"})
"""Roles of dependencies that may be written inside their client."""


def prewrite_dependencies(writer: Writer) -> None:
    """Write the dependencies whose lines may stand inside other elements."""
    for element in writer.graph.of_kind(Kind.DEPENDENCY):
        member = writer.plan.find(element)
        if member is None or writer.plan.is_author_member(member):
            continue
        if element.role in _MAY_BE_INSIDE_CLIENT:
            member.prewritten = _BY_ROLE[element.role](writer, member)


def write_dependency(writer: Writer, member: Member) -> list[Line]:
    """Write a dependency, or return its lines if they were written before."""
    if member.prewritten is not None:
        lines, member.prewritten = member.prewritten, None
        return lines
    return _BY_ROLE.get(member.require_element().role, _write_plain)(writer, member)


def _write_plain(writer: Writer, member: Member) -> list[Line]:
    """Write a dependency without a meaning of its own, with a keyword if there is one."""
    element = member.require_element()
    clients, suppliers = _find_ends(writer, member)
    if not clients or not suppliers:
        return writer.drop(member, "client or supplier")
    scope = member.parent
    keyword = _KEYWORDS_BY_ROLE.get(element.role) or _KEYWORDS_BY_SUBKIND.get(element.subkind)
    if element.role == "refine":
        prefix = f"#{writer.refer_to_library(scope, 'ModelingMetadata::refinement')} "
    else:
        prefix = f"#{writer.refer_to_sysmlc(scope, keyword)} " if keyword else ""
    words = " ".join([*list_visibility(writer, element), f"{prefix}dependency"])
    name = f"{quote_name(member.name)} " if member.name else ""
    sources, targets = (
        ", ".join(str(format_qualified_name(writer.plan, scope, end)) for end in ends)
        for ends in (clients, suppliers)
    )
    return [Line(f"{words} {name}from {sources} to {targets}", write_contents(writer, member))]


def _find_ends(writer: Writer, member: Member) -> tuple[list[Member], list[Member]]:
    """Return the clients and suppliers that have a name; record the others as lost."""
    clients = _find_targets(writer, member, Edge.CLIENT)
    return clients, _find_targets(writer, member, Edge.SUPPLIER)


def _find_targets(writer: Writer, member: Member, edge: Edge) -> list[Member]:
    element = member.require_element()
    targets = []
    for target in writer.graph.targets(element, edge):
        end = writer.plan.find(target)
        if end is None or format_reference(writer.plan, member.parent, end) is None:
            writer.record_unreachable(element, str(edge.value))
        else:
            targets.append(end)
    return targets


def _find_definition(usage: Member) -> Member | None:
    """Return the definition that contains a usage: its bare name is valid only there."""
    return next((space for space in usage.namespaces if space.shape.is_definition), None)


# -- satisfaction and verification ---------------------------------------------------------------


def _write_satisfaction(writer: Writer, member: Member) -> list[Line]:
    """Write ``satisfy`` inside a definition, or ``satisfy ... by`` for a usage.

    The role ``not satisfy`` is written in the same way, with these keywords.
    """
    keyword = member.require_element().role
    clients, suppliers = _find_ends(writer, member)
    are_requirements = all(end.shape.keyword == "requirement" for end in suppliers)
    if not are_requirements or len(clients) != 1 or not suppliers:
        return _write_plain(writer, member)
    client = clients[0]
    if client.shape.keyword in _SATISFYING:
        lines = _write_requirement_references(writer, member, client, suppliers, keyword, "")
        client.added_lines += lines
        _record_owner(writer, member, client)
        return []
    if client.shape.is_usage and client.shape.keyword != "requirement":
        definition = _find_definition(client)
        if definition is not None and definition.shape.keyword == "enum def":
            return _write_plain(writer, member)
        scope = member.parent if definition is None else definition
        end = f" by {format_reference(writer.plan, scope, client)}"
        lines = _write_requirement_references(writer, member, scope, suppliers, keyword, end)
        if definition is None:
            return lines
        definition.added_lines += lines
        _record_owner(writer, member, definition)
        return []
    return _write_plain(writer, member)


def _record_owner(writer: Writer, member: Member, owner: Member) -> None:
    """Record that a dependency stands in the definition that has its end, not in its namespace."""
    if owner is not member.parent:
        element = member.require_element()
        construct = f"the owner of a dependency ({element.role})"
        writer.record_approximation(element, construct, "the definition at its end")


def _write_verification(writer: Writer, member: Member) -> list[Line]:
    """Write ``verify`` in the objective of a verification case."""
    clients, suppliers = _find_ends(writer, member)
    is_case = len(clients) == 1 and clients[0].shape.usage_keyword == "verification"
    are_requirements = all(end.shape.keyword == "requirement" for end in suppliers)
    if not suppliers or not is_case or not are_requirements:
        return _write_plain(writer, member)
    case = clients[0]
    lines = _write_requirement_references(writer, member, case, suppliers, "verify", "")
    case.objective_lines += lines
    return []


def _write_requirement_references(
    writer: Writer,
    member: Member,
    scope: Member | None,
    requirements: list[Member],
    keyword: str,
    end: str,
) -> list[Line]:
    """Return a line for each requirement; the first line bears the name of the dependency."""
    if scope is not None and is_referential_owner(scope):
        keyword = f"ref {keyword}"
    name, lines = member.name, []
    for requirement in requirements:
        reference = str(format_reference(writer.plan, scope, requirement))
        if name:
            reference = f"requirement {quote_name(name)} references {reference}"
        lines.append(Line(f"{keyword} {reference}{end}"))
        name = ""
    lines[0].body += write_contents(writer, member)
    return lines


# -- derivation and allocation -------------------------------------------------------------------


def _write_derivation(writer: Writer, member: Member) -> list[Line]:
    """Write a derivation connection of the standard library."""
    clients, suppliers = _find_ends(writer, member)
    are_requirements = all(end.shape.keyword == "requirement" for end in (*clients, *suppliers))
    if len(suppliers) != 1 or not clients or not are_requirements:
        return _write_plain(writer, member)
    connection, original, derive = (
        writer.refer_to_library(member.parent, f"RequirementDerivation::{name}")
        for name in ("derivation", "original", "derive")
    )
    ends = [Line(f"end #{original} ::> {format_reference(writer.plan, member, suppliers[0])}")]
    for client in clients:
        ends.append(Line(f"end #{derive} ::> {format_reference(writer.plan, member, client)}"))
    name = f" {quote_name(member.name)}" if member.name else ""
    return [Line(f"#{connection} connection{name}", ends + write_contents(writer, member))]


def _write_allocation(writer: Writer, member: Member) -> list[Line]:
    """Write an allocation between two usages, or an allocation definition for two definitions.

    An end of an allocation, unlike that of a dependency, is a feature that is accessible.
    """
    clients, suppliers = _find_ends(writer, member)
    ends = [*clients, *suppliers]
    if not len(clients) == len(suppliers) == 1:
        return _write_plain(writer, member)
    if all(end.shape.is_usage for end in ends):
        scope = _find_allocation_scope(member, ends)
        if all(is_path_accessible(writer.plan, scope, end) for end in ends):
            return _write_usage_allocation(writer, member, ends, scope)
        return _write_plain(writer, member)
    if all(end.shape.is_definition for end in ends):
        names = [format_reference(writer.plan, member, end) for end in ends]
        roles = zip(("allocated", "allocatedTo"), names, strict=True)
        lines = [Line(f"end {role} : {name}") for role, name in roles]
        name = quote_name(member.name) if member.name else ""
        head = f"allocation def {name}".strip()
        return [Line(head, lines + write_contents(writer, member))]
    return _write_plain(writer, member)


def _find_allocation_scope(member: Member, ends: list[Member]) -> Member | None:
    """Return the namespace of an allocation: the definition that contains both features, if any."""
    definition = _find_definition(ends[0])
    is_shared = definition is not None and _find_definition(ends[1]) is definition
    return definition if is_shared else member.parent


def _write_usage_allocation(
    writer: Writer, member: Member, ends: list[Member], scope: Member | None
) -> list[Line]:
    """Write an allocation between two features, which *scope* may be the definition of."""
    name = quote_name(member.name) if member.name else ""
    head = f"allocation {name} allocate" if name else "allocate"
    if scope is not None and is_referential_owner(scope):
        head = f"ref {head}"
    names = [format_reference(writer.plan, scope, end) for end in ends]
    line = Line(f"{head} {names[0]} to {names[1]}", write_contents(writer, member))
    if scope is member.parent or scope is None:
        return [line]
    _record_owner(writer, member, scope)
    scope.added_lines.append(line)
    return []


_BY_ROLE: dict[str, Callable[[Writer, Member], list[Line]]] = {
    "satisfy": _write_satisfaction,
    "not satisfy": _write_satisfaction,
    "verify": _write_verification,
    "derive": _write_derivation,
    "allocate": _write_allocation,
}
