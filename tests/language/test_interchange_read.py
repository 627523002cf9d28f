"""Reading interchange files: folding of relationships, references, and faults."""

import pytest
from interchange_files import (
    list_messages,
    read_content,
    read_text,
    write_file,
    write_member,
    write_relationship,
)
from tree_outlines import outline

from sysmlc.diagnostics import Place, Sink
from sysmlc.language.interchange import link, read
from sysmlc.sources import Fault, Source, SourceError


def read_outline(content):
    """Return the outline of a file that is read without diagnostics."""
    document, messages = read_content(content)
    assert messages == []
    return outline(document.root)


def write_argument(expression, membership_attributes=""):
    """Return an expression as the interchange format writes it as an argument."""
    value = f'<ownedRelationship xsi:type="sysml:FeatureValue">{expression}</ownedRelationship>'
    return write_member(
        "Feature", 'direction="in"', value, "ParameterMembership", membership_attributes
    )


def write_expression(kind, attributes="", content=""):
    """Return an expression with the empty result that the interchange format demands."""
    start = f'<ownedRelatedElement xsi:type="sysml:{kind}" {attributes}>'
    return f"{start}{content}{RESULT}</ownedRelatedElement>"


RESULT = write_member("Feature", 'direction="out"', membership="ReturnParameterMembership")
ONE = '<ownedRelatedElement xsi:type="sysml:LiteralInteger" value="1"/>'
ZERO = '<ownedRelatedElement xsi:type="sysml:LiteralInteger"/>'


def write_value(content):
    """Return a feature with an expression as its value."""
    inner = f'<ownedRelationship xsi:type="sysml:FeatureValue">{content}</ownedRelationship>'
    return write_member("Feature", 'declaredName="x" xmi:id="x"', inner)


def test_memberships_are_folded_into_their_members():
    part = write_member(
        "PartUsage",
        'declaredName="arm" declaredShortName="a" isComposite="true"',
        membership="FeatureMembership",
        membership_attributes='visibility="private"',
    )
    content = write_member("PartDefinition", 'declaredName="Robot" isAbstract="true"', part)
    assert read_outline(content) == [
        "OwningMembership PartDefinition Robot isAbstract=True",
        "  FeatureMembership private PartUsage <a> arm",
    ]


def test_owned_relationships_are_relations_with_qualified_names():
    general = write_member("PartDefinition", 'xmi:id="d" declaredName="Machine"')
    special = write_member(
        "PartDefinition",
        'xmi:id="r" declaredName="Robot"',
        write_relationship("Subclassification", 'subclassifier="r" superclassifier="d"'),
    )
    package = write_member("Package", 'declaredName="Plant"', general + special)
    assert read_outline(package) == [
        "OwningMembership Package Plant",
        "  OwningMembership PartDefinition Machine",
        "  OwningMembership PartDefinition Robot Subclassification->Plant::Machine",
    ]


def test_a_feature_chain_is_one_reference_with_several_links():
    chain = (
        '<ownedRelatedElement xsi:type="sysml:Feature" xmi:id="c">'
        + write_relationship("FeatureChaining", 'chainingFeature="a"')
        + write_relationship("FeatureChaining", 'chainingFeature="b"')
        + "</ownedRelatedElement>"
    )
    features = (
        write_member("Feature", 'xmi:id="a" declaredName="a"')
        + write_member("Feature", 'xmi:id="b" declaredName="b"')
        + write_member(
            "Feature",
            'xmi:id="x" declaredName="x"',
            write_relationship("Subsetting", 'subsettingFeature="x" subsettedFeature="c"', chain),
        )
    )
    document, messages = read_content(features)
    assert messages == []
    assert outline(document.root)[2] == "OwningMembership Feature x Subsetting->a.b"
    reference = document.root.members[2].relations[0].reference
    assert [node.name for node in reference.targets] == ["a", "b"]


def test_arguments_and_empty_results_of_expressions_are_folded():
    addition = write_expression(
        "OperatorExpression",
        'operator="+"',
        write_argument(ONE, 'visibility="private"') + write_argument(ZERO),
    )
    assert read_outline(write_value(addition)) == [
        "OwningMembership Feature x",
        "  FeatureValue (=) OperatorExpression operator=+",
        "    ParameterMembership LiteralInteger value=1",
        "    ParameterMembership LiteralInteger value=0",
    ]


