"""Associations, connectors and item flows, with their ends as feature chains."""

from sysmlc.backends.sysml.annotations import write_annotations
from sysmlc.backends.sysml.declarations import (
    format_multiplicity,
    is_referential_owner,
    list_types,
    list_visibility,
    make_definition_head,
    make_feature_head,
)
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import (
    format_chain,
    is_accessible,
    is_path_accessible,
    visible_members,
)
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import (
    conforms,
    flow_directions,
    role_of,
    runs_both_ways,
    type_of,
)
from sysmlc.ir.query.relations import flow_path

# -- associations --------------------------------------------------------------------------------


def write_association(writer: Writer, member: Member) -> list[Line]:
    """Write an association as a connection definition, which repeats the ends that classes own.

    An association that only connects an actor has no lines: the use case names the actor.
    """
    element = member.require_element()
    if find_actor_end(writer.graph, element) is not None:
        writer.expressed.update(child.id for child in writer.graph.owned(element))
        return []
    repeated = []
    for end in writer.graph.targets(element, Edge.END):
        end_member = writer.plan.find(end)
        if end_member is not None and end_member.parent is not member:
            repeated.append((end, end_member))
    # A repeated end hides a type of the same name.
    names = visible_members(writer.plan, member)
    names.update((end_member.name, end_member) for _, end_member in repeated)
    ends = [Line(_format_repeated_end(writer, member, *pair)) for pair in repeated]
    head = make_definition_head(writer, member).format()
    return [Line(head, ends + write_contents(writer, member))]


def _format_repeated_end(
    writer: Writer, association: Member, end: Element, end_member: Member
) -> str:
    types, _ = list_types(writer, association, end)
    multiplicity = format_multiplicity(writer, association, end)
    keyword = end_member.shape.keyword
    if keyword == "ref" and not multiplicity:
        keyword = ""
    words = ("end", multiplicity.strip(), keyword, quote_name(end_member.name))
    head = " ".join(word for word in words if word)
    return head + (f" : {', '.join(types)}" if types else "")


def write_association_end(writer: Writer, member: Member) -> list[Line]:
    """Write an end that the association owns; its multiplicity stands before the keyword."""
    head = make_feature_head(writer, member)
    multiplicity, head.multiplicity = head.multiplicity, ""
    head.prefixes = ["end", *([multiplicity.strip()] if multiplicity else [])]
    if multiplicity and not head.keyword:
        head.keyword = "ref"
    return [Line(head.format(), write_contents(writer, member))]


def find_actor_end(graph: Graph, association: Element) -> Element | None:
    """Return the end at the actor, if the association only connects a use case with an actor.

    None if the association has a name, attributes, or a name for its end at the use case: the
    text would lose them.
    """
    ends = graph.targets(association, Edge.END)
    if association.name or len(ends) != 2 or graph.owned(association) != ends:
        return None
    case_end, actor_end = ends
    case = type_of(graph, case_end)
    if case is None or case.kind is not Kind.USE_CASE or case.owner != association.owner:
        return None
    if case_end.name or case_end.attrs or graph.owned(actor_end) or graph.owned(case_end):
        return None
    return actor_end if not actor_end.attrs else None


# -- connectors ----------------------------------------------------------------------------------


def write_connector(writer: Writer, member: Member) -> list[Line]:
    """Write a connector: an interface between ports, a binding, else a connection."""
    element = member.require_element()
    ends = writer.graph.targets(element, Edge.END)
    texts = [_format_end(writer, member, end) for end in ends]
    writer.expressed.update(end.id for end in ends)
    if len(texts) < 2 or None in texts:
        return writer.drop(member, "end")
    end_texts = [str(text) for text in texts]
    body = write_contents(writer, member)
    for end in ends:
        if any(child.kind is not Kind.APPLICATION for child in writer.graph.owned(end)):
            writer.record_approximation(end, "what an end of a connector owns", "its own")
    if element.role == "binding connector" and len(end_texts) == 2:
        name = f"binding {quote_name(member.name)} " if member.name else ""
        return [Line(f"{name}bind {end_texts[0]} = {end_texts[1]}", body)]
    return [Line(_format_connection(writer, member, ends, end_texts), body)]


