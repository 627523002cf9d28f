"""The parser builds the trees that the productions of the standard describe."""

import pytest
from tree_outlines import parse_outline

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse


def parse_members(text, language="sysml"):
    """Return the outline of the members of the first element."""
    return [line[2:] for line in parse_outline(text, language)[1:]]


def parse_value(expression):
    """Return the outline of the value of an attribute."""
    return parse_members(f"attribute x = {expression};")


def test_a_package_owns_its_members_and_a_definition_its_features():
    assert parse_outline("package P { part def <c> Cell :> Unit { private part arm; } }") == [
        "OwningMembership Package P",
        "  OwningMembership PartDefinition <c> Cell Subclassification->Unit",
        "    FeatureMembership private PartUsage arm",
    ]


def test_names_in_quotes_lose_quotes_and_escapes():
    assert parse_outline(r"part 'a \'b\' \\ c' : A::'x y'.z;") == [
        r"OwningMembership PartUsage a 'b' \ c FeatureTyping->A::x y.z"
    ]


def test_specialisations_keep_the_order_of_the_text():
    assert parse_outline("part a : T, ~U [0..*] ordered nonunique :> b, c.d :>> e ::> f => g;") == [
        "OwningMembership PartUsage a isOrdered=True isUnique=False FeatureTyping->T "
        "ConjugatedPortTyping->U Subsetting->b Subsetting->c.d Redefinition->e "
        "ReferenceSubsetting->f CrossSubsetting->g",
        "  OwningMembership MultiplicityRange",
        "    OwningMembership LiteralInteger value=0",
        "    OwningMembership LiteralInfinity",
    ]


def test_prefixes_are_attributes_and_metadata_comes_first():
    assert parse_outline("in abstract ref individual snapshot #m part x { part y; }") == [
        "OwningMembership PartUsage x direction=in isAbstract=True isIndividual=True "
        "isPortion=True portionKind=snapshot",
        "  OwningMembership MetadataUsage isPrefix=True FeatureTyping->m",
        "  FeatureMembership PartUsage y",
    ]


def test_operators_are_grouped_by_precedence():
    assert parse_value("not a or b + c * d ** e ** f == g") == [
        "FeatureValue (=) OperatorExpression operator=or",
        "  ParameterMembership OperatorExpression operator=not",
        "    ParameterMembership FeatureReferenceExpression Membership->a",
        "  ParameterMembership (expression) OperatorExpression operator===",
        "    ParameterMembership OperatorExpression operator=+",
        "      ParameterMembership FeatureReferenceExpression Membership->b",
        "      ParameterMembership OperatorExpression operator=*",
        "        ParameterMembership FeatureReferenceExpression Membership->c",
        "        ParameterMembership OperatorExpression operator=**",
        "          ParameterMembership FeatureReferenceExpression Membership->d",
        "          ParameterMembership OperatorExpression operator=**",
        "            ParameterMembership FeatureReferenceExpression Membership->e",
        "            ParameterMembership FeatureReferenceExpression Membership->f",
        "    ParameterMembership FeatureReferenceExpression Membership->g",
    ]


def test_operators_of_one_level_group_to_the_left():
    assert parse_value("1 - 2 - 3") == [
        "FeatureValue (=) OperatorExpression operator=-",
        "  ParameterMembership OperatorExpression operator=-",
        "    ParameterMembership LiteralInteger value=1",
        "    ParameterMembership LiteralInteger value=2",
        "  ParameterMembership LiteralInteger value=3",
    ]


def test_parentheses_start_a_feature_chain_of_their_own():
    assert parse_value("a.b.c") == [
        "FeatureValue (=) FeatureChainExpression Membership->b.c",
        "  ParameterMembership FeatureReferenceExpression Membership->a",
    ]
    assert parse_value("(a.b).c") == [
        "FeatureValue (=) FeatureChainExpression Membership->c",
        "  ParameterMembership FeatureChainExpression Membership->b",
        "    ParameterMembership FeatureReferenceExpression Membership->a",
    ]


def test_invocations_take_arguments_by_position_or_name():
    assert parse_value("A::f(1, x = 'é')->g { in y; y > 2.5e3 }") == [
        "FeatureValue (=) InvocationExpression Membership->g",
        "  ParameterMembership InvocationExpression Membership->A::f",
        "    ParameterMembership LiteralInteger value=1",
        "    FeatureMembership Feature Redefinition->x",
        "      FeatureValue (=) FeatureReferenceExpression Membership->é",
        "  ParameterMembership FeatureReferenceExpression",
        "    FeatureMembership Expression",
        "      FeatureMembership ReferenceUsage y direction=in",
        "      ResultExpressionMembership OperatorExpression operator=>",
        "        ParameterMembership FeatureReferenceExpression Membership->y",
        "        ParameterMembership LiteralRational value=2500.0",
    ]


