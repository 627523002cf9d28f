"""Facts that metadata preserves because SysML v2 has no words for them.

A fact is a line of text: ``key=value`` for an attribute, ``edge->name`` for an edge to a member of
the text, ``edge=>name`` for an edge to an element outside of the model, ``key[]->name`` for an
attribute that is a list of elements, and ``{"->": name}`` for an element in other JSON. The front
end for SysML v2 restores attributes and edges from it. Facts of a part without a member start with
the word for the part and a dot (``region.visibility=private``); the path to such a part ends with
a dot and the word (``P::accept.trigger``).
"""

import json
from collections.abc import Iterator

from sysmlc.backends.sysml.attribute_coverage import iter_unexpressed_attributes
from sysmlc.backends.sysml.edge_coverage import iter_unexpressed_edges
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import quote_name
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query import follows_v2, list_rule_dependent_nodes, waits_for_change

_NEVER_PRESERVED = frozenset({"external", "library", "unresolved"})
_PRESERVED_EDGES = tuple(
    edge for edge in Edge if edge not in (Edge.OWNS, Edge.FEATURE, Edge.SUBJECT)
)
_WITH_PARTS = (
    Kind.ACTION,
    Kind.TRANSITION,
    Kind.ACTIVITY,
    Kind.STRUCTURED,
    Kind.STATE_MACHINE,
    Kind.STATE,
    Kind.REGION,
)
_STARTS = ((Kind.CONTROL, "initial"), (Kind.PSEUDOSTATE, "initial"))
_ENDS = ((Kind.CONTROL, "final"), (Kind.CONTROL, "flow-final"), (Kind.FINAL_STATE, ""))
_NEVER_IDS = frozenset(
    {"name", "guard", "body", "default", "value", "visibility", "subkind", "href"}
)
"""Attributes whose value is never the id of an element, even if it equals one."""
_VALUE = "value."
"""Start of the attributes with values of an interface; a value may look like an id as well."""
_MARKS = ("=", "->", '"')


# -- facts of an element -------------------------------------------------------------------------


def list_unexpressed_facts(writer: Writer, member: Member, element: Element) -> tuple[str, ...]:
    """Return the facts of an element, and of its parts without a member, that the text lacks."""
    facts = [*_iter_own_facts(writer, member, element)]
    for word, part in _iter_parts(writer, element):
        default_name = {"node": element.name, "start": "start", "done": "done"}.get(word, "")
        facts += [f"{word}.{fact}" for fact in _iter_part_facts(writer, part, default_name)]
    return tuple(facts)


def list_all_facts(writer: Writer, element: Element) -> tuple[str, ...]:
    """Return all facts of an element whose kind has no equivalent in SysML v2."""
    facts = []
    for key, value in element.attrs.items():
        attribute_facts = _format_attribute(writer, key, value)
        if attribute_facts and key not in _NEVER_PRESERVED:
            writer.stored_attributes.add((element.id, key))
            facts += attribute_facts
    for edge in _PRESERVED_EDGES:
        for target in writer.graph.targets(element, edge):
            facts += _iter_edge_facts(writer, element, edge, target)
    return tuple(facts)


def _iter_own_facts(writer: Writer, member: Member, element: Element) -> Iterator[str]:
    yield from _iter_attribute_facts(writer, member, element)
    facts: set[str] = set()
    for edge, target in iter_unexpressed_edges(writer, element):
        fact = _format_edge(writer, edge, target)
        # Two elements outside of the model that have one name cannot be told apart.
        if fact is not None and fact not in facts:
            facts.add(fact)
            writer.stored_edges.add((edge, element.id, target.id))
            yield fact
    if element.kind is Kind.ACTIVITY and not follows_v2(writer.graph, element):
        yield from _iter_token_rules(writer, element)


def _iter_token_rules(writer: Writer, activity: Element) -> Iterator[str]:
    """Yield the fact that an activity follows the rules of UML if it matters for a node of it."""
    nodes = list_rule_dependent_nodes(writer.graph, activity)
    for node in nodes:
        if node.kind not in (Kind.ACTION, Kind.STRUCTURED):
            construct = "a node whose tokens take one of several flows"
            writer.record_approximation(node, construct, "one whose tokens take all of them")
        elif writer.graph.sources(node, Edge.FLOW_TARGET):
            construct = "a step that waits for several flows, one of them with a guard,"
            written = "one that waits for those whose guards hold"
            writer.record_approximation(node, construct, written)
    if nodes and "token_rules" not in activity.attrs:
        yield "token_rules=uml"