def test_an_operand_that_is_evaluated_conditionally_has_the_role_expression():
    second = write_expression(
        "FeatureReferenceExpression",
        "",
        write_member("LiteralBoolean", 'value="true"', membership="FeatureMembership"),
    )
    operands = write_argument(
        '<ownedRelatedElement xsi:type="sysml:LiteralBoolean"/>'
    ) + write_argument(second)
    assert read_outline(
        write_value(write_expression("OperatorExpression", 'operator="and"', operands))
    )[2:] == [
        "    ParameterMembership LiteralBoolean value=False",
        "    ParameterMembership (expression) LiteralBoolean value=True",
    ]


def test_a_body_expression_that_is_an_argument_is_not_folded():
    body = write_expression(
        "FeatureReferenceExpression", "", write_member("Expression", membership="FeatureMembership")
    )
    call = write_relationship("Membership", 'memberElement="x"') + write_argument(body)
    assert read_outline(write_value(write_expression("InvocationExpression", "", call)))[1:] == [
        "  FeatureValue (=) InvocationExpression Membership->x",
        "    ParameterMembership FeatureReferenceExpression",
        "      FeatureMembership Expression",
    ]


def test_referents_and_owned_chains_become_relations():
    chain = write_member(
        "Feature", "", write_relationship("FeatureChaining", 'chainingFeature="x"') * 2
    )
    referent = write_expression(
        "FeatureReferenceExpression", "", write_relationship("Membership", 'memberElement="x"')
    )
    empty_feature = write_member("Feature", 'declaredName=""', membership="FeatureMembership")
    value = (
        f'<ownedRelationship xsi:type="sysml:FeatureValue">{referent}</ownedRelationship>'
        + empty_feature
    )
    operand = write_member("Feature", 'direction="in"', value, "ParameterMembership")
    assert read_outline(
        write_value(write_expression("FeatureChainExpression", "", operand + chain))
    )[1:] == [
        "  FeatureValue (=) FeatureChainExpression Membership->x.x",
        "    ParameterMembership FeatureReferenceExpression Membership->x",
    ]


@pytest.mark.parametrize(
    ("attributes", "role"),
    [
        ("", "="),
        ('isInitial="true"', ":="),
        ('isDefault="true"', "default"),
        ('isDefault="true" isInitial="true"', "default :="),
    ],
)
def test_the_role_of_a_feature_value_is_its_operator(attributes, role):
    inner = (
        f'<ownedRelationship xsi:type="sysml:FeatureValue" {attributes}>{ONE}</ownedRelationship>'
    )
    lines = read_outline(write_member("Feature", 'declaredName="x"', inner))
    assert lines[1] == f"  FeatureValue ({role}) LiteralInteger value=1"


def test_imports_are_members_and_private_unless_stated():
    package = write_member("Package", 'xmi:id="p" declaredName="P"').replace(
        "<ownedRelationship ", '<ownedRelationship xmi:id="m" '
    )
    imports = write_relationship("MembershipImport", 'importedMembership="m"') + write_relationship(
        "NamespaceImport", 'importedNamespace="p" isRecursive="true" visibility="public"'
    )
    assert read_outline(package + write_member("Package", 'declaredName="Q"', imports))[1:] == [
        "OwningMembership Package Q",
        "  - private MembershipImport importedMembership->P",
        "  - public NamespaceImport isRecursive=True importedNamespace->P",
    ]


def test_an_alias_is_a_membership_that_names_another_element():
    documentation = '<ownedRelatedElement xsi:type="sysml:Documentation" body="why"/>'
    alias = write_relationship(
        "Membership",
        'memberName="A" memberShortName="a" memberElement="p"',
        write_relationship("Annotation", "", documentation),
    )
    assert read_outline(write_member("Package", 'xmi:id="p" declaredName="P"') + alias)[1:] == [
        "- Membership <a> A Membership->P",
        "  Annotation Documentation body=why",
    ]


def test_a_dependency_has_its_ends_as_relations():
    packages = "".join(write_member("Package", f'xmi:id="{n}" declaredName="{n}"') for n in "abc")
    dependency = write_member("Dependency", 'declaredName="d" client="a b" supplier="c"')
    assert read_outline(packages + dependency)[3:] == [
        "OwningMembership Dependency d client->a client->b supplier->c"
    ]


