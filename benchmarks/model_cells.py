"""Content of a generated UML/SysML model: the elements of one cell, and those that cells share.

A cell is a production line of six machines. Each machine is a block with values, ports, a state
machine and an activity. A line has connectors with nested ends, item flows and requirements. The
compiler derives token graphs from the activities and reports no errors.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from random import Random

PRIMITIVES = "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#"

_MACHINES = ("Feeder", "Gripper", "Press", "Oven", "Printer", "Sorter")
_VERBS = ("clamp", "heat", "lift", "turn", "weigh", "measure", "release", "clean", "align")
_EVENTS = ("Start", "Done", "Fault", "Reset")
_VALUES = (("temperature", "Integer"), ("count", "Integer"), ("speed", "Real"), ("busy", "Boolean"))
_RANGES = {
    "temperature": "temperature >= 0 and temperature <= 120",
    "count": "count >= 0 and count <= 15",
}
_DEFAULTS = {"Integer": ("LiteralInteger", "3"), "Real": ("LiteralReal", "1.5")}


@dataclass(frozen=True, slots=True)
class Node:
    """One element of the model. A key that begins with ``@`` names an element that all cells share.

    ``refs`` map features to keys of nodes. ``texts`` are children that contain only text, ``hrefs``
    are references into other files. ``<n>`` in a name or value stands for the number of the cell.
    """

    feature: str
    metaclass: str
    key: str
    name: str = ""
    attrs: tuple[tuple[str, str], ...] = ()
    refs: tuple[tuple[str, tuple[str, ...]], ...] = ()
    texts: tuple[tuple[str, str], ...] = ()
    hrefs: tuple[tuple[str, str, str], ...] = ()
    children: tuple["Node", ...] = ()


@dataclass(frozen=True, slots=True)
class Application:
    """One stereotype application; ``bases`` are its properties that refer to the element."""

    stereotype: str
    key: str
    bases: tuple[str, ...]
    base: str
    tags: tuple[tuple[str, str], ...] = ()
    refs: tuple[tuple[str, tuple[str, ...]], ...] = ()


@dataclass(frozen=True, slots=True)
class Part:
    """Elements of the model's tree, and the stereotype applications on them."""

    nodes: tuple[Node, ...]
    applications: tuple[Application, ...]


def iter_subtree(node: Node) -> Iterator[Node]:
    """Yield the node and its descendants."""
    yield node
    for child in node.children:
        yield from iter_subtree(child)


# -- shared elements ---------------------------------------------------------------------------


def build_shared_part() -> Part:
    """Return the item that flows, the interface blocks of the ports, signals and events."""
    pallet = Node("packagedElement", "Class", "@Pallet", "Pallet")
    nodes = [pallet, *(_build_interface(name) for name in ("Material", "Order", "Status"))]
    signals = [Node("packagedElement", "Signal", f"@{name}", name) for name in _EVENTS]
    events = [
        Node("packagedElement", "SignalEvent", f"@on{e}", f"on{e}", refs=(("signal", (f"@{e}",)),))
        for e in _EVENTS
    ]
    applications = [_apply_block("@Pallet")]
    for name in ("Material", "Order", "Status"):
        applications.append(
            _apply_stereotype("PortsAndFlows:InterfaceBlock", f"@{name}", "base_Class")
        )
        flow = _apply_stereotype("PortsAndFlows:FlowProperty", f"@{name}.flow", "base_Property")
        direction = "inout" if name == "Status" else "out"
        applications.append(replace(flow, tags=(("direction", direction),)))
    return Part((*nodes, *signals, *events), tuple(applications))


def _build_interface(name: str) -> Node:
    flow = Node(
        "ownedAttribute", "Property", f"@{name}.flow", "item", refs=(("type", ("@Pallet",)),)
    )
    return Node("packagedElement", "Class", f"@{name}", name, children=(flow,))


# -- a cell ------------------------------------------------------------------------------------


