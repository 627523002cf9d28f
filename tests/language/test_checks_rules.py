"""Constraints about the types of usages, members of which there is one, accessible features."""

import pytest
from resolving import documents, library

from sysmlc.diagnostics import Sink
from sysmlc.language.checks import check, memberships, references, specializations
from sysmlc.language.names import resolve


def found(text):
    sink = Sink()
    check(resolve(documents(text), library(), Sink()), sink)
    return [one.message for one in sink]


def codes(text):
    sink = Sink()
    check(resolve(documents(text), library(), Sink()), sink)
    return {one.rule.code for one in sink}


@pytest.mark.parametrize(
    ("rule", "code"),
    [
        (specializations.TYPED_BY, "SM221"),
        (specializations.ONE_TYPE, "SM222"),
        (memberships.ONLY_ONE, "SM223"),
        (memberships.SUBJECT_FIRST, "SM224"),
        (references.NOT_ACCESSIBLE, "SM225"),
        (references.OTHER_KIND, "SM236"),
        (references.PART_OF_PORT, "SM237"),
        (references.OTHER_DIRECTION, "SM238"),
        (references.INDIVIDUAL, "SM239"),
        (memberships.VARIANT_ELSEWHERE, "SM226"),
        (memberships.NO_VARIANT, "SM227"),
        (memberships.VARIATION_OF_VARIATION, "SM228"),
        (memberships.VERIFY_ELSEWHERE, "SM229"),
        (memberships.PARALLEL, "SM230"),
        (memberships.PORTION_ELSEWHERE, "SM231"),
        (memberships.END_NO_PORT, "SM232"),
        (memberships.TOO_MANY_ENDS, "SM233"),
        (memberships.ABSTRACT_METADATA, "SM234"),
        (memberships.ENUMERATION_AND_MORE, "SM235"),
    ],
)
def test_the_wrong_model_has_the_finding_and_the_right_one_nearly(rule, code):
    assert rule.code == code
    assert codes(rule.read_page().wrong) == {code}
    assert codes(rule.read_page().right) == set()


def test_a_usage_is_no_type_and_a_subset_brings_its_types():
    assert found("""
        part def Gate;
        part gate : Gate;
        attribute speed;
        part a : gate;
        part b :> speed;
        ref c : gate;
        part d :> gate;
    """) == [
        "part 'a' must be typed by occurrence, item or part definitions, but 'gate' is a part",
        "part 'b' must be typed by occurrence, item or part definitions, but 'DataValue' is "
        "a data type",
        "reference 'c' must be typed by definitions, but 'gate' is a part",
    ]


def test_a_more_special_type_beside_a_general_one_is_one_type():
    assert found("""
        requirement def Safe;
        requirement def Safer :> Safe;
        requirement one : Safe, Safer;
        requirement def Other;
        requirement two : Safe, Other;
    """) == ["requirement 'two' must be typed by one definition, but has 'Safe' and 'Other'"]


def test_each_role_of_a_state_and_a_case_is_there_once():
    assert found("""
        state def Running { entry action a; do action b; exit action c; exit action d; }
        case def Study { subject a; subject b; objective c; objective d; return x; return y; }
    """) == [
        "'Running' may have only one exit action",
        "'Study' may have only one subject",
        "'Study' may have only one objective",
        "'Study' may have only one result",
    ]


def test_features_of_generals_and_of_packages_are_accessible():
    assert (
        found("""
        part def Machine { port plug; }
        part def Mill :> Machine { port other; connect plug to other; bind Machine::plug = other; }
        attribute speed;
        part mill : Mill { attribute s = speed; connect plug to Machine::plug; }
        enum def Colour { red; }
        attribute c = Colour::red;
    """)
        == []
    )


def test_a_condition_of_a_filter_is_about_what_is_filtered():
    text = """
        package Plant {{
            metadata def Rated {{ attribute isMandatory : ScalarValues::Boolean; }}
            part belt {{ @Rated {{ isMandatory = true; }} }}
        }}
        package Seen {{ private import Plant::*; {} }}
    """
    assert found(text.format("filter @Rated and Rated::isMandatory;")) == []
    assert found(text.format("attribute is = Rated::isMandatory;")) == [
        "'Rated::isMandatory' is a feature of 'Rated', which is not the type of any enclosing "
        "element"
    ]