def test_operators_on_types_and_metadata_have_typed_features_as_operands():
    assert parse_value("x istype T and x meta M") == [
        "FeatureValue (=) OperatorExpression operator=and",
        "  ParameterMembership OperatorExpression operator=istype",
        "    ParameterMembership FeatureReferenceExpression Membership->x",
        "    ParameterMembership Feature FeatureTyping->T",
        "  ParameterMembership (expression) OperatorExpression operator=meta",
        "    ParameterMembership MetadataAccessExpression Membership->x",
        "    ReturnParameterMembership Feature FeatureTyping->M",
    ]


def test_an_operator_behind_a_cast_applies_to_the_cast():
    assert parse_value("1 + x as T < 2") == [
        "FeatureValue (=) OperatorExpression operator=<",
        "  ParameterMembership OperatorExpression operator=as",
        "    ParameterMembership OperatorExpression operator=+",
        "      ParameterMembership LiteralInteger value=1",
        "      ParameterMembership FeatureReferenceExpression Membership->x",
        "    ReturnParameterMembership Feature FeatureTyping->T",
        "  ParameterMembership LiteralInteger value=2",
    ]


def test_a_sequence_nests_to_the_right():
    assert parse_value("(1, null, (true))") == [
        "FeatureValue (=) OperatorExpression operator=,",
        "  ParameterMembership LiteralInteger value=1",
        "  ParameterMembership OperatorExpression operator=,",
        "    ParameterMembership NullExpression",
        "    ParameterMembership LiteralBoolean value=True",
    ]


def test_a_semicolon_behind_a_bracket_makes_a_declaration_and_no_semicolon_a_result():
    assert parse_members("calc c { x [1]; x [kg] }") == [
        "FeatureMembership ReferenceUsage x",
        "  OwningMembership MultiplicityRange",
        "    OwningMembership LiteralInteger value=1",
        "ResultExpressionMembership OperatorExpression operator=[",
        "  ParameterMembership FeatureReferenceExpression Membership->x",
        "  ParameterMembership FeatureReferenceExpression Membership->kg",
    ]


def test_the_body_of_a_comment_loses_its_frame():
    assert parse_outline("/* one\n   * two\n\n     three */ doc /*\n * four\n */") == [
        "OwningMembership Comment body=one\ntwo\n\nthree ",
        "OwningMembership Documentation body=four\n",
    ]


def test_notes_may_stand_anywhere_and_add_nothing():
    assert parse_outline("part //* a { ; */ x // b ;\n : T;") == [
        "OwningMembership PartUsage x FeatureTyping->T"
    ]


def test_a_filtered_import_imports_a_package_of_its_own():
    assert parse_outline("private import all A::**[@M];") == [
        "- private NamespaceImport isImportAll=True",
        "  - Package",
        "    - public MembershipImport isRecursive=True importedMembership->A",
        "    ElementFilterMembership OperatorExpression operator=@",
        "      ParameterMembership Feature FeatureTyping->M",
    ]


def test_connections_have_ends_with_names_and_multiplicities():
    assert parse_members("interface i : I connect a ::> b.c to [1] d;") == [
        "EndFeatureMembership PortUsage a ReferenceSubsetting->b.c",
        "EndFeatureMembership PortUsage ReferenceSubsetting->d",
        "  OwningMembership Feature",
        "    OwningMembership MultiplicityRange",
        "      OwningMembership LiteralInteger value=1",
    ]
    assert parse_members("interface a ::> b to c;") == [
        "EndFeatureMembership PortUsage a ReferenceSubsetting->b",
        "EndFeatureMembership PortUsage ReferenceSubsetting->c",
    ]


def test_the_end_of_a_flow_consists_of_the_owner_of_the_feature_and_the_feature():
    assert parse_members("flow of x : T from a.b.c to d;") == [
        "FeatureMembership PayloadFeature x FeatureTyping->T",
        "EndFeatureMembership FlowEnd ReferenceSubsetting->a.b",
        "  FeatureMembership ReferenceUsage Redefinition->c",
        "EndFeatureMembership FlowEnd",
        "  FeatureMembership ReferenceUsage Redefinition->d",
    ]


def test_ends_of_interfaces_are_ports_unless_they_say_ref():
    assert parse_members("interface def I { end a; end ref b; end [1] port c; }") == [
        "FeatureMembership PortUsage a isEnd=True",
        "FeatureMembership ReferenceUsage b isEnd=True",
        "FeatureMembership PortUsage c isEnd=True",
        "  OwningMembership ReferenceUsage",
        "    OwningMembership MultiplicityRange",
        "      OwningMembership LiteralInteger value=1",
    ]


