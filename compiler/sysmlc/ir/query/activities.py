"""Activities: chains of actions, guards, rules of tokens, joined branches, and UML's pins."""

from collections.abc import Iterable, Mapping

from sysmlc.ir.algorithms import find_reachable
from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.pending import TextFile

_STEPS = (Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL)
_CHOICES = ("decision", "merge")
_EXIT = ""
"""The virtual exit: the successor of every step without a successor."""
_Successors = Mapping[str, list[str]]


def is_referential(action: Element) -> bool:
    """Whether an action is declared with ``ref`` (SysML v2)."""
    return bool(action.attrs.get("referential"))


def is_performed(graph: Graph, node: Element) -> bool:
    """Whether a node of an activity is a step that the activity performs.

    A referential action is none of the subactions (SysML 2.0, 8.3.17,
    ``checkActionUsageSubactionSpecialization``): it is a name for a performance elsewhere. It is
    a step only if the model orders it, so that a flow leads to or from it or one of its pins.
    """
    if not is_referential(node):
        return True
    ends = (node, *(member for member in graph.owned(node) if member.kind is Kind.PIN))
    edges = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    return any(True for end in ends for edge in edges for _ in graph.sources(end, edge))


def list_chained_actions(graph: Graph, activity: Element) -> tuple[Element, ...]:
    """Return the actions of an activity that performs one after another and does nothing else.

    Control flows without guards and weights join them. The first may follow an initial node, and a
    final node the last. The result is empty for any other activity, such as one with parameters,
    attributes or pins, and one that specialises another activity.
    """
    members = [member for member in graph.owned(activity) if member.kind is not Kind.COMMENT]
    nodes = [member for member in members if member.kind in (Kind.ACTION, Kind.CONTROL)]
    flows = [member for member in members if _is_plain_flow(member)]
    is_special = any(
        graph.targets(activity, edge) for edge in (Edge.SPECIALIZES, Edge.REDEFINES, Edge.SUBSETS)
    )
    if is_special or len(nodes) + len(flows) < len(members) or len(flows) != len(nodes) - 1:
        return ()
    targets = {node.id for flow in flows for node in graph.targets(flow, Edge.FLOW_TARGET)}
    node = next((node for node in nodes if node.id not in targets), None)
    chain: list[Element] = []
    while node is not None and len(chain) < len(nodes):
        chain.append(node)
        leaving = graph.sources(node, Edge.FLOW_SOURCE)
        node = graph.target(leaving[0], Edge.FLOW_TARGET) if leaving else None
    first, last = chain[:1], chain[1:][-1:]
    first = [node for node in first if node.subkind == "initial"]
    last = [node for node in last if node.subkind in ("final", "flow-final")]
    actions = chain[len(first) : len(chain) - len(last)]
    is_chain = {node.id for node in chain} == {node.id for node in nodes}
    is_plain = all(_is_plain_action(graph, action) for action in actions)
    return tuple(actions) if is_chain and is_plain and not _may_branch(graph, nodes) else ()


def _may_branch(graph: Graph, nodes: Iterable[Element]) -> bool:
    """Whether several flows lead to one of the nodes or leave it."""
    ends = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    return any(len(graph.sources(node, edge)) > 1 for node in nodes for edge in ends)


def _is_plain_flow(member: Element) -> bool:
    """Whether a member of an activity is a control flow that passes each token."""
    guard, weight = member.attrs.get("guard", "true"), member.attrs.get("weight", "1")
    is_open = str(guard).lower() == "true" and str(weight) == "1"
    return member.kind is Kind.CONTROL_FLOW and is_open and "interrupts" not in member.attrs


def _is_plain_action(graph: Graph, node: Element) -> bool:
    """Whether a node is an opaque action without pins, which the activity itself performs."""
    has_members = any(member.kind is not Kind.COMMENT for member in graph.owned(node))
    is_opaque = node.kind is Kind.ACTION and node.subkind == "opaque"
    return is_opaque and not has_members and not is_referential(node)