def _iter_attribute_facts(writer: Writer, member: Member | None, element: Element) -> Iterator[str]:
    for key in iter_unexpressed_attributes(writer, member, element):
        facts = _format_attribute(writer, key, element.attrs.get(key))
        if facts:
            writer.stored_attributes.add((element.id, key))
        yield from facts


def _iter_edge_facts(
    writer: Writer, element: Element, edge: Edge, target: Element
) -> Iterator[str]:
    fact = _format_edge(writer, edge, target)
    if fact is not None:
        writer.stored_edges.add((edge, element.id, target.id))
        yield fact


def _iter_part_facts(writer: Writer, part: Element, default_name: str) -> Iterator[str]:
    """Yield the facts of a part without a member; readers name it *default_name* otherwise."""
    writer.stored_attributes.add((part.id, "name"))
    if part.name != default_name and not part.name and default_name in ("start", "done"):
        construct = "a first or last node without a name"
        writer.record_approximation(part, construct, "start or done")
    elif (
        part.name != default_name
        or _is_idle_parameter_node(writer, part)
        or is_empty_region(writer, part)
    ):
        yield from _format_attribute(writer, "name", part.name)
    if part.kind is Kind.ACTIVITY_PARAMETER and not writer.graph.targets(part, Edge.TYPED_BY):
        construct = "a parameter node without a type"
        writer.record_approximation(part, construct, "one of its parameter's type")
    if waits_for_change(part) and "immediate" not in part.attrs:
        yield "immediate=false"
    yield from _iter_attribute_facts(writer, None, part)


def _is_idle_parameter_node(writer: Writer, part: Element) -> bool:
    """Whether no flow of the text is sure to tell a reader that a parameter has a node.

    A flow without a second end is omitted, and a flow over a control node may lead nowhere.
    """
    if part.kind is not Kind.ACTIVITY_PARAMETER:
        return False
    leaving = writer.graph.sources(part, Edge.FLOW_SOURCE)
    arriving = writer.graph.sources(part, Edge.FLOW_TARGET)
    ends = [writer.graph.target(flow, Edge.FLOW_TARGET) for flow in leaving]
    ends += [writer.graph.target(flow, Edge.FLOW_SOURCE) for flow in arriving]
    return all(end is None or end.kind is Kind.CONTROL for end in ends)


def is_empty_region(writer: Writer, part: Element) -> bool:
    """Whether an element is a region of which no vertex or transition has a line."""
    if part.kind is not Kind.REGION:
        return False
    return all(writer.plan.find(member) is None for member in writer.graph.owned(part))


def _iter_parts(writer: Writer, element: Element) -> Iterator[tuple[str, Element]]:
    """Yield the parts of an element that its own member expresses, with words for them.

    ``node`` is the parameter node of a parameter, ``region`` the only region, ``trigger`` the only
    trigger; ``start`` and ``done`` begin and end a behaviour.
    """
    graph = writer.graph
    if element.kind is Kind.PARAMETER:
        references = graph.sources(element, Edge.REFERENCES)
        nodes = [source for source in references if _is_parameter_node(writer, source)]
        _record_shared(writer, nodes[1:], "the second node of an inout parameter", "the first")
        yield from (("node", node) for node in nodes[:1])
    children = graph.owned(element) if element.kind in _WITH_PARTS else []
    triggers = [child for child in children if child.kind is Kind.TRIGGER]
    if len(triggers) == 1 and element.kind is not Kind.STATE:
        yield "trigger", triggers[0]
    regions = [child for child in children if child.kind is Kind.REGION]
    if len(regions) == 1 and writer.plan.find(regions[0]) is None:
        yield "region", regions[0]
        children = graph.owned(regions[0])
    starts = [child for child in children if (child.kind, child.subkind) in _STARTS]
    _record_shared(writer, starts[1:], "one of several initial nodes", "start")
    for start in starts[:1]:
        if has_complete_flow(graph, start):
            yield "start", start
    ends = [
        child
        for child in children
        if (child.kind, child.subkind) in _ENDS and writer.plan.find(child) is None
    ]
    _record_shared(writer, ends[1:], "one of several final nodes", "done")
    for end in ends[:1]:
        if has_complete_flow(graph, end):
            yield "done", end


def _record_shared(writer: Writer, nodes: list[Element], construct: str, word: str) -> None:
    """Record the nodes that the text cannot distinguish from the first start or end."""
    for node in nodes:
        if has_complete_flow(writer.graph, node):
            writer.record_approximation(node, construct, word)


