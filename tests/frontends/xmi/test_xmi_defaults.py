"""What an absent attribute means: a tool may write the default or leave it out (UML 2.5.1)."""

import pytest
from lxml import etree
from reading_xmi import below_model, papyrus, read

CLASS = '<packagedElement xmi:type="uml:Class" xmi:id="k">%s</packagedElement>'
ACTIVITY = '<packagedElement xmi:type="uml:Activity" xmi:id="k">%s</packagedElement>'
REGION = (
    '<packagedElement xmi:type="uml:StateMachine" xmi:id="k"><region xmi:id="r">%s'
    '<subvertex xmi:type="uml:State" xmi:id="s"/></region></packagedElement>'
)
HOLDERS = {
    "Class": '<packagedElement xmi:type="uml:Class" xmi:id="x" {}/>',
    "Component": '<packagedElement xmi:type="uml:Component" xmi:id="x" {}/>',
    "Association": '<packagedElement xmi:type="uml:Association" xmi:id="x" {}/>',
    "Behavior": '<packagedElement xmi:type="uml:Activity" xmi:id="x" {}/>',
    "PackageImport": '<packageImport xmi:id="x" importedPackage="m" {}/>',
    "ElementImport": '<elementImport xmi:id="x" importedElement="m" {}/>',
    "GeneralizationSet": '<packagedElement xmi:type="uml:GeneralizationSet" xmi:id="x" {}/>',
    "TimeObservation": '<packagedElement xmi:type="uml:TimeObservation" xmi:id="x" {}/>',
    "Continuation": '<packagedElement xmi:type="uml:Interaction" xmi:id="k">'
    '<fragment xmi:type="uml:Continuation" xmi:id="x" {}/></packagedElement>',
    "CombinedFragment": '<packagedElement xmi:type="uml:Interaction" xmi:id="k">'
    '<fragment xmi:type="uml:CombinedFragment" xmi:id="x" {}/></packagedElement>',
    "Message": '<packagedElement xmi:type="uml:Interaction" xmi:id="k">'
    '<message xmi:id="x" {}/></packagedElement>',
}
IN_CLASS = {
    "Property": '<ownedAttribute xmi:type="uml:Property" xmi:id="x" {}/>',
    "Port": '<ownedAttribute xmi:type="uml:Port" xmi:id="x" {}/>',
    "Operation": '<ownedOperation xmi:type="uml:Operation" xmi:id="x" {}/>',
    "Parameter": '<ownedOperation xmi:id="o"><ownedParameter xmi:id="x" {}/></ownedOperation>',
    "Generalization": '<generalization xmi:id="x" general="k" {}/>',
}
IN_ACTIVITY = {
    "ObjectFlow": '<edge xmi:type="uml:ObjectFlow" xmi:id="x" {}/>',
    "CallBehaviorAction": '<node xmi:type="uml:CallBehaviorAction" xmi:id="x" {}/>',
    "AcceptEventAction": '<node xmi:type="uml:AcceptEventAction" xmi:id="x" {}/>',
    "AddStructuralFeatureValueAction": '<node xmi:type="uml:AddStructuralFeatureValueAction"'
    ' xmi:id="x" {}/>',
    "RemoveStructuralFeatureValueAction": '<node xmi:type="uml:RemoveStructuralFeatureValueAction"'
    ' xmi:id="x" {}/>',
    "DestroyObjectAction": '<node xmi:type="uml:DestroyObjectAction" xmi:id="x" {}/>',
    "ReadIsClassifiedObjectAction": '<node xmi:type="uml:ReadIsClassifiedObjectAction"'
    ' xmi:id="x" {}/>',
    "ReclassifyObjectAction": '<node xmi:type="uml:ReclassifyObjectAction" xmi:id="x" {}/>',
    "AddVariableValueAction": '<node xmi:type="uml:AddVariableValueAction" xmi:id="x" {}/>',
    "RemoveVariableValueAction": '<node xmi:type="uml:RemoveVariableValueAction" xmi:id="x" {}/>',
    "LinkEndCreationData": '<node xmi:type="uml:CreateLinkAction" xmi:id="n">'
    '<endData xmi:type="uml:LinkEndCreationData" xmi:id="x" {}/></node>',
    "LinkEndDestructionData": '<node xmi:type="uml:DestroyLinkAction" xmi:id="n">'
    '<endData xmi:type="uml:LinkEndDestructionData" xmi:id="x" {}/></node>',
    "ReduceAction": '<node xmi:type="uml:ReduceAction" xmi:id="x" {}/>',
    "JoinNode": '<node xmi:type="uml:JoinNode" xmi:id="x" {}/>',
    "CentralBufferNode": '<node xmi:type="uml:CentralBufferNode" xmi:id="x" {}/>',
    "LoopNode": '<node xmi:type="uml:LoopNode" xmi:id="x" {}/>',
    "ConditionalNode": '<node xmi:type="uml:ConditionalNode" xmi:id="x" {}/>',
    "ExpansionRegion": '<node xmi:type="uml:ExpansionRegion" xmi:id="x" {}/>',
    "ActivityPartition": '<group xmi:type="uml:ActivityPartition" xmi:id="x" {}/>',
    "InputPin": '<node xmi:type="uml:OpaqueAction" xmi:id="n"><inputValue xmi:id="x" {}/></node>',
}
IN_REGION = {
    "Pseudostate": '<subvertex xmi:type="uml:Pseudostate" xmi:id="x" {}/>',
    "Transition": '<transition xmi:id="x" source="s" target="s" {}/>',
}
DEFAULTS = """
Class isAbstract false            Class isActive false              Class isLeaf false
Class visibility public           Class isFinalSpecialization false
Component isIndirectlyInstantiated true                             Association isDerived false
Behavior isReentrant true         Behavior isReadOnly false         Behavior isSingleExecution false
Property aggregation none         Property isDerived false          Property isDerivedUnion false
Property isID false               Property isReadOnly false         Property isStatic false
Property isOrdered false          Property isUnique true            Property visibility public
Port isConjugated false           Port isBehavior false             Port isService true
Operation isQuery false           Operation concurrency sequential  Operation isAbstract false
Parameter direction in            Parameter isException false       Parameter isStream false
Generalization isSubstitutable true                                 PackageImport visibility public
ObjectFlow isMulticast false      ObjectFlow isMultireceive false
CallBehaviorAction isSynchronous true         CallBehaviorAction isLocallyReentrant false
AcceptEventAction isUnmarshall false          AddStructuralFeatureValueAction isReplaceAll false
RemoveStructuralFeatureValueAction isRemoveDuplicates false
DestroyObjectAction isDestroyLinks false      DestroyObjectAction isDestroyOwnedObjects false
ReadIsClassifiedObjectAction isDirect false   ReduceAction isOrdered false
JoinNode isCombineDuplicate true              CentralBufferNode isControlType false
CentralBufferNode ordering FIFO               LoopNode isTestedFirst false
LoopNode mustIsolate false                    ConditionalNode isAssured false
ConditionalNode isDeterminate false           ExpansionRegion mode iterative
ActivityPartition isDimension false           ActivityPartition isExternal false
InputPin isControl false                      InputPin isControlType false
Pseudostate kind initial                      Transition kind external
ElementImport visibility public               GeneralizationSet isCovering false
GeneralizationSet isDisjoint false            TimeObservation firstEvent true
Continuation setting true                     CombinedFragment interactionOperator seq
Message messageSort synchCall                 ReclassifyObjectAction isReplaceAll false
AddVariableValueAction isReplaceAll false     RemoveVariableValueAction isRemoveDuplicates false
LinkEndCreationData isReplaceAll false        LinkEndDestructionData isDestroyDuplicates false
"""
TABLE = [tuple(row) for row in zip(*[iter(DEFAULTS.split())] * 3, strict=True)]
OTHERS = {
    "true": "false",
    "false": "true",
    "none": "composite",
    "public": "private",
    "in": "out",
    "sequential": "concurrent",
    "FIFO": "LIFO",
    "iterative": "parallel",
    "initial": "fork",
    "external": "local",
    "seq": "alt",
    "synchCall": "reply",
}
ELSEWHERE = """
ClassifierTemplateParameter LiteralBoolean LiteralInteger LiteralUnlimitedNatural
ProfileApplication TimeConstraint TimeEvent
"""
"""Metaclasses whose defaults other tests have, or whose attributes the graph has no room for."""
SUBCLASSES = {
    "Action": "CallBehaviorAction",
    "Activity": "Behavior",
    "BehavioralFeature": "Operation",
    "CallAction": "CallBehaviorAction",
    "Classifier": "Class",
    "Feature": "Property",
    "MultiplicityElement": "Property",
    "ObjectNode": "CentralBufferNode",
    "Pin": "InputPin",
    "RedefinableElement": "Class",
    "StructuralFeature": "Property",
    "StructuredActivityNode": "LoopNode",
}
EDGES = ("Generalization", "LinkEndCreationData", "LinkEndDestructionData")
"""No elements of the graph, which has no room for their attributes: SM114 tells of them."""


