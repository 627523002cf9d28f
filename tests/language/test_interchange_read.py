"""Interchange files read into the tree: folding, references, and what cannot be read."""

import pytest
from v2_trees import interchange, outline, owning, reading, reading_file, relating

from sysmlc.diagnostics import Place, Sink
from sysmlc.language.interchange import link, read
from sysmlc.sources import Fault, Source, SourceError


def tree(content):
    document, messages = reading(content)
    assert messages == []
    return outline(document.root)


def argument(expression, said=""):
    value = f'<ownedRelationship xsi:type="sysml:FeatureValue">{expression}</ownedRelationship>'
    return owning("Feature", 'direction="in"', value, "ParameterMembership", said)


def expression(kind, attributes="", content=""):
    start = f'<ownedRelatedElement xsi:type="sysml:{kind}" {attributes}>'
    return f"{start}{content}{RESULT}</ownedRelatedElement>"


RESULT = owning("Feature", 'direction="out"', membership="ReturnParameterMembership")
ONE = '<ownedRelatedElement xsi:type="sysml:LiteralInteger" value="1"/>'
ZERO = '<ownedRelatedElement xsi:type="sysml:LiteralInteger"/>'


def value(content):
    inner = f'<ownedRelationship xsi:type="sysml:FeatureValue">{content}</ownedRelationship>'
    return owning("Feature", 'declaredName="x" xmi:id="x"', inner)


def test_memberships_are_folded_into_their_members():
    part = owning(
        "PartUsage",
        'declaredName="arm" declaredShortName="a" isComposite="true"',
        membership="FeatureMembership",
        said='visibility="private"',
    )
    content = owning("PartDefinition", 'declaredName="Robot" isAbstract="true"', part)
    assert tree(content) == [
        "OwningMembership PartDefinition Robot isAbstract=True",
        "  FeatureMembership private PartUsage <a> arm",
    ]


def test_owned_relationships_are_relations_with_qualified_names():
    general = owning("PartDefinition", 'xmi:id="d" declaredName="Machine"')
    special = owning(
        "PartDefinition",
        'xmi:id="r" declaredName="Robot"',
        relating("Subclassification", 'subclassifier="r" superclassifier="d"'),
    )
    package = owning("Package", 'declaredName="Plant"', general + special)
    assert tree(package) == [
        "OwningMembership Package Plant",
        "  OwningMembership PartDefinition Machine",
        "  OwningMembership PartDefinition Robot Subclassification->Plant::Machine",
    ]


def test_a_feature_chain_is_one_reference_with_several_links():
    chain = (
        '<ownedRelatedElement xsi:type="sysml:Feature" xmi:id="c">'
        + relating("FeatureChaining", 'chainingFeature="a"')
        + relating("FeatureChaining", 'chainingFeature="b"')
        + "</ownedRelatedElement>"
    )
    features = (
        owning("Feature", 'xmi:id="a" declaredName="a"')
        + owning("Feature", 'xmi:id="b" declaredName="b"')
        + owning(
            "Feature",
            'xmi:id="x" declaredName="x"',
            relating("Subsetting", 'subsettingFeature="x" subsettedFeature="c"', chain),
        )
    )
    document, messages = reading(features)
    assert messages == []
    assert outline(document.root)[2] == "OwningMembership Feature x Subsetting->a.b"
    reference = document.root.members[2].relations[0].reference
    assert [node.name for node in reference.targets] == ["a", "b"]


def test_arguments_and_empty_results_of_expressions_are_folded():
    sum_ = expression(
        "OperatorExpression", 'operator="+"', argument(ONE, 'visibility="private"') + argument(ZERO)
    )
    assert tree(value(sum_)) == [
        "OwningMembership Feature x",
        "  FeatureValue (=) OperatorExpression operator=+",
        "    ParameterMembership LiteralInteger value=1",
        "    ParameterMembership LiteralInteger value=0",
    ]


def test_what_is_evaluated_late_has_the_role_expression():
    late = expression(
        "FeatureReferenceExpression",
        "",
        owning("LiteralBoolean", 'value="true"', membership="FeatureMembership"),
    )
    both = argument('<ownedRelatedElement xsi:type="sysml:LiteralBoolean"/>') + argument(late)
    assert tree(value(expression("OperatorExpression", 'operator="and"', both)))[2:] == [
        "    ParameterMembership LiteralBoolean value=False",
        "    ParameterMembership (expression) LiteralBoolean value=True",
    ]


def test_a_body_expression_that_is_an_argument_stays():
    body = expression(
        "FeatureReferenceExpression", "", owning("Expression", membership="FeatureMembership")
    )
    call = relating("Membership", 'memberElement="x"') + argument(body)
    assert tree(value(expression("InvocationExpression", "", call)))[1:] == [
        "  FeatureValue (=) InvocationExpression Membership->x",
        "    ParameterMembership FeatureReferenceExpression",
        "      FeatureMembership Expression",
    ]


