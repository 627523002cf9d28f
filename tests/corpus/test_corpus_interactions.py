"""Nothing of UML is left out: metaclasses, interactions, templates; counted without our reader."""

from collections import Counter

import pytest
from lxml import etree

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND, lowering, metaclasses
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.query import interactions, templates
from sysmlc.passes import pipeline
from sysmlc.sources import load

pytestmark = pytest.mark.corpus

FOLDERS = ("papyrus", "magicdraw", "md-eclipse-export", "omg", "profile", "ea")
WITHIN_OTHERS = {
    "Clause": "clauses of conditionals are an attribute",
    "ExceptionHandler": "handlers are an attribute of the protected node",
    "LinkEndData": "ends of links are an attribute of the action",
    "LinkEndCreationData": "as LinkEndData",
    "LinkEndDestructionData": "as LinkEndData",
    "QualifierValue": "inside LinkEndData",
}
"""Metaclasses that only stand in features which have readers of their own."""

_XSI_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"


def compiled(path):
    graph, sink = Graph(), Sink()
    FRONTEND.read(load(path, path.name), graph, sink, Coverage())
    pipeline.run(graph, sink, until="interactions")
    return graph, sink


def trees(path):
    parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
    return [etree.fromstring(source.data, parser) for source in load(path, path.name)]


def typed(path, name):
    """Elements whose ``xmi:type`` is ``uml:<name>`` and that are not references."""
    return [
        element
        for tree in trees(path)
        for element in tree.iter("*")
        if "href" not in element.attrib
        and any(k.endswith("}type") and v == f"uml:{name}" for k, v in element.attrib.items())
    ]


def test_every_metaclass_of_uml_is_read(corpus):
    root = etree.parse(corpus / "xmi" / "metamodel" / "uml.ecore").getroot()
    concrete = {
        found.get("name")
        for found in root.iter("eClassifiers")
        if found.get(_XSI_TYPE) == "ecore:EClass"
        and "true" not in (found.get("abstract"), found.get("interface"))
    }
    assert len(concrete) > 150
    known = {*lowering._TYPES, *metaclasses.VALUE_TYPES, *WITHIN_OTHERS}
    assert {name for name in concrete - known if metaclasses.kind_of(name) is None} == set()
    assert {"clause", "handler", "endData"} <= lowering._FEATURES.keys()


@pytest.mark.parametrize("folder", FOLDERS)
def test_only_stereotypes_of_nothing_are_unsupported(folder, corpus):
    for path in sorted((corpus / "xmi" / folder).iterdir()):
        if path.suffix == ".ecore":
            continue
        sink = Sink()
        FRONTEND.read(load(path, path.name), Graph(), sink, Coverage())
        assert [f.message for f in sink if f.rule.code == "SM111"] == [], path.name


def test_interactions_have_all_their_parts(corpus):
    total = Counter()
    for name in ("papyrus/Arrowhead-5.0.uml", "papyrus/CraneModel.uml", "papyrus/RoboCab.uml"):
        path = corpus / "xmi" / name
        graph, _ = compiled(path)
        for metaclass, kind in (
            ("Interaction", Kind.INTERACTION),
            ("Lifeline", Kind.LIFELINE),
            ("Message", Kind.MESSAGE),
            ("MessageOccurrenceSpecification", Kind.OCCURRENCE),
            ("BehaviorExecutionSpecification", Kind.EXECUTION),
            ("CollaborationUse", Kind.COLLABORATION_USE),
        ):
            found = typed(path, metaclass)
            assert len(graph.of_kind(kind)) == len(found), (name, metaclass)
            total[metaclass] += len(found)
    assert min(total.values()) >= 1


@pytest.mark.parametrize("name", ["Arrowhead-5.0.uml", "CraneModel.uml", "AllDiagrams.uml"])
def test_messages_lead_between_lifelines_in_the_order_of_the_file(name, corpus):
    path = corpus / "xmi" / "papyrus" / name
    graph, _ = compiled(path)
    for interaction in graph.of_kind(Kind.INTERACTION):
        happening = [e.id for e in interactions.interaction_fragments(graph, interaction)]
        written = [
            _id(element)
            for tree in trees(path)
            for element in tree.iter("fragment")
            if _id(element.getparent()) == interaction.id
        ]
        assert happening == written
        for message in interactions.messages(graph, interaction):
            for event, end in (
                (Edge.SEND_EVENT, Edge.FLOW_SOURCE),
                (Edge.RECEIVE_EVENT, Edge.FLOW_TARGET),
            ):
                occurrence = graph.target(message, event)
                assert interactions.covered_lifelines(graph, occurrence) == [
                    graph.target(message, end)
                ]


def _id(element):
    return next((v for k, v in element.attrib.items() if k.endswith("}id")), None)


def test_the_combined_fragment_of_tank_control(corpus):
    graph, _ = compiled(corpus / "xmi" / "magicdraw" / "Tank_control_2.mdzip")
    (fragment,) = graph.of_kind(Kind.FRAGMENT)
    assert fragment.subkind == "neg"
    (operand,) = interactions.operands(graph, fragment)
    sent, received = interactions.interaction_fragments(graph, operand)
    assert interactions.sent_message(graph, sent) is interactions.received_message(graph, received)
    assert len(interactions.covered_lifelines(graph, fragment)) == 1


@pytest.mark.long
def test_every_binding_of_the_alf_library_leads_to_its_template(corpus):
    path = corpus / "xmi" / "papyrus" / "Alf.library.uml"
    graph, sink = compiled(path)
    assert not sink.has_errors()
    bound = [graph.owner(item) for item in graph.of_kind(Kind.TEMPLATE_BINDING)]
    found = [one for element in bound for one in templates.bindings(graph, element)]
    written = [e for tree in trees(path) for e in tree.iter("templateBinding")]
    assert len(found) == len(written) > 70
    for binding in found:
        formal = templates.parameters(graph, binding.template)
        assert formal
        assert [one.formal for one in binding.substitutions] == formal[: len(binding.substitutions)]
        assert all(one.actual is not None for one in binding.substitutions)
