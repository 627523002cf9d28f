"""Back end ``sysml``: the compile unit as text of SysML v2, with ``SysMLC.sysml`` if needed.

Texts of SysML v2 remain as their authors wrote them; ``author_texts`` inserts what passes add. All
other elements are printed from the graph.

The text is written in steps: ``placement`` decides where members stand, ``naming`` names them,
``WRITERS`` write their lines, and ``rules`` counts the losses.
"""

import posixpath

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.backends.base import EmitOptions, name_compile_unit
from sysmlc.backends.sysml import (
    actions,
    activity_flows,
    behaviours,
    comments,
    connections,
    constraints,
    definitions,
    dependencies,
    features,
    instances,
    interactions,
    states,
    use_cases,
)
from sysmlc.backends.sysml.annotations import make_annotation
from sysmlc.backends.sysml.author_texts import (
    Insertions,
    edit_text,
    is_whole_model,
    list_texts,
    path_of_text,
    report_changes,
    write_insertions,
)
from sysmlc.backends.sysml.coverage import record_omissions
from sysmlc.backends.sysml.naming import assign_names, rename_hiding_members
from sysmlc.backends.sysml.placement import make_plan
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, print_lines, quote_name
from sysmlc.backends.sysml.profiles import define_stereotypes
from sysmlc.backends.sysml.rules import Losses
from sysmlc.backends.sysml.writer import WriteMember, Writer
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind
from sysmlc.support import resources
from sysmlc.support.interpreter import allow_recursion
from sysmlc.support.output import Output, assign_file_names, fold_path

LIBRARY = "SysMLC.sysml"
"""The library of metadata definitions to which the text refers."""


