"""Names of members: those of the model, made distinct where SysML v2 requires it.

A member needs a name of its own among its siblings, the names of libraries and the members that its
namespace inherits (KerML 1.0, validateNamespaceDistinguishability).
"""

from collections import Counter
from collections.abc import Iterator

from sysmlc.backends.sysml.compatibility import is_incompatible
from sysmlc.backends.sysml.library import ROOTS
from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.printing import replace_control_characters
from sysmlc.backends.sysml.references import is_or_redefines, iter_generals
from sysmlc.backends.sysml.rules import RENAMED
from sysmlc.ir import Edge, Kind

_INHERITING = (
    *(Kind.CLASS, Kind.COMPONENT, Kind.INTERFACE, Kind.DATA_TYPE, Kind.STEREOTYPE, Kind.SIGNAL),
    *(Kind.PROPERTY, Kind.PORT, Kind.INSTANCE, Kind.ACTOR, Kind.ASSOCIATION),
)
_MEMBERS = frozenset(
    {Kind.PROPERTY, Kind.PORT, Kind.CLASS, Kind.OPERATION, Kind.INSTANCE, Kind.CONNECTOR}
)


# -- names among siblings ------------------------------------------------------------------------


def assign_names(plan: Plan) -> None:
    """Give every member that needs a name one of its own in its namespace."""
    library_packages = {member.name: member for member in plan.library_packages}
    taken = {*ROOTS, *library_packages}
    plan.root_names = _assign_sibling_names(plan, plan.roots, taken) | library_packages
    stack = list(plan.roots)
    while stack:
        namespace = stack.pop()
        _assign_sibling_names(plan, namespace.members, set(namespace.shape.reserved_names))
        stack.extend(namespace.members)


def _assign_sibling_names(plan: Plan, members: list[Member], taken: set[str]) -> dict[str, Member]:
    """Name the members of one namespace, return them by name, and add the names to *taken*."""
    by_name: dict[str, Member] = {}
    numbers: Counter[str] = Counter()
    taken |= {member.name for member in members if plan.is_author_member(member)}
    nameless = [member for member in members if member.shape.needs_name and not member.name]
    for member in members:
        if member.name:
            if not plan.is_author_member(member):
                name = replace_control_characters(member.name)
                member.name = _find_free_name(plan, member, name, taken, numbers)
            taken.add(member.name)
            by_name[member.name] = member
    for member in nameless:
        member.name = _invent_name(member, taken, numbers)
        taken.add(member.name)
        by_name[member.name] = member
    return by_name


def _find_free_name(
    plan: Plan, member: Member, name: str, taken: set[str], numbers: Counter[str]
) -> str:
    """Return the name if it is free; else it gets a capital letter or a number.

    A capital letter is tried for definitions only: ``Motor`` beside a usage called ``motor``.
    """
    if name not in taken:
        return name
    capitalized = name[:1].upper() + name[1:]
    if member.shape.is_definition and capitalized not in taken:
        free_name = capitalized
    else:
        numbers[f"{name}_"] = max(numbers[f"{name}_"], 1)
        free_name = _append_number(f"{name}_", taken, numbers)
    if member.element is not None:
        plan.losses.record(RENAMED, member.element, name=name, replacement=free_name)
    return free_name


def _append_number(base: str, taken: set[str], numbers: Counter[str]) -> str:
    """Return the base with the next free number; *numbers* has the last number of each base."""
    numbers[base] += 1
    while f"{base}{numbers[base]}" in taken:
        numbers[base] += 1
    return f"{base}{numbers[base]}"


def _invent_name(member: Member, taken: set[str], numbers: Counter[str]) -> str:
    """Return a name for a nameless member: its direction, subkind or keyword, with a number."""
    element = member.element
    is_return = element is not None and element.attrs.get("direction") == "return"
    if is_return and "result" not in taken:
        return "result"
    base = _join_camel_case(member.shape.usage_keyword.split())
    if element is not None and element.kind in (Kind.PARAMETER, Kind.PIN):
        base = str(element.attrs.get("direction", "in"))
        base = {"in": "input", "out": "output", "return": "result"}.get(base, base)
    if element is not None and element.subkind and element.kind in (Kind.ACTION, Kind.PSEUDOSTATE):
        base = _join_camel_case(element.subkind.split("-"))
    if member.shape.is_definition:
        base = base[:1].upper() + base[1:]
    return _append_number(base, taken, numbers)


def _join_camel_case(words: list[str]) -> str:
    return words[0] + "".join(word.capitalize() for word in words[1:])


# -- names that would hide an inherited member ---------------------------------------------------


def rename_hiding_members(plan: Plan) -> None:
    """Number members that have the name of an inherited member without redefining it."""
    for namespace in _iter_inheriting_namespaces(plan):
        inherited: dict[str, Member] = {}
        for member in _iter_inherited_members(plan, namespace):
            inherited.setdefault(member.name, member)
        if not inherited:
            continue
        taken = {member.name for member in namespace.members} | inherited.keys()
        for member in namespace.members:
            general_member = inherited.get(member.name)
            if not member.name or general_member is None or plan.is_author_member(member):
                continue
            if _hides(plan, member, general_member):
                _append_free_number(plan, member, taken)


def _iter_inheriting_namespaces(plan: Plan) -> Iterator[Member]:
    stack = list(plan.roots)
    while stack:
        namespace = stack.pop()
        element = namespace.element
        if element is not None and element.kind in _INHERITING and namespace.members:
            yield namespace
        stack.extend(namespace.members)


def _iter_inherited_members(plan: Plan, namespace: Member) -> Iterator[Member]:
    """Yield inherited members; for an association, also its ends that classes own."""
    for general in iter_generals(plan, namespace):
        yield from general.members
    element = namespace.element
    if element is not None and element.kind is Kind.ASSOCIATION:
        for end in plan.graph.targets(element, Edge.END):
            end_member = plan.find(end)
            if end_member is not None and end_member.parent is not namespace:
                yield end_member


def _hides(plan: Plan, member: Member, general_member: Member) -> bool:
    element = member.element
    if element is None or element.kind not in _MEMBERS:
        return False
    has_lost_redefinition = any(
        feature is general_member.element and is_incompatible(plan, element, feature)
        for feature in plan.graph.targets(element, Edge.REDEFINES)
    )
    return has_lost_redefinition or not is_or_redefines(plan, member, general_member)


def _append_free_number(plan: Plan, member: Member, taken: set[str]) -> None:
    number = 2
    while f"{member.name}_{number}" in taken:
        number += 1
    free_name = f"{member.name}_{number}"
    taken.add(free_name)
    if member.element is not None:
        plan.losses.record(RENAMED, member.element, name=member.name, replacement=free_name)
    member.name = free_name
