"""Topics of structure that connect: ports, connectors, flows, constraint blocks, collaborations."""

from dialects.papyrus import Element
from legal.draft import Draft


def add_ports(draft: Draft) -> None:
    """Add two parts with ports of each kind, and a connector between each pair of ports."""
    whole = draft.add_block("Whole")
    sides = [draft.add_block(word) for word in ("Source", "Sink")]
    parts = [draft.add_part(whole, side) for side in sides]
    for part, side in zip(parts, sides, strict=True):
        draft.add_association(whole, part, side)
    for make in (_add_proxy_ports, _add_full_ports, _add_flow_ports, _add_service_ports):
        if draft.maybe(0.7):
            ports = make(draft, sides)
            connector = _connect(draft, whole, list(zip(parts, ports, strict=True)))
            if make is not _add_service_ports and draft.maybe():
                _add_item_flow(draft, connector, ports[0], ports[1])
    if draft.maybe():
        _connect(draft, whole, [(None, parts[0]), (None, parts[1])])
    if draft.maybe():
        inside = _add_port(draft, sides[0], None, "FullPort", draft.item)
        border = _add_port(draft, whole, None, "FullPort", draft.item)
        _connect(draft, whole, [(None, border), (parts[0], inside)])


def _add_port(
    draft: Draft, owner: Element, word: str | None, stereotype: str, type_: Element
) -> Element:
    name = draft.make_name(word or "port")
    port = draft.add(owner, "ownedAttribute", "Port", name, type=type_, aggregation="composite")
    if stereotype:
        prefix = "DeprecatedElements" if stereotype == "FlowPort" else "PortsAndFlows"
        tags = {"direction": draft.choose("in", "out", "inout")} if stereotype == "FlowPort" else {}
        draft.apply(f"{prefix}:{stereotype}", port, **tags)
    return port


def _add_proxy_ports(draft: Draft, sides: list[Element]) -> list[Element]:
    interface = draft.add_packaged("Class", "Interface")
    draft.apply("PortsAndFlows:InterfaceBlock", interface)
    for direction in draft.random.sample(["in", "out", "inout", ""], 2):
        name = draft.make_name("flow")
        flow = draft.add(interface, "ownedAttribute", "Property", name, type=draft.item)
        tags = {"direction": direction} if direction else {}
        draft.apply("PortsAndFlows:FlowProperty", flow, **tags)
    if draft.maybe():
        operation = draft.add(interface, "ownedOperation", "Operation", draft.make_name("call"))
        direction = draft.choose("provided", "required", "providedRequired")
        draft.apply("PortsAndFlows:DirectedFeature", operation, featureDirection=direction)
    ports = [_add_port(draft, side, None, "ProxyPort", interface) for side in sides]
    draft.set(ports[1], isConjugated=True)
    if draft.maybe(0.3):
        draft.set(ports[0], isBehavior=True)
    return ports


def _add_full_ports(draft: Draft, sides: list[Element]) -> list[Element]:
    return [_add_port(draft, side, None, "FullPort", draft.item) for side in sides]


def _add_flow_ports(draft: Draft, sides: list[Element]) -> list[Element]:
    ports = [_add_port(draft, side, None, "", draft.item) for side in sides]
    for port, direction in zip(ports, ("out", draft.choose("in", "inout")), strict=True):
        draft.apply("DeprecatedElements:FlowPort", port, direction=direction)
    return ports


def _add_service_ports(draft: Draft, sides: list[Element]) -> list[Element]:
    """Add a port that provides an interface, and one that requires it."""
    interface = draft.add_packaged("Interface", "Service")
    draft.add(interface, "ownedOperation", "Operation", draft.make_name("serve"))
    provider = draft.add_packaged("Class", "Provider")
    features = {"contract": interface, "client": [provider], "supplier": [interface]}
    draft.add(provider, "interfaceRealization", "InterfaceRealization", **features)
    user = draft.add_packaged("Class", "User")
    draft.add_packaged("Usage", "uses", client=[user], supplier=[interface])
    ports = [
        _add_port(draft, side, None, "", type_)
        for side, type_ in zip(sides, (provider, user), strict=True)
    ]
    draft.set(ports[0], isService=draft.maybe())
    return ports


def _connect(draft: Draft, owner: Element, ends: list[tuple[Element | None, Element]]) -> Element:
    name = draft.make_name("wire") if draft.maybe() else ""
    connector = draft.add(owner, "ownedConnector", "Connector", name)
    if draft.maybe(0.3):
        is_delegation = any(part is None for part, _ in ends)
        draft.set(connector, kind="delegation" if is_delegation else "assembly")
    for part, role in ends:
        end = draft.add(connector, "end", "ConnectorEnd", role=role)
        if part is not None:
            draft.set(end, partWithPort=part)
        if draft.maybe(0.2):
            draft.document.set_bounds(end, 1, "1")
    return connector


