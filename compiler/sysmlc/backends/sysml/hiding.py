"""Members that would hide what their namespace inherits get a name of their own."""

from collections.abc import Iterator

from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.references import generals_of, is_same
from sysmlc.backends.sysml.relating import is_unlike
from sysmlc.backends.sysml.rules import RENAMED
from sysmlc.ir import Edge, Kind

_INHERITING = (
    *(Kind.CLASS, Kind.COMPONENT, Kind.INTERFACE, Kind.DATA_TYPE, Kind.STEREOTYPE, Kind.SIGNAL),
    *(Kind.PROPERTY, Kind.PORT, Kind.INSTANCE, Kind.ACTOR, Kind.ASSOCIATION),
)
_MEMBERS = frozenset({Kind.PROPERTY, Kind.PORT, Kind.CLASS, Kind.OPERATION, Kind.INSTANCE})


def name_apart(plan: Plan) -> None:
    """Number what has the name of an inherited member that it does not redefine.

    SysML v2 would take the one for the other (KerML 1.0, validateNamespaceDistinguishability).
    """
    for space in _spaces(plan):
        inherited: dict[str, Entry] = {}
        for one in _known(plan, space):
            inherited.setdefault(one.name, one)
        taken = {one.name for one in space.members} | inherited.keys() if inherited else set()
        for member in space.members:
            other = inherited.get(member.name)
            if member.name and other is not None and _hides(plan, member, other):
                _rename(plan, member, taken)


def _known(plan: Plan, space: Entry) -> Iterator[Entry]:
    """What a namespace has besides its own members; an association has the ends of classes too."""
    for general in generals_of(plan, space):
        yield from general.members
    element = space.element
    if element is not None and element.kind is Kind.ASSOCIATION:
        for end in plan.graph.targets(element, Edge.END):
            own = plan.entry(end)
            if own is not None and own.parent is not space:
                yield own


def _spaces(plan: Plan) -> Iterator[Entry]:
    stack = list(plan.tops)
    while stack:
        top = stack.pop()
        if top.element is not None and top.element.kind in _INHERITING and top.members:
            yield top
        stack.extend(top.members)


def _hides(plan: Plan, member: Entry, other: Entry) -> bool:
    element = member.element
    if element is None or element.kind not in _MEMBERS:
        return False
    redefined = plan.graph.targets(element, Edge.REDEFINES)
    is_apart = any(one is other.element and is_unlike(plan, element, one) for one in redefined)
    return is_apart or not is_same(plan, member, other)


def _rename(plan: Plan, member: Entry, taken: set[str]) -> None:
    number = 2
    while f"{member.name}_{number}" in taken:
        number += 1
    found = f"{member.name}_{number}"
    taken.add(found)
    if member.element is not None:
        plan.losses.note(RENAMED, member.element, name=member.name, written=found)
    member.name = found
