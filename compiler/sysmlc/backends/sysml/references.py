"""How the text refers to an element: the shortest name that finds it from where it is used.

Names are looked up as KerML 1.0, 8.2.3.5 says: from the namespace outwards, own and inherited
members first, then the packages of the unit.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.library import IMPORTED, IMPORTS
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind

_GENERAL = (
    Edge.REDEFINES,
    Edge.TYPED_BY,
    Edge.SPECIALIZES,
    Edge.SUBSETS,
    Edge.INSTANCE_OF,
    Edge.CALLS,
)
"""Edges along which members are inherited in the text."""


def lookup(plan: Plan, scope: Entry | None, name: str) -> Entry | None:
    """What a name means in a namespace (None: outside of all packages)."""
    for space in _outwards(scope):
        found = visible(plan, space).get(name)
        if found is not None or name in space.shape.inherited:
            return found
    if scope is not None and name in IMPORTED:
        return None
    return plan.globals.get(name)


def visible(plan: Plan, space: Entry) -> dict[str, Entry]:
    """Own and inherited members of a namespace, by name.

    Two inherited members of one name hide one another (KerML 1.0, 8.3.2.4).
    """
    if space.visible is None:
        space.visible = {one.name: one for one in space.members if one.name}
        inherited: dict[str, Entry | None] = {}
        for general in _direct(plan, space):
            for name, one in visible(plan, general).items():
                known = inherited.setdefault(name, one)
                if known is not None and known is not one and not is_same(plan, known, one):
                    inherited[name] = one if is_same(plan, one, known) else None
        for name, found in inherited.items():
            if found is not None:
                space.visible.setdefault(name, found)
    return space.visible


def meant(plan: Plan, space: Entry, name: str) -> Entry | None:
    """What a text of the model means by a name in a namespace: features before behaviours."""
    if space.meant is None:
        found: dict[str, Entry] = {}
        for one in (space, *_generals(plan, space)):
            for member in sorted(one.members, key=_is_behaviour):
                if member.element is not None and member.element.name:
                    found.setdefault(member.element.name, member)
        # What a model in SysML v2 says has the names of its text, which metadata takes back.
        for one in (space, *_generals(plan, space)):
            for member in one.members:
                if member.element is not None and member.name:
                    found.setdefault(member.name, member)
        space.meant = found
    return space.meant.get(name)


def _is_behaviour(entry: Entry) -> bool:
    return entry.shape.keyword in (
        "action",
        "state",
        "occurrence",
        "connection",
        "flow",
        "constraint",
    )


def _generals(plan: Plan, space: Entry) -> Iterator[Entry]:
    seen = {id(space)}
    level = [space]
    while level:
        above = [one for entry in level for one in _direct(plan, entry)]
        level = []
        for one in above:
            if id(one) not in seen:
                seen.add(id(one))
                level.append(one)
                yield one


def _direct(plan: Plan, space: Entry) -> Iterator[Entry]:
    element = space.element
    if element is None:
        return
    edges: tuple[Edge, ...] = _GENERAL
    if element.kind is Kind.ACTION and element.subkind not in ("call-behavior", "call-operation"):
        edges = _GENERAL[:-1]
    if space.shape.keyword == "part" and element.subkind == "part":
        edges = (Edge.REPRESENTS, *_GENERAL)
    for edge in edges:
        for target in plan.graph.targets(element, edge):
            found = plan.entry(target)
            if found is space and target is not element:
                yield from _direct_of(plan, target)
            elif found is not None:
                yield found


def _direct_of(plan: Plan, own: Element) -> Iterator[Entry]:
    """What the class of a feature's own members specialises."""
    for target in plan.graph.targets(own, Edge.SPECIALIZES):
        found = plan.entry(target)
        if found is not None:
            yield found


def _outwards(scope: Entry | None) -> Iterator[Entry]:
    while scope is not None:
        yield scope
        scope = scope.parent


def path_to(plan: Plan, scope: Entry | None, target: Entry) -> list[Entry] | None:
    """The entries to name, outermost first; None when one of them has no name.

    The list starts with what lexical lookup finds; when nothing is found so it is the whole
    path, which is then written from the root (``$::``).
    """
    path = [target, *target.above]
    for number, one in enumerate(path):
        if not one.name:
            return None
        if is_same(plan, lookup(plan, scope, one.name), one):
            return _shown(plan, scope, path[number::-1])
    return _shown(plan, scope, path[::-1])


