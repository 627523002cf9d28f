"""Rules for SysML v1 in valid text of SysML v2, and the names in its contracts."""

import pytest
from reading_v2 import read

from sysmlc.diagnostics import Coverage, Place, Severity, Sink, Subject, catalogue
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.frontends.sysml.rules import SEVERITIES
from sysmlc.ir import Graph
from sysmlc.logic.contract import Contract, EnumerationDomain, IntegerDomain
from sysmlc.logic.domains import describe
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline
from sysmlc.simulation import run_scenarios
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


ACTIONS = ["SM402", "SM412", "SM450", "SM451", "SM454", "SM457", "SM464", "SM465", "SM466", "SM486"]


@pytest.mark.parametrize(
    ("port", "codes"),
    [
        ("port p : ~Orders { out :>> order; }", []),
        ("port p : ~Orders;", []),
        ("port p : Orders { in :>> order; }", ["SM315"]),
        ("port p : Orders;", ["SM315"]),
    ],
)
def test_a_conjugated_port_does_not_reverse_what_it_declares_itself(port, codes):
    text = """
package P {
    item def Order;
    port def Orders { in ref order : Order; }
    part def Sender { PORT }
    part def Taker { port q : Orders; }
    part def Shop { part s : Sender; part t : Taker; connect s.p to t.q; }
}"""
    assert read(text.replace("PORT", port), passes=ALL).list_codes() == codes


def list_action_findings(members):
    """Return the findings about actions, as ``code: message`` and ``help: advice``."""
    sink = read(f"package P {{ item def Go; item def Stop; {members} }}", passes=ALL).sink
    return [
        line
        for diagnostic in sink
        if diagnostic.rule.code in ACTIONS
        for line in (f"{diagnostic.rule.code}: {diagnostic.message}", f"help: {diagnostic.help}")
    ]


def test_an_accept_action_happens_once_in_each_performance_of_its_owner():
    first = "action wait accept Go; then action work; then action rest;"
    assert list_action_findings(f"action run {{ {first} }}") == []
    loop = "first start; then merge again; then action wait accept Go; then again;"
    assert list_action_findings(f"action run {{ {loop} }}") == [
        "SM466: action 'run' never finishes",
        "help: let a succession lead to 'done' if it is meant to end",
    ]


def test_several_successions_after_the_start_are_all_taken():
    both = "first start then a; first start then b; action a; action b;"
    assert list_action_findings(f"action run {{ {both} }}") == []
    merged = "first start; then merge m; first m then a; first m then b; action a; action b;"
    assert list_action_findings(f"action run {{ {merged} }}") == [
        "SM465: merge 'm' is drawn with 2 outgoing flows; it is taken as a merge and a fork",
        "help: draw two control nodes",
    ]


def test_a_step_may_specialise_a_step():
    steps = "action def Work { action step; } part def Cell { action move; }"
    special = "part def Fast :> Cell { action run :> move { action a; then action b; } }"
    assert list_action_findings(f"{steps} {special}") == []


def test_findings_about_steps_speak_of_steps():
    assert list_action_findings("action run { action a; action b; }") == [
        "SM486: action 'run' does not order its steps; it gets no contract",
        "help: order the steps with 'first <step> then <step>;'",
    ]
    assert list_action_findings("action run { action a; then action b; }") == []
    ring = "action a; action b; first a then b; first b then a;"
    assert list_action_findings(f"action run {{ {ring} }}") == [
        "SM450: action 'run' has no first step: a succession leads to each of its steps",
        "help: write 'first start then <step>;'",
    ]


@pytest.mark.parametrize(
    "reference",
    ["ref action other;", "ref action other : Grip;", "ref action other { action part; }"],
)
def test_a_referential_action_is_no_step(reference):
    steps = f"action def Grip {{ in x; }} action run {{ {reference} action a; }}"
    assert list_action_findings(steps) == []


def test_a_referential_action_in_an_order_is_a_step():
    assert list_action_findings("action run { ref action a; action b; first b then a; }") == []
    alone = "action run { ref action a; action b; action c; first b then a; }"
    assert list_action_findings(alone) == list_action_findings(alone.replace("ref ", ""))


def test_a_redefined_function_gets_its_arguments_where_the_function_is_called():
    base = "calc def Grade { in x; }"
    assert list_action_findings(f"{base} action def Study {{ calc grade {{ in x; }} }}") == [
        "SM464: parameter 'x' of action 'grade' gets no value; it is taken as available",
        "help: bind the parameter, or let a flow lead to it",
    ]
    study = "action def Trial { calc grade : Grade; } action t : Trial { calc :>> grade { in x; } }"
    assert "SM464" not in " ".join(list_action_findings(f"{base} {study}"))


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
    assert domains["kind"] == IntegerDomain(-2, 41)
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