class SysmlBackend(Struct, frozen=True):
    """Writes the graph of any front end as SysML v2 text."""

    name: str = "sysml"
    summary: str = "the model as SysML v2 text, sysml/*.sysml"
    is_default: bool = False
    needs: tuple[str, ...] = ("recipe",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the texts of the authors and ``sysml/<unit>.sysml``; report what texts omit."""
        documents = list_texts(graph)
        author_files = frozenset(document.path for document in documents)
        paths = {path_of_text(document) for document in documents}
        insertions: Insertions = {}
        if not documents or not is_whole_model(graph, author_files):
            writer, lines = write_document(graph, author_files)
            writer.losses.report(sink)
            insertions = writer.insertions
            if lines or not documents:
                path = _name_file(graph, options, author_files, paths)
                output.add(f"sysml/{path}", print_lines(lines), (), self.name)
            if writer.uses_library and LIBRARY not in paths:
                library = resources.read_text("metamodels", LIBRARY)
                output.add(f"sysml/{LIBRARY}", library, (), self.name)
        report_changes(graph, author_files, sink)
        for document in documents:
            text = edit_text(document, insertions)
            output.add(f"sysml/{path_of_text(document)}", text, (), self.name)


def _name_file(
    graph: Graph, options: EmitOptions, author_files: frozenset[str], taken: set[str]
) -> str:
    """Return the path of the text that is printed from the graph.

    It is named after the first input that is no text of an author: by its name without suffix,
    or by the whole name if an author has a file of that name.
    """
    inputs = tuple(file for file in options.inputs if file.path not in author_files)
    unit = name_compile_unit(graph, replace(options, inputs=inputs))
    path = f"{assign_file_names([unit])[unit]}.sysml"
    if fold_path(path) not in set(map(fold_path, taken)):
        return path
    whole_name = posixpath.basename(inputs[0].path) if inputs else f"{unit}.graph"
    return f"{assign_file_names([whole_name])[whole_name]}.sysml"


def print_document(graph: Graph, sink: Sink) -> tuple[str, bool]:
    """Return the text of a graph, and whether it uses the library ``SysMLC``. Report the losses.

    The text contains all elements, also those of texts in SysML v2.
    """
    writer, lines = write_document(graph)
    writer.losses.report(sink)
    return print_lines(lines), writer.uses_library


def write_document(
    graph: Graph, author_files: frozenset[str] = frozenset()
) -> tuple[Writer, list[Line]]:
    """Return the lines of the text, and the writer with the losses of each element.

    The lines omit the elements of *author_files*; the writer has the insertions into these files.
    The text is written again until no reference leads to a private or a dropped element: whether
    the text refers to an element is known only after it is written.
    """
    public_ids: frozenset[str] = frozenset()
    dropped: dict[str, str] = {}
    while True:
        writer, lines = _write_once(graph, author_files, public_ids, frozenset(dropped))
        exposed = writer.plan.exposed
        if public_ids >= exposed and dropped.keys() >= writer.dropped.keys():
            break
        public_ids, dropped = public_ids | exposed, dropped | writer.dropped
    record_omissions(writer, dropped)
    return writer, lines


def _write_once(
    graph: Graph,
    author_files: frozenset[str],
    public_ids: frozenset[str],
    dropped: frozenset[str],
) -> tuple[Writer, list[Line]]:
    losses = Losses(graph, author_files)
    plan = make_plan(graph, losses, dropped)
    plan.metadata_definitions = define_stereotypes(plan)
    assign_names(plan)
    rename_hiding_members(plan)
    documents = graph.of_kind(Kind.DOCUMENT)
    caex_files = frozenset(d.source for d in documents if d.subkind == "caex" and d.source)
    writer = Writer(graph, plan, losses, WRITERS, public_ids=public_ids, caex_files=caex_files)
    dependencies.prewrite_dependencies(writer)
    with allow_recursion(plan.depth):
        roots = [root for root in plan.roots if not plan.is_author_member(root)]
        lines = [line for root in roots for line in writer.write_member(root)]
        write_insertions(writer)
    return writer, lines


def _write_added_member(writer: Writer, member: Member) -> list[Line]:
    """Write a member without an element: a package, a metadata definition or its attribute."""
    if member.shape.keyword == "package":
        return definitions.write_package(writer, member)
    type_ = member.added_type
    head = f"{member.shape.keyword} {quote_name(member.name)}{' : ' if type_ else ''}{type_}"
    profile = member.profile_namespace
    body = [make_annotation(writer, member, "External", {"href": profile})] if profile else []
    return [Line(head, body + writer.write_members(member))]


WRITERS: dict[str, WriteMember] = {
    "": _write_added_member,
    Kind.PACKAGE: definitions.write_package,
    Kind.PROFILE: definitions.write_package,
    Kind.IMPORT: definitions.write_import,
    Kind.CLASS: definitions.write_class,
    Kind.COMPONENT: definitions.write_definition,
    Kind.ACTOR: definitions.write_definition,
    Kind.INTERFACE: definitions.write_definition,
    Kind.SIGNAL: definitions.write_definition,
    Kind.ITEM: definitions.write_definition,
    Kind.STEREOTYPE: definitions.write_definition,
    Kind.DATA_TYPE: definitions.write_value_type,
    Kind.ENUMERATION: definitions.write_enumeration,
    Kind.ENUMERATION_LITERAL: definitions.write_enumeration_literal,
    Kind.REQUIREMENT: definitions.write_requirement,
    Kind.PROPERTY: features.write_property,
    Kind.FLOW_PROPERTY: features.write_feature,
    Kind.PORT: features.write_port,
    Kind.OPERATION: features.write_operation,
    Kind.RECEPTION: features.write_reception,
    Kind.PARAMETER: features.write_parameter,
    Kind.PIN: features.write_pin,
    Kind.ACTIVITY_PARAMETER: features.write_pin,
    Kind.OBJECT_NODE: features.write_object_node,
    Kind.DATA_STORE: features.write_object_node,
    Kind.ASSOCIATION: connections.write_association,
    Kind.CONNECTOR: connections.write_connector,
    Kind.ITEM_FLOW: connections.write_item_flow,
    Kind.INSTANCE: instances.write_instance,
    Kind.CONSTRAINT: constraints.write_constraint,
    Kind.DEPENDENCY: dependencies.write_dependency,
    Kind.COMMENT: comments.write_comment,
    Kind.DOCUMENT: comments.write_document,
    Kind.METADATA: comments.write_document,
    Kind.ALIAS: comments.write_document,
    Kind.FACET: comments.write_group,
    Kind.GROUP: comments.write_group,
    Kind.ACTIVITY: behaviours.write_behaviour,
    Kind.STATE_MACHINE: behaviours.write_behaviour,
    Kind.TEST_CASE: behaviours.write_behaviour,
    Kind.INTERACTION: behaviours.write_behaviour,
    Kind.ACTION: actions.write_action,
    Kind.STRUCTURED: actions.write_structured_node,
    Kind.CONTROL: actions.write_control_node,
    Kind.CONTROL_FLOW: actions.write_control_flow,
    Kind.OBJECT_FLOW: activity_flows.write_object_flow,
    Kind.STATE: states.write_state,
    Kind.REGION: states.write_region,
    Kind.PSEUDOSTATE: states.write_pseudostate,
    Kind.TRANSITION: states.write_transition,
    Kind.LIFELINE: interactions.write_lifeline,
    Kind.MESSAGE: interactions.write_message,
    Kind.FRAGMENT: interactions.write_fragment,
    Kind.OPERAND: interactions.write_fragment,
    Kind.USE_CASE: use_cases.write_use_case,
    Kind.EXTEND: use_cases.write_extend,
    Kind.EXTENSION_POINT: use_cases.write_extension_point,
}
"""Writer by kind of element; the empty kind is for members that the back end adds itself."""

BACKEND = SysmlBackend()
