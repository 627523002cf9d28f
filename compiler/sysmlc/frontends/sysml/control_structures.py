"""If, while and for actions: control nodes with guards, and regions that repeat for elements."""

from collections.abc import Iterable

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.successions import SUCCESSIONS, defer_implied_start, lower_steps
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

_FLOW_NODES = (Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL)


def lower_if(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower an if action to ``decision -> branch -> merge`` for each of its two branches.

    A branch without an action leads from the decision to the merge.
    """
    parameters = _list_parameters(node)
    conditions = [parameter for parameter in parameters if _is_expression(parameter)]
    actions = [parameter for parameter in parameters if _is_action(parameter)]
    decision = _add_control_node(lowering, node, owner, "decision", node.name or "")
    merge = _add_control_node(lowering, node, owner, "merge")
    lowering.elements.own[id(node)] = decision
    lowering.elements.spans[id(node)] = (decision, merge)
    defer_implied_start(lowering, node, owner, decision)
    guards: list[Node | str] = [conditions[0] if conditions else "true", "else"]
    for number, guard in enumerate(guards):
        action = actions[number] if number < len(actions) else None
        block = None if action is None else _lower_block(lowering, action, owner)
        if block is None:
            _add_flow(lowering, node, decision, merge, guard)
        else:
            _add_flow(lowering, node, decision, block[0], guard)
            _add_flow(lowering, node, block[1], merge)


def lower_while(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a loop to ``entry -> while decision -> body -> until decision -> entry``.

    The condition of ``while`` is tested before the body, the condition of ``until`` after it. A
    condition that is absent has no decision.
    """
    parameters = _list_parameters(node)
    body_at = next((i for i, item in enumerate(parameters) if _is_action(item)), len(parameters))
    while_condition = next(filter(_is_expression, parameters[:body_at]), None)
    until_condition = next(filter(_is_expression, parameters[body_at + 1 :]), None)
    entry = _add_control_node(lowering, node, owner, "merge", node.name or "")
    exit_ = _add_control_node(lowering, node, owner, "merge")
    lowering.elements.own[id(node)] = entry
    lowering.elements.spans[id(node)] = (entry, exit_)
    defer_implied_start(lowering, node, owner, entry)
    # The next flow leaves `source`; its guard is the while condition until it has been tested.
    source, guard = entry, while_condition
    if while_condition is not None:
        source = _add_control_node(lowering, node, owner, "decision")
        _add_flow(lowering, node, entry, source)
        _add_flow(lowering, node, source, exit_, "else")
    bodies = parameters[body_at : body_at + 1]
    block = _lower_block(lowering, bodies[0], owner) if bodies else None
    if block is not None:
        _add_flow(lowering, node, source, block[0], guard)
        source, guard = block[1], None
    if until_condition is None:
        _add_flow(lowering, node, source, entry, guard)
        if while_condition is None:
            _defer_removal(lowering, exit_)
        return
    decision = _add_control_node(lowering, node, owner, "decision")
    _add_flow(lowering, node, source, decision, guard)
    _add_flow(lowering, node, decision, exit_, until_condition)
    _add_flow(lowering, node, decision, entry, "else")


def lower_for(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a for loop to an expansion region that takes the elements one after the other."""
    region = lowering.add_element(
        node, Kind.STRUCTURED, node.name or "", owner, subkind="expansion", mode="iterative"
    )
    _lower_range(lowering, node, region)
    for member in node.members:
        if member.membership.endswith("Membership") and _is_action(member):
            lowering.elements.own.setdefault(id(member), region)
            steps = [member] if member.name else nodes.body_of(member)
            lower_steps(lowering, steps, region)


def _lower_range(lowering: Lowering, node: Node, region: Element) -> None:
    """Lower the collection of a loop to a text, and its variable with the type of the elements."""
    parameter_values = map(nodes.value_of, _list_parameters(node))
    collection = next((value for value in parameter_values if value is not None), None)
    values.defer_expression(lowering, region, "collection", collection)
    variable = next(nodes.iter_by_metaclass(node, "ReferenceUsage"), None)
    if variable is None:
        return
    element = lowering.add_element(
        variable, Kind.PROPERTY, variable.name or "", region, subkind="variable"
    )
    path = [] if collection is None else nodes.path_of_expression(collection)
    feature = path[-1] if path else None
    types = lowering.trees.types_of(variable)
    if not types and feature is not None:
        types = lowering.trees.types_of(feature)
    lowering.defer_edges(Edge.TYPED_BY, element, types)


# -- blocks ------------------------------------------------------------------------------------


def _lower_block(
    lowering: Lowering, action: Node, owner: Element
) -> tuple[Element, Element] | None:
    """Lower the action of a branch or a loop; return its entry and exit, None if it is empty.

    The steps of an action without a name are steps of the activity itself, so that its conditions
    and calls are those of the activity.
    """
    if action.kind != "ActionUsage" or action.name:
        lowering.lower(action, owner)
        entry = lowering.elements.flow_node_of(action, is_target=True)
        exit_ = lowering.elements.flow_node_of(action, is_target=False)
        return None if entry is None or exit_ is None else (entry, exit_)
    body = nodes.body_of(action)
    if not body:
        return None
    # `start` and `done` in the block mean its entry and exit, which are added after its steps.
    number_before, entry_and_exit = len(lowering.graph.owned(owner)), list[Element]()
    lower_steps(lowering, body, owner, entry_and_exit)
    added = lowering.graph.owned(owner)[number_before:]
    steps = [element for element in added if element.kind in _FLOW_NODES]
    if not steps and not any(element.kind is Kind.CONTROL_FLOW for element in added):
        return None
    entry = _add_control_node(lowering, action, owner, "merge")
    exit_ = _add_control_node(lowering, action, owner, "merge")
    entry_and_exit += (entry, exit_)
    lowering.queue.defer_until_edges(lambda: _connect_block(lowering, action, steps, entry, exit_))
    _defer_removal(lowering, exit_)
    return entry, exit_


def _connect_block(
    lowering: Lowering, action: Node, steps: Iterable[Element], entry: Element, exit_: Element
) -> None:
    """Connect the entry to the steps that nothing precedes, and the last steps to the exit.

    Flows back to the entry of a loop do not precede it. Nothing leads to the exit of a loop without
    conditions.
    """
    spans = list(lowering.elements.spans.values())
    entries, exits = ({ends[index].id for ends in spans} for index in (0, 1))
    for step in steps:
        flows = lowering.graph.sources(step, Edge.FLOW_TARGET)
        if step.id in entries:
            node = lowering.elements.origins.get(step.id)
            flows = [flow for flow in flows if lowering.elements.origins.get(flow.id) is not node]
        if not flows and step.id not in exits:
            _add_flow(lowering, action, entry, step)
        is_end = step.subkind != "final" and (flows or step.id not in exits)
        if is_end and not lowering.graph.sources(step, Edge.FLOW_SOURCE):
            _add_flow(lowering, action, step, exit_)


def _defer_removal(lowering: Lowering, exit_: Element) -> None:
    """Remove the exit of an endless loop, or of a block that ends with one.

    A step that the model states after the loop keeps the exit, from which it waits for a token.
    """

    def remove_exit() -> None:
        flows = lowering.graph.sources(exit_, Edge.FLOW_SOURCE)
        origins = [lowering.elements.origins.get(flow.id) for flow in flows]
        is_stated = any(node is not None and node.kind in SUCCESSIONS for node in origins)
        if not lowering.graph.sources(exit_, Edge.FLOW_TARGET) and not is_stated:
            for element in (*flows, exit_):
                lowering.graph.remove(element)

    lowering.queue.defer_to_second_round(remove_exit)


# -- nodes and flows ---------------------------------------------------------------------------


def _list_parameters(node: Node) -> list[Node]:
    return list(nodes.iter_by_membership(node, "ParameterMembership"))


def _is_expression(node: Node) -> bool:
    return node.kind in nodes.EXPRESSIONS


def _is_action(node: Node) -> bool:
    return node.kind.endswith("ActionUsage")


def _add_control_node(
    lowering: Lowering, node: Node, owner: Element, subkind: str, name: str = ""
) -> Element:
    return lowering.add_derived(node, Kind.CONTROL, name, owner, subkind=subkind)


def _add_flow(
    lowering: Lowering,
    node: Node,
    source: Element,
    target: Element,
    guard: Node | str | None = None,
) -> None:
    """Add a control flow; the guard is a condition, or a text such as ``else``."""
    flow = lowering.add_derived(node, Kind.CONTROL_FLOW, "", lowering.graph.owner(source))
    lowering.graph.connect(Edge.FLOW_SOURCE, flow, source)
    lowering.graph.connect(Edge.FLOW_TARGET, flow, target)
    values.defer_expression(lowering, flow, "guard", guard)