def test_what_has_no_finite_values_is_an_opaque_effect():
    reading = read(MACHINE, passes=ALL)
    diagnostics = [d for d in reading.sink if d.rule.code in ("SM415", "SM416")]
    assert [(diagnostic.severity, diagnostic.message) for diagnostic in diagnostics] == [
        (
            Severity.INFO,
            "effect 'machine.age := 1.5' is not understood: 'machine.age' has no finite type; the "
            "contract shows it as output 'machine_age_1_5'",
        )
    ]


def test_an_action_may_subset_an_action_but_not_perform_a_part():
    subset = "package P { part def A { action general [1..*]; action echo :> general; } }"
    assert not any(d.severity is not Severity.INFO for d in read(subset, passes=ALL).sink)
    performed = "package P { part def A { part x; perform x; } }"
    errors = [d.rule.code for d in read(performed, passes=ALL).sink if d.is_error]
    assert errors == ["SM236"]


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


def test_variants_and_the_start_and_end_of_an_action_need_no_order():
    variants = "variation action def A { variant action a; variant action b; }"
    ends = "action def B { action a :>> start; action b :>> done; }"
    assert list_action_findings(f"{variants} {ends}") == []


def test_a_condition_over_a_feature_of_a_package_names_the_package():
    text = """package P {
        attribute ready : ScalarValues::Boolean;
        part def Cell {
            action work { first start; then decide; if ready then a; else a; action a; }
            exhibit state s { entry; then x; state x; transition first x if ready then x; }
        }
    }"""
    findings = [
        d for d in read(text, passes=ALL).sink if d.rule.code in ("SM411", "SM412", "SM458")
    ]
    assert {d.rule.code for d in findings} == {"SM411", "SM458"}
    assert all(
        "has no formula: 'ready' is a feature of package 'P'; " in d.message for d in findings
    )
    assert all(d.help.startswith("give it to the owner") for d in findings)


CONSTANTS = """package Limits {
    attribute top : ScalarValues::Natural = 9;
    attribute soft : ScalarValues::Natural := 9;
}
package P {
    enum def Mode { enum slow; enum fast; }
    attribute fast : Mode = Mode::slow;
    attribute step : ScalarValues::Natural = 2;
    part def Cell {
        attribute level : ScalarValues::Natural := 0;
        attribute mode : Mode := Mode::slow;
        exhibit state s { entry; then x; state x;
            transition first x if level < Limits::top and mode == fast
                do assign level := step then x; }
        action work { first start; then decide; if level < step then a; else a; action a; }
    }
    part def Other {
        attribute level : ScalarValues::Natural := 0;
        exhibit state s { entry; then x; state x;
            transition first x if level < Limits::soft then x; }
    }
}"""
TAKEN = "level=at_step | level=_3_to_top) & mode=slow -> state'=x & level'=at_step"


def test_attributes_of_packages_with_bound_values_are_constants_in_behaviours():
    reading = read(CONSTANTS, passes=ALL)
    findings = [d for d in reading.sink if d.rule.code in ("SM411", "SM412", "SM416", "SM458")]
    assert ["'Limits::soft'" in d.message for d in findings] == [True]
    (contract,) = (c for c in reading.graph.derived(Contract) if c.component == "P::Cell")
    texts = {print_formula(c.formula) for c in contract.guarantees}
    assert any(text.endswith(TAKEN) for text in texts)


@pytest.mark.parametrize(
    "declaration",
    ["private import Limits::top;", "private import Limits::*;", "alias top for Limits::top;"],
)
def test_a_constant_is_the_one_that_its_name_means_in_the_text(declaration):
    text = CONSTANTS.replace("Limits::top", "top")
    text = text.replace("part def Cell {", f"part def Cell {{ {declaration}")
    reading = read(f"package Other {{ attribute top = 5; }} {text}", passes=ALL)
    (contract,) = (c for c in reading.graph.derived(Contract) if c.component == "P::Cell")
    (taken,) = (c for c in contract.guarantees if c.text.startswith("In 'x'"))
    assert print_formula(taken.formula).endswith(TAKEN)
    guard = "[level < top and mode == fast] (top = 9, fast = slow)"
    assert taken.text.startswith(f"In 'x', when 'x' is complete and {guard}: ")