def _format_connection(
    writer: Writer, member: Member, ends: list[Element], end_texts: list[str]
) -> str:
    element = member.require_element()
    keyword = "interface" if _connects_ports(writer, ends) else "connection"
    types, _ = list_types(writer, member.parent, element)
    type_ = writer.plan.find(type_of(writer.graph, element))
    if type_ is not None and type_.shape.is_definition:
        keyword = type_.shape.usage_keyword
    joined_ends = f"({', '.join(end_texts)})" if len(end_texts) > 2 else " to ".join(end_texts)
    prefixes = list_visibility(writer, element)
    prefixes += ["ref"] if is_referential_owner(member.parent) else []
    if not member.name and not types:
        word = "interface" if keyword == "interface" else "connect"
        return " ".join([*prefixes, word, joined_ends])
    words = [*prefixes, keyword, quote_name(member.name) if member.name else ""]
    head = " ".join(word for word in words if word)
    return head + (f" : {', '.join(types)}" if types else "") + f" connect {joined_ends}"


def _connects_ports(writer: Writer, ends: list[Element]) -> bool:
    roles = [writer.plan.find(role_of(writer.graph, end)) for end in ends]
    return all(role is not None and role.shape.keyword == "port" for role in roles)


def _format_end(writer: Writer, member: Member, end: Element) -> str | None:
    """Return an end as its multiplicity and a feature chain; None if no chain leads to the role."""
    chain = _format_end_chain(writer, member, end)
    multiplicity = end.attrs.get("multiplicity")
    if chain is None or multiplicity is None:
        return chain
    return f"[{multiplicity}] {chain}"


def _format_end_chain(writer: Writer, member: Member, end: Element) -> str | None:
    """Return the chain from the owner of the connector to the role of one of its ends."""
    role = role_of(writer.graph, end)
    if role is None:
        return None
    path = writer.graph.targets(end, Edge.PATH)
    steps = [*(step for step in path if step is not role), role]
    first = writer.plan.find(steps[0])
    # Of a role outside of the model only the id is known: its stub is a definition.
    if first is None or first.shape.is_definition:
        return None
    if not is_accessible(writer.plan, member.parent, first):
        return None
    return format_chain(writer.plan, member.parent, steps)


# -- item flows ----------------------------------------------------------------------------------


def write_item_flow(writer: Writer, member: Member) -> list[Line]:
    """Write a flow for each conveyed item and each connector that realises the item flow."""
    element = member.require_element()
    end_pairs = [pair for pair in _list_flow_ends(writer, member, element) if None not in pair]
    if not end_pairs:
        return _write_flow_definition(writer, member, element)
    items: list[Element | None] = [*writer.graph.targets(element, Edge.CONVEYS)] or [None]
    lines = []
    name = member.name
    for source, target in end_pairs:
        for item in items:
            ends = (str(source), str(target))
            lines.append(Line(_format_flow(writer, member, name, item, ends)))
            name = ""
    lines[0].body += write_contents(writer, member)
    return lines


def _format_flow(
    writer: Writer, member: Member, name: str, item: Element | None, ends: tuple[str, str]
) -> str:
    element = member.require_element()
    # A flow connects features of two elements (SysML 2.0, 7.16); all others are messages.
    keyword = "flow" if all("." in end for end in ends) else "message"
    words = [*list_visibility(writer, element), keyword, *([quote_name(name)] if name else [])]
    type_ = None
    if item is not None:
        type_ = writer.refer_to(member.parent, element, Edge.CONVEYS, item)
    payload = "" if type_ is None else f" of {type_}"
    return f"{' '.join(words)}{payload} from {ends[0]} to {ends[1]}"


