"""The plan of a text: which element becomes a member of which namespace.

Placement runs before any line is written. Elements outside of the model are placed only if the
model uses them.
"""

from collections.abc import Iterator

from sysmlc.backends.sysml.elided_elements import find_specific_feature, find_step_after_merge
from sysmlc.backends.sysml.library import SHIPPED, find_scalar_type
from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.profiles import is_standard
from sysmlc.backends.sysml.relocation import move_members
from sysmlc.backends.sysml.rules import APPROXIMATED, Losses
from sysmlc.backends.sysml.shapes import PACKAGES, Shape, find_shape
from sysmlc.ir import Edge, Element, Graph, Kind

_ENUMERATION_MEMBERS = frozenset({"enum", "comment", "metadata", "import"})
"""Keywords of members that an enumeration definition may have."""
_NAMELESS = frozenset({"start", "import"})
"""Keywords of members that have no name in the text."""
_USING_EDGES = (
    Edge.TYPED_BY,
    Edge.SPECIALIZES,
    Edge.REALIZES,
    Edge.REDEFINES,
    Edge.SUBSETS,
    Edge.INSTANCE_OF,
    Edge.CALLS,
    Edge.CLIENT,
    Edge.SUPPLIER,
    Edge.CONVEYS,
    Edge.ROLE,
    Edge.PATH,
    Edge.REPRESENTS,
    Edge.SUBJECT,
    Edge.INCLUDES,
    Edge.REFERENCES,
    Edge.FLOW_SOURCE,
    Edge.FLOW_TARGET,
)
_MEASURES = (Kind.UNIT, Kind.QUANTITY_KIND)
_WITHOUT_REFERENCES = (Kind.IMPORT, Kind.DATA_TYPE, Kind.APPLICATION, *_MEASURES)
"""Kinds whose edges ``references`` the text does not express by a name."""


def make_plan(graph: Graph, losses: Losses, dropped: frozenset[str]) -> Plan:
    """Return the plan for a graph, without the dropped elements. Members have their model names."""
    plan = Plan(graph, losses, losses.author_files, dropped=dropped)
    used = _find_used_outside(graph, losses.author_files)
    outside = _OutsidePlacement(plan)
    for root in graph.roots():
        if not root.attrs.get("external"):
            _place(plan, root, None, used)
    for root in graph.roots():
        if root.id in used and root.source.startswith(SHIPPED):
            _place_library(plan, root, used)
        elif root.id in used:
            outside.place(root, used)
    move_members(plan)
    return plan


# -- the tree of members -------------------------------------------------------------------------


def _place(plan: Plan, top: Element, namespace: Member | None, used: set[str]) -> None:
    """Add members for an element and all that it owns.

    The children of an element without a member become members of the namespace around it.
    """
    stack: list[tuple[Element, Member | None]] = [(top, namespace)]
    while stack:
        element, parent = stack.pop()
        if element.attrs.get("external") and element.id not in used:
            continue
        if find_scalar_type(element) or _is_outside_measure(element) or element.id in plan.dropped:
            continue
        member = _place_element(plan, element, parent)
        stack.extend((child, member) for child in reversed(plan.graph.owned(element)))


def _place_element(plan: Plan, element: Element, parent: Member | None) -> Member | None:
    """Return the member that stands for the element, else the namespace of its children."""
    twin = _find_operation(plan, element) or _find_specific_usage(plan, element)
    if twin is not None:
        plan.members_by_id[element.id] = twin
        return twin
    if _is_only_region(plan.graph, element):
        return parent
    if find_step_after_merge(plan.graph, element) is not None:
        return parent
    shape = find_shape(plan.graph, element, plan.type_shapes)
    if shape is None:
        return parent
    if _is_foreign_to_enumeration(parent, shape):
        owner = f"the owner of {shape.keyword} in an enumeration"
        plan.losses.record(APPROXIMATED, element, construct=owner, replacement="its namespace")
        parent = None if parent is None else parent.parent
    name = "" if shape.keyword in _NAMELESS else element.name
    return plan.add(shape, parent, name, element)


def _is_foreign_to_enumeration(parent: Member | None, shape: Shape) -> bool:
    """Whether a member cannot stand in an enumeration definition (SysML 2.0, 7.8)."""
    is_enumeration = parent is not None and parent.shape.keyword == "enum def"
    return is_enumeration and shape.keyword not in _ENUMERATION_MEMBERS