def test_enumerated_values_are_variants():
    assert parse_members("enum def E { a; enum b = 2; }") == [
        "VariantMembership EnumerationUsage a",
        "VariantMembership EnumerationUsage b",
        "  FeatureValue (=) LiteralInteger value=2",
    ]


def test_the_body_of_metadata_redefines_attributes():
    assert parse_members("@M { a = 1; :>> b; }") == [
        "FeatureMembership ReferenceUsage Redefinition->a",
        "  FeatureValue (=) LiteralInteger value=1",
        "FeatureMembership ReferenceUsage Redefinition->b",
    ]


def test_action_nodes_have_the_parameters_of_the_standard():
    assert parse_members("action a { send x to y; assign b.c := 1; accept s after 2; }") == [
        "FeatureMembership SendActionUsage",
        "  ParameterMembership ReferenceUsage",
        "    FeatureValue (=) FeatureReferenceExpression Membership->x",
        "  ParameterMembership ReferenceUsage",
        "  ParameterMembership ReferenceUsage",
        "    FeatureValue (=) FeatureReferenceExpression Membership->y",
        "FeatureMembership AssignmentActionUsage Membership->c",
        "  ParameterMembership ReferenceUsage",
        "    FeatureValue (=) FeatureReferenceExpression Membership->b",
        "  ParameterMembership ReferenceUsage",
        "    FeatureValue (=) LiteralInteger value=1",
        "FeatureMembership AcceptActionUsage",
        "  ParameterMembership ReferenceUsage s",
        "    FeatureValue (=) TriggerInvocationExpression kind=after",
        "      ParameterMembership LiteralInteger value=2",
    ]


def test_structured_actions_have_conditions_and_bodies_as_parameters():
    assert parse_members(
        "action a { if b { } else if c { } while d { } until e; for i in f { } }"
    ) == [
        "FeatureMembership IfActionUsage",
        "  ParameterMembership FeatureReferenceExpression Membership->b",
        "  ParameterMembership ActionUsage",
        "  ParameterMembership IfActionUsage",
        "    ParameterMembership FeatureReferenceExpression Membership->c",
        "    ParameterMembership ActionUsage",
        "FeatureMembership WhileLoopActionUsage",
        "  ParameterMembership FeatureReferenceExpression Membership->d",
        "  ParameterMembership ActionUsage",
        "  ParameterMembership FeatureReferenceExpression Membership->e",
        "FeatureMembership ForLoopActionUsage",
        "  FeatureMembership ReferenceUsage i",
        "  ParameterMembership ReferenceUsage",
        "    FeatureValue (=) FeatureReferenceExpression Membership->f",
        "  ParameterMembership ActionUsage",
    ]


def test_then_is_a_succession_in_actions_and_a_transition_after_a_state():
    assert parse_members("action a { first start; then b; }") == [
        "- Membership Membership->start",
        "FeatureMembership SuccessionAsUsage",
        "  EndFeatureMembership ReferenceUsage",
        "  EndFeatureMembership ReferenceUsage ReferenceSubsetting->b",
    ]
    assert parse_members("state s { entry; then b; state b; then c; }") == [
        "StateSubactionMembership (entry) ActionUsage",
        "FeatureMembership SuccessionAsUsage",
        "  EndFeatureMembership ReferenceUsage",
        "  EndFeatureMembership ReferenceUsage ReferenceSubsetting->b",
        "FeatureMembership StateUsage b",
        "FeatureMembership TransitionUsage",
        "  ParameterMembership ReferenceUsage",
        "  OwningMembership SuccessionAsUsage",
        "    EndFeatureMembership ReferenceUsage",
        "    EndFeatureMembership ReferenceUsage ReferenceSubsetting->c",
    ]


def test_transitions_have_source_trigger_guard_effect_and_target():
    assert parse_members("state s { transition t first a accept e if g do send m then b; }") == [
        "FeatureMembership TransitionUsage t Membership->a",
        "  ParameterMembership ReferenceUsage",
        "  ParameterMembership ReferenceUsage",
        "  TransitionFeatureMembership (trigger) AcceptActionUsage",
        "    ParameterMembership ReferenceUsage FeatureTyping->e",
        "  TransitionFeatureMembership (guard) FeatureReferenceExpression Membership->g",
        "  TransitionFeatureMembership (effect) SendActionUsage",
        "    ParameterMembership ReferenceUsage",
        "      FeatureValue (=) FeatureReferenceExpression Membership->m",
        "  OwningMembership SuccessionAsUsage",
        "    EndFeatureMembership ReferenceUsage",
        "    EndFeatureMembership ReferenceUsage ReferenceSubsetting->b",
    ]


def test_the_effect_of_a_transition_may_be_empty():
    assert parse_members("state s { transition first a do then b; }") == [
        "FeatureMembership TransitionUsage Membership->a",
        "  ParameterMembership ReferenceUsage",
        "  TransitionFeatureMembership (effect) ActionUsage",
        "  OwningMembership SuccessionAsUsage",
        "    EndFeatureMembership ReferenceUsage",
        "    EndFeatureMembership ReferenceUsage ReferenceSubsetting->b",
    ]


