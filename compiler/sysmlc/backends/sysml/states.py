"""States, regions, pseudostates and transitions."""

from sysmlc.backends.sysml.annotations import make_annotation, write_annotations
from sysmlc.backends.sysml.behaviours import write_subaction
from sysmlc.backends.sysml.conditions import format_condition, format_trigger
from sysmlc.backends.sysml.declarations import list_visibility
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.preserved_facts import is_empty_region
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import format_element_reference
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import waits_for_change

_KEYWORDS = {
    "choice": "choice",
    "junction": "junction",
    "fork": "forking",
    "join": "joining",
    "shallow-history": "shallowHistory",
    "deep-history": "deepHistory",
    "entry-point": "entryPoint",
    "exit-point": "exitPoint",
    "connection-point": "connectionPoint",
    "terminate": "termination",
}
"""Keyword of the library ``SysMLC`` by the subkind of a pseudostate."""
_POINTS = ("entry-point", "exit-point", "connection-point")
"""Pseudostates that states and state machines own themselves (UML 2.5.1, 14.2.4)."""
_TRANSITION_WIDTH = 80
"""Longest transition in one line."""


# -- states and pseudostates ---------------------------------------------------------------------


def write_state(writer: Writer, member: Member) -> list[Line]:
    """Write a state with its actions; one with several regions is parallel."""
    element = member.require_element()
    head = " ".join([*list_visibility(writer, element), "state", quote_name(member.name)])
    for machine in writer.graph.targets(element, Edge.CALLS):
        machine_member = writer.plan.find(machine)
        name = writer.refer_to(member.parent, element, Edge.CALLS, machine)
        if name is not None and machine_member is not None:
            head += f" {':' if machine_member.shape.is_definition else ':>'} {name}"
    regions = [child for child in writer.graph.owned(element) if child.kind is Kind.REGION]
    body = write_annotations(writer, member)
    for word, edge in (("entry", Edge.ENTRY), ("do", Edge.DO), ("exit", Edge.EXIT)):
        for behaviour in writer.graph.targets(element, edge):
            body.append(write_subaction(writer, member, word, behaviour))
    body += writer.write_members(member)
    return [Line(f"{head} parallel" if len(regions) > 1 else head, body)]


def write_region(writer: Writer, member: Member) -> list[Line]:
    """Write one of several regions: a substate of a parallel state.

    Metadata marks an empty region, which would be read as a region with one state.
    """
    body = write_contents(writer, member)
    if is_empty_region(writer, member.require_element()):
        body.insert(0, make_annotation(writer, member, "Kind", {"name": "region"}))
    return [Line(f"state {quote_name(member.name)}", body)]


def write_pseudostate(writer: Writer, member: Member) -> list[Line]:
    """Write a pseudostate: a state with a keyword of the library ``SysMLC``."""
    element = member.require_element()
    keyword = writer.refer_to_sysmlc(member.parent, _KEYWORDS.get(element.subkind, "choice"))
    owner = writer.graph.owner(element)
    if owner is not None and owner.kind is Kind.STATE and element.subkind not in _POINTS:
        construct = "a pseudostate that no region owns"
        writer.record_approximation(element, construct, "one of the only region")
    body = write_contents(writer, member)
    for target in writer.graph.targets(element, Edge.REFERENCES):
        name = writer.refer_to(member, element, Edge.REFERENCES, target)
        body += [] if name is None else [Line(f"ref :> {name}")]
    return [Line(f"#{keyword} state {quote_name(member.name)}", body)]


# -- transitions ---------------------------------------------------------------------------------