IMPORTED_CONSTANTS = """
package Limits {
    private import ScalarValues::*;
    attribute top : Integer = 20;
    attribute 'half way' : Integer = 10;
    attribute open : Integer;
    attribute on : Boolean = true;
}
package Plant {
    private import ScalarValues::*;
    private import Limits::*;
    attribute def Go;
    part def Tank {
        attribute level : Integer = top;
        attribute valve : Boolean = on;
        attribute tank : Integer = 0;
        assert constraint { 0 <= tank and tank <= top }
        exhibit state life {
            entry; then x;
            state x;
            transition first x accept Go if level >= 'half way' and valve
                do action { assign level := 0; assign tank := top; } then x;
            transition first x accept Go if level < 'half way' do assign valve := false then y;
            state y;
            OPEN
        }
    }
}
"""


def test_constants_give_defaults_bounds_and_thresholds():
    reading = read(IMPORTED_CONSTANTS.replace("OPEN", ""), passes=ALL)
    (contract,) = reading.graph.derived(Contract)
    assert [d.rule.code for d in reading.sink if d.severity != "info"] == []
    texts = [print_formula(g.formula) for g in contract.guarantees]
    assert {"level=at_20", "valve", "tank=0"} <= set(texts)
    at_least_10 = "(level=half_way_to_20 | level=at_20 | level=from_21)"
    taken = f"state=x & event=Go & {at_least_10} & valve"
    assert f"{taken} -> state'=x & level'=at_0 & tank'=20" in texts
    assert {v.name: describe(v.domain) for v in contract.variables}["tank"] == "0..20"
    assert any("('half way' = 10)" in g.text for g in contract.guarantees)


def test_scenarios_play_behaviours_with_imported_constants():
    graph = read(IMPORTED_CONSTANTS.replace("OPEN", ""), passes=ALL).graph
    steps = (
        "{expect: {state: x, level: 20}}, {inputs: {event: Go}}, {inputs: {event: Go}, expect: "
        "{state: x, level: 0, tank: 20}}, {expect: {state: y, valve: false}}"
    )
    scenario = f"name: twice\ncomponent: Tank\nsteps: [{steps}]\n"
    report = run_scenarios(graph, Source("scenario.yaml", scenario.encode()), Sink())
    assert [result.difference for result in report.results] == [None]


def test_a_constant_without_a_value_hides_the_constants_around_it():
    text = IMPORTED_CONSTANTS.replace("package Plant {", "package Plant { package Inner {") + "}"
    text = text.replace("OPEN", "transition first y accept Go if level > open then x;")
    text = text.replace(
        "package Inner {", "attribute open : ScalarValues::Integer = 2; package Inner {"
    )
    reading = read(text, passes=ALL)
    messages = "".join(diagnostic.message for diagnostic in reading.sink)
    assert "'Limits::open' is a feature of package 'Limits'; the contract treats" in messages


def test_components_of_one_name_in_two_files_are_reported_once_with_both():
    text = "package P { action def A { first start; then action x; then done; } }"
    reading = read(text, text, passes=ALL)
    (finding,) = [diagnostic for diagnostic in reading.sink if diagnostic.rule.code == "SM500"]
    assert finding.notes == ("another 'P::A' is in model.sysml",)
    assert finding.help.startswith("packages of two files have one name")


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


def test_enumerations_and_constants_of_one_name_are_distinct_in_a_contract():
    reading = read(
        """
package P {
    private import ScalarValues::*;
    package A { enum def Mode { off = 1; slow = 2; } attribute LIMIT : Integer = 3; }
    package B { enum def Mode { slow = 4; off = 6; auto = 7; } attribute LIMIT : Integer = 5; }
    part def Pump {
        private import A::*;
        in attribute a : A::Mode;
        in attribute n : Integer { assert constraint { n >= 0 and n <= 7 } }
        attribute b : B::Mode := B::Mode::off;
        exhibit state run {
            private import B::*;
            entry; then idle;
            state idle;
            state busy { entry action { assign b := B::Mode::auto; } }
            transition first idle if A::Mode::slow == a and n >= LIMIT then busy;
            transition first busy if n >= A::LIMIT and n != B::Mode::slow then idle;
        }
    }
}
""",
        passes=ALL,
    )
    (contract,) = reading.graph.derived(Contract)
    domains = {variable.name: describe(variable.domain) for variable in contract.variables}
    assert (domains["a"], domains["b"]) == ("off, slow", "slow, off, auto")
    formulas = {print_formula(conjunct.formula) for conjunct in contract.guarantees}
    assert "state=idle & slow=a & n>=5 -> state'=busy & b'=auto" in formulas
    assert "state=busy & n>=3 & n!=4 -> state'=idle" in formulas
    assert reading.list_codes() == []
