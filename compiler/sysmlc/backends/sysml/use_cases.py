"""Use cases with their subjects, actors, inclusions and extensions."""

from collections.abc import Iterator

from sysmlc.backends.sysml.connections import find_actor_end
from sysmlc.backends.sysml.declarations import make_definition_head
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import type_of


def write_use_case(writer: Writer, member: Member) -> list[Line]:
    """Write a use case definition; SysML v2 allows one subject."""
    element = member.require_element()
    subjects = writer.refer_to_targets(member, element, Edge.SUBJECT)
    body = [Line(f"subject : {subject}") for subject in subjects[:1]]
    for subject in writer.graph.targets(element, Edge.SUBJECT)[1:]:
        writer.record_unreachable(subject, "subject")
    for end_name, actor in _iter_actors(writer.graph, element):
        type_name = writer.refer_to(member, element, Edge.REFERENCES, actor)
        name = f" {quote_name(end_name)}" if end_name else ""
        body += [] if type_name is None else [Line(f"actor{name} : {type_name}")]
    for included in writer.refer_to_targets(member, element, Edge.INCLUDES):
        body.append(Line(f"include use case : {included}"))
    head = make_definition_head(writer, member).format()
    return [Line(head, body + write_contents(writer, member))]


def _iter_actors(graph: Graph, use_case: Element) -> Iterator[tuple[str, Element]]:
    """Yield the actors that associations connect with a use case, with the names of their ends.

    An association with a line of its own expresses the name of its end itself.
    """
    for end in graph.sources(use_case, Edge.TYPED_BY):
        for association in graph.sources(end, Edge.END):
            actor_end = find_actor_end(graph, association)
            if actor_end is not None:
                type_ = type_of(graph, actor_end)
                if type_ is not None:
                    yield actor_end.name, type_
                continue
            for association_end in graph.targets(association, Edge.END):
                type_ = type_of(graph, association_end)
                if type_ is not None and type_.kind is Kind.ACTOR:
                    yield "", type_


def write_extend(writer: Writer, member: Member) -> list[Line]:
    """Write an extension: a dependency on the extended use case and its extension points."""
    element = member.require_element()
    keyword = writer.refer_to_sysmlc(member.parent, "extension")
    owner = "" if member.parent is None else quote_name(member.parent.name)
    targets = writer.refer_to_targets(member.parent, element, Edge.EXTENDS)
    targets += writer.refer_to_targets(member.parent, element, Edge.REFERENCES)
    if not targets:
        return writer.drop(member, "extends")
    name = f"{quote_name(member.name)} " if member.name else ""
    head = f"#{keyword} dependency {name}from {owner} to {', '.join(targets)}"
    return [Line(head, write_contents(writer, member))]


def write_extension_point(writer: Writer, member: Member) -> list[Line]:
    """Write an extension point: an event of the use case."""
    return [Line(f"event occurrence {quote_name(member.name)}", write_contents(writer, member))]