def write_transition(writer: Writer, member: Member) -> list[Line]:
    """Write a transition for each trigger; only the first has the name and the annotations."""
    element = member.require_element()
    triggers = writer.graph.targets(element, Edge.TRIGGER)
    writer.expressed.update(trigger.id for trigger in triggers)
    source = _format_end(writer, member, element, Edge.FLOW_SOURCE)
    target = _format_end(writer, member, element, Edge.FLOW_TARGET)
    if source is None or target is None:
        return writer.drop(member, "flow ends")
    body = write_annotations(writer, member)
    if element.subkind not in ("", "external"):
        body.append(make_annotation(writer, member, "Kind", {"name": element.subkind}))
    # Members besides effect, guard and triggers.
    body += [line for child in member.members for line in writer.write_member(child)]
    lines = []
    accepts = [format_trigger(writer, member, trigger) for trigger in triggers] or [""]
    name = member.name
    for index, accept in enumerate(accepts):
        # The metadata of the element names the trigger only if there is a single one.
        if len(triggers) > 1 and waits_for_change(triggers[index]):
            facts = {"attributes": ("trigger.immediate=false",)}
            body = [*body, make_annotation(writer, member, "Kept", facts)]
        lines.append(_write_line(writer, member, name, (source, target), accept, body))
        name, body = "", []
    return lines


def _write_line(
    writer: Writer,
    member: Member,
    name: str,
    ends: tuple[str, str],
    accept: str,
    body: list[Line],
) -> Line:
    """Write ``transition first <source> accept ... if ... do ... then <target>``."""
    element = member.require_element()
    source, target = ends
    words = [*list_visibility(writer, element), "transition", quote_name(name) if name else ""]
    head = " ".join(word for word in words if word)
    effects = writer.graph.targets(element, Edge.EFFECT)
    guard = element.attrs.get("guard")
    is_bare = head == "transition" and not accept and "guard" not in element.attrs
    if is_bare and source == "start" and not effects and not body:
        return Line(f"first start then {target}")
    parts = [head, f"first {source}"]
    parts += [accept] if accept else []
    if guard is not None and str(guard).strip() != "else":
        parts.append(f"if {format_condition(writer, member, element, str(guard))}")
    elif guard is not None:
        parts.append(f"if {_format_else(writer, member, element)}")
    effect = write_subaction(writer, member, "do", effects[0]) if effects else None
    end = f"then {target}"
    if effect is not None and effect.body:
        return Line(_wrap([*parts, effect.head]), effect.body, tail=end, tail_body=body)
    parts += [] if effect is None else [effect.head]
    return Line(_wrap([*parts, end]), body)


def _wrap(parts: list[str]) -> str:
    """Return the parts of a transition in one line, or one below the other if it is too long."""
    text = " ".join(parts)
    return text if len(text) <= _TRANSITION_WIDTH else "\n".join(parts)


def _format_else(writer: Writer, member: Member, element: Element) -> str:
    """Return the condition that no other transition from the same vertex is enabled."""
    source = writer.graph.target(element, Edge.FLOW_SOURCE)
    siblings = [] if source is None else writer.graph.sources(source, Edge.FLOW_SOURCE)
    conditions = [
        f"({format_condition(writer, member, sibling, str(sibling.attrs['guard']))})"
        for sibling in siblings
        if sibling is not element and sibling.attrs.get("guard") not in (None, "else")
    ]
    return f"not ({' or '.join(conditions)})" if conditions else "true"


def _format_end(writer: Writer, member: Member, element: Element, edge: Edge) -> str | None:
    """Return the name of the source or target; ``start`` and ``done`` for vertices without one."""
    vertex = writer.graph.target(element, edge)
    if vertex is None:
        return None
    if writer.plan.find(vertex) is not None:
        return format_element_reference(writer.plan, member.parent, vertex)
    writer.expressed.add(vertex.id)
    word = "start" if vertex.kind is Kind.PSEUDOSTATE else "done"
    for ancestor in writer.graph.ancestors(vertex):
        behaviour = writer.plan.find(ancestor)
        if behaviour is None:
            continue
        if behaviour is member.parent:
            return word
        name = format_element_reference(writer.plan, member.parent, behaviour.element)
        return None if name is None else f"{name}.{word}"
    return word