def _is_outside_measure(element: Element) -> bool:
    """Whether an element is a unit or quantity kind that front ends and passes add.

    Value types express them.
    """
    return element.kind in _MEASURES and bool(element.attrs.get("external"))


def _is_only_region(graph: Graph, element: Element) -> bool:
    if element.kind is not Kind.REGION:
        return False
    owner = graph.owner(element)
    siblings = [] if owner is None else graph.owned(owner)
    return sum(sibling.kind is Kind.REGION for sibling in siblings) == 1


def _find_specific_usage(plan: Plan, element: Element) -> Member | None:
    """Return the usage to which the members of a property-specific class belong, or None."""
    if not element.attrs.get("property_specific"):
        return None
    usage = plan.find(find_specific_feature(plan.graph, element))
    return usage if usage is not None and usage.shape.is_usage else None


def _find_operation(plan: Plan, element: Element) -> Member | None:
    """Return the operation that a method of the same name implements: one action for both.

    For a parameter of such a method, return the parameter of the operation with the same name.
    """
    if element.kind is Kind.PARAMETER:
        owner = plan.graph.owner(element)
        action = plan.find(owner)
        if action is None or action.element is owner:
            return None
        namesakes = (m for m in action.members if m.name == element.name and element.name)
        return next(namesakes, None)
    if element.kind is not Kind.ACTIVITY:
        return None
    for operation in plan.graph.sources(element, Edge.METHOD):
        if operation.name == element.name and operation.owner == element.owner:
            return plan.find(operation)
    return None


# -- elements outside of the model ---------------------------------------------------------------


def _find_used_outside(graph: Graph, author_files: frozenset[str]) -> set[str]:
    """Return the ids of outside elements that the model uses, directly or through others.

    What the authors' texts use is known to their readers.
    """
    used: set[str] = set()
    worklist = [
        element
        for element in graph
        if not element.attrs.get("external") and element.source not in author_files
    ]
    while worklist:
        for target in _iter_used(graph, worklist.pop()):
            if target.attrs.get("external") and target.id not in used:
                used.add(target.id)
                worklist.append(target)
    return used


def _iter_used(graph: Graph, element: Element) -> Iterator[Element]:
    if element.attrs.get("external"):
        owner = graph.owner(element)
        if owner is not None:
            yield owner
    if element.kind is Kind.APPLICATION and is_standard(element):
        return
    if _belongs_to_measure(graph, element):
        return
    methods = graph.targets(element, Edge.METHOD)
    yield from (method for method in methods if method.source.startswith(SHIPPED))
    for edge in _USING_EDGES:
        if edge is Edge.REFERENCES and element.kind in _WITHOUT_REFERENCES:
            continue
        for target in graph.targets(element, edge):
            if target.kind not in _MEASURES:
                yield target


def _belongs_to_measure(graph: Graph, element: Element) -> bool:
    """Whether an element is a unit, or its slot: both refer to the library of units of SysML."""
    for candidate in (element, graph.owner(element)):
        if candidate is not None and candidate.role in ("unit", "quantity kind"):
            return True
    return False


def _place_library(plan: Plan, root: Element, used: set[str]) -> None:
    """Place a package of a library of sysmlc: the text refers to it and does not contain it."""
    count = len(plan.roots)
    _place(plan, root, None, used)
    plan.library_packages.extend(plan.roots[count:])
    del plan.roots[count:]


class _OutsidePlacement:
    """Places outside elements in packages named by their qualified names."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._packages: dict[str, Member] = {}

    def place(self, root: Element, used: set[str]) -> None:
        """Place an element without an owner; ``External`` holds it if it has no package."""
        if find_scalar_type(root) or _is_outside_measure(root):
            return
        path = str(root.attrs.get("qualified_name", "")).split("::")[:-1]
        if root.kind not in PACKAGES and not path:
            path = ["External"]
        _place(self._plan, root, self._require_package(path), used)

    def _require_package(self, path: list[str]) -> Member | None:
        package: Member | None = None
        for index, name in enumerate(path):
            key = "::".join(path[: index + 1])
            if key not in self._packages:
                shape = Shape("package")
                self._packages[key] = self._plan.add(shape, package, name or "External", None)
            package = self._packages[key]
        return package