def build_cell(random: Random) -> Part:
    """Return a line with its machines, flows and requirements; words and numbers are random."""
    machines = [_build_machine(kind, random) for kind in _MACHINES]
    flows = [_build_item_flow(number) for number in range(len(_MACHINES) - 1)]
    requirements = [_build_requirement(number) for number in range(4)]
    satisfactions = [_build_satisfaction(number) for number in range(4)]
    content = (*machines, _build_line(), *flows, *requirements, *satisfactions)
    package = Node("packagedElement", "Package", "cell", "Cell <n>", children=content)
    return Part((package,), tuple(_iter_applications()))


def _iter_applications() -> Iterator[Application]:
    for kind in (*_MACHINES, "Line"):
        yield _apply_block(kind)
    for kind in _MACHINES:
        for port in _PORTS:
            yield _apply_stereotype("PortsAndFlows:ProxyPort", f"{kind}.{port}", "base_Port")
    for number in range(len(_MACHINES) - 1):
        for side, part in (("from", number), ("to", number + 1)):
            end = _apply_stereotype(
                "Blocks:NestedConnectorEnd", f"connector{number}.{side}", "base_ConnectorEnd"
            )
            yield replace(end, refs=(("propertyPath", (f"part{part}",)),))
        yield _apply_stereotype("PortsAndFlows:ItemFlow", f"flow{number}", "base_InformationFlow")
    for number in range(4):
        tags = (
            ("id", f"R-<n>-{number}"),
            ("text", f"Line <n> keeps limit {number} in every shift."),
        )
        requirement = _apply_stereotype("Requirements:Requirement", f"requirement{number}", "")
        yield replace(requirement, bases=("base_NamedElement", "base_Class"), tags=tags)
        bases = ("base_Abstraction", "base_DirectedRelationship")
        yield replace(
            _apply_stereotype("Requirements:Satisfy", f"satisfy{number}", ""), bases=bases
        )


def _apply_stereotype(stereotype: str, base: str, feature: str) -> Application:
    return Application(stereotype, f"{base}|{stereotype}", (feature,), base)


def _apply_block(key: str) -> Application:
    return _apply_stereotype("Blocks:Block", key, "base_Class")


_PORTS = {"infeed": "Material", "outfeed": "Material", "order": "Order", "status": "Status"}


def _build_machine(kind: str, random: Random) -> Node:
    body = f"{kind} of line <n>: it can {random.choice(_VERBS)} one pallet at a time."
    comment = Node(
        "ownedComment",
        "Comment",
        f"{kind}.comment",
        refs=(("annotatedElement", (kind,)),),
        texts=(("body", body),),
    )
    children = (
        comment,
        *(_build_value(kind, name, type_) for name, type_ in _VALUES),
        *(_build_condition(f"{kind}.{name}.range", text) for name, text in _RANGES.items()),
        *(_build_port(kind, name, type_) for name, type_ in _PORTS.items()),
        _build_state_machine(kind, random),
        _build_activity(kind, random),
    )
    refs = (("classifierBehavior", (f"{kind}.states",)),)
    return Node("packagedElement", "Class", kind, f"{kind}<n>", refs=refs, children=children)


def _build_value(kind: str, name: str, type_: str) -> Node:
    metaclass, value = _DEFAULTS.get(type_, ("LiteralBoolean", ""))
    attrs = (("value", value),) if value else ()
    default = Node("defaultValue", metaclass, f"{kind}.{name}.default", attrs=attrs)
    hrefs = (("type", "PrimitiveType", PRIMITIVES + type_),)
    return Node(
        "ownedAttribute", "Property", f"{kind}.{name}", name, hrefs=hrefs, children=(default,)
    )


def _build_port(kind: str, name: str, type_: str) -> Node:
    attrs = [("aggregation", "composite")]
    if name in ("infeed", "order"):
        attrs.append(("isConjugated", "true"))
    refs = (("type", (f"@{type_}",)),)
    return Node("ownedAttribute", "Port", f"{kind}.{name}", name, tuple(attrs), refs)


# -- behaviour of a machine --------------------------------------------------------------------