def test_requirements_have_subjects_assumptions_and_guarantees():
    text = "requirement r { subject s : S; assume constraint a { s > 1 } require b; }"
    assert parse_members(text) == [
        "SubjectMembership ReferenceUsage s FeatureTyping->S",
        "RequirementConstraintMembership (assumption) ConstraintUsage a",
        "  ResultExpressionMembership OperatorExpression operator=>",
        "    ParameterMembership FeatureReferenceExpression Membership->s",
        "    ParameterMembership LiteralInteger value=1",
        "RequirementConstraintMembership (requirement) ConstraintUsage ReferenceSubsetting->b",
    ]


def test_a_satisfaction_binds_its_subject():
    assert parse_outline("assert not satisfy r by p.q;") == [
        "OwningMembership SatisfyRequirementUsage isNegated=True ReferenceSubsetting->r",
        "  SubjectMembership ReferenceUsage",
        "    FeatureValue (=) FeatureReferenceExpression Membership->p.q",
    ]


def test_kerml_has_types_features_and_relationships_of_its_own():
    text = """abstract class all A [1] :> B disjoint from C unions D, E {
        composite var feature f : F [2] chains g.h inverse of k;
        inv false i { true }
        member step s;
        connector from [1] a to b;
    }
    specialization z subtype A :> B;"""
    assert parse_outline(text, "kerml") == [
        "OwningMembership Class A isAbstract=True isSufficient=True Subclassification->B "
        "Disjoining->C Unioning->D Unioning->E",
        "  OwningMembership MultiplicityRange",
        "    OwningMembership LiteralInteger value=1",
        "  FeatureMembership Feature f isComposite=True isVariable=True FeatureTyping->F "
        "FeatureChaining->g FeatureChaining->h FeatureInverting->k",
        "    OwningMembership MultiplicityRange",
        "      OwningMembership LiteralInteger value=2",
        "  FeatureMembership Invariant i isNegated=True",
        "    ResultExpressionMembership LiteralBoolean value=True",
        "  OwningMembership Step s",
        "  FeatureMembership Connector",
        "    EndFeatureMembership Feature ReferenceSubsetting->a",
        "      OwningMembership Feature",
        "        OwningMembership MultiplicityRange",
        "          OwningMembership LiteralInteger value=1",
        "    EndFeatureMembership Feature ReferenceSubsetting->b",
        "OwningMembership Specialization z specific->A general->B",
    ]


def test_bindings_of_kerml_have_names_types_or_neither():
    text = "feature f { binding a = b; binding x of a = b; binding : B of a = b; }"
    assert [line for line in parse_members(text, "kerml") if "Binding" in line] == [
        "FeatureMembership BindingConnector",
        "FeatureMembership BindingConnector x",
        "FeatureMembership BindingConnector FeatureTyping->B",
    ]


@pytest.mark.parametrize(
    ("language", "usage", "ends"),
    [
        ("kerml", "connector from a to b;", ["Feature", "Feature"]),
        ("kerml", "binding a = b;", ["Feature", "Feature"]),
        ("kerml", "succession first a then b;", ["Feature", "Feature"]),
        ("kerml", "flow from a.x to b.y;", ["FlowEnd Feature", "FlowEnd Feature"]),
        ("kerml", "succession flow from a.x to b.y;", ["FlowEnd Feature", "FlowEnd Feature"]),
        ("sysml", "connect a to b;", ["ReferenceUsage", "ReferenceUsage"]),
        ("sysml", "bind a = b;", ["ReferenceUsage", "ReferenceUsage"]),
        ("sysml", "succession first a then b;", ["ReferenceUsage", "ReferenceUsage"]),
        ("sysml", "interface connect a to b;", ["PortUsage", "PortUsage"]),
        ("sysml", "flow from a.x to b.y;", ["FlowEnd ReferenceUsage"] * 2),
        ("sysml", "succession flow from a.x to b.y;", ["FlowEnd ReferenceUsage"] * 2),
        ("sysml", "message from a.x to b.y;", ["EventOccurrenceUsage"] * 2),
    ],
)
def test_each_kind_of_connector_has_its_kind_of_ends(language, usage, ends):
    """SysML 2.0, 8.2.2.13 and 8.2.2.16; KerML 1.0, 8.2.5.5 and 8.2.5.9."""
    document = parse(f"package P {{ {usage} }}", "m", language, Sink())
    (connector,) = document.root.members[0].members
    kinds = [[end.kind, *(inner.kind for inner in end.members)] for end in connector.members]
    assert list(map(" ".join, kinds)) == ends
