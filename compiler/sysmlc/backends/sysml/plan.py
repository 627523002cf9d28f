"""Where each element stands in the text, and its name there: decided before a line is written."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.sysml.library import ROOTS, scalar_of
from sysmlc.backends.sysml.rules import APPROXIMATED, RENAMED, Losses
from sysmlc.backends.sysml.shapes import HOLDERS, Shape, shape_of
from sysmlc.backends.sysml.used import used_outside
from sysmlc.backends.sysml.words import writable
from sysmlc.ir import Edge, Element, Graph, Kind


@dataclass(slots=True, eq=False)
class Entry:
    """One member of a namespace of the text; what the text adds itself has no element."""

    shape: Shape
    parent: "Entry | None"
    element: Element | None = None
    name: str = ""
    members: list["Entry"] = field(default_factory=list)
    visible: "dict[str, Entry] | None" = None
    """Names of own and inherited members, once someone has asked."""
    meant: "dict[str, Entry] | None" = None
    """The same by the names that the model gives them."""

    @property
    def above(self) -> "Iterator[Entry]":
        """The namespaces around it, nearest first."""
        found = self.parent
        while found is not None:
            yield found
            found = found.parent


@dataclass(slots=True)
class Plan:
    """All entries: the tree, and by the ids of their elements."""

    graph: Graph
    losses: Losses
    tops: list[Entry] = field(default_factory=list)
    entries: dict[str, Entry] = field(default_factory=dict)
    globals: dict[str, Entry] = field(default_factory=dict)
    added: dict[int, str] = field(default_factory=dict)
    """Type and multiplicity of attributes that no element stands for, by identity."""
    imports: dict[int, set[str]] = field(default_factory=dict)
    """Packages of libraries that a package of the text imports, by its identity."""
    dropped: frozenset[str] = frozenset()
    """Ids of elements that cannot be written."""
    shown: set[str] = field(default_factory=set)
    """Ids of elements that are not public in the model and that the text refers to."""
    applied: dict[str, Entry] = field(default_factory=dict)
    """Metadata definition of each application of a stereotype, by its id."""

    @property
    def depth(self) -> int:
        """How deep members are nested in one another."""
        level, found = self.tops, 0
        while level:
            level, found = [one for above in level for one in above.members], found + 1
        return found

    def entry(self, element: Element | None) -> Entry | None:
        """The entry that an element has, or that stands for it."""
        return None if element is None else self.entries.get(element.id)

    def show(self, entry: Entry) -> None:
        """Something refers to the member from outside of its namespace, so that it is public."""
        if entry.element is not None and "visibility" in entry.element.attrs:
            self.shown.add(entry.element.id)

    def new(self, shape: Shape, parent: Entry | None, name: str, element: Element | None) -> Entry:
        """A new entry at the end of its namespace."""
        made = Entry(shape, parent, element, name)
        (self.tops if parent is None else parent.members).append(made)
        if element is not None:
            self.entries[element.id] = made
        return made


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
        if root.id in used:
            outside.place(root, used)
    _move_flows(plan)
    _move_messages(plan)
    return plan


def _move_flows(plan: Plan) -> None:
    """Item flows stand beside the connectors that realise them, where the ends can be named."""
    for flow in plan.graph.of_kind(Kind.ITEM_FLOW):
        entry = plan.entry(flow)
        realizing = [plan.entry(one) for one in plan.graph.targets(flow, Edge.REALIZING)]
        homes = [one.parent for one in realizing if one is not None]
        if entry is None or not homes or homes[0] is None or homes[0] is entry.parent:
            continue
        if all(one is homes[0] for one in homes):
            (plan.tops if entry.parent is None else entry.parent.members).remove(entry)
            entry.parent = homes[0]
            homes[0].members.append(entry)
            facts = {"said": "the owner of an item flow", "written": "that of its connector"}
            plan.losses.note(APPROXIMATED, flow, **facts)


def _move_messages(plan: Plan) -> None:
    """Messages stand in the operand in which they are sent."""
    for message in plan.graph.of_kind(Kind.MESSAGE):
        entry = plan.entry(message)
        event = plan.graph.target(message, Edge.SEND_EVENT)
        if event is None or event.kind is not Kind.OCCURRENCE:
            event = plan.graph.target(message, Edge.RECEIVE_EVENT)
        home = None if event is None else plan.entry(plan.graph.owner(event))
        if entry is None or entry.parent is None or home is None or home is entry.parent:
            continue
        entry.parent.members.remove(entry)
        entry.parent = home
        home.members.append(entry)


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
    twin = _operation_of(plan, element)
    if twin is not None:
        plan.entries[element.id] = twin
        return twin
    if _is_only_region(plan.graph, element):
        return parent
    shape = shape_of(plan.graph, element)
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


# -- names -------------------------------------------------------------------------------------

_TAKEN_IN_BEHAVIOURS = frozenset({"start", "done", "self", "this", "that"})


def name_all(plan: Plan) -> None:
    """Give every member a name of its own in its namespace, if it needs one."""
    taken = dict.fromkeys(ROOTS)
    plan.globals = _name(plan, plan.tops, set(taken))
    stack = list(plan.tops)
    while stack:
        top = stack.pop()
        is_behaviour = top.shape.plain in ("action", "state", "verification", "occurrence")
        _name(plan, top.members, set(_TAKEN_IN_BEHAVIOURS if is_behaviour else ()))
        stack.extend(top.members)


def _name(plan: Plan, members: list[Entry], taken: set[str]) -> dict[str, Entry]:
    """Give each member a name of its own; definitions that are second start with a capital."""
    named: dict[str, Entry] = {}
    numbers: Counter[str] = Counter()
    wanting = [one for one in members if one.shape.is_named and not one.name]
    for one in members:
        if one.name:
            one.name = _free(plan, one, writable(one.name), taken, numbers)
            taken.add(one.name)
            named[one.name] = one
    for one in wanting:
        one.name = _made(one, taken, numbers)
        taken.add(one.name)
        named[one.name] = one
    return named


def _free(plan: Plan, entry: Entry, name: str, taken: set[str], numbers: Counter[str]) -> str:
    if name not in taken:
        return name
    capital = name[:1].upper() + name[1:]
    if entry.shape.is_definition and capital not in taken:
        found = capital
    else:
        numbers[f"{name}_"] = max(numbers[f"{name}_"], 1)
        found = _numbered(f"{name}_", taken, numbers)
    if entry.element is not None:
        plan.losses.note(RENAMED, entry.element, name=name, written=found)
    return found


def _numbered(base: str, taken: set[str], numbers: Counter[str]) -> str:
    """The first name of its kind that is not taken; ``numbers`` are those given last."""
    numbers[base] += 1
    while f"{base}{numbers[base]}" in taken:
        numbers[base] += 1
    return f"{base}{numbers[base]}"


def _made(entry: Entry, taken: set[str], numbers: Counter[str]) -> str:
    """A name for what has none: of what it is typed by, else of what it is."""
    element = entry.element
    is_return = element is not None and element.attrs.get("direction") == "return"
    if is_return and "result" not in taken:
        return "result"
    words = entry.shape.plain.split()
    base = words[0] + "".join(word.capitalize() for word in words[1:])
    if element is not None and element.kind in (Kind.PARAMETER, Kind.PIN):
        base = str(element.attrs.get("direction", "in"))
        base = {"in": "input", "out": "output", "return": "result"}.get(base, base)
    if element is not None and element.subkind and element.kind in (Kind.ACTION, Kind.PSEUDOSTATE):
        first, *rest = element.subkind.split("-")
        base = first + "".join(word.capitalize() for word in rest)
    if entry.shape.is_definition:
        base = base[:1].upper() + base[1:]
    return _numbered(base, taken, numbers)
