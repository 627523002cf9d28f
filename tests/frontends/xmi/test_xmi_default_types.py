"""Elements without ``xmi:type``: Eclipse leaves out what is the declared type (UML 2.5.1)."""

import pytest
from lxml import etree
from reading_xmi import below_model, papyrus, read

from sysmlc.frontends.xmi.metaclasses import DEFAULT_TYPES
from sysmlc.frontends.xmi.uml_features import is_misplaced

CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="k">%s</packagedElement>'
INTERFACE = '<packagedElement xmi:type="uml:Interface" xmi:id="k">%s</packagedElement>'
COMPONENT = '<packagedElement xmi:type="uml:Component" xmi:id="k">%s</packagedElement>'
ASSOCIATION = '<packagedElement xmi:type="uml:Association" xmi:id="k">%s</packagedElement>'
ENUMERATION = '<packagedElement xmi:type="uml:Enumeration" xmi:id="k">%s</packagedElement>'
INSTANCE = '<packagedElement xmi:type="uml:InstanceSpecification" xmi:id="k">%s</packagedElement>'
USE_CASE = '<packagedElement xmi:type="uml:UseCase" xmi:id="k">%s</packagedElement>'
INTERACTION = '<packagedElement xmi:type="uml:Interaction" xmi:id="k">%s</packagedElement>'
NODE = '<packagedElement xmi:type="uml:Node" xmi:id="k">%s</packagedElement>'
ARTIFACT = '<packagedElement xmi:type="uml:Artifact" xmi:id="k">%s</packagedElement>'
ACTIVITY = '<packagedElement xmi:type="uml:Activity" xmi:id="k">%s</packagedElement>'
MACHINE = '<packagedElement xmi:type="uml:StateMachine" xmi:id="k">%s</packagedElement>'
REGION = MACHINE % '<region xmi:id="r">%s<subvertex xmi:type="uml:State" xmi:id="s"/></region>'
STATE = (
    MACHINE
    % '<region xmi:id="r"><subvertex xmi:type="uml:State" xmi:id="s">%s</subvertex></region>'
)


def action(metaclass):
    return ACTIVITY % f'<node xmi:type="uml:{metaclass}" xmi:id="n">%s</node>'


PLACES = [
    ("ownedParameter", "Parameter", CLASS % '<ownedOperation xmi:id="o">%s</ownedOperation>'),
    ("ownedParameter", "Parameter", ACTIVITY),
    (
        "ownedParameter",
        "TemplateParameter",
        CLASS % '<ownedTemplateSignature xmi:id="o">%s</ownedTemplateSignature>',
    ),
    ("ownedTemplateSignature", "TemplateSignature", CLASS),
    ("templateBinding", "TemplateBinding", CLASS),
    (
        "parameterSubstitution",
        "TemplateParameterSubstitution",
        CLASS % '<templateBinding xmi:id="o">%s</templateBinding>',
    ),
    ("ownedComment", "Comment", "%s"),
    ("ownedRule", "Constraint", CLASS),
    ("packageImport", "PackageImport", "%s"),
    ("packageMerge", "PackageMerge", "%s"),
    ("elementImport", "ElementImport", "%s"),
    ("profileApplication", "ProfileApplication", "%s"),
    ("generalization", "Generalization", CLASS),
    ("interfaceRealization", "InterfaceRealization", CLASS),
    ("substitution", "Substitution", CLASS),
    ("realization", "ComponentRealization", COMPONENT),
    ("ownedAttribute", "Property", CLASS),
    ("ownedOperation", "Operation", CLASS),
    ("ownedReception", "Reception", CLASS),
    ("ownedConnector", "Connector", CLASS),
    ("end", "ConnectorEnd", CLASS % '<ownedConnector xmi:id="o">%s</ownedConnector>'),
    ("qualifier", "Property", CLASS % '<ownedAttribute xmi:id="o">%s</ownedAttribute>'),
    ("ownedUseCase", "UseCase", CLASS),
    ("collaborationUse", "CollaborationUse", CLASS),
    ("protocol", "ProtocolStateMachine", INTERFACE),
    ("ownedEnd", "Property", ASSOCIATION),
    ("ownedLiteral", "EnumerationLiteral", ENUMERATION),
    ("slot", "Slot", INSTANCE),
    ("include", "Include", USE_CASE),
    ("extend", "Extend", USE_CASE),
    ("extensionPoint", "ExtensionPoint", USE_CASE),
    ("lifeline", "Lifeline", INTERACTION),
    ("message", "Message", INTERACTION),
    ("formalGate", "Gate", INTERACTION),
    ("nestedNode", "Node", NODE),
    ("deployment", "Deployment", NODE),
    ("nestedArtifact", "Artifact", ARTIFACT),
    ("manifestation", "Manifestation", ARTIFACT),
    ("region", "Region", MACHINE),
    ("region", "Region", STATE),
    ("connectionPoint", "Pseudostate", MACHINE),
    ("connection", "ConnectionPointReference", STATE),
    ("deferrableTrigger", "Trigger", STATE),
    ("transition", "Transition", REGION),
    ("trigger", "Trigger", REGION % '<transition xmi:id="t">%s</transition>'),
    ("structuredNode", "StructuredActivityNode", ACTIVITY),
    (
        "subpartition",
        "ActivityPartition",
        ACTIVITY % '<group xmi:type="uml:ActivityPartition" xmi:id="g">%s</group>',
    ),
    ("structuredNodeInput", "InputPin", action("StructuredActivityNode")),
    ("structuredNodeOutput", "OutputPin", action("StructuredActivityNode")),
    ("loopVariable", "OutputPin", action("LoopNode")),
    ("loopVariableInput", "InputPin", action("LoopNode")),
    ("result", "OutputPin", action("LoopNode")),
    ("clause", "Clause", action("ConditionalNode")),
    ("handler", "ExceptionHandler", action("OpaqueAction")),
    ("inputValue", "InputPin", action("OpaqueAction")),
    ("outputValue", "OutputPin", action("OpaqueAction")),
    ("localPrecondition", "Constraint", action("OpaqueAction")),
    ("localPostcondition", "Constraint", action("OpaqueAction")),
    ("argument", "InputPin", action("CallBehaviorAction")),
    ("result", "OutputPin", action("CallBehaviorAction")),
    ("target", "InputPin", action("CallOperationAction")),
    ("request", "InputPin", action("SendObjectAction")),
    ("trigger", "Trigger", action("AcceptEventAction")),
    ("result", "OutputPin", action("AcceptEventAction")),
    ("returnInformation", "OutputPin", action("AcceptCallAction")),
    ("returnInformation", "InputPin", action("ReplyAction")),
    ("replyValue", "InputPin", action("ReplyAction")),
    ("object", "InputPin", action("ReadStructuralFeatureAction")),
    ("value", "InputPin", action("AddStructuralFeatureValueAction")),
    ("insertAt", "InputPin", action("AddStructuralFeatureValueAction")),
    ("removeAt", "InputPin", action("RemoveStructuralFeatureValueAction")),
    ("result", "OutputPin", action("ValueSpecificationAction")),
    ("first", "InputPin", action("TestIdentityAction")),
    ("second", "InputPin", action("TestIdentityAction")),
    ("exception", "InputPin", action("RaiseExceptionAction")),
    ("collection", "InputPin", action("ReduceAction")),
    ("endData", "LinkEndData", action("ReadLinkAction")),
]