def test_conjugated_port_definitions_and_empty_multiplicities_are_omitted():
    conjugation = write_relationship(
        "PortConjugation", 'conjugatedType="c" originalPortDefinition="d"'
    )
    conjugate = write_member("ConjugatedPortDefinition", 'xmi:id="c"', conjugation)
    definition = write_member("PortDefinition", 'xmi:id="d" declaredName="D"', conjugate)
    typing = write_relationship(
        "ConjugatedPortTyping", 'typedFeature="u" conjugatedPortDefinition="c"'
    )
    port = write_member(
        "PortUsage", 'xmi:id="u" declaredName="u"', typing + write_member("Multiplicity")
    )
    assert read_outline(definition + port) == [
        "OwningMembership PortDefinition D",
        "OwningMembership PortUsage u ConjugatedPortTyping->D",
    ]


def test_a_usage_that_is_not_composite_is_a_reference_unless_it_is_directed_or_an_end():
    parts = (
        write_member("PartUsage", 'declaredName="a" isComposite="true"', "", "FeatureMembership")
        + write_member("PartUsage", 'declaredName="b"', "", "FeatureMembership")
        + write_member("PartUsage", 'declaredName="c" direction="in"', "", "FeatureMembership")
        + write_member(
            "PartUsage", 'declaredName="d" isEnd="true" isConstant="true"', "", "FeatureMembership"
        )
    )
    assert read_outline(write_member("PartDefinition", 'declaredName="P"', parts))[1:] == [
        "  FeatureMembership PartUsage a",
        "  FeatureMembership PartUsage b isReference=True",
        "  FeatureMembership PartUsage c direction=in",
        "  FeatureMembership PartUsage d isEnd=True",
    ]


def test_implied_relationships_are_not_read():
    implied = write_relationship("Subclassification", 'isImplied="true" superclassifier="gone"')
    assert read_outline(write_member("PartDefinition", 'declaredName="P"', implied)) == [
        "OwningMembership PartDefinition P"
    ]


@pytest.mark.parametrize("organisation", ["www.omg.org", "www.omg.org/spec", "schema.omg.org/spec"])
def test_the_root_element_may_be_xmi(organisation):
    inner = write_file(write_member("Package", 'declaredName="P"'))
    file = f'<xmi:XMI xmlns:xmi="http://{organisation}/XMI/20131001">{inner}</xmi:XMI>'
    document, messages = read_text(file)
    assert (outline(document.root), messages) == (["OwningMembership Package P"], [])


def test_features_may_be_written_as_xml_elements():
    comment = write_member(
        "Comment", "", "<body>two &lt; three</body><annotatedElement href='#p'/>"
    )
    lines = read_outline(write_member("Package", 'xmi:id="p" declaredName="P"') + comment)
    assert lines[1] == "OwningMembership Comment body=two < three"


BASE = write_file(write_member("Classifier", 'xmi:id="k" declaredName="Thing"'))
USE = write_file(
    write_member(
        "Class",
        'declaredName="C"',
        write_relationship(
            "Subclassification", "", "<superclassifier href='../Core%20Library/Base.kermlx#k'/>"
        ),
    )
)


def read_together(*files):
    """Return the documents of files that refer to each other, and the messages."""
    sink = Sink()
    documents = [read(Source(path, text.encode()), sink) for path, text in files]
    link(documents, sink)
    return documents, list_messages(sink)


def test_references_to_files_that_are_read_together_are_resolved():
    files = [("a/Use.kermlx", USE), ("Core Library/Base.kermlx", BASE)]
    (use, base), messages = read_together(*files)
    reference = use.root.members[0].relations[0].reference
    assert messages == []
    assert (str(reference), reference.target) == ("Thing", base.root.members[0])


def test_references_to_other_files_remain_hrefs():
    (use,), messages = read_together(("a/Use.kermlx", USE))
    reference = use.root.members[0].relations[0].reference
    assert messages == []
    assert str(reference) == "../Core%20Library/Base.kermlx#k"
    assert reference.targets is None