def _add_item_flow(draft: Draft, connector: Element, source: Element, target: Element) -> None:
    flow = draft.add_packaged("InformationFlow", "flow", conveyed=[draft.item])
    draft.set(flow, informationSource=[source], informationTarget=[target])
    draft.set(flow, realizingConnector=[connector])
    draft.apply("PortsAndFlows:ItemFlow", flow)


def add_nested_connector(draft: Draft) -> None:
    """Add a connector that reaches a port through parts and a port of a port."""
    inner, outer = (draft.add_packaged("Class", word) for word in ("Inner", "Outer"))
    for interface in (inner, outer):
        draft.apply("PortsAndFlows:InterfaceBlock", interface)
    nested = _add_port(draft, outer, "nested", "ProxyPort", inner)
    holder, middle, whole = (draft.add_block(word) for word in ("Holder", "Middle", "Whole"))
    door = _add_port(draft, holder, "door", "ProxyPort", outer)
    step, first = draft.add_part(middle, holder), draft.add_part(whole, middle)
    near = _add_port(draft, whole, "near", "ProxyPort", inner)
    connector = draft.add(whole, "ownedConnector", "Connector", draft.make_name("deep"))
    draft.add(connector, "end", "ConnectorEnd", role=near)
    end = draft.add(connector, "end", "ConnectorEnd", role=nested, partWithPort=door)
    draft.apply("Blocks:NestedConnectorEnd", end, propertyPath=[first, step, door])


def add_constraint_block(draft: Draft) -> None:
    """Add a constraint block inside another one, and bind its parameters to values."""
    law, nest, user = (draft.add_packaged("Class", word) for word in ("Law", "Nest", "User"))
    for block in (law, nest):
        draft.apply("ConstraintBlocks:ConstraintBlock", block)
    draft.apply("Blocks:Block", user)
    parameters = [draft.add_value(law, "x", "Real") for _ in range(2)]
    text = f"{parameters[0].get('name')} = 2 * {parameters[1].get('name')}"
    rule = draft.add_rule(law, text)
    draft.set(rule, constrainedElement=[law])
    inner = draft.add_part(nest, law)
    outer_parameter = draft.add_value(nest, "y", "Real")
    _bind(draft, nest, (outer_parameter, []), (parameters[0], [inner]))
    value = draft.add_value(user, "v", "Real")
    use = draft.add_part(user, nest)
    _bind(draft, user, (value, []), (outer_parameter, [use]))
    _bind(draft, user, (draft.add_value(user, "w", "Real"), []), (parameters[1], [use, inner]))


def _bind(draft: Draft, owner: Element, *ends: tuple[Element, list[Element]]) -> None:
    bond = draft.add(owner, "ownedConnector", "Connector", draft.make_name("bond"))
    draft.apply("Blocks:BindingConnector", bond)
    for role, path in ends:
        end = draft.add(bond, "end", "ConnectorEnd", role=role)
        if path:
            draft.apply("Blocks:NestedConnectorEnd", end, propertyPath=path)


def add_collaboration(draft: Draft) -> None:
    """Add a collaboration with connected roles, and its use in a class."""
    add, collaboration = draft.add, draft.add_packaged("Collaboration", "Handover")
    roles = [draft.add_part(collaboration, draft.block, "none") for _ in range(2)]
    draft.set(collaboration, collaborationRole=roles)
    connector = add(collaboration, "ownedConnector", "Connector", draft.make_name("link"))
    for role in roles:
        add(connector, "end", "ConnectorEnd", role=role)
    user = draft.add_packaged("Class", "Cell")
    parts = [draft.add_part(user, draft.block) for _ in range(2)]
    use = add(user, "collaborationUse", "CollaborationUse", "use", type=collaboration)
    for role, part in zip(roles, parts, strict=True):
        add(use, "roleBinding", "Dependency", "", client=[part], supplier=[role])
    draft.set(user, representation=use)


def add_information_flows(draft: Draft) -> None:
    """Add flows between classes, actors and instances, which convey items or classes."""
    item = draft.add_packaged("InformationItem", "news", represented=[draft.item])
    actor = draft.add_packaged("Actor", "Operator")
    instance = draft.add_packaged("InstanceSpecification", "", classifier=[draft.block])
    node = draft.add_packaged("Node", "Server")
    for source, target in ((actor, draft.block), (draft.block, instance), (node, actor)):
        flow = draft.add_packaged("InformationFlow", "tells", conveyed=[item])
        draft.set(flow, informationSource=[source], informationTarget=[target])
    link = draft.add_packaged("Dependency", "way", client=[draft.block], supplier=[draft.item])
    flow = draft.add_packaged("InformationFlow", "carries", conveyed=[draft.signal])
    draft.set(
        flow, realization=[link], informationSource=[draft.block], informationTarget=[draft.item]
    )
