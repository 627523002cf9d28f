"""Requirements, cases and relations of SysML v2 in the graph."""

from reading_v2 import classified, read

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
    light = reading.named("P::light")
    assert (light.role, light.attrs["req_id"], light.attrs["text"]) == (
        "requirement",
        "R1",
        "The car is light.",
    )
    assert reading.to("P::light", "subject") == ["P::Car"]
    assert reading.named("P::light::limit").attrs["body"] == "one.mass <= 1000.0"


def test_satisfactions_verifications_and_derivations_are_dependencies():
    reading = classified(MODEL)
    assert reading.to("P::car", "satisfies") == ["P::light"]
    assert reading.to("P::Weigh", "verifies") == ["P::light"]
    assert reading.to("P::safe", "derives") == ["P::light"]
    assert reading.to("P::car", "allocated-to") == ["P::car"]
    assert reading.named("P::Weigh").role == "test case"


def test_a_part_that_satisfies_may_be_called_as_the_subject():
    reading = classified("""
package P {
    part def Pump { part motor; }
    requirement quiet { subject pump : Pump; }
    part plant { part pump : Pump; satisfy quiet by pump; satisfy quiet by pump.motor; }
}""")
    assert reading.codes() == []
    assert reading.to("P::plant::pump", "satisfies") == ["P::quiet"]
    assert reading.to("P::Pump::motor", "satisfies") == ["P::quiet"]


def test_a_satisfaction_of_a_special_requirement_is_one_of_what_it_subsets():
    reading = classified("""
package P {
    requirement def Quiet;
    requirement quiet : Quiet;
    part pump;
    satisfy requirement here : Quiet subsets quiet by pump;
}""")
    assert reading.to("P::pump", "satisfies") == ["P::quiet"]


def test_use_cases_have_subjects_inclusions_and_actors():
    reading = read(MODEL)
    assert reading.to("P::Drive", "includes") == ["P::StartEngine"]
    assert reading.to("P::Drive", "subject") == ["P::Car"]
    ends = reading.graph.owned(reading.named("P::<Association>"))
    types = [reading.graph.target(one, "typed-by").name for one in ends]
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
    comments = [one for one in reading.graph if str(one.kind) == "Comment"]
    assert [one.attrs["body"] for one in comments] == ["What this is.", "Inside."]
    assert reading.graph.target(comments[1], "references").name == "Q"
    assert reading.to("P::B", "references") == ["P::Q::A"]
    assert reading.to("P::<Import>", "references") == ["P::Q"]
