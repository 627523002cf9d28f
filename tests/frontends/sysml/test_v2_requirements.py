"""Requirements, cases and relations of SysML v2 in the graph."""

from reading_v2 import read, read_classified

from sysmlc.ir import Kind

MODEL = """
package P {
    part def Car { attribute mass : ScalarValues::Real; }
    requirement <R1> light {
        doc /* The car is light. */
        subject one : Car;
        assume constraint { one.mass > 0.0 }
        require constraint limit { one.mass <= 1000.0 }
    }
    requirement def <R2> Safe { doc /* The car is safe. */ }
    part car : Car;
    satisfy light by car;
    verification def Weigh {
        objective { verify light; }
    }
    use case def Drive {
        subject car : Car;
        actor driver : Driver;
        include use case start : StartEngine;
    }
    part def Driver;
    use case def StartEngine;
    part def Sensor;
    allocate car to car;
    #derivation connection { end #original ::> light; end #derive ::> safe; }
    requirement safe : Safe;
    private import RequirementDerivation::*;
}
"""


def test_a_requirement_has_id_text_subject_and_constraints():
    reading = read(MODEL)
    light = reading.find_element("P::light")
    assert (light.role, light.attrs["req_id"], light.attrs["text"]) == (
        "requirement",
        "R1",
        "The car is light.",
    )
    assert reading.list_targets("P::light", "subject") == ["P::Car"]
    assert reading.find_element("P::light::limit").attrs["body"] == "one.mass <= 1000.0"


def test_satisfactions_verifications_and_derivations_are_dependencies():
    reading = read_classified(MODEL)
    assert reading.list_targets("P::car", "satisfies") == ["P::light"]
    assert reading.list_targets("P::Weigh", "verifies") == ["P::light"]
    assert reading.list_targets("P::safe", "derives") == ["P::light"]
    assert reading.list_targets("P::car", "allocated-to") == ["P::car"]
    assert reading.find_element("P::Weigh").role == "test case"


def test_a_part_that_satisfies_may_be_called_as_the_subject():
    reading = read_classified("""
package P {
    part def Pump { part motor; }
    requirement quiet { subject pump : Pump; }
    part plant { part pump : Pump; satisfy quiet by pump; satisfy quiet by pump.motor; }
}""")
    assert reading.list_codes() == []
    assert reading.list_targets("P::plant::pump", "satisfies") == ["P::quiet"]
    assert reading.list_targets("P::Pump::motor", "satisfies") == ["P::quiet"]


def test_a_satisfaction_of_a_special_requirement_is_one_of_what_it_subsets():
    reading = read_classified("""
package P {
    requirement def Quiet;
    requirement quiet : Quiet;
    part pump;
    satisfy requirement here : Quiet subsets quiet by pump;
}""")
    assert reading.list_targets("P::pump", "satisfies") == ["P::quiet"]


def test_the_subject_of_an_enclosing_requirement_satisfies_the_inner_one():
    reading = read_classified("""
package P {
    part def Pump;
    requirement def Quiet { subject pump : Pump; }
    requirement site { subject pm : Pump; requirement quiet : Quiet; satisfy quiet by pm; }
}""")
    assert reading.list_targets("P::site", "satisfies") == ["P::site::quiet"]
    assert [diagnostic.message for diagnostic in reading.sink] == [
        "a satisfaction by a subject is read as one by the requirement with this subject "
        "(1 in the unit)"
    ]


def test_the_subject_of_the_satisfied_requirement_cannot_satisfy_it():
    reading = read_classified("""
package P {
    part def Pump;
    requirement quiet { subject pump : Pump; }
    part plant { satisfy quiet by pump; }
}""")
    assert reading.list_codes() == ["SM205"]


def test_a_verification_after_a_satisfaction_leads_to_the_requirement():
    reading = read_classified("""
package P {
    requirement quiet;
    part pump;
    part site {
        satisfy quiet by pump;
        verification weigh { objective { verify quiet; } }
    }
}""")
    assert reading.list_targets("P::site::weigh", "verifies") == ["P::quiet"]


def test_a_negated_satisfaction_is_no_satisfaction():
    reading = read_classified("""
package P {
    requirement quiet;
    requirement cheap;
    part pump;
    not satisfy quiet by pump;
    satisfy cheap by pump;
}""")
    assert reading.list_targets("P::pump", "satisfies") == ["P::cheap"]
    roles = [element.role for element in reading.graph.of_kind(Kind.DEPENDENCY)]
    assert roles == ["not satisfy", "satisfy"]
    assert reading.list_codes() == []


def test_use_cases_have_subjects_inclusions_and_actors():
    reading = read(MODEL)
    assert reading.list_targets("P::Drive", "includes") == ["P::StartEngine"]
    assert reading.list_targets("P::Drive", "subject") == ["P::Car"]
    ends = reading.graph.owned(reading.find_element("P::<Association>"))
    types = [reading.graph.target(end, "typed-by").name for end in ends]
    assert types == ["Drive", "Driver"]


def test_comments_documentation_aliases_and_imports():
    reading = read("""
package P {
    doc /* What this is. */
    package Q { part def A; }
    private import Q::*;
    alias B for Q::A;
    comment about Q /* Inside. */
}""")
    comments = [element for element in reading.graph if str(element.kind) == "Comment"]
    assert [comment.attrs["body"] for comment in comments] == ["What this is.", "Inside."]
    assert reading.graph.target(comments[1], "references").name == "Q"
    assert reading.list_targets("P::B", "references") == ["P::Q::A"]
    assert reading.list_targets("P::<Import>", "references") == ["P::Q"]