def text(metaclass, attribute):
    if metaclass in HOLDERS:
        model = HOLDERS[metaclass]
    elif metaclass in IN_CLASS:
        model = CLASS % IN_CLASS[metaclass]
    elif metaclass in IN_ACTIVITY:
        model = ACTIVITY % IN_ACTIVITY[metaclass]
    else:
        model = REGION % IN_REGION[metaclass]
    reading = read(papyrus(model.replace("{}", attribute)))
    assert reading.totals.get("unsupported", 0) == 0
    return below_model(reading)


@pytest.mark.parametrize(("metaclass", "attribute", "default"), TABLE, ids=" ".join)
def test_writing_the_default_changes_nothing(metaclass, attribute, default):
    assert text(metaclass, f'{attribute}="{default}"') == text(metaclass, "")


@pytest.mark.parametrize(
    ("metaclass", "attribute", "default"), [r for r in TABLE if r[0] not in EDGES], ids=" ".join
)
def test_another_value_is_seen(metaclass, attribute, default):
    assert text(metaclass, f'{attribute}="{OTHERS[default]}"') != text(metaclass, "")


@pytest.mark.corpus
def test_the_table_has_every_default_of_the_metamodel(corpus):
    """Those that UML 2.5.1 gives to attributes that are not derived, as Eclipse has them."""
    tree = etree.parse(corpus / "xmi" / "metamodel" / "uml.ecore")
    defaults = [
        (metaclass, feature.get("name"), feature.get("defaultValueLiteral"))
        for feature in tree.iter("eStructuralFeatures")
        if feature.get("defaultValueLiteral") is not None and feature.get("derived") != "true"
        if (metaclass := feature.getparent().get("name")) not in ELSEWHERE.split()
    ]
    assert len(defaults) > 40
    renamed = {(SUBCLASSES.get(metaclass, metaclass), *rest) for metaclass, *rest in defaults}
    assert renamed - set(TABLE) == set()