_STATES = ("Idle", "Loading", "Working", "Unloading", "Stopped")
_TRANSITIONS = (
    ("initial", "Idle", "", ""),
    ("Idle", "Loading", "Start", "not busy"),
    ("Loading", "Working", "Done", "temperature < <limit>"),
    ("Working", "Unloading", "Done", "count > <few>"),
    ("Unloading", "Idle", "Done", ""),
    ("Working", "Stopped", "Fault", "temperature >= <limit>"),
    ("Stopped", "Idle", "Reset", ""),
)


def _build_state_machine(kind: str, random: Random) -> Node:
    key = f"{kind}.states"
    numbers = {"<limit>": str(random.randint(60, 99)), "<few>": str(random.randint(2, 9))}
    vertices = [
        Node("subvertex", "Pseudostate", f"{key}.initial", "initial"),
        *(Node("subvertex", "State", f"{key}.{name}", name) for name in _STATES),
    ]
    transitions = [
        _build_transition(key, number, row, numbers) for number, row in enumerate(_TRANSITIONS)
    ]
    region = Node("region", "Region", f"{key}.region", "main", children=(*transitions, *vertices))
    return Node("ownedBehavior", "StateMachine", key, f"{kind}States", children=(region,))


def _build_transition(
    behaviour: str, number: int, row: tuple[str, str, str, str], numbers: dict[str, str]
) -> Node:
    source, target, event, guard = row
    key = f"{behaviour}.{number}"
    refs = [("source", (f"{behaviour}.{source}",)), ("target", (f"{behaviour}.{target}",))]
    children = []
    if guard:
        for word, value in numbers.items():
            guard = guard.replace(word, value)
        refs.append(("guard", (f"{key}.guard",)))
        children.append(_build_condition(f"{key}.guard", guard))
    if event:
        trigger = (("event", (f"@on{event}",)),)
        children.append(Node("trigger", "Trigger", f"{key}.trigger", event.lower(), refs=trigger))
    return Node(
        "transition", "Transition", key, f"to{target}", refs=tuple(refs), children=tuple(children)
    )


def _build_condition(key: str, body: str) -> Node:
    texts = (("language", "OCL"), ("body", body))
    expression = Node("specification", "OpaqueExpression", f"{key}.text", texts=texts)
    return Node("ownedRule", "Constraint", key, "guard", children=(expression,))


_NODES = {
    "start": "InitialNode",
    "check": "DecisionNode",
    "meet": "MergeNode",
    "split": "ForkNode",
    "wait": "JoinNode",
    "end": "ActivityFinalNode",
}
_FLOWS = (
    ("start", "act1", ""),
    ("act1", "check", ""),
    ("check", "act2", "count > <few>"),
    ("check", "act3", "else"),
    ("act2", "meet", ""),
    ("act3", "meet", ""),
    ("meet", "split", ""),
    ("split", "act4", ""),
    ("split", "act5", ""),
    ("act4", "wait", ""),
    ("act5", "wait", ""),
    ("wait", "act6", ""),
    ("act6", "end", ""),
)
_UPPER_LANE = ("start", "act1", "check", "act2", "act3", "meet")


def _build_activity(kind: str, random: Random) -> Node:
    behaviour = f"{kind}.work"
    few = str(random.randint(2, 9))
    verbs = random.sample(_VERBS, 6)
    names = {f"act{number}": verb for number, verb in enumerate(verbs, 1)}
    edges = [_build_control_flow(behaviour, number, row, few) for number, row in enumerate(_FLOWS)]
    edges.append(_build_object_flow(behaviour))
    nodes = [
        _build_node(behaviour, key, name)
        for key, name in ({key: key for key in _NODES} | names).items()
    ]
    lanes = [
        _build_lane(behaviour, "upper", _UPPER_LANE),
        _build_lane(behaviour, "lower", _list_lower_lane()),
    ]
    children = (*edges, *lanes, *nodes)
    return Node("ownedBehavior", "Activity", behaviour, f"{kind}Work", children=children)


def _build_control_flow(behaviour: str, number: int, row: tuple[str, str, str], few: str) -> Node:
    source, target, guard = row
    refs = (("source", (f"{behaviour}.{source}",)), ("target", (f"{behaviour}.{target}",)))
    key = f"{behaviour}.edge{number}"
    texts = (("language", "OCL"), ("body", guard.replace("<few>", few)))
    expression = Node("guard", "OpaqueExpression", f"{key}.guard", texts=texts)
    return Node("edge", "ControlFlow", key, refs=refs, children=(expression,) if guard else ())