def has_complete_flow(graph: Graph, node: Element) -> bool:
    """Whether a flow or transition with both ends leaves or enters a node: the text writes it."""
    leaving = graph.sources(node, Edge.FLOW_SOURCE)
    arriving = graph.sources(node, Edge.FLOW_TARGET)
    return any(graph.targets(flow, Edge.FLOW_TARGET) for flow in leaving) or any(
        graph.targets(flow, Edge.FLOW_SOURCE) for flow in arriving
    )


def _is_parameter_node(writer: Writer, element: Element) -> bool:
    return element.kind is Kind.ACTIVITY_PARAMETER and writer.plan.find(element) is None


# -- the text of a fact --------------------------------------------------------------------------


def _format_attribute(writer: Writer, key: str, value: AttrValue) -> list[str]:
    """Return the facts of an attribute; none if the text cannot name an element in the value.

    A string stands as it is unless a reader would take it for JSON; all other values are JSON. A
    key that contains one of the marks is a JSON string. A list of elements has a fact for each.
    """
    name = _format_json(key) if any(mark in key for mark in _MARKS) else key
    if key.startswith(_VALUE):
        return [f"{name}={format_fact_value(value)}"]
    if isinstance(value, str) and key not in _NEVER_IDS and value in writer.graph:
        path = _format_path(writer, writer.graph[value])
        return [] if path is None else [f"{name}->{path}"]
    if isinstance(value, tuple) and _contains_ids(writer, value):
        elements = [writer.graph.get(item) for item in value if isinstance(item, str)]
        paths = [_format_path(writer, element) for element in elements if element is not None]
        if len(paths) == len(value) and None not in paths:
            return [f"{name}[]->{path}" for path in paths]
        try:
            return [f"{name}={_format_json(_replace_ids(writer, value))}"]
        except LookupError:
            return []
    return [f"{name}={format_fact_value(value)}"]


def _format_edge(writer: Writer, edge: Edge, target: Element) -> str | None:
    """Return the fact of an edge; None if the target has no name."""
    if target.attrs.get("external") and writer.plan.find(target) is None:
        name = str(target.attrs.get("qualified_name") or target.name)
        return f"{edge.value}=>{name}" if name else None
    path = _format_path(writer, target)
    return None if path is None else f"{edge.value}->{path}"


def _format_path(writer: Writer, target: Element) -> str | None:
    """Return the qualified name of a member, which must be public; None if it has none."""
    member = writer.plan.find(target)
    if member is None:
        return _format_part_path(writer, target)
    if member.element is not target:
        return None
    path: list[Member] = [member, *member.namespaces]
    if not all(step.name for step in path):
        return None
    for step in path:
        writer.plan.expose(step)
    return "::".join(quote_name(step.name) for step in reversed(path))


def _format_part_path(writer: Writer, part: Element) -> str | None:
    """Return the path to a part without a member: that of the element with the part, and a word."""
    owner = writer.graph.owner(part)
    if part.kind is Kind.ACTIVITY_PARAMETER:
        owner, word = writer.graph.target(part, Edge.REFERENCES), "node"
    elif part.kind is Kind.CONTROL:
        word = "start" if part.subkind == "initial" else "done"
    else:
        siblings = [] if owner is None else writer.graph.owned(owner)
        is_only_trigger = sum(sibling.kind is Kind.TRIGGER for sibling in siblings) == 1
        word = "trigger" if part.kind is Kind.TRIGGER and is_only_trigger else ""
    path = None if owner is None or not word else _format_path(writer, owner)
    return None if path is None else f"{path}.{word}"


def _contains_ids(writer: Writer, value: AttrValue) -> bool:
    if isinstance(value, tuple):
        return any(_contains_ids(writer, item) for item in value)
    return isinstance(value, str) and value in writer.graph


def format_fact_value(value: AttrValue) -> str:
    """Return the text of a value: itself unless a reader would take it for JSON, else JSON."""
    is_plain = isinstance(value, str) and not _is_json(value) and not value.startswith(">")
    return str(value) if is_plain else _format_json(value)


def _replace_ids(writer: Writer, value: AttrValue) -> object:
    """Return a value with an object ``{"->": path}`` for each id of an element.

    Raises LookupError if an element has no path.
    """
    if isinstance(value, tuple):
        return [_replace_ids(writer, item) for item in value]
    if not isinstance(value, str) or value not in writer.graph:
        return value
    path = _format_path(writer, writer.graph[value])
    if path is None:
        raise LookupError(value)
    return {"->": path}


def _format_json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    except RecursionError:
        return True
    return True
