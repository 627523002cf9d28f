"""Where each element stands in the text: decided before a line is written."""

from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.library import SHIPPED, scalar_of
from sysmlc.backends.sysml.merges import step_behind
from sysmlc.backends.sysml.moves import move_flows, move_messages
from sysmlc.backends.sysml.rules import Losses
from sysmlc.backends.sysml.shapes import HOLDERS, Shape, shape_of
from sysmlc.backends.sysml.specific import feature_of
from sysmlc.backends.sysml.used import used_outside
from sysmlc.ir import Edge, Element, Graph, Kind


def make_plan(graph: Graph, losses: Losses, dropped: frozenset[str]) -> Plan:
    """The plan of the text for a graph, without elements that cannot be written.

    Names are those of the model as yet.
    """
    plan = Plan(graph, losses, dropped=dropped)
    used = used_outside(graph)
    outside = Outside(plan)
    for root in graph.roots():
        if not root.attrs.get("external"):
            _place(plan, root, None, used)
    for root in graph.roots():
        if root.id in used and root.source.startswith(SHIPPED):
            _place_shipped(plan, root, used)
        elif root.id in used:
            outside.place(root, used)
    move_flows(plan)
    move_messages(plan)
    return plan


def _place_shipped(plan: Plan, root: Element, used: set[str]) -> None:
    """What a library of ours has is referred to by its name there, and not written."""
    number = len(plan.tops)
    _place(plan, root, None, used)
    plan.shipped.extend(plan.tops[number:])
    del plan.tops[number:]


class Outside:
    """Places what is outside of the model and used in it, in packages as it is qualified."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._packages: dict[str, Entry] = {}

    def place(self, root: Element, used: set[str]) -> None:
        """Place a root that nothing owns, below packages that its qualified name tells."""
        if scalar_of(root) or _is_measure(root):
            return
        path = str(root.attrs.get("qualified_name", "")).split("::")[:-1]
        if root.kind not in HOLDERS and not path:
            path = ["External"]
        _place(self._plan, root, self._package(path), used)

    def _package(self, path: list[str]) -> Entry | None:
        above: Entry | None = None
        for number, name in enumerate(path):
            key = "::".join(path[: number + 1])
            if key not in self._packages:
                self._packages[key] = self._plan.new(
                    Shape("package"), above, name or "External", None
                )
            above = self._packages[key]
        return above


# -- the tree ----------------------------------------------------------------------------------


def _place(plan: Plan, top: Element, above: Entry | None, used: set[str]) -> None:
    """Entries for an element and all below it; what is no member leaves its parts to its owner."""
    stack: list[tuple[Element, Entry | None]] = [(top, above)]
    while stack:
        element, parent = stack.pop()
        if element.attrs.get("external") and element.id not in used:
            continue
        if scalar_of(element) or _is_measure(element) or element.id in plan.dropped:
            continue
        entry = _entry(plan, element, parent)
        stack.extend((one, entry) for one in reversed(plan.graph.owned(element)))


def _is_measure(element: Element) -> bool:
    """Units and quantity kinds that passes and front ends add: value types say them."""
    return element.kind in (Kind.UNIT, Kind.QUANTITY_KIND) and bool(element.attrs.get("external"))


def _entry(plan: Plan, element: Element, parent: Entry | None) -> Entry | None:
    twin = _operation_of(plan, element) or _usage_of(plan, element)
    if twin is not None:
        plan.entries[element.id] = twin
        return twin
    if _is_only_region(plan.graph, element) or step_behind(plan.graph, element) is not None:
        return parent
    shape = shape_of(plan.graph, element, plan.typing)
    if shape is None:
        return parent
    name = "" if shape.keyword in _NAMELESS else element.name
    return plan.new(shape, parent, name, element)


_NAMELESS = frozenset({"start", "import"})
"""Keywords of members that have no name in the text."""


def _is_only_region(graph: Graph, element: Element) -> bool:
    if element.kind is not Kind.REGION:
        return False
    owner = graph.owner(element)
    beside = [] if owner is None else graph.owned(owner)
    return sum(one.kind is Kind.REGION for one in beside) == 1


def _usage_of(plan: Plan, element: Element) -> Entry | None:
    """The feature that a class is made for: its members are those of the usage."""
    if not element.attrs.get("property_specific"):
        return None
    found = plan.entry(feature_of(plan.graph, element))
    return found if found is not None and found.shape.is_usage else None


def _operation_of(plan: Plan, element: Element) -> Entry | None:
    """The operation that a behaviour implements under the same name: one action for both.

    A parameter of such a behaviour is that of the operation with its name.
    """
    if element.kind is Kind.PARAMETER:
        owner = plan.graph.owner(element)
        above = plan.entry(owner)
        is_twin = above is not None and above.element is not owner
        if is_twin and above is not None:
            beside = (one for one in above.members if one.name == element.name and element.name)
            return next(beside, None)
        return None
    if element.kind is not Kind.ACTIVITY:
        return None
    for operation in plan.graph.sources(element, Edge.METHOD):
        if operation.name == element.name and operation.owner == element.owner:
            return plan.entry(operation)
    return None
