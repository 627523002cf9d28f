"""What a generated model says: one cell of a plant, and what all cells share.

A cell is a production line of six machines: blocks with values, ports, a state machine and an
activity each; connectors with nested ends, item flows and requirements. The model is sane: the
compiler makes token graphs of its activities and has next to nothing to object to.
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
    """One element. ``refs`` lead to keys of nodes; a key with ``@`` is the same in all cells.

    ``<n>`` in a name or value stands for the number of the cell, ``texts`` are children that
    hold only text, ``hrefs`` references into other files.
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
    """One stereotype application; ``bases`` are the base properties that lead to the element."""

    stereotype: str
    key: str
    bases: tuple[str, ...]
    base: str
    tags: tuple[tuple[str, str], ...] = ()
    refs: tuple[tuple[str, tuple[str, ...]], ...] = ()


@dataclass(frozen=True, slots=True)
class Part:
    """Elements for the model's tree, and the stereotype applications that follow it."""

    nodes: tuple[Node, ...]
    applications: tuple[Application, ...]


def walk(node: Node) -> Iterator[Node]:
    """The node and all below it."""
    yield node
    for child in node.children:
        yield from walk(child)


# -- what all cells share ----------------------------------------------------------------------


def shared() -> Part:
    """Value types, the item that flows, interface blocks of the ports, and events."""
    pallet = Node("packagedElement", "Class", "@Pallet", "Pallet")
    nodes = [pallet, *(_interface(name) for name in ("Material", "Order", "Status"))]
    signals = [Node("packagedElement", "Signal", f"@{name}", name) for name in _EVENTS]
    events = [
        Node("packagedElement", "SignalEvent", f"@on{e}", f"on{e}", refs=(("signal", (f"@{e}",)),))
        for e in _EVENTS
    ]
    applications = [_block("@Pallet")]
    for name in ("Material", "Order", "Status"):
        applications.append(_apply("PortsAndFlows:InterfaceBlock", f"@{name}", "base_Class"))
        flow = _apply("PortsAndFlows:FlowProperty", f"@{name}.flow", "base_Property")
        direction = "inout" if name == "Status" else "out"
        applications.append(replace(flow, tags=(("direction", direction),)))
    return Part((*nodes, *signals, *events), tuple(applications))


def _interface(name: str) -> Node:
    flow = Node(
        "ownedAttribute", "Property", f"@{name}.flow", "item", refs=(("type", ("@Pallet",)),)
    )
    return Node("packagedElement", "Class", f"@{name}", name, children=(flow,))


# -- a cell ------------------------------------------------------------------------------------


def cell(chance: Random) -> Part:
    """One line with its machines, flows and requirements; ``chance`` chooses words and numbers."""
    machines = [_machine(kind, chance) for kind in _MACHINES]
    flows = [_flow(number) for number in range(len(_MACHINES) - 1)]
    requirements = [_requirement(number) for number in range(4)]
    satisfactions = [_satisfaction(number) for number in range(4)]
    content = (*machines, _line(), *flows, *requirements, *satisfactions)
    package = Node("packagedElement", "Package", "cell", "Cell <n>", children=content)
    return Part((package,), tuple(_applications()))


def _applications() -> Iterator[Application]:
    for kind in (*_MACHINES, "Line"):
        yield _block(kind)
    for kind in _MACHINES:
        for port in _PORTS:
            yield _apply("PortsAndFlows:ProxyPort", f"{kind}.{port}", "base_Port")
    for number in range(len(_MACHINES) - 1):
        for side, part in (("from", number), ("to", number + 1)):
            end = _apply(
                "Blocks:NestedConnectorEnd", f"connector{number}.{side}", "base_ConnectorEnd"
            )
            yield replace(end, refs=(("propertyPath", (f"part{part}",)),))
        yield _apply("PortsAndFlows:ItemFlow", f"flow{number}", "base_InformationFlow")
    for number in range(4):
        tags = (
            ("id", f"R-<n>-{number}"),
            ("text", f"Line <n> keeps limit {number} in every shift."),
        )
        made = _apply("Requirements:Requirement", f"requirement{number}", "base_NamedElement")
        yield replace(made, bases=("base_NamedElement", "base_Class"), tags=tags)
        bases = ("base_Abstraction", "base_DirectedRelationship")
        yield replace(_apply("Requirements:Satisfy", f"satisfy{number}", ""), bases=bases)


