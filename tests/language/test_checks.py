"""Constraints on well-formed models: the examples of each rule, and cases beyond the examples."""

import pytest
from small_models import list_codes, list_messages, load_library, parse_texts

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.language import checks
from sysmlc.language.checks import memberships, references, specializations
from sysmlc.language.metaclasses import ALL_GENERALS
from sysmlc.language.names import resolve

KERML = {
    *("SM251", "SM252", "SM254", "SM255", "SM256", "SM257", "SM258", "SM266", "SM267"),
    *("SM285", "SM286", "SM287", "SM288"),
}
"""Rules about constructs that only KerML has a notation for."""
SYSML = {
    *("SM250", "SM259", "SM260", "SM261", "SM262", "SM263", "SM264", "SM265", "SM268", "SM269"),
    *("SM270", "SM271", "SM272", "SM273", "SM276", "SM277", "SM278", "SM279"),
    *("SM253", "SM280", "SM281", "SM282", "SM283", "SM284", "SM292"),
}


def test_every_rule_from_sm250_to_sm299_is_tested_here():
    assert checks.BY_KIND
    assert {code for code in catalogue() if "SM250" <= code <= "SM299"} == KERML | SYSML


@pytest.mark.parametrize("code", sorted(KERML | SYSML))
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(code):
    language = "kerml" if code in KERML else "sysml"
    rule = catalogue()[code]
    assert list_codes(rule.read_page().wrong, language) == {code}
    assert list_codes(rule.read_page().right, language) == set()


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
def test_a_rule_has_its_code_and_only_its_wrong_example_breaks_it(rule, code):
    assert rule.code == code
    assert list_codes(rule.read_page().wrong) == {code}
    assert list_codes(rule.read_page().right) == set()


def test_a_usage_cannot_be_a_type_and_a_subset_inherits_types():
    assert list_messages("""
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


def test_an_enumerated_value_is_typed_by_its_enumeration_definition():
    colours = "enum def Colour { enum red; } enum def Size { enum red; }"
    assert list_messages(colours + "attribute a : Colour { enum warm redefines red; }") == []
    assert list_messages(colours + "attribute a : Colour; enum warm :> Colour::red;") == []
    assert list_messages(colours + "enum warm :> Colour::red, Size::red;") == [
        "enumeration 'warm' must be typed by one definition, but has 'Colour' and 'Size'"
    ]


def test_a_type_and_its_specialisation_count_as_one_type():
    assert list_messages("""
        requirement def Safe;
        requirement def Safer :> Safe;
        requirement one : Safe, Safer;
        requirement def Other;
        requirement two : Safe, Other;
    """) == ["requirement 'two' must be typed by one definition, but has 'Safe' and 'Other'"]


def test_states_and_cases_have_each_role_once():
    assert list_messages("""
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
        list_messages("""
        part def Machine { port plug; }
        part def Mill :> Machine { port other; connect plug to other; bind Machine::plug = other; }
        attribute speed;
        part mill : Mill { attribute s = speed; connect plug to Machine::plug; }
        enum def Colour { red; }
        attribute c = Colour::red;
    """)
        == []
    )


def test_a_filter_condition_may_use_features_of_the_filtered_elements():
    text = """
        package Plant {{
            metadata def Rated {{ attribute isMandatory : ScalarValues::Boolean; }}
            part belt {{ @Rated {{ isMandatory = true; }} }}
        }}
        package Seen {{ private import Plant::*; {} }}
    """
    assert list_messages(text.format("filter @Rated and Rated::isMandatory;")) == []
    assert list_messages(text.format("attribute is = Rated::isMandatory;")) == [
        "'Rated::isMandatory' is a feature of 'Rated', which is not the type of any enclosing "
        "element"
    ]


def test_metadata_annotates_only_elements_of_the_metaclass_in_its_definition():
    assert list_messages("""
        metadata def Safe { ref :>> annotatedElement : SysML::ActionUsage; }
        metadata def Tested :> Safe;
        action open { @Safe; }
        state opening { @Tested; }
        part gate { @Tested; }
        part fence;
        metadata Safe about fence;
    """) == [
        "metadata 'Tested' cannot annotate a part",
        "metadata 'Safe' cannot annotate a part",
    ]


def test_the_core_library_has_every_metaclass():
    model = resolve(parse_texts("part gate;"), load_library(), Sink())
    missing = [kind for kind in ALL_GENERALS if model.find(f"SysML::{kind}") is None]
    assert missing == []


def test_a_conjugated_type_reverses_directions():
    text = "class C {{ in z; }} class T conjugates C; class D specializes T {{ {} :>> z; }}"
    assert list_messages(text.format("out"), "kerml") == []
    assert list_messages(text.format("in"), "kerml") == [
        "the direction of 'z' differs from that of its definition in 'C'"
    ]