def has_guard(graph: Graph, flow: Element) -> bool:
    """Whether a guard restricts a flow of an activity.

    Tools write the literal ``true`` as the guard of every flow. It restricts only the flows of a
    decision that compares it with an input.
    """
    if flow.attrs.get("guard") != "true" or flow.attrs.get("guard_literal") is not True:
        return "guard" in flow.attrs
    source = graph.target(flow, Edge.FLOW_SOURCE)
    return source is not None and has_decision_input(graph, source)


def has_decision_input(graph: Graph, node: Element) -> bool:
    """Whether a node is a decision that compares its literal guards with an input.

    The input is the decision input of UML, or else the object that the decision passes on.
    """
    if node.subkind != "decision":
        return False
    is_stated = bool(node.attrs.get("decision_input") or node.attrs.get("decision_input_flow"))
    flows = graph.sources(node, Edge.FLOW_TARGET)
    return is_stated or any(flow.kind is Kind.OBJECT_FLOW for flow in flows)


def follows_v2(graph: Graph, activity: Element) -> bool:
    """Whether the tokens of an activity follow the rules of SysML v2, not those of UML.

    The attribute ``token_rules`` is ``uml`` in a text that was written from UML.
    """
    is_in_text = TextFile(activity.source) in graph.derived(TextFile)
    return is_in_text and activity.attrs.get("token_rules") != "uml"


def list_rule_dependent_nodes(graph: Graph, activity: Element) -> list[Element]:
    """List the nodes of an activity whose tokens move differently in UML and SysML v2.

    In UML, a token takes one of several flows that leave an object node, a merge or an initial
    node, an accept action without incoming flows accepts again after each event (UML 2.5.1,
    16.10.3), and a step waits for all its flows (15.2.3.4). In SysML v2, tokens take all flows of
    a node that is no decision, each action happens once in each performance of its owner, and a
    step does not wait for a succession whose guard is false (SysML 2.0, 8.4.13.5).
    """
    return [node for node in graph.subtree(activity) if _depends_on_rules(graph, node)]


def _depends_on_rules(graph: Graph, node: Element) -> bool:
    if node.kind in (Kind.ACTION, Kind.STRUCTURED):
        is_accept = node.subkind.startswith("accept")
        flows = graph.sources(node, Edge.FLOW_TARGET)
        control_flows = [flow for flow in flows if _is_control_flow(flow)]
        has_guards = len(control_flows) > 1 and any(has_guard(graph, flow) for flow in flows)
        return has_guards or (is_accept and not flows)
    is_object_node = node.kind in (Kind.PIN, Kind.OBJECT_NODE, Kind.ACTIVITY_PARAMETER)
    may_choose = is_object_node or node.subkind in ("initial", "merge")
    return may_choose and len(graph.sources(node, Edge.FLOW_SOURCE)) > 1


def is_joined(graph: Graph, end: Element) -> bool:
    """Whether no other token is left when a token reaches a final node of an activity.

    This holds if all paths from every fork before the end (or step with several outgoing control
    flows) lead through one node that waits for several flows. Then the end of the flow is the
    end of the activity (UML 2.5.1, 15.3.3.2).
    """
    owner = graph.owner(end)
    steps = [] if owner is None else [node for node in graph.owned(owner) if node.kind in _STEPS]
    # Most activities have no fork: the quick test looks at no flow.
    if not any(_may_fork(graph, step) for step in steps):
        return True
    successors = {step.id: _list_successors(graph, step) for step in steps}
    forks = [s.id for s in steps if len(successors[s.id]) > 1 and s.subkind not in _CHOICES]
    if not forks:
        return True
    joins = {step.id for step in steps if _is_join(graph, step)}
    return _are_forks_joined(successors, end.id, forks, joins)


def _may_fork(graph: Graph, step: Element) -> bool:
    """Whether several flows of any kind leave a step."""
    return len(graph.sources(step, Edge.FLOW_SOURCE)) > 1 and step.subkind not in _CHOICES


def _list_successors(graph: Graph, step: Element) -> list[str]:
    flows = [flow for flow in graph.sources(step, Edge.FLOW_SOURCE) if _is_control_flow(flow)]
    targets = [graph.target(flow, Edge.FLOW_TARGET) for flow in flows]
    return [
        node.id for node in targets if node and node.kind in _STEPS and node.owner == step.owner
    ]