def _apply(stereotype: str, base: str, feature: str) -> Application:
    return Application(stereotype, f"{base}|{stereotype}", (feature,), base)


def _block(key: str) -> Application:
    return _apply("Blocks:Block", key, "base_Class")


_PORTS = {"infeed": "Material", "outfeed": "Material", "order": "Order", "status": "Status"}


def _machine(kind: str, chance: Random) -> Node:
    body = f"{kind} of line <n>: it can {chance.choice(_VERBS)} one pallet at a time."
    comment = Node(
        "ownedComment",
        "Comment",
        f"{kind}.comment",
        refs=(("annotatedElement", (kind,)),),
        texts=(("body", body),),
    )
    children = (
        comment,
        *(_value(kind, name, type_) for name, type_ in _VALUES),
        *(_condition(f"{kind}.{name}.range", text) for name, text in _RANGES.items()),
        *(_port(kind, name, type_) for name, type_ in _PORTS.items()),
        _machine_states(kind, chance),
        _activity(kind, chance),
    )
    refs = (("classifierBehavior", (f"{kind}.states",)),)
    return Node("packagedElement", "Class", kind, f"{kind}<n>", refs=refs, children=children)


def _value(kind: str, name: str, type_: str) -> Node:
    metaclass, value = _DEFAULTS.get(type_, ("LiteralBoolean", ""))
    attrs = (("value", value),) if value else ()
    default = Node("defaultValue", metaclass, f"{kind}.{name}.default", attrs=attrs)
    hrefs = (("type", "PrimitiveType", PRIMITIVES + type_),)
    return Node(
        "ownedAttribute", "Property", f"{kind}.{name}", name, hrefs=hrefs, children=(default,)
    )


def _port(kind: str, name: str, type_: str) -> Node:
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


def _machine_states(kind: str, chance: Random) -> Node:
    at = f"{kind}.states"
    numbers = {"<limit>": str(chance.randint(60, 99)), "<few>": str(chance.randint(2, 9))}
    vertices = [
        Node("subvertex", "Pseudostate", f"{at}.initial", "initial"),
        *(Node("subvertex", "State", f"{at}.{name}", name) for name in _STATES),
    ]
    transitions = [_transition(at, number, row, numbers) for number, row in enumerate(_TRANSITIONS)]
    region = Node("region", "Region", f"{at}.region", "main", children=(*transitions, *vertices))
    return Node("ownedBehavior", "StateMachine", at, f"{kind}States", children=(region,))


def _transition(
    at: str, number: int, row: tuple[str, str, str, str], numbers: dict[str, str]
) -> Node:
    source, target, event, guard = row
    key = f"{at}.{number}"
    refs = [("source", (f"{at}.{source}",)), ("target", (f"{at}.{target}",))]
    children = []
    if guard:
        for word, value in numbers.items():
            guard = guard.replace(word, value)
        refs.append(("guard", (f"{key}.guard",)))
        children.append(_condition(f"{key}.guard", guard))
    if event:
        trigger = (("event", (f"@on{event}",)),)
        children.append(Node("trigger", "Trigger", f"{key}.trigger", event.lower(), refs=trigger))
    return Node(
        "transition", "Transition", key, f"to{target}", refs=tuple(refs), children=tuple(children)
    )


def _condition(key: str, body: str) -> Node:
    texts = (("language", "OCL"), ("body", body))
    said = Node("specification", "OpaqueExpression", f"{key}.text", texts=texts)
    return Node("ownedRule", "Constraint", key, "guard", children=(said,))


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


