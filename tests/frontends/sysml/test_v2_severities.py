"""Rules for SysML v1 in valid text of SysML v2, and the names in its contracts."""

from reading_v2 import read

from sysmlc.diagnostics import Coverage, Place, Severity, Sink, Subject, catalogue
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.frontends.sysml.rules import SEVERITIES
from sysmlc.ir import Graph
from sysmlc.logic.contract import Contract, EnumerationDomain, IntegerDomain
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline
from sysmlc.sources import Source

STEPS = ("resolve", "inherit", "classify", "ports", "flows", "behaviours", "activities")
ALL = (*STEPS, "contracts")
VALID = """
package P {
    enum def Colour { enum red; enum blue; }
    attribute def Paint;
    enum def Special :> Paint { enum gold; }
    abstract action def Work { in speed : ScalarValues::Integer; }
    requirement def Quiet { doc /* Be quiet. */ }
    port def Pipe { out attribute amount; }
    part def Pump { port p; port q : Pipe; port r : ~Pipe; flow from q.amount to r.amount; }
    part one : Pump { port redefines p; }
    part def Plant { part pump : Pump; perform action run : Work; }
}
"""


def test_rules_of_sysml_v1_are_silent_where_the_language_judges():
    assert read(VALID, passes=ALL).list_codes() == ["SM300"]
    assert SEVERITIES["SM202"] is None


def test_a_cycle_of_specialisations_is_reported_once():
    cycle = "package P { part def A :> B; part def B :> A; part def C :> A; }"
    assert read(cycle, passes=ALL).list_codes() == ["SM206"]


def test_the_project_has_the_last_word():
    graph, sink = Graph(), Sink({"SM214": Severity.WARNING})
    FRONTEND.read([Source("model.sysml", VALID.encode())], graph, sink, Coverage())
    pipeline.build_pipeline(("resolve", "inherit", "classify")).run(graph, sink)
    assert [diagnostic.rule.code for diagnostic in sink] == ["SM214"]


def test_other_files_are_judged_as_before():
    sink, rule = Sink(), catalogue()["SM214"]
    sink.set_file_severities(["model.sysml"], SEVERITIES)
    sink.report(rule, Subject("a", place=Place("model.sysml")), requirement="a")
    sink.report(rule, Subject("b", place=Place("model.uml")), requirement="b")
    sink.report(rule, Subject("c"), requirement="c")
    assert [diagnostic.subject.name for diagnostic in sink] == ["b", "c"]


def find_contract(text, component):
    reading = read(text, passes=ALL)
    (contract,) = [
        find_contract
        for find_contract in reading.graph.derived(Contract)
        if find_contract.component == component
    ]
    names = {f"{variable.owner} {variable.name}" for variable in contract.variables}
    return names, reading.list_codes()


def test_outputs_of_steps_are_variables_of_the_contract():
    names, codes = find_contract(
        """
package P {
    private import ScalarValues::*;
    item def Picture { attribute sharp : Boolean; }
    action def Look { out seen : Boolean; out picture : Picture; }
    action def Check {
        first start;
        then action look : Look;
        then decide;
            if look.seen and look.picture.sharp then keep;
            else done;
        action keep;
        then done;
    }
}""",
        "P::Check",
    )
    assert {"env look_seen", "env look_picture_sharp"} <= names
    assert "SM458" not in codes


def test_a_name_that_is_no_output_of_the_step_stays_plain_words():
    names, codes = find_contract(
        """
package P {
    action def Look { out mass : ScalarValues::Real; }
    action def Check {
        first start;
        then action look : Look;
        then decide;
            if look.mass > 1.5 then keep;
            else done;
        action keep;
        then done;
    }
}""",
        "P::Check",
    )
    assert "SM458" in codes
    assert "env look_mass" not in names


MACHINE = """
package P {
    private import ScalarValues::*;
    part def Machine { attribute busy : Boolean; attribute text : String; attribute age : Real; }
    item def Fault { attribute severe : Boolean; }
    action def Reset { in hard : Boolean; out accepted : Boolean; }
    part def Cell {
        attribute def Nothing;
        exhibit state run {
            in machine : Machine;
            entry; then idle;
            state idle;
            state broken;
            transition first idle accept fault : Fault if fault.severe
                do assign machine.busy := false then broken;
            transition first broken accept reset : Reset
                do action { assign reset.accepted := true; assign machine.age := 1.5; }
                then idle;
        }
    }
}
"""


def test_payloads_and_arguments_of_states_are_variables_of_the_contract():
    names, codes = find_contract(MACHINE, "P::Cell")
    assert {"env fault_severe", "sys machine_busy", "sys reset_accepted"} <= names
    assert "SM412" not in codes


