"""Constraints about subsets, types made of others, bounds, conditions, metadata, ends, results."""

import pytest
from resolving import documents, library

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.language import checks
from sysmlc.language.checks import check
from sysmlc.language.metaclasses import ALL_GENERALS
from sysmlc.language.names import resolve

KERML = {
    *("SM251", "SM252", "SM254", "SM255", "SM256", "SM257", "SM258", "SM266", "SM267"),
    *("SM285", "SM286", "SM287", "SM288"),
}
"""Rules about what SysML has no notation for: their examples are in KerML."""
SYSML = {
    *("SM250", "SM259", "SM260", "SM261", "SM262", "SM263", "SM264", "SM265", "SM268", "SM269"),
    *("SM270", "SM271", "SM272", "SM273", "SM276", "SM277", "SM278", "SM279"),
    *("SM253", "SM280", "SM281", "SM282", "SM283", "SM284"),
}


def codes(text, language="sysml"):
    sink = Sink()
    check(resolve(documents(text, language=language), library(), sink), sink)
    return {one.rule.code for one in sink} - {"SM207"}


def found(text, language="sysml"):
    sink = Sink({"SM207": None})
    check(resolve(documents(text, language=language), library(), sink), sink)
    return [one.message for one in sink]


def test_every_rule_of_the_families_has_examples_here():
    assert checks.BY_KIND
    ours = {code for code in catalogue() if "SM250" <= code <= "SM299"}
    assert ours == KERML | SYSML


@pytest.mark.parametrize("code", sorted(KERML | SYSML))
def test_the_wrong_model_has_it_and_the_right_one_has_nothing(code):
    language = "kerml" if code in KERML else "sysml"
    rule = catalogue()[code]
    assert codes(rule.read_page().wrong, language) == {code}
    assert codes(rule.read_page().right, language) == set()


def test_metadata_is_for_what_its_definition_says():
    assert found("""
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


def test_the_core_has_every_metaclass_that_metadata_may_be_for():
    model = resolve(documents("part gate;"), library(), Sink())
    missing = [kind for kind in ALL_GENERALS if model.find(f"SysML::{kind}") is None]
    assert missing == []


def test_a_conjugate_turns_directions_around():
    text = "class C {{ in z; }} class T conjugates C; class D specializes T {{ {} :>> z; }}"
    assert found(text.format("out"), "kerml") == []
    assert found(text.format("in"), "kerml") == [
        "the direction of 'z' differs from that of its definition in 'C'"
    ]


def test_bounds_are_followed_through_values_that_are_constant():
    assert found("""
        attribute two = 1 + 1;
        attribute less = two - 3;
        attribute open;
        part a[two];
        part b[less];
        part c[open];
        part d[two > 1];
    """) == [
        "the multiplicity of 'b' has a bound that is -1",
        "the multiplicity of 'd' has a bound that is true",
        "the multiplicity of 'd' has an expression as a bound",
    ]


def test_values_that_double_at_each_step_are_given_up():
    doubled = "".join(f"attribute a{n} = a{n - 1} + a{n - 1};\n" for n in range(1, 200))
    assert found(f"attribute a0 = 1;\n{doubled}part gates[a199];") == []


def test_features_of_metadata_are_named_at_every_depth():
    assert found("""
        metadata def Limits { attribute speed { attribute max; } }
        part gate { @Limits { speed { max = 3; least = 1; } } }
    """) == ["'least' is not a feature of the metadata 'speed'"]


def test_a_feature_that_is_said_to_be_featured_may_be_redefined_where_no_type_owns_it():
    free = "class Car { member feature driver; member feature owner redefines Car::driver; }"
    told = ["'driver' is not a feature of a type, so 'owner' cannot redefine it"]
    assert found(free, "kerml") == told
    assert found(free.replace("driver;", "driver featured by Car;", 1), "kerml") == []
    assert found(f"{free} featuring of Car::driver by Car;", "kerml") == []


def test_flows_need_a_dot_unless_a_usage_holds_what_flows():
    text = (
        "part def A {{ out item x; }} part def B {{ in item z; }}"
        "{} plant {{ part a : A; part b : B; in item y; {} }}"
    )
    assert found(text.format("part def", "flow from a.x to b.z;")) == []
    assert found(text.format("part", "flow from a.x to y;")) == []
    assert found(text.format("part def", "flow from a.x to y;")) == [
        "'y' does not name the element whose feature the flow connects"
    ]
    assert found(text.format("part def", "flow from A::x to b.z;")) == [
        "'A::x' does not name the element whose feature the flow connects"
    ]


def test_a_member_with_the_name_of_an_inherited_one_redefines_it_or_hides_it():
    assert found("""
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