def _activity(kind: str, chance: Random) -> Node:
    at = f"{kind}.work"
    few = str(chance.randint(2, 9))
    verbs = chance.sample(_VERBS, 6)
    names = {f"act{number}": verb for number, verb in enumerate(verbs, 1)}
    edges = [_edge(at, number, row, few) for number, row in enumerate(_FLOWS)]
    edges.append(_object_flow(at))
    nodes = [_node(at, key, name) for key, name in ({key: key for key in _NODES} | names).items()]
    lanes = [_lane(at, "upper", _UPPER_LANE), _lane(at, "lower", _lower_lane())]
    children = (*edges, *lanes, *nodes)
    return Node("ownedBehavior", "Activity", at, f"{kind}Work", children=children)


def _edge(at: str, number: int, row: tuple[str, str, str], few: str) -> Node:
    source, target, guard = row
    refs = (("source", (f"{at}.{source}",)), ("target", (f"{at}.{target}",)))
    key = f"{at}.edge{number}"
    texts = (("language", "OCL"), ("body", guard.replace("<few>", few)))
    said = Node("guard", "OpaqueExpression", f"{key}.guard", texts=texts)
    return Node("edge", "ControlFlow", key, refs=refs, children=(said,) if guard else ())


def _object_flow(at: str) -> Node:
    refs = (("source", (f"{at}.act1.out",)), ("target", (f"{at}.act6.in",)))
    return Node("edge", "ObjectFlow", f"{at}.object", refs=refs)


def _node(at: str, key: str, name: str) -> Node:
    lane = "upper" if key in _UPPER_LANE else "lower"
    ends = {
        feature: tuple(
            f"{at}.edge{number}" for number, row in enumerate(_FLOWS) if row[side] == key
        )
        for side, feature in ((1, "incoming"), (0, "outgoing"))
    }
    refs = [(feature, keys) for feature, keys in ends.items() if keys]
    refs.append(("inPartition", (f"{at}.{lane}",)))
    metaclass = _NODES.get(key, "OpaqueAction")
    return Node("node", metaclass, f"{at}.{key}", name, (), tuple(refs), children=_pins(at, key))


def _pins(at: str, action: str) -> tuple[Node, ...]:
    flow = (f"{at}.object",)
    type_ = ("type", ("@Pallet",))
    made = []
    if action == "act6":
        refs = (("incoming", flow), type_)
        made.append(Node("inputValue", "InputPin", f"{at}.act6.in", "pallet", refs=refs))
    elif action == "act1":
        refs = (("outgoing", flow), type_)
        made.append(Node("outputValue", "OutputPin", f"{at}.act1.out", "pallet", refs=refs))
    return tuple(made)


def _lower_lane() -> tuple[str, ...]:
    actions = [f"act{number}" for number in range(1, 7)]
    return tuple(key for key in (*_NODES, *actions) if key not in _UPPER_LANE)


def _lane(at: str, name: str, keys: tuple[str, ...]) -> Node:
    refs = (("node", tuple(f"{at}.{key}" for key in keys)),)
    return Node("group", "ActivityPartition", f"{at}.{name}", name, refs=refs)


# -- the line ----------------------------------------------------------------------------------


def _line() -> Node:
    attrs = (("aggregation", "composite"),)
    parts = [
        Node("ownedAttribute", "Property", f"part{n}", kind.lower(), attrs, (("type", (kind,)),))
        for n, kind in enumerate(_MACHINES)
    ]
    connectors = [_connector(number) for number in range(len(_MACHINES) - 1)]
    return Node("packagedElement", "Class", "Line", "Line<n>", children=(*parts, *connectors))


def _connector(number: int) -> Node:
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


def _flow(number: int) -> Node:
    refs = (
        ("conveyed", ("@Pallet",)),
        ("informationSource", (f"{_MACHINES[number]}.outfeed",)),
        ("informationTarget", (f"{_MACHINES[number + 1]}.infeed",)),
        ("realizingConnector", (f"connector{number}",)),
    )
    return Node(
        "packagedElement", "InformationFlow", f"flow{number}", f"pallets{number}", refs=refs
    )


def _requirement(number: int) -> Node:
    return Node("packagedElement", "Class", f"requirement{number}", f"Limit<n>.{number}")


def _satisfaction(number: int) -> Node:
    refs = (("client", (_MACHINES[number],)), ("supplier", (f"requirement{number}",)))
    return Node("packagedElement", "Abstraction", f"satisfy{number}", refs=refs)