def test_bounds_are_computed_from_constant_features():
    assert list_messages("""
        attribute two = 1 + 1;
        attribute less = two - 3;
        attribute open;
        part a[two];
        part b[less];
        part c[open];
        part d[two > 1];
        part e[two + 1];
    """) == [
        "the multiplicity of 'b' has a bound that is -1",
        "the multiplicity of 'd' has a bound that is true",
        "the multiplicity of 'e' has an expression as a bound",
    ]


def test_a_bound_that_needs_exponential_time_is_not_computed():
    doubled = "".join(f"attribute a{n} = a{n - 1} + a{n - 1};\n" for n in range(1, 200))
    assert list_messages(f"attribute a0 = 1;\n{doubled}part gates[a199];") == []


def test_nested_features_of_metadata_are_checked():
    assert list_messages("""
        metadata def Limits { attribute speed { attribute max; } }
        part gate { @Limits { speed { max = 3; least = 1; } } }
    """) == ["'least' is not a feature of the metadata 'speed'"]


def test_a_member_feature_may_be_redefined_only_if_it_has_a_featuring_type():
    free = "class Car { member feature driver; member feature owner redefines Car::driver; }"
    messages = ["'driver' is not a feature of a type, so 'owner' cannot redefine it"]
    assert list_messages(free, "kerml") == messages
    assert list_messages(free.replace("driver;", "driver featured by Car;", 1), "kerml") == []
    assert list_messages(f"{free} featuring of Car::driver by Car;", "kerml") == []


def test_the_end_of_a_flow_needs_a_dot_unless_the_flow_is_in_a_usage():
    text = (
        "part def A {{ out item x; }} part def B {{ in item z; }}"
        "{} plant {{ part a : A; part b : B; in item y; {} }}"
    )
    assert list_messages(text.format("part def", "flow from a.x to b.z;")) == []
    assert list_messages(text.format("part", "flow from a.x to y;")) == []
    assert list_messages(text.format("part def", "flow from a.x to y;")) == [
        "'y' does not name the element whose feature the flow connects"
    ]
    assert list_messages(text.format("part def", "flow from A::x to b.z;")) == [
        "'A::x' does not name the element whose feature the flow connects"
    ]


def test_a_member_that_hides_an_inherited_one_is_reported_unless_it_redefines_it():
    assert list_messages("""
        part def Gate { part motor; part leaf; alias arm for leaf; }
        part def Big :> Gate { part motor; part :>> leaf; }
        part big : Big { part leaf; attribute speed; }
        part other : Gate { part arm :>> arm; }
        metadata def Rated { attribute level { attribute max; } }
        part rated { @Rated { level { max = 3; } } }
        action def Move { in way; }
        action move : Move { in way; }
        action def Print { attribute start; }
        part def Plate { attribute shape; }
    """) == [
        "'motor' of 'Big' hides the 'motor' that it inherits from 'Gate'",
        "'leaf' of 'big' hides the 'leaf' that it inherits from 'Big'",
    ]


OPERATORS = "== != === !== < > <= >= and or xor & implies |"


@pytest.mark.parametrize(
    ("bound", "found"),
    [
        *((f"a {operator} a", "no number") for operator in OPERATORS.split()),
        *((f"a {operator} b", "no number") for operator in ("istype", "hastype", "@", "@@")),
        *((bound, "no number") for bound in ("not a", "@b", "c")),
        *((bound, "true") for bound in ("true", "1 < 2", "2 > 1", "1 <= 1", "1 >= 1", "1 == 1")),
        *((bound, "-1") for bound in ("-1", "1 - 2", "-2 + 1", "-1 * 1")),
        ("1 != 1", "false"),
        ("1.5", "1.5"),
    ],
)
def test_a_bound_whose_value_is_no_natural_number_is_reported(bound, found):
    text = "attribute a; attribute def b; attribute c : ScalarValues::String; part x[{}];"
    message = f"the multiplicity of 'x' has a bound that is {found}"
    assert list_messages(text.format(bound)) == [message]


@pytest.mark.parametrize(
    ("condition", "called"),
    [
        *((f"(1, 2)->{name} {{ true }}", name) for name in ("collect", "select", "selectOne")),
        *((f"(1, 2)->{name} {{ true }}", name) for name in ("reject", "forAll", "exists")),
        ("~true", "~"),
        ("all Parts::Part", "all"),
    ],
)
def test_a_condition_that_needs_a_running_system_is_reported(condition, called):
    text = f"package P {{ private import ControlFunctions::*; filter {condition}; }}"
    messages = list_messages(text)
    message = (
        f"the filter of 'P' uses '{called}', which cannot be evaluated without a running system"
    )
    assert message in messages


@pytest.mark.parametrize(
    ("kind", "general"),
    [
        ("attribute", "item"),
        ("attribute", "connection"),
        ("item", "attribute"),
        ("part", "connection"),
        ("connection", "attribute"),
        ("part", "action"),
        ("action", "part"),
    ],
)
def test_a_definition_cannot_specialise_one_of_an_excluded_kind(kind, general):
    (message,) = list_messages(f"{general} def A; {kind} def B :> A;")
    assert message.startswith("'B', ")
    assert " cannot specialise 'A', " in message
