"""All of UML is read: metaclasses, interactions and templates, as counted by lxml."""

from collections import Counter

import pytest
from lxml import etree
from reading_corpus import XMI_FOLDERS, find_typed, load_files, lower, parse_data, xmi_id

from sysmlc.frontends.xmi import lowering, metaclasses
from sysmlc.ir import Edge, Kind
from sysmlc.ir.query import interactions, templates
from sysmlc.passes import pipeline

pytestmark = pytest.mark.corpus

WITHIN_OTHERS = {
    "Clause": "clauses of conditionals are an attribute",
    "ExceptionHandler": "handlers are an attribute of the protected node",
    "LinkEndData": "ends of links are an attribute of the action",
    "LinkEndCreationData": "as LinkEndData",
    "LinkEndDestructionData": "as LinkEndData",
    "QualifierValue": "inside LinkEndData",
}
"""Metaclasses that occur only in features with readers of their own."""

_XSI_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"


def read_with_interactions(path):
    """Return the graph after the passes up to ``interactions``, and the diagnostics."""
    graph, sink = lower(load_files(path))
    pipeline.run(graph, sink, until="interactions")
    return graph, sink


def parse_file(path):
    return [parse_data(source.data) for source in load_files(path)]


def test_every_metaclass_of_uml_is_read(corpus):
    root = etree.parse(corpus / "xmi" / "metamodel" / "uml.ecore").getroot()
    concrete = {
        classifier.get("name")
        for classifier in root.iter("eClassifiers")
        if classifier.get(_XSI_TYPE) == "ecore:EClass"
        and "true" not in (classifier.get("abstract"), classifier.get("interface"))
    }
    assert len(concrete) > 150
    readable = {*lowering._TYPES, *metaclasses.VALUE_TYPES, *WITHIN_OTHERS}
    assert {name for name in concrete - readable if metaclasses.kind_of(name) is None} == set()
    assert {"clause", "handler", "endData"} <= lowering._FEATURES.keys()


@pytest.mark.parametrize("folder", XMI_FOLDERS)
def test_no_element_is_reported_as_unsupported(folder, corpus):
    for path in sorted((corpus / "xmi" / folder).iterdir()):
        if path.suffix == ".ecore":
            continue
        _, sink = lower(load_files(path))
        assert [
            diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM111"
        ] == [], path.name


def test_interactions_have_all_parts_of_the_file(corpus):
    total = Counter()
    for name in ("papyrus/Arrowhead-5.0.uml", "papyrus/CraneModel.uml", "papyrus/RoboCab.uml"):
        path = corpus / "xmi" / name
        graph, _ = read_with_interactions(path)
        for metaclass, kind in (
            ("Interaction", Kind.INTERACTION),
            ("Lifeline", Kind.LIFELINE),
            ("Message", Kind.MESSAGE),
            ("MessageOccurrenceSpecification", Kind.OCCURRENCE),
            ("BehaviorExecutionSpecification", Kind.EXECUTION),
            ("CollaborationUse", Kind.COLLABORATION_USE),
        ):
            elements = find_typed(parse_file(path), metaclass)
            assert len(graph.of_kind(kind)) == len(elements), (name, metaclass)
            total[metaclass] += len(elements)
    assert min(total.values()) >= 1


@pytest.mark.parametrize("name", ["Arrowhead-5.0.uml", "CraneModel.uml", "AllDiagrams.uml"])
def test_messages_connect_lifelines_in_the_order_of_the_file(name, corpus):
    path = corpus / "xmi" / "papyrus" / name
    graph, _ = read_with_interactions(path)
    for interaction in graph.of_kind(Kind.INTERACTION):
        fragments = [e.id for e in interactions.interaction_fragments(graph, interaction)]
        fragments_in_file = [
            xmi_id(element)
            for tree in parse_file(path)
            for element in tree.iter("fragment")
            if xmi_id(element.getparent()) == interaction.id
        ]
        assert fragments == fragments_in_file
        for message in interactions.messages(graph, interaction):
            for event, end in (
                (Edge.SEND_EVENT, Edge.FLOW_SOURCE),
                (Edge.RECEIVE_EVENT, Edge.FLOW_TARGET),
            ):
                occurrence = graph.target(message, event)
                assert interactions.covered_lifelines(graph, occurrence) == [
                    graph.target(message, end)
                ]


def test_a_message_in_a_combined_fragment_has_both_ends(corpus):
    graph, _ = read_with_interactions(corpus / "xmi" / "magicdraw" / "Tank_control_2.mdzip")
    (fragment,) = graph.of_kind(Kind.FRAGMENT)
    assert fragment.subkind == "neg"
    (operand,) = interactions.operands(graph, fragment)
    sending, receiving = interactions.interaction_fragments(graph, operand)
    assert interactions.sent_message(graph, sending) is interactions.received_message(
        graph, receiving
    )
    assert len(interactions.covered_lifelines(graph, fragment)) == 1


@pytest.mark.long
def test_every_binding_of_the_alf_library_names_its_template(corpus):
    path = corpus / "xmi" / "papyrus" / "Alf.library.uml"
    graph, sink = read_with_interactions(path)
    assert not sink.has_errors()
    bindings = [
        templates.read_binding(graph, graph.owner(item), item)
        for item in graph.of_kind(Kind.TEMPLATE_BINDING)
    ]
    elements = [e for tree in parse_file(path) for e in tree.iter("templateBinding")]
    assert len(bindings) == len(elements) > 70
    for binding in bindings:
        formal = templates.parameters(graph, binding.template)
        assert formal
        assert [binding.formal for binding in binding.substitutions] == formal[
            : len(binding.substitutions)
        ]
        assert all(binding.actual is not None for binding in binding.substitutions)