def _list_flow_ends(
    writer: Writer, member: Member, flow: Element
) -> list[tuple[str | None, str | None]]:
    """Return the chains to source and target, for each connector that realises the flow.

    A flow without such connectors has the chains to its own ends, if both are usages.
    """
    graph = writer.graph
    source, target = graph.target(flow, Edge.FLOW_SOURCE), graph.target(flow, Edge.FLOW_TARGET)
    item = graph.target(flow, Edge.CONVEYS)
    pairs: list[tuple[str | None, str | None]] = []
    for realizing in graph.targets(flow, Edge.REALIZING):
        ends = graph.targets(realizing, Edge.END) if realizing.kind is Kind.CONNECTOR else []
        connector = writer.plan.find(realizing)
        if len(ends) != 2 or connector is None:
            continue
        # The flow has to find the names of the connector's owner.
        if not any(connector.parent is namespace for namespace in member.namespaces):
            continue
        first, last = _order_ends(graph, ends, source, target)
        first_chain = _format_flow_end(writer, member, first, item)
        last_chain = _format_flow_end(writer, member, last, item)
        pairs.append((first_chain, last_chain))
        if runs_both_ways(graph, flow):
            pairs.append((last_chain, first_chain))
    if pairs or source is None or target is None:
        return pairs
    members = [writer.plan.find(end) for end in (source, target)]
    if not all(end is not None and end.shape.is_usage for end in members):
        return []
    source_path = _find_path_to_end(graph, flow, Edge.FLOW_SOURCE, source)
    target_path = _find_path_to_end(graph, flow, Edge.FLOW_TARGET, target)
    scope = member.parent
    firsts = [writer.plan.find(path[0]) for path in (source_path, target_path)]
    if not all(first and is_path_accessible(writer.plan, scope, first) for first in firsts):
        return []
    source_chain = format_chain(writer.plan, scope, source_path)
    return [(source_chain, format_chain(writer.plan, scope, target_path))]


def _find_path_to_end(graph: Graph, flow: Element, edge: Edge, end: Element) -> list[Element]:
    """Return the features that lead from the owner of a flow to its end.

    A flow without a path leads to the feature of the only part of the owner that has the feature.
    """
    path, owner = flow_path(graph, flow, edge), graph.owner(flow)
    if path or owner is None:
        return [*path, end]
    classifier = graph.owner(end)
    holders = [part for part in graph.owned(owner) if type_of(graph, part) is classifier]
    return [*holders, end] if classifier is not None and len(holders) == 1 else [end]


def _order_ends(
    graph: Graph, ends: list[Element], source: Element | None, target: Element | None
) -> tuple[Element, Element]:
    """Return the ends of a connector in the direction of the flow."""
    roles = [role_of(graph, end) for end in ends]
    is_reversed = False
    if source is not target:
        starts_at_second = source is not None and roles[1] is source
        ends_at_first = target is not None and roles[0] is target
        is_reversed = starts_at_second or ends_at_first
    return (ends[1], ends[0]) if is_reversed else (ends[0], ends[1])


def _format_flow_end(
    writer: Writer, member: Member, end: Element, item: Element | None
) -> str | None:
    """Return the chain to an end, with the only flow property of its port that fits the item."""
    chain = _format_end_chain(writer, member, end)
    role = role_of(writer.graph, end)
    if chain is None or role is None or role.kind is not Kind.PORT or item is None:
        return chain
    fitting = [
        flow_property
        for flow_property, _ in flow_directions(writer.graph, role)
        if (type_ := type_of(writer.graph, flow_property)) is not None
        and (conforms(writer.graph, item, type_) or conforms(writer.graph, type_, item))
    ]
    feature = writer.plan.find(fitting[0]) if len(fitting) == 1 else None
    return chain if feature is None else f"{chain}.{quote_name(feature.name)}"


def _write_flow_definition(writer: Writer, member: Member, flow: Element) -> list[Line]:
    """Write a flow between classifiers: a definition of flows."""
    graph = writer.graph
    ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    names = [
        None if end is None else writer.refer_to(member, flow, Edge.FLOW_SOURCE, end)
        for end in ends
    ]
    end_members = [writer.plan.find(end) for end in ends]
    if None in names or any(end is None or not end.shape.is_definition for end in end_members):
        return writer.drop(member, "flow ends")
    payloads = writer.refer_to_targets(member, flow, Edge.CONVEYS)
    body = [Line(f"ref :>> payload : {payload}") for payload in payloads[:1]]
    if len(graph.targets(flow, Edge.CONVEYS)) > 1:
        writer.record_unreachable(flow, "conveys")
    pairs = zip(("source", "target"), names, strict=True)
    body += [Line(f"end ref {role} : {name}") for role, name in pairs]
    head = f"flow def {quote_name(member.name)}" if member.name else "flow def"
    return [Line(head, body + write_annotations(writer, member) + writer.write_members(member))]