@pytest.mark.parametrize(
    ("feature", "metaclass", "place"), PLACES, ids=[f"{f}-{m}" for f, m, _ in PLACES]
)
def test_omitting_the_type_changes_nothing(feature, metaclass, place):
    is_unnamed = metaclass in _EDGES or is_misplaced(metaclass, "name")
    name = "" if is_unnamed else ' name="it"'
    plain = read(papyrus(place % f'<{feature} xmi:id="x"{name}/>'))
    typed = read(papyrus(place % f'<{feature} xmi:type="uml:{metaclass}" xmi:id="x"{name}/>'))
    assert below_model(plain) == below_model(typed)
    assert plain.findings == typed.findings == []


_EDGES = ("InterfaceRealization", "Include")
"""Relations that the graph has as edges: their names are reported as lost."""

OWN_READERS = {"icon", "mapping", "nameExpression", "subExpression", "when", "operand", "guard"}
"""Features whose content is a value or notation, or whose type depends on where it stands."""


@pytest.mark.corpus
def test_every_feature_of_the_metamodel_has_its_type(corpus):
    tree = etree.parse(corpus / "xmi" / "metamodel" / "uml.ecore")
    abstract = {c.get("name") for c in tree.iter("eClassifiers") if c.get("abstract") == "true"}
    declared = {
        (feature.get("name"), feature.get("eType").removeprefix("#//"))
        for feature in tree.iter("eStructuralFeatures")
        if feature.get("containment") == "true" and feature.get("derived") != "true"
        if feature.get("eType") and feature.get("name") not in OWN_READERS
    }
    concrete = {pair for pair in declared if pair[1] not in abstract}
    assert len(concrete) > 70
    differing = concrete - set(DEFAULT_TYPES.items())
    assert sorted(differing) == [
        ("ownedParameter", "TemplateParameter"),
        ("qualifier", "QualifierValue"),
        ("returnInformation", "InputPin"),
    ]


@pytest.mark.corpus
def test_the_features_that_the_corpus_leaves_untyped_are_all_tested(corpus):
    """The 36 features of the notes on XMI are these, icons, and columns of tool's tables."""
    untyped = {
        etree.QName(child).localname
        for path in sorted((corpus / "xmi").rglob("*.uml"))
        for child in etree.parse(path, etree.XMLParser(huge_tree=True)).getroot().iter()
        if _is_untyped_element(child)
    }
    tested = {feature for feature, _, _ in PLACES}
    assert len(untyped) == 34
    assert untyped - tested == set()


def _is_untyped_element(child):
    if not isinstance(child.tag, str) or child.tag.startswith("{") or _is_noted(child):
        return False
    keys = {str(name).rpartition("}")[2] for name in child.attrib if str(name).startswith("{")}
    return "id" in keys and not keys & {"type", "idref"} and child.tag != "icon"


def _is_noted(child):
    return any(
        etree.QName(above).localname in ("eAnnotations", "Extension")
        for above in (child, *child.iterancestors())
    )


def test_a_file_of_plain_emf_has_its_types_from_xml_schema():
    model = (
        '<packagedElement {0}type="uml:Class" xmi:id="k" name="K"><ownedAttribute xmi:id="p">'
        '<defaultValue {0}type="uml:LiteralInteger" xmi:id="v" value="3"/></ownedAttribute>'
        "</packagedElement>"
    )
    plain, usual = read(papyrus(model.format("xsi:"))), read(papyrus(model.format("xmi:")))
    assert plain.findings == []
    assert plain.text == usual.text