def test_an_id_that_the_other_file_lacks_is_reported():
    files = [("a/Use.kermlx", USE), ("Core Library/Base.kermlx", BASE.replace('"k"', '"z"'))]
    assert read_together(*files)[1] == [
        "SM165 'superclassifier' of 'Subclassification' refers to the id 'k', which does not "
        "exist in 'Core Library/Base.kermlx'"
    ]


def test_a_nameless_feature_is_referred_to_by_the_name_of_the_redefined_one():
    redefinition = write_relationship("Redefinition", 'redefiningFeature="n" redefinedFeature="f"')
    content = (
        write_member("Feature", 'xmi:id="f" declaredName="f"')
        + write_member(
            "Class",
            'declaredName="C"',
            write_member("Feature", 'xmi:id="n"', redefinition, "FeatureMembership"),
        )
        + write_member(
            "Feature", 'declaredName="g"', write_relationship("Subsetting", 'subsettedFeature="n"')
        )
    )
    assert read_outline(content)[-1] == "OwningMembership Feature g Subsetting->C::f"


FAULTS = [
    (
        write_member("PartDef", 'declaredName="P"'),
        "SM163 'PartDef' is not a metaclass of SysML 2.0: the element is omitted with "
        "everything that it owns",
    ),
    (
        write_member("Usage", 'declaredName="u"') + write_member("ControlNode"),
        "SM163 'ControlNode' is not a metaclass of SysML 2.0: the element is omitted with "
        "everything that it owns",
    ),
    (
        write_member("PartDefinition", 'declaredName="P" isAbstrct="true"'),
        "SM164 'isAbstrct' of 'P' is not a feature of PartDefinition: it is ignored",
    ),
    (
        write_member("PartDefinition", 'declaredName="P"', "<operater>x</operater>"),
        "SM164 'operater' of 'P' is not a feature of PartDefinition: it is ignored",
    ),
    (
        write_member(
            "PartDefinition",
            'declaredName="P"',
            write_relationship("Subclassification", 'superclassifier="q"'),
        ),
        "SM165 'superclassifier' of 'Subclassification' refers to the id 'q', which does not "
        "exist in 'm.sysmlx'",
    ),
    (
        write_member("Package", 'xmi:id="p"') + write_member("Package", 'xmi:id="p"'),
        "SM751 the id 'p' is used by two elements",
    ),
    (
        write_member("PartDefinition", 'declaredName="P" isAbstract="yes"'),
        "SM756 'isAbstract' of 'P' is 'yes', which is not a valid truth value",
    ),
    (
        write_value('<ownedRelatedElement xsi:type="sysml:LiteralInteger" value="1.5"/>'),
        "SM756 'value' of 'LiteralInteger' is '1.5', which is not a valid number",
    ),
]


@pytest.mark.parametrize(("content", "message"), FAULTS)
def test_a_fault_is_reported(content, message):
    assert read_content(content)[1] == [message]


def test_the_location_of_a_diagnostic_is_the_ordinal_of_the_element():
    sink = Sink()
    read(Source("m.sysmlx", write_file(write_member("PartDef")).encode()), sink)
    assert [diagnostic.subject.place for diagnostic in sink] == [Place("m.sysmlx", ordinal=2)]


@pytest.mark.parametrize(
    ("file", "message"),
    [
        (
            "<catalogue/>",
            "SM757 'm.sysmlx' contains no model of SysML 2.0: its root is 'catalogue'",
        ),
        ("<a><b></a>", "SM750 'm.sysmlx' cannot be read: not well-formed XML: mismatched tag"),
        (
            '<!DOCTYPE a [<!ENTITY b "c">]><a/>',
            "SM750 'm.sysmlx' cannot be read: it has a DOCTYPE,"
            " which is refused because entities can hide anything",
        ),
    ],
)
def test_a_file_that_is_not_a_model_has_an_empty_tree(file, message):
    document, messages = read_text(file)
    assert (document.root.members, messages[-1:]) == ([], [message])


def test_a_file_that_nests_too_deeply_is_refused():
    deep = '<ownedRelationship xsi:type="sysml:OwningMembership">' * 20_001
    with pytest.raises(SourceError) as raised:
        read_text(write_file(deep))
    assert raised.value.fault is Fault.LIMIT