@pytest.mark.parametrize(
    ("value", "multiplicity"),
    [
        ("", None),
        ('<lowerValue xmi:type="uml:LiteralInteger"/>', "0..1"),
        ('<lowerValue xmi:type="uml:LiteralInteger" value="0"/>', "0..1"),
        ('<lowerValue xmi:type="uml:LiteralUnlimitedNatural" value="1"/>', None),
        ('<upperValue xmi:type="uml:LiteralUnlimitedNatural" value="*"/>', "1..*"),
        ('<upperValue xmi:type="uml:LiteralUnlimitedNatural" value="-1"/>', "1..*"),
        ('<upperValue xmi:type="uml:LiteralUnlimitedNatural"/>', "1..0"),
        ('<upperValue xmi:type="uml:LiteralInteger" value="1"/>', None),
        ('<lower value="0"/><upper value="-1"/>', "*"),
        ("<lower>0</lower><upper>*</upper>", "*"),
    ],
)
def test_bounds(value, multiplicity):
    model = CLASS % f'<ownedAttribute xmi:id="x">{value}</ownedAttribute>'
    assert read(papyrus(model)).graph["x"].attrs.get("multiplicity") == multiplicity


BOUND = '<{}Value xmi:type="uml:{}" value="{}"/>'
EXPRESSION = '<upperValue xmi:type="uml:OpaqueExpression"><body>size</body></upperValue>'


@pytest.mark.parametrize(
    ("value", "multiplicity"),
    [
        (BOUND.format("upper", "LiteralString", "many"), "1..many"),
        (BOUND.format("upper", "LiteralUnlimitedNatural", "many"), "1..many"),
        (BOUND.format("upper", "LiteralReal", "2.5"), "1..2.5"),
        (BOUND.format("lower", "LiteralInteger", "-3"), "-3..1"),
        (BOUND.format("lower", "LiteralUnlimitedNatural", "*"), "*..1"),
        (BOUND.format("upper", "LiteralInteger", "٣"), "1..٣"),
        ("<lower>0</lower><upper>many</upper>", "0..many"),
    ],
)
def test_a_bound_that_is_no_number_is_reported_at_its_element(value, multiplicity):
    reading = read(
        papyrus(CLASS % f'<ownedAttribute xmi:id="x" name="motors">{value}</ownedAttribute>')
    )
    (diagnostic,) = reading.sink
    assert (diagnostic.rule.code, diagnostic.subject.id) == ("SM117", "x")
    assert diagnostic.message.startswith(f"multiplicity {multiplicity} of 'M::")
    assert reading.graph["x"].attrs["multiplicity"] == multiplicity


@pytest.mark.parametrize(
    "value",
    [
        BOUND.format("upper", "LiteralString", "3"),
        BOUND.format("upper", "LiteralString", "*"),
        BOUND.format("lower", "LiteralInteger", "0"),
        BOUND.format("lower", "LiteralUnlimitedNatural", "*")
        + BOUND.format("upper", "LiteralUnlimitedNatural", "*"),
        EXPRESSION,
    ],
)
def test_a_bound_is_a_number_or_an_expression(value):
    model = CLASS % f'<ownedAttribute xmi:id="x" name="motors">{value}</ownedAttribute>'
    assert read(papyrus(model)).findings == []


@pytest.mark.parametrize(("lower", "upper"), [("0", "*"), ("0", "-1")])
def test_bounds_as_attributes(lower, upper):
    model = CLASS % f'<ownedAttribute xmi:id="x" lower="{lower}" upper="{upper}"/>'
    assert read(papyrus(model)).graph["x"].attrs == {"multiplicity": "*"}


@pytest.mark.parametrize(
    ("literal", "value"),
    [
        ("LiteralBoolean", False),
        ("LiteralInteger", 0),
        ("LiteralReal", 0.0),
        ("LiteralString", ""),
        ("LiteralUnlimitedNatural", 0),
        ("LiteralNull", "null"),
    ],
)
def test_a_literal_without_value(literal, value):
    value_of = f'<defaultValue xmi:type="uml:{literal}"/>'
    model = CLASS % f'<ownedAttribute xmi:id="x">{value_of}</ownedAttribute>'
    literal = read(papyrus(model)).graph["x"].attrs["default"]
    assert (literal, type(literal)) == (value, type(value))