def test_a_referent_is_a_relation_and_an_owned_chain_too():
    chain = owning("Feature", "", relating("FeatureChaining", 'chainingFeature="x"') * 2)
    named = expression(
        "FeatureReferenceExpression", "", relating("Membership", 'memberElement="x"')
    )
    reaching = owning("Feature", 'declaredName=""', membership="FeatureMembership")
    carried = (
        f'<ownedRelationship xsi:type="sysml:FeatureValue">{named}</ownedRelationship>' + reaching
    )
    first = owning("Feature", 'direction="in"', carried, "ParameterMembership")
    assert tree(value(expression("FeatureChainExpression", "", first + chain)))[1:] == [
        "  FeatureValue (=) FeatureChainExpression Membership->x.x",
        "    ParameterMembership FeatureReferenceExpression Membership->x",
    ]


@pytest.mark.parametrize(
    ("said", "role"),
    [
        ("", "="),
        ('isInitial="true"', ":="),
        ('isDefault="true"', "default"),
        ('isDefault="true" isInitial="true"', "default :="),
    ],
)
def test_a_feature_value_has_its_sign_as_role(said, role):
    inner = f'<ownedRelationship xsi:type="sysml:FeatureValue" {said}>{ONE}</ownedRelationship>'
    lines = tree(owning("Feature", 'declaredName="x"', inner))
    assert lines[1] == f"  FeatureValue ({role}) LiteralInteger value=1"


def test_imports_are_members_and_private_unless_stated():
    package = owning("Package", 'xmi:id="p" declaredName="P"').replace(
        "<ownedRelationship ", '<ownedRelationship xmi:id="m" '
    )
    imports = relating("MembershipImport", 'importedMembership="m"') + relating(
        "NamespaceImport", 'importedNamespace="p" isRecursive="true" visibility="public"'
    )
    assert tree(package + owning("Package", 'declaredName="Q"', imports))[1:] == [
        "OwningMembership Package Q",
        "  - private MembershipImport importedMembership->P",
        "  - public NamespaceImport isRecursive=True importedNamespace->P",
    ]


def test_an_alias_is_a_membership_that_names_another_element():
    documentation = '<ownedRelatedElement xsi:type="sysml:Documentation" body="why"/>'
    alias = relating(
        "Membership",
        'memberName="A" memberShortName="a" memberElement="p"',
        relating("Annotation", "", documentation),
    )
    assert tree(owning("Package", 'xmi:id="p" declaredName="P"') + alias)[1:] == [
        "- Membership <a> A Membership->P",
        "  Annotation Documentation body=why",
    ]


def test_a_dependency_has_its_ends_as_relations():
    packages = "".join(owning("Package", f'xmi:id="{n}" declaredName="{n}"') for n in "abc")
    dependency = owning("Dependency", 'declaredName="d" client="a b" supplier="c"')
    assert tree(packages + dependency)[3:] == [
        "OwningMembership Dependency d client->a client->b supplier->c"
    ]


def test_conjugated_ports_and_empty_multiplicities_are_left_out():
    conjugation = relating("PortConjugation", 'conjugatedType="c" originalPortDefinition="d"')
    conjugate = owning("ConjugatedPortDefinition", 'xmi:id="c"', conjugation)
    definition = owning("PortDefinition", 'xmi:id="d" declaredName="D"', conjugate)
    typing = relating("ConjugatedPortTyping", 'typedFeature="u" conjugatedPortDefinition="c"')
    port = owning("PortUsage", 'xmi:id="u" declaredName="u"', typing + owning("Multiplicity"))
    assert tree(definition + port) == [
        "OwningMembership PortDefinition D",
        "OwningMembership PortUsage u ConjugatedPortTyping->D",
    ]


def test_a_usage_that_could_be_composite_and_is_not_is_a_reference():
    parts = (
        owning("PartUsage", 'declaredName="a" isComposite="true"', "", "FeatureMembership")
        + owning("PartUsage", 'declaredName="b"', "", "FeatureMembership")
        + owning("PartUsage", 'declaredName="c" direction="in"', "", "FeatureMembership")
        + owning(
            "PartUsage", 'declaredName="d" isEnd="true" isConstant="true"', "", "FeatureMembership"
        )
    )
    assert tree(owning("PartDefinition", 'declaredName="P"', parts))[1:] == [
        "  FeatureMembership PartUsage a",
        "  FeatureMembership PartUsage b isReference=True",
        "  FeatureMembership PartUsage c direction=in",
        "  FeatureMembership PartUsage d isEnd=True",
    ]


def test_implied_relationships_are_left_to_the_rules_of_the_language():
    implied = relating("Subclassification", 'isImplied="true" superclassifier="gone"')
    assert tree(owning("PartDefinition", 'declaredName="P"', implied)) == [
        "OwningMembership PartDefinition P"
    ]


def test_the_root_may_be_xmi_with_the_model_inside():
    inner = interchange(owning("Package", 'declaredName="P"'))
    file = f'<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001">{inner}</xmi:XMI>'
    document, messages = reading_file(file)
    assert (outline(document.root), messages) == (["OwningMembership Package P"], [])