WORDS = """
package P {
    private import ScalarValues::*;
    enum def Kind :> Integer { none = -2; plain = 3; }
    item def Report { attribute text : String; }
    part def Cell {
        attribute last : String := "idle";
        attribute note : String;
        attribute kind : Integer;
        exhibit state run {
            entry; then idle;
            state idle { doc /* "never" said */ }
            state broken;
            transition first idle accept report : Report if report.text == "no good"
                do assign last := report.text then broken;
            transition first broken if last == "other" and kind == Kind::none
                do action { assign last := "idle"; assign kind := Kind::plain; assign note := ""; }
                then idle;
            transition first broken if kind > 40 then broken;
        }
    }
}
"""


def test_texts_are_those_that_a_behaviour_mentions_and_any_other():
    reading = read(WORDS, passes=ALL)
    (contract,) = reading.graph.derived(Contract)
    domains = {variable.name: variable.domain for variable in contract.variables}
    words = EnumerationDomain(
        ("no_good", "other", "idle", "empty", "other_2"), ("no good", "other", "idle", "")
    )
    assert domains["last"] == domains["note"] == domains["report_text"] == words
    assert domains["kind"] == IntegerDomain(-2, 40)
    assert {"SM415", "SM458"}.isdisjoint(reading.list_codes())
    moves = [print_formula(guarantee.formula) for guarantee in contract.guarantees]
    assert any("report_text=no_good" in text for text in moves)
    assert any("kind=-2" in text and "last=other" in text for text in moves)


def test_two_texts_of_which_neither_is_known_are_not_compared():
    compared = WORDS.replace('report.text == "no good"', "report.text == note")
    reading = read(compared, passes=ALL)
    (contract,) = reading.graph.derived(Contract)
    assert "SM411" in reading.list_codes()
    assert not any(
        "report_text=note" in print_formula(guarantee.formula) for guarantee in contract.guarantees
    )


def test_a_behaviour_without_texts_has_none_as_values():
    names, _ = find_contract(
        """
package P {
    part def Cell {
        attribute name : ScalarValues::String;
        attribute on : ScalarValues::Boolean;
        exhibit state run { entry; then idle; state idle; transition first idle if on then idle; }
    }
}""",
        "P::Cell",
    )
    assert "env on" in names
    assert not any("name" in name for name in names)


def test_what_has_no_finite_values_is_an_opaque_effect_with_a_warning():
    reading = read(MACHINE, passes=ALL)
    diagnostics = [diagnostic for diagnostic in reading.sink if diagnostic.rule.code == "SM415"]
    assert [(diagnostic.severity, diagnostic.message) for diagnostic in diagnostics] == [
        (
            Severity.WARNING,
            "'machine.age := 1.5' assigns to 'machine.age', which has no finite type; the contract "
            "shows the assignment as output 'machine_age_1_5'",
        )
    ]


def test_states_without_a_first_one_are_no_error():
    reading = read("package P { state def S { state a; state b; } }", passes=ALL)
    assert [(diagnostic.rule.code, diagnostic.severity) for diagnostic in reading.sink] == [
        ("SM421", Severity.WARNING)
    ]


def test_actions_without_successions_are_correct_but_have_no_contract():
    reading = read("package P { action def A { action a; action b; } }", passes=ALL)
    assert [(diagnostic.rule.code, diagnostic.severity) for diagnostic in reading.sink] == [
        ("SM486", Severity.INFO)
    ]


def test_components_of_one_name_in_two_files_are_reported_with_both():
    text = "package P { action def A { first start; then action x; then done; } }"
    reading = read(text, text, passes=ALL)
    (first, second) = [diagnostic for diagnostic in reading.sink if diagnostic.rule.code == "SM500"]
    assert first.notes == ("another 'P::A' is in model.sysml",)
    assert second.notes == ("another 'P::A' is in m0.sysml",)
    assert first.help.startswith("packages of two files have one name")


LOOP = """
package P {
    private import ScalarValues::*;
    attribute def Status { attribute free : Boolean; }
    part def Belt { attribute pallets : Status [0..*]; }
    action def Count {
        in ref belt : Belt;
        first start;
        then for p in belt.pallets {
            action look;
            then decide;
                if p.free then take;
                else skip;
            action take;
            action skip;
        }
        then done;
    }
}"""


def test_a_loop_keeps_its_collection_and_the_type_of_its_variable():
    reading = read(LOOP)
    region = reading.find_element("P::Count::<Structured>")
    assert region.attrs["collection"] == "belt.pallets"
    assert reading.list_targets("P::Count::<Structured>::p", "typed-by") == ["P::Status"]


def test_values_of_what_a_loop_is_at_are_variables_of_the_contract():
    names, codes = find_contract(LOOP, "P::Count")
    assert "env p_free" in names
    assert "SM458" not in codes