def _build_object_flow(behaviour: str) -> Node:
    refs = (("source", (f"{behaviour}.act1.out",)), ("target", (f"{behaviour}.act6.in",)))
    return Node("edge", "ObjectFlow", f"{behaviour}.object", refs=refs)


def _build_node(behaviour: str, key: str, name: str) -> Node:
    lane = "upper" if key in _UPPER_LANE else "lower"
    ends = {
        feature: tuple(
            f"{behaviour}.edge{number}" for number, row in enumerate(_FLOWS) if row[side] == key
        )
        for side, feature in ((1, "incoming"), (0, "outgoing"))
    }
    refs = [(feature, keys) for feature, keys in ends.items() if keys]
    refs.append(("inPartition", (f"{behaviour}.{lane}",)))
    metaclass = _NODES.get(key, "OpaqueAction")
    return Node(
        "node",
        metaclass,
        f"{behaviour}.{key}",
        name,
        (),
        tuple(refs),
        children=_build_pins(behaviour, key),
    )


def _build_pins(behaviour: str, action: str) -> tuple[Node, ...]:
    flow = (f"{behaviour}.object",)
    type_ = ("type", ("@Pallet",))
    pins = []
    if action == "act6":
        refs = (("incoming", flow), type_)
        pins.append(Node("inputValue", "InputPin", f"{behaviour}.act6.in", "pallet", refs=refs))
    elif action == "act1":
        refs = (("outgoing", flow), type_)
        pins.append(Node("outputValue", "OutputPin", f"{behaviour}.act1.out", "pallet", refs=refs))
    return tuple(pins)


def _list_lower_lane() -> tuple[str, ...]:
    actions = [f"act{number}" for number in range(1, 7)]
    return tuple(key for key in (*_NODES, *actions) if key not in _UPPER_LANE)


def _build_lane(behaviour: str, name: str, keys: tuple[str, ...]) -> Node:
    refs = (("node", tuple(f"{behaviour}.{key}" for key in keys)),)
    return Node("group", "ActivityPartition", f"{behaviour}.{name}", name, refs=refs)


# -- the line ----------------------------------------------------------------------------------


def _build_line() -> Node:
    attrs = (("aggregation", "composite"),)
    parts = [
        Node("ownedAttribute", "Property", f"part{n}", kind.lower(), attrs, (("type", (kind,)),))
        for n, kind in enumerate(_MACHINES)
    ]
    connectors = [_build_connector(number) for number in range(len(_MACHINES) - 1)]
    return Node("packagedElement", "Class", "Line", "Line<n>", children=(*parts, *connectors))


def _build_connector(number: int) -> Node:
    sides = (("from", number, "outfeed"), ("to", number + 1, "infeed"))
    ends = [
        Node(
            "end",
            "ConnectorEnd",
            f"connector{number}.{side}",
            refs=(("partWithPort", (f"part{part}",)), ("role", (f"{_MACHINES[part]}.{port}",))),
        )
        for side, part, port in sides
    ]
    key = f"connector{number}"
    return Node("ownedConnector", "Connector", key, f"belt{number}", children=tuple(ends))


def _build_item_flow(number: int) -> Node:
    refs = (
        ("conveyed", ("@Pallet",)),
        ("informationSource", (f"{_MACHINES[number]}.outfeed",)),
        ("informationTarget", (f"{_MACHINES[number + 1]}.infeed",)),
        ("realizingConnector", (f"connector{number}",)),
    )
    return Node(
        "packagedElement", "InformationFlow", f"flow{number}", f"pallets{number}", refs=refs
    )


def _build_requirement(number: int) -> Node:
    return Node("packagedElement", "Class", f"requirement{number}", f"Limit<n>.{number}")


def _build_satisfaction(number: int) -> Node:
    refs = (("client", (_MACHINES[number],)), ("supplier", (f"requirement{number}",)))
    return Node("packagedElement", "Abstraction", f"satisfy{number}", refs=refs)