def test_features_may_be_elements():
    comment = owning("Comment", "", "<body>two &lt; three</body><annotatedElement href='#p'/>")
    lines = tree(owning("Package", 'xmi:id="p" declaredName="P"') + comment)
    assert lines[1] == "OwningMembership Comment body=two < three"


BASE = interchange(owning("Classifier", 'xmi:id="k" declaredName="Thing"'))
USE = interchange(
    owning(
        "Class",
        'declaredName="C"',
        relating(
            "Subclassification", "", "<superclassifier href='../Core%20Library/Base.kermlx#k'/>"
        ),
    )
)


def linked(*files):
    sink = Sink()
    documents = [read(Source(path, text.encode()), sink) for path, text in files]
    link(documents, sink)
    return documents, [f"{found.rule.code} {found.message}" for found in sink]


def test_references_lead_into_files_that_are_read_together():
    files = [("a/Use.kermlx", USE), ("Core Library/Base.kermlx", BASE)]
    (use, base), messages = linked(*files)
    reference = use.root.members[0].relations[0].reference
    assert messages == []
    assert (str(reference), reference.target) == ("Thing", base.root.members[0])


def test_references_into_other_files_stay_as_hrefs():
    (use,), messages = linked(("a/Use.kermlx", USE))
    reference = use.root.members[0].relations[0].reference
    assert messages == []
    assert str(reference) == "../Core%20Library/Base.kermlx#k"
    assert reference.targets is None


def test_an_id_that_the_other_file_lacks_is_reported_where_it_stands():
    files = [("a/Use.kermlx", USE), ("Core Library/Base.kermlx", BASE.replace('"k"', '"z"'))]
    assert linked(*files)[1] == [
        "SM165 'superclassifier' of 'Subclassification' refers to the id 'k', which does not "
        "exist in 'Core Library/Base.kermlx'"
    ]


def test_a_name_of_a_redefined_feature_counts_where_there_is_no_own_one():
    redefinition = relating("Redefinition", 'redefiningFeature="n" redefinedFeature="f"')
    content = (
        owning("Feature", 'xmi:id="f" declaredName="f"')
        + owning(
            "Class",
            'declaredName="C"',
            owning("Feature", 'xmi:id="n"', redefinition, "FeatureMembership"),
        )
        + owning("Feature", 'declaredName="g"', relating("Subsetting", 'subsettedFeature="n"'))
    )
    assert tree(content)[-1] == "OwningMembership Feature g Subsetting->C::f"


WRONG = [
    (
        owning("PartDef", 'declaredName="P"'),
        "SM163 'PartDef' is not a metaclass of SysML 2.0: the element is omitted with "
        "everything that it owns",
    ),
    (
        owning("Usage", 'declaredName="u"') + owning("ControlNode"),
        "SM163 'ControlNode' is not a metaclass of SysML 2.0: the element is omitted with "
        "everything that it owns",
    ),
    (
        owning("PartDefinition", 'declaredName="P" isAbstrct="true"'),
        "SM164 'isAbstrct' of 'P' is not a feature of PartDefinition: it is ignored",
    ),
    (
        owning("PartDefinition", 'declaredName="P"', "<operater>x</operater>"),
        "SM164 'operater' of 'P' is not a feature of PartDefinition: it is ignored",
    ),
    (
        owning(
            "PartDefinition",
            'declaredName="P"',
            relating("Subclassification", 'superclassifier="q"'),
        ),
        "SM165 'superclassifier' of 'Subclassification' refers to the id 'q', which does not "
        "exist in 'm.sysmlx'",
    ),
    (
        owning("Package", 'xmi:id="p"') + owning("Package", 'xmi:id="p"'),
        "SM751 the id 'p' is used by two elements",
    ),
    (
        owning("PartDefinition", 'declaredName="P" isAbstract="yes"'),
        "SM756 'isAbstract' of 'P' is 'yes', which is not a valid truth value",
    ),
    (
        value('<ownedRelatedElement xsi:type="sysml:LiteralInteger" value="1.5"/>'),
        "SM756 'value' of 'LiteralInteger' is '1.5', which is not a valid number",
    ),
]


@pytest.mark.parametrize(("content", "message"), WRONG)
def test_what_cannot_be_understood_is_reported(content, message):
    assert reading(content)[1] == [message]


def test_findings_are_located():
    sink = Sink()
    read(Source("m.sysmlx", interchange(owning("PartDef")).encode()), sink)
    assert [found.subject.place for found in sink] == [Place("m.sysmlx", ordinal=2)]


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
def test_files_that_are_no_models_give_an_empty_tree(file, message):
    document, messages = reading_file(file)
    assert (document.root.members, messages[-1:]) == ([], [message])


def test_a_file_that_nests_too_deeply_is_refused():
    deep = '<ownedRelationship xsi:type="sysml:OwningMembership">' * 20_001
    with pytest.raises(SourceError) as raised:
        reading_file(interchange(deep))
    assert raised.value.fault is Fault.LIMIT
