"""References: the shortest text that names an element from where it is used.

Name lookup follows KerML 1.0, 8.2.3.5: from the namespace outwards, own members before inherited
ones, then the global scope of roots and libraries. The namespace around a use is called *scope*;
None is the global scope.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from sysmlc.backends.sysml.library import IMPORTED, IMPORTS
from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.printing import quote_name
from sysmlc.ir import Edge, Element, Kind

_GENERALIZATIONS = (
    Edge.REDEFINES,
    Edge.TYPED_BY,
    Edge.SPECIALIZES,
    Edge.SUBSETS,
    Edge.INSTANCE_OF,
    Edge.CALLS,
)
"""Edges along which the text inherits members."""


# -- name lookup ---------------------------------------------------------------------------------


def look_up(plan: Plan, scope: Member | None, name: str) -> Member | None:
    """Return the member that a name denotes in *scope*; None if the plan has no such member."""
    for namespace in _iter_scopes(scope):
        member = visible_members(plan, namespace).get(name)
        if member is not None or name in namespace.shape.library_names:
            return member
    if scope is not None and name in IMPORTED:
        return None
    return plan.root_names.get(name)


def visible_members(plan: Plan, namespace: Member) -> dict[str, Member]:
    """Return own and inherited members by name. The dictionary is shared between all calls.

    Inherited members of the same name hide one another (KerML 1.0, 8.3.2.4), unless one of them
    redefines the other. What an own member redefines is not inherited.
    """
    if namespace.visible_names is None:
        own_members = {member.name: member for member in namespace.members if member.name}
        # In a cycle of generalisations, the namespace is asked again before it is complete.
        namespace.visible_names = own_members
        redefined = {
            plan.find(feature)
            for member in namespace.members
            if member.element is not None
            for feature in plan.graph.targets(member.element, Edge.REDEFINES)
        }
        inherited: dict[str, Member | None] = {}
        for general in _iter_direct_generals(plan, namespace):
            for name, member in visible_members(plan, general).items():
                if member in redefined:
                    continue
                rival = inherited.setdefault(name, member)
                if rival is None or rival is member or is_or_redefines(plan, rival, member):
                    continue
                inherited[name] = member if is_or_redefines(plan, member, rival) else None
        for name, inherited_member in inherited.items():
            if inherited_member is not None:
                namespace.visible_names.setdefault(name, inherited_member)
    return namespace.visible_names


def _iter_scopes(scope: Member | None) -> Iterator[Member]:
    if scope is not None:
        yield scope
        yield from scope.namespaces


# -- inheritance ---------------------------------------------------------------------------------


def iter_generals(plan: Plan, namespace: Member) -> Iterator[Member]:
    """Yield the namespaces from which a namespace inherits members, the nearest first."""
    seen = {namespace}
    level = [namespace]
    while level:
        generals = [g for member in level for g in _iter_direct_generals(plan, member)]
        level = []
        for general in generals:
            if general not in seen:
                seen.add(general)
                level.append(general)
                yield general


def _iter_direct_generals(plan: Plan, namespace: Member) -> Iterator[Member]:
    element = namespace.element
    if element is None:
        return
    edges: tuple[Edge, ...] = _GENERALIZATIONS
    if element.kind is Kind.ACTION and element.subkind not in ("call-behavior", "call-operation"):
        edges = tuple(edge for edge in edges if edge is not Edge.CALLS)
    if namespace.shape.keyword == "part" and element.subkind == "part":
        edges = (Edge.REPRESENTS, *_GENERALIZATIONS)
    for edge in edges:
        for target in plan.graph.targets(element, edge):
            general = plan.find(target)
            if general is namespace and target is not element:
                # The target is the property-specific class of the feature: skip to its generals.
                yield from _iter_class_generals(plan, target)
            elif general is not None and _inherits_from(namespace, edge, general):
                yield general


def _inherits_from(namespace: Member, edge: Edge, general: Member) -> bool:
    """Whether the target of an edge is a general in the text.

    A feature inside a port has types that are no port definitions; dependencies express
    specialisations that SysML v2 does not allow.
    """
    if edge is Edge.SPECIALIZES and not namespace.shape.may_specialize(general.shape):
        return False
    is_port_type = edge is Edge.TYPED_BY and namespace.shape.keyword == "port"
    return not is_port_type or general.shape.usage_keyword == "port"


def _iter_class_generals(plan: Plan, class_: Element) -> Iterator[Member]:
    for target in plan.graph.targets(class_, Edge.SPECIALIZES):
        general = plan.find(target)
        if general is not None:
            yield general


def is_or_redefines(plan: Plan, member: Member | None, wanted: Member) -> bool:
    """Whether *member* is the wanted one, or redefines it over any number of steps.

    The part of an instance counts as a redefinition of the part that it represents.
    """
    seen = set()
    while member is not None and member is not wanted and member not in seen:
        seen.add(member)
        element = member.element
        if element is None:
            return False
        redefined = None
        if element.subkind == "part":
            redefined = plan.graph.target(element, Edge.REPRESENTS)
        member = plan.find(redefined or plan.graph.target(element, Edge.REDEFINES))
    return member is wanted


def is_accessible(plan: Plan, scope: Member | None, feature: Member) -> bool:
    """Whether a feature belongs to a namespace around *scope*, so that its bare name is allowed.

    All other features need a feature chain.
    """
    owner = feature.parent
    if owner is None or not (owner.shape.is_definition or owner.shape.is_usage):
        return True
    for namespace in _iter_scopes(scope):
        if namespace is owner:
            return True
        if any(general is owner for general in iter_generals(plan, namespace)):
            return True
    return False


def is_path_accessible(plan: Plan, scope: Member | None, feature: Member) -> bool:
    """Whether a feature chain from *scope* leads to a feature through the usages around it."""
    usage: Member | None = feature
    while usage is not None and usage.shape.is_usage:
        if is_accessible(plan, scope, usage):
            return True
        usage = usage.parent
    return False


# -- text of references --------------------------------------------------------------------------


def format_element_reference(
    plan: Plan, scope: Member | None, element: Element | None
) -> str | None:
    """Return the text that names an element; None if it has no member or no name."""
    member = plan.find(element)
    return None if member is None else format_reference(plan, scope, member)


def format_reference(plan: Plan, scope: Member | None, target: Member) -> str | None:
    """Return the text that names a member, as a feature chain where it leads through usages."""
    path = _find_path(plan, scope, target)
    return None if path is None else _format_root(plan, scope, path) + _join_path(path)


def format_qualified_name(plan: Plan, scope: Member | None, target: Member) -> str | None:
    """Return the qualified name of a member, for places where no feature chain may stand."""
    path = _find_path(plan, scope, target)
    if path is None:
        return None
    return _format_root(plan, scope, path) + "::".join(quote_name(m.name) for m in path)


def _find_path(plan: Plan, scope: Member | None, target: Member) -> list[Member] | None:
    """Return the members whose names form the reference, outermost first; None if one has no name.

    The path starts with the innermost member that name lookup finds. If it finds none, the path
    is complete, and the reference starts at the root (``$::``).
    """
    path = [target, *target.namespaces]
    for index, member in enumerate(path):
        if not member.name:
            return None
        if is_or_redefines(plan, look_up(plan, scope, member.name), member):
            return _expose_path(plan, scope, path[index::-1])
    return _expose_path(plan, scope, path[::-1])


def _expose_path(plan: Plan, scope: Member | None, path: list[Member]) -> list[Member]:
    """Return the path after marking the members on it that must be public."""
    head = path[0]
    if head.parent is not None and all(head.parent is not space for space in _iter_scopes(scope)):
        plan.expose(head)
    for member in path[1:]:
        plan.expose(member)
    return path


def _format_root(plan: Plan, scope: Member | None, path: Sequence[Member]) -> str:
    head = path[0]
    is_visible = is_or_redefines(plan, look_up(plan, scope, head.name), head)
    return "" if is_visible else "$::"


def _join_path(path: Sequence[Member]) -> str:
    text = quote_name(path[0].name)
    for namespace, member in pairwise(path):
        separator = "." if namespace.shape.is_usage and member.shape.is_usage else "::"
        text += f"{separator}{quote_name(member.name)}"
    return text


def format_chain(plan: Plan, scope: Member | None, steps: Iterable[Element]) -> str | None:
    """Return a feature chain through features of several classifiers (``gate.sensor.out``).

    None if a step has no name, or another name inside the step before.
    """
    members = [plan.find(step) for step in steps]
    named = [member for member in members if member is not None and member.name]
    if not named or len(named) != len(members):
        return None
    for namespace, member in pairwise(named):
        if not is_or_redefines(plan, visible_members(plan, namespace).get(member.name), member):
            return None
        plan.expose(member)
    first = format_reference(plan, scope, named[0])
    if first is None:
        return None
    return ".".join([first, *(quote_name(member.name) for member in named[1:])])


def format_library_name(plan: Plan, scope: Member | None, name: str) -> str:
    """Return the text that names an element of a library.

    The package of the text imports the library, so that the bare name suffices. If the model hides
    that name, the text is the qualified name, from the root if the model hides the library, too.
    The text of an author has the imports of its author.
    """
    package, _, short = name.partition("::")
    if scope is not None and short in IMPORTS.get(package, ()):
        top = [scope, *scope.namespaces][-1]
        can_import = top.shape.keyword == "package" and not plan.is_author_member(top)
        if can_import and look_up(plan, scope, short) is None:
            if package not in top.imports:
                top.imports.append(package)
            return quote_name(short)
    head, *rest = name.split("::")
    root = "" if look_up(plan, scope, head) is None else "$::"
    return root + "::".join(quote_name(segment) for segment in (head, *rest))


def format_redefined_name(plan: Plan, scope: Member | None, target: Member) -> str | None:
    """Return the name of a feature that a member of *scope* redefines: short if inherited.

    If *scope* inherits another member of the same name, the short name may denote that one.
    """
    if scope is not None and target.name:
        generals = _iter_direct_generals(plan, scope)
        namesakes = [visible_members(plan, general).get(target.name) for general in generals]
        if target in namesakes and all(member in (None, target) for member in namesakes):
            plan.expose(target)
            return quote_name(target.name)
    return format_reference(plan, None if scope is None else scope.parent, target)
