"""The whole text: the plan, then every member, then what was not said."""

from sysmlc.backends.sysml import (
    actions,
    annotations,
    automation,
    behaviours,
    connections,
    constraints,
    imports,
    instances,
    interactions,
    objectflows,
    pins,
    relations,
    states,
    structure,
    texts,
    usecases,
)
from sysmlc.backends.sysml.account import account
from sysmlc.backends.sysml.book import Book, Writer
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.hiding import name_apart
from sysmlc.backends.sysml.naming import name_all
from sysmlc.backends.sysml.plan import make_plan
from sysmlc.backends.sysml.printing import Line, printed
from sysmlc.backends.sysml.profiles import define
from sysmlc.backends.sysml.rules import Losses
from sysmlc.backends.sysml.words import quoted
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind
from sysmlc.support.recursion import allow_recursion


def document(graph: Graph, sink: Sink) -> tuple[str, bool]:
    """The text, and whether it uses our library; what it cannot say is reported.

    It is written again when it refers to what is private in the model, or to what turned out
    to have no place.
    """
    book, lines = written(graph)
    book.losses.report(sink)
    return printed(lines), book.uses_library


def written(graph: Graph) -> tuple[Book, list[Line]]:
    """What the text is printed from, with the losses of each element."""
    public: frozenset[str] = frozenset()
    dropped: dict[str, str] = {}
    while True:
        book, lines = _written(graph, public, frozenset(dropped))
        if public >= book.plan.shown and dropped.keys() >= book.dropped.keys():
            break
        public, dropped = public | book.plan.shown, dropped | book.dropped
    account(book, dropped)
    return book, lines


def _written(
    graph: Graph, public: frozenset[str], dropped: frozenset[str]
) -> tuple[Book, list[Line]]:
    losses = Losses(graph)
    plan = make_plan(graph, losses, dropped)
    plan.applied = define(plan)
    name_all(plan)
    name_apart(plan)
    caex = frozenset(one.source for one in graph.of_kind(Kind.DOCUMENT) if one.subkind == "caex")
    book = Book(graph, plan, losses, WRITERS, public=public, caex=caex)
    relations.prepare(book)
    with allow_recursion(plan.depth):
        return book, [line for top in plan.tops for line in book.member(top)]


def _added(book: Book, entry: Entry) -> list[Line]:
    """A member that no element stands for."""
    if entry.shape.keyword == "package":
        return structure.package(book, entry)
    type_ = book.plan.added.get(id(entry), "")
    head = f"{entry.shape.keyword} {quoted(entry.name)}{' : ' if type_ else ''}{type_}"
    profile = book.plan.profiles.get(id(entry))
    body = [annotations.ours(book, entry, "External", {"href": profile})] if profile else []
    return [Line(head, body + book.members(entry))]


WRITERS: dict[str, Writer] = {
    "": _added,
    Kind.PACKAGE: structure.package,
    Kind.PROFILE: structure.package,
    Kind.CLASS: relations.class_,
    Kind.COMPONENT: structure.classifier,
    Kind.ACTOR: structure.classifier,
    Kind.INTERFACE: structure.classifier,
    Kind.DATA_TYPE: structure.value_type,
    Kind.ENUMERATION: structure.enumeration,
    Kind.ENUMERATION_LITERAL: structure.enumerated,
    Kind.SIGNAL: structure.classifier,
    Kind.ITEM: structure.classifier,
    Kind.STEREOTYPE: structure.classifier,
    Kind.PROPERTY: structure.property_,
    Kind.FLOW_PROPERTY: structure.feature,
    Kind.PORT: structure.port,
    Kind.OPERATION: structure.operation,
    Kind.RECEPTION: structure.reception,
    Kind.PARAMETER: structure.parameter,
    Kind.ASSOCIATION: structure.association,
    Kind.CONNECTOR: connections.connector,
    Kind.ITEM_FLOW: connections.item_flow,
    Kind.INSTANCE: instances.instance,
    Kind.CONSTRAINT: constraints.constraint,
    Kind.COMMENT: texts.comment,
    Kind.DEPENDENCY: relations.dependency,
    Kind.REQUIREMENT: relations.requirement,
    Kind.IMPORT: imports.import_,
    Kind.DOCUMENT: automation.facts,
    Kind.METADATA: automation.facts,
    Kind.ALIAS: automation.facts,
    Kind.ACTIVITY: behaviours.behaviour,
    Kind.STATE_MACHINE: behaviours.behaviour,
    Kind.TEST_CASE: behaviours.behaviour,
    Kind.ACTION: actions.action,
    Kind.STRUCTURED: actions.structured,
    Kind.CONTROL: actions.control,
    Kind.PIN: pins.pin,
    Kind.ACTIVITY_PARAMETER: pins.pin,
    Kind.OBJECT_NODE: pins.object_node,
    Kind.DATA_STORE: pins.object_node,
    Kind.OBJECT_FLOW: objectflows.object_flow,
    Kind.CONTROL_FLOW: actions.nothing,
    Kind.INTERACTION: behaviours.behaviour,
    Kind.LIFELINE: interactions.lifeline,
    Kind.MESSAGE: interactions.message,
    Kind.FRAGMENT: interactions.fragment,
    Kind.OPERAND: interactions.fragment,
    Kind.USE_CASE: usecases.use_case,
    Kind.EXTEND: usecases.extend,
    Kind.EXTENSION_POINT: usecases.extension_point,
    Kind.STATE: states.state,
    Kind.REGION: states.region,
    Kind.PSEUDOSTATE: states.pseudostate,
    Kind.TRANSITION: states.transition,
    Kind.FACET: automation.group,
    Kind.GROUP: automation.group,
}
"""Writer by kind of element; the empty kind is for members that the text adds itself."""