def _is_join(graph: Graph, step: Element) -> bool:
    """Whether a step waits for several control flows."""
    if step.subkind in _CHOICES or step.subkind.endswith("final"):
        return False
    return sum(1 for flow in graph.sources(step, Edge.FLOW_TARGET) if _is_control_flow(flow)) > 1


def _is_control_flow(flow: Element) -> bool:
    return flow.kind is Kind.CONTROL_FLOW


def _are_forks_joined(
    successors: _Successors, end: str, forks: Iterable[str], joins: set[str]
) -> bool:
    predecessors = _reverse(successors)
    before_end = find_reachable([end], predecessors.__getitem__)
    before_exit = find_reachable([_EXIT], predecessors.__getitem__)
    # From these steps a path leads into an endless cycle.
    endless = find_reachable(
        [step for step in successors if step not in before_exit], predecessors.__getitem__
    )
    post_dominators = _immediate_post_dominators(successors, predecessors)
    return all(
        fork not in endless and not joins.isdisjoint(_post_dominators(post_dominators, fork))
        for fork in forks
        if fork in before_end
    )


def _reverse(successors: _Successors) -> dict[str, list[str]]:
    predecessors: dict[str, list[str]] = {_EXIT: [], **{step: [] for step in successors}}
    for step, following in successors.items():
        for successor in following or [_EXIT]:
            predecessors[successor].append(step)
    return predecessors


def _post_dominators(immediate: Mapping[str, str], step: str) -> set[str]:
    """Return the steps that all paths from *step* to the exit lead through."""
    post_dominators: set[str] = set()
    while step != _EXIT:
        step = immediate[step]
        post_dominators.add(step)
    return post_dominators


def _immediate_post_dominators(
    successors: _Successors, predecessors: _Successors
) -> dict[str, str]:
    """Return the nearest post-dominator of each step (Cooper, Harvey and Kennedy, 2001)."""
    order = _postorder(predecessors)
    rank = {step: number for number, step in enumerate(order)}
    immediate = {_EXIT: _EXIT}
    is_changed = True
    while is_changed:
        is_changed = False
        for step in reversed(order[:-1]):
            following = [s for s in successors[step] or [_EXIT] if s in immediate]
            common = _intersect(immediate, rank, following)
            is_changed = is_changed or immediate.get(step) != common
            immediate[step] = common
    return immediate


def _postorder(predecessors: _Successors) -> list[str]:
    """Return the steps in postorder of a depth-first search from the exit, the exit last."""
    order: list[str] = []
    visited, path = {_EXIT}, [(_EXIT, iter(predecessors[_EXIT]))]
    while path:
        step, remaining = path[-1]
        new = next((predecessor for predecessor in remaining if predecessor not in visited), None)
        if new is None:
            order.append(step)
            path.pop()
        else:
            visited.add(new)
            path.append((new, iter(predecessors[new])))
    return order


def _intersect(immediate: Mapping[str, str], rank: Mapping[str, int], steps: list[str]) -> str:
    """Return the nearest common post-dominator of several steps."""
    common, *rest = steps
    for step in rest:
        finger = step
        while common != finger:
            if rank[common] < rank[finger]:
                common = immediate[common]
            else:
                finger = immediate[finger]
    return common


# -- pins --------------------------------------------------------------------------------------

_PINS_OF_CALLS = {"in": "argument", "out": "result"}
_PINS_OF_OPAQUE_ACTIONS = {"in": "input-value", "out": "output-value"}
_PINS = {
    "call-behavior": _PINS_OF_CALLS,
    "call-operation": _PINS_OF_CALLS,
    "opaque": _PINS_OF_OPAQUE_ACTIONS,
    "send": {"in": "argument"},
    "accept": {"out": "result"},
    "value": {"out": "result"},
    "read": {"out": "result"},
}
"""Features of actions for pins, by the subkind of the action and the direction of the pin."""


def pin_subkind(action: Element, pin: Element) -> str:
    """Return the feature of the action that owns the pin (UML 2.5.1, 16.2 and 16.3).

    The result is empty if the direction of the pin does not decide it.
    """
    if action.kind is not Kind.ACTION:
        return ""
    return _PINS.get(action.subkind, {}).get(str(pin.attrs.get("direction", "")), "")