def _shown(plan: Plan, scope: Entry | None, path: list[Entry]) -> list[Entry]:
    """The path; what it reaches from outside of its owner, or inherits, cannot be private."""
    head = path[0]
    if head.parent is not None and all(head.parent is not one for one in _outwards(scope)):
        plan.show(head)
    for one in path[1:]:
        plan.show(one)
    return path


def is_same(plan: Plan, found: Entry | None, wanted: Entry) -> bool:
    """Whether a name leads to an entry, or to one that redefines it where it is used."""
    seen = set()
    while found is not None and found is not wanted and id(found) not in seen:
        seen.add(id(found))
        element = found.element
        edge = Edge.REPRESENTS if element is not None and element.subkind == "part" else None
        edge = edge if edge and element and plan.graph.target(element, edge) else Edge.REDEFINES
        found = None if element is None else plan.entry(plan.graph.target(element, edge))
    return found is wanted


def reference(plan: Plan, scope: Entry | None, target: Entry) -> str | None:
    """The text that names the target from a namespace, or None when nothing names it."""
    found = path_to(plan, scope, target)
    if found is None:
        return None
    is_found = is_same(plan, lookup(plan, scope, found[0].name), found[0])
    return ("" if is_found else "$::") + _joined(found)


def qualified(plan: Plan, scope: Entry | None, target: Entry) -> str | None:
    """The same as a qualified name, where no feature chain may stand."""
    found = path_to(plan, scope, target)
    if found is None:
        return None
    is_found = is_same(plan, lookup(plan, scope, found[0].name), found[0])
    return ("" if is_found else "$::") + "::".join(quoted(one.name) for one in found)


def _joined(path: Sequence[Entry]) -> str:
    text = quoted(path[0].name)
    for before, one in pairwise(path):
        dot = "." if before.shape.is_usage and one.shape.is_usage else "::"
        text += f"{dot}{quoted(one.name)}"
    return text


def named(plan: Plan, scope: Entry | None, element: Element | None) -> str | None:
    """The text that names an element, or None."""
    entry = plan.entry(element)
    return None if entry is None else reference(plan, scope, entry)


def chain(plan: Plan, scope: Entry | None, steps: Iterable[Element]) -> str | None:
    """A feature chain through features of several classifiers (``gate.sensor.out``)."""
    entries = [plan.entry(one) for one in steps]
    known = [one for one in entries if one is not None and one.name]
    if not known or len(known) != len(entries):
        return None
    for before, one in pairwise(known):
        if not is_same(plan, visible(plan, before).get(one.name), one):
            return None
        plan.show(one)
    first = reference(plan, scope, known[0])
    return None if first is None else ".".join([first, *(quoted(one.name) for one in known[1:])])


def is_around(plan: Plan, scope: Entry | None, feature: Entry) -> bool:
    """Whether a feature is one of what is around a namespace, so that it may be used there."""
    above = feature.parent
    if above is None or not (above.shape.is_definition or above.shape.is_usage):
        return True
    for one in _outwards(scope):
        if one is above or any(general is above for general in _generals(plan, one)):
            return True
    return False


def generals_of(plan: Plan, space: Entry) -> Iterator[Entry]:
    """Namespaces whose members a namespace inherits, the nearest first."""
    return _generals(plan, space)


def library_name(plan: Plan, scope: Entry | None, name: str) -> str:
    """A name of the standard library or of ours, which packages import when they use it.

    It is short when the model does not hide it, and from the root when the model hides even the
    name of the package.
    """
    package, _, short = name.partition("::")
    if scope is not None and short in IMPORTS.get(package, ()):
        top = [scope, *scope.above][-1]
        if top.shape.keyword == "package" and lookup(plan, scope, short) is None:
            plan.imports.setdefault(id(top), set()).add(package)
            return quoted(short)
    head, *rest = name.split("::")
    hidden = "" if lookup(plan, scope, head) is None else "$::"
    return hidden + "::".join(quoted(one) for one in (head, *rest))


def redefined_name(plan: Plan, scope: Entry | None, target: Entry) -> str | None:
    """The name of a feature that a member of a namespace redefines: it is inherited there."""
    if scope is not None and target.name:
        for general in _generals(plan, scope):
            if any(one is target for one in general.members):
                plan.show(target)
                return quoted(target.name)
    return reference(plan, None if scope is None else scope.parent, target)
