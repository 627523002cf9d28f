"""Verdicts that rest on an assumption of the compiler name it.

An Integer without a range that is more than compared is taken as 0..15 (SM410); a condition without
formula is a free input (SM411). Neither is a fact of the model.
"""

import json

import pytest


@pytest.fixture
def check(workspace, all_passes):
    """Return a function from a block and formulas to the printed verdicts, in order."""

    def run(block, *formulas):
        workspace.write("model.sysml", _require(block, formulas))
        result = workspace.sysmlc("contracts", "check", "-v", "model.sysml")
        lines = [line.strip() for line in result.stdout.splitlines()]
        return [line for line in lines if line.startswith("R")]

    return run


@pytest.fixture
def report(workspace, all_passes):
    """Return a function from a block and formulas to the JSON document about it."""

    def run(block, *formulas):
        workspace.write("model.sysml", _require(block, formulas))
        result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
        return json.loads(result.stdout)

    return run


def _require(block, formulas):
    requirements = (
        f"requirement def R{number} {{ subject b : B; "
        f'require constraint {{ language "ltl" /* {formula} */ }} }}'
        for number, formula in enumerate(formulas)
    )
    head = ("package P {", "private import ScalarValues::*;", "item def Go;", "item def Stop;")
    return "\n".join((*head, f"part def B {{ {block} }}", *requirements, "}"))


# -- ranges --------------------------------------------------------------------------------------

LEVEL = """
in attribute level : Integer;
exhibit state M {
    entry; then B;
    state B;
    state A;
    transition first B if level * level > level + 400 then A;
}"""


def test_what_holds_within_an_assumed_range_says_so(check):
    assert check(LEVEL, "G (state=B -> G state=B)", "G (state=A -> G state=A)") == [
        "R0: holds within level in 0..15 (assumed): G (state=B -> G state=B)",
        "R1: holds within level in 0..15 (assumed): G (state=A -> G state=A)",
    ]


def test_the_json_document_lists_assumed_ranges(report):
    document = report(LEVEL, "G (state=B -> G state=B)")
    (entry,) = document["requirements"]
    assert entry["verdict"] == "holds-within-assumed-ranges"
    assert entry["assumed_ranges"] == ["level in 0..15"]
    (behaviour,) = document["behaviours"]
    assert behaviour["unreachable"] == ["A"]
    assert behaviour["assumed_ranges"] == ["level in 0..15"]


def test_findings_about_unreachable_places_name_the_range(report):
    findings = report(LEVEL, "G (state=B -> G state=B)")["diagnostics"]
    messages = {finding["code"]: finding["message"] for finding in findings}
    within = " within level in 0..15 (assumed)"
    assert messages["SM559"].endswith(f"reaches 'A'{within}")
    assert messages["SM517"].endswith(f"although runs reach its source{within}")


def test_a_declared_range_is_a_fact(check):
    block = LEVEL.replace(";", "; assert constraint { level >= 0 and level <= 15 }", 1)
    assert check(block, "G state=B") == ["R0: holds: G (state=B)"]


def test_an_integer_that_does_not_matter_is_not_named(check):
    block = """
    in attribute level : Integer;
    attribute x : Integer := 0;
    exhibit state M {
        entry; then B;
        state B;
        transition first B accept Go do assign x := level then B;
    }"""
    assert check(block, "G state=B", "G x <= 15") == [
        "R0: holds: G (state=B)",
        "R1: holds within level in 0..15 and x in 0..15 (assumed): G (x<=15)",
    ]


COUNTER = """
attribute count : Integer := 0;
assert constraint { count * count < 1000 }
exhibit state M {
    entry; then A;
    state A;
    transition first A accept Go do assign count := count + 1 then A;
}"""


def test_a_run_within_the_assumed_range_breaks_a_requirement(check):
    formulas = "G (count <= 3)", "G (event=Go -> X (count = 1))"
    assert [line[:10] for line in check(COUNTER, *formulas)] == ["R0: broken", "R1: broken"]


def test_a_bound_of_an_assumed_range_neither_proves_nor_refutes(check):
    formulas = "G (event=Go & count = 15 -> X (count = 16))", "G (count > 14 -> X (count = 15))"
    stopped, proved = check(COUNTER, *formulas)
    assert stopped.startswith("R0: not decided: it depends on count in 0..15 (assumed): ")
    assert proved.startswith("R1: holds within count in 0..15 (assumed): ")


def test_a_promise_that_holds_only_at_the_bound_is_not_decided(check):
    block = COUNTER.replace("accept Go ", "")
    promised, broken = check(block, "F G (count = 15)", "G (count <= 3)")
    assert promised.startswith("R0: not decided: it depends on count in 0..15 (assumed): ")
    assert broken.startswith("R1: broken: ")


def test_a_range_in_a_part_has_the_name_of_the_author(check):
    block = """
    part tank {
        in attribute level : Integer;
        exhibit state M {
            entry; then B; state B; state A;
            transition first B if level * level > level + 400 then A;
        }
    }"""
    (line,) = check(block, "G tank.state=B")
    assert line.startswith("R0: holds within tank.level in 0..15 (assumed): ")


# -- regions -------------------------------------------------------------------------------------


def make_counter(initial, *transitions):
    """Return a block with an Integer ``n``, which starts with a value, and transitions from A."""
    ways = " ".join(f"transition first A accept Go {transition};" for transition in transitions)
    states = f"exhibit state M {{ entry; then A; state A; state C; {ways} }}"
    return f"attribute n : Integer := {initial}; {states}"


@pytest.mark.parametrize(
    ("block", "true", "false"),
    [
        (make_counter(0, "do assign n := n + 1 then A", "if n >= 3 then C"), "n >= 0", "n <= 40"),
        (make_counter(0, "if n < 4 do assign n := n + 1 then A"), "n <= 4", "n <= 3"),
        (make_counter(0, "if n < 4 do assign n := n + 3 then A"), "n <= 6", "n != 6"),
        (make_counter(3, "do assign n := n - 2 then A", "if n < 0 then C"), "n != 2", "n > 0"),
        (make_counter(1, "if n < 5 do assign n := 90 then A"), "n <= 90", "n < 90"),
        (make_counter(0, "then A", "if n > 20 then C"), "state=A", "n > 0"),
    ],
)
def test_an_integer_that_is_only_compared_needs_no_range(check, block, true, false):
    assert [line[:10] for line in check(block, f"G ({true})", f"G ({false})")] == [
        "R0: holds:",
        "R1: broken",
    ]


def test_a_natural_that_is_only_compared_is_not_negative(check):
    block = LEVEL.replace("Integer", "Natural").replace("level * level > level + 400", "level < 0")
    assert check(block, "G state=B", "G (level >= 0)") == [
        "R0: holds: G (state=B)",
        "R1: holds: G level >= 0",
    ]


@pytest.mark.parametrize("used", ["a * b < 3", "(a + b) * 2 < 6"])
def test_numbers_that_a_formula_multiplies_have_ranges(check, used):
    block = make_counter(0, "if a > 2 and b > 2 then C")
    block = f"in attribute a : Integer; in attribute b : Integer; {block}"
    (line,) = check(block, f"G (state=A & {used} -> X state=A)")
    assert "in 0..15" in line


def test_a_number_in_a_requirement_is_no_constraint_of_the_block(check, workspace):
    check(make_counter(0, "if n < 3 do assign n := 5 then C"), "n < 4")
    text = workspace.read("model.sysml").replace('language "ltl" /* n < 4 */', "b.n < 4")
    workspace.write("model.sysml", text)
    result = workspace.sysmlc("contracts", "check", "-v", "model.sysml")
    assert "R0: broken: G n < 4" in result.stdout


# -- conditions ----------------------------------------------------------------------------------

ROOM = """
attribute temp : Real;
calc def cold { in x : Real; return : Boolean; }
calc def warm { in x : Real; return : Boolean; }
exhibit state M {
    entry; then A;
    state A;
    state B;
    state C;
    transition first A if cold(temp) then B;
    transition first A if warm(temp) then C;
    transition first C accept Go then A;
}"""


def test_a_run_that_depends_on_an_unread_condition_decides_nothing(check):
    assert check(
        ROOM, "F !(state=A)", "G !(state=B)", "G !(state=C)", "G (state=B -> X state=B)"
    ) == [
        "R0: not decided: it depends on 'cold(temp)': F !state=A",
        "R1: not decided: it depends on 'cold(temp)': G (!state=B)",
        "R2: not decided: it depends on 'warm(temp)': G (!state=C)",
        "R3: holds: G (state=B -> state'=B)",
    ]


def test_conditions_that_are_opposites_are_one_input(check):
    block = ROOM.replace("warm(temp)", "not cold(temp)")
    assert check(block, "F !(state=A)", "G !(state=B)") == [
        "R0: holds: F !state=A",
        "R1: not decided: it depends on 'cold(temp)': G (!state=B)",
    ]


@pytest.mark.parametrize("condition", ["cold(temp)", "not cold(temp)"])
def test_the_past_of_a_condition_that_does_not_matter_is_no_doubt(check, condition):
    block = ROOM.replace("if cold(temp) then B", "accept Stop then B").replace("warm", "cold")
    change = f"transition first B accept when {condition} then A;"
    block = block.replace("state C;", f"state C; {change}").replace("if cold", "accept Go if cold")
    assert check(block, "G !(state=B)") == ["R0: broken: G (!state=B)"]


def test_a_run_that_depends_on_an_unread_condition_is_no_error(check, workspace):
    check(ROOM, "F !(state=A)")
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    assert result.exit_code == 0
    assert "SM560" not in result.stderr + result.stdout


def test_the_json_document_lists_unread_conditions(report):
    document = report(ROOM, "F !(state=A)")
    (entry,) = document["requirements"]
    assert entry["verdict"] == "not-decided"
    assert entry["unread_conditions"] == ["cold(temp)"]
    assert entry["reason"] == "it depends on 'cold(temp)'"
    messages = [d["message"] for d in document["diagnostics"] if d["code"] == "SM562"]
    assert [message.rpartition(": ")[2] for message in messages] == ["it depends on 'cold(temp)'"]


def test_a_run_whatever_a_condition_does_breaks_a_requirement(report):
    block = ROOM.replace("first A if cold(temp) then B", "first A accept Stop then B")
    block = block.replace("first A if warm(temp)", "first A accept Go if warm(temp)")
    document = report(block, "G !(state=B)", "G !(state=C)")
    assert [entry["verdict"] for entry in document["requirements"]] == ["broken", "not-decided"]
    steps = document["requirements"][0]["witness"]["steps"]
    assert all("temp" not in name for step in steps for name in step)


def test_a_change_of_an_unread_condition_decides_nothing(check):
    block = """
    attribute temp : Real;
    calc def cold { in x : Real; return : Boolean; }
    exhibit state M {
        entry; then A;
        state A;
        state B;
        state C;
        transition first A accept when cold(temp) then B;
        transition first A accept Go then C;
    }"""
    lines = check(block, "G !(state=B)", "G !(state=C)", "G (state=C -> G state=C)")
    assert lines[0] == "R0: not decided: it depends on 'cold(temp)': G (!state=B)"
    assert lines[1:] == ["R1: broken: G (!state=C)", "R2: holds: G (state=C -> G state=C)"]


def test_a_decision_with_unread_guards_decides_nothing(check):
    block = """
    attribute temp : Real;
    attribute hot : Boolean := false;
    calc def rise { in x : Real; return : Real; }
    perform action run {
        first start;
        then action look;
        then decide choose;
            if rise(temp) > 20.5 then heat;
            if rise(temp) <= 20.5 then done;
        action heat assign hot := true;
        first heat then done;
    }"""
    lines = check(block, "G !hot", "G !running(look)")
    assert lines == [
        "R0: not decided: it depends on 'rise(temp) > 20.5': G (!hot)",
        "R1: broken: G !running(look)",
    ]


def test_a_violation_in_a_part_does_not_depend_on_conditions_of_another(check):
    block = """
    calc def cold { in x : Real; return : Boolean; }
    calc def warm { in x : Real; return : Boolean; }
    part room { attribute temp : Real; exhibit state M {
        entry; then A; state A; state B; transition first A if cold(temp) then B;
        transition first A if warm(temp) then B;
    } }
    part door { exhibit state M {
        entry; then Shut; state Shut; state Open; transition first Shut accept Go then Open;
    } }"""
    assert check(block, "G door.state=Shut") == ["R0: broken: G door.state=Shut"]


# -- contracts -----------------------------------------------------------------------------------

LAMP = """{{"format": "sysmlc-contract/1", "name": "Lamp", "origin": "",
 "variables": {{
  "hot": {{"owner": "env", "type": "bool", "origin": "", "condition": "temp > 80.0"}},
  "level": {{"owner": "sys", "type": [0, 15], "origin": "", "assumed": true}},
  "lamp": {{"owner": "sys", "type": "bool", "origin": ""}}}},
 "assumptions": {{"init": [], "safety": [], "liveness": [], "other": []}},
 "guarantees": {{"init": [], "liveness": [], "other": [], "safety": [
  {{"formula": "{}", "class": "safety", "origin": "", "text": ""}}]}}}}"""


def write_lamp(workspace, name, formula):
    workspace.write(f"{name}.contract.json", LAMP.format(formula))


def test_a_contract_names_its_assumed_ranges(workspace, all_passes):
    write_lamp(workspace, "lamp", "lamp' <-> hot'")
    result = workspace.sysmlc("synth", "lamp.contract.json", "--realizable")
    assert result.stdout.startswith("Lamp: realizable within level in 0..15 (assumed) (")
    assert result.exit_code == 0


def test_an_unread_condition_makes_no_contract_unrealizable(workspace, all_passes):
    write_lamp(workspace, "lamp", "lamp <-> hot'")
    result = workspace.sysmlc("synth", "lamp.contract.json", "--realizable")
    assert "Lamp: not decided" in result.stdout
    message = "a system can satisfy the contract of 'Lamp': it depends on 'temp > 80.0'"
    assert message in result.stdout + result.stderr
    assert "warning[SM547 depends-on-unread-condition]" in result.stderr
    assert result.exit_code == 2


def test_a_refinement_names_what_it_rests_on(workspace, all_passes):
    write_lamp(workspace, "strong", "lamp' <-> hot'")
    write_lamp(workspace, "weak", "lamp' -> hot'")
    files = "weak.contract.json", "strong.contract.json"
    result = workspace.sysmlc("contracts", "refine", *files)
    assert result.stdout == "Lamp refines Lamp within level in 0..15 (assumed)\n"
    result = workspace.sysmlc("contracts", "refine", *files[::-1], "--format", "json")
    (entry,) = json.loads(result.stdout)["requirements"]
    assert entry["verdict"] == "not-decided"
    assert entry["unread_conditions"] == ["temp > 80.0"]
    assert result.exit_code == 2


def test_contract_files_and_pages_mark_ranges_and_conditions(workspace, all_passes):
    transition = "transition first C accept Stop if level * level < 9 then B;"
    block = ROOM.replace("state C;", f"state C; {transition}")
    workspace.write("model.sysml", _require(f"in attribute level : Integer;{block}", ()))
    assert workspace.sysmlc("model.sysml", "-o", "out").exit_code == 0
    contract = json.loads(workspace.read("out/contracts/P.B.contract.json"))
    assert contract["variables"]["level"]["assumed"] is True
    assert contract["variables"]["cold_temp"]["condition"] == "cold(temp)"
    reason = "calls such as 'cold(temp)' are not evaluated"
    assert contract["variables"]["cold_temp"]["reason"] == reason
    page = workspace.read("out/contracts/P.B.md")
    assert "| `level` | 0..15 (assumed) |" in page
    assert (
        f"| `cold_temp` | Boolean, stands for `cold(temp)`, which has no formula: {reason} |"
        in page
    )


SCENARIO = """
name: counts
component: B
steps:
  - inputs: {{event: Go}}
    repeat: {}
  - expect: {{count: {}}}
"""


@pytest.mark.parametrize(
    ("steps", "value", "line"),
    [
        (3, 4, "FAILED  P::B: counts within count in 0..15 (assumed)"),
        (16, 15, "passed  P::B: counts (17 steps) within count in 0..15 (assumed)"),
    ],
)
def test_a_scenario_names_the_range_at_whose_bound_it_is(workspace, all_passes, steps, value, line):
    workspace.write("model.sysml", _require(COUNTER, ()))
    workspace.write("counts.yaml", SCENARIO.format(steps, value))
    result = workspace.sysmlc("simulate", "model.sysml", "--scenario", "counts.yaml")
    assert result.stdout.splitlines()[0] == line


def test_a_scenario_away_from_the_bounds_passes(workspace, all_passes):
    workspace.write("model.sysml", _require(COUNTER.replace(":= 0", ":= 1"), ()))
    workspace.write("counts.yaml", SCENARIO.format(3, 4))
    result = workspace.sysmlc("simulate", "model.sysml", "--scenario", "counts.yaml")
    assert result.stdout.splitlines()[0] == "passed  P::B: counts (4 steps)"


def test_a_recorded_run_outside_an_assumed_range_is_not_the_fault_of_the_component(
    workspace, all_passes
):
    workspace.write("model.sysml", _require(COUNTER, ()))
    rows = ["event,count,state", *(f"Go,{count},A" for count in range(18))]
    workspace.write("run.csv", "\n".join(rows))
    result = workspace.sysmlc("contracts", "accept", "model.sysml", "run.csv", "-c", "P::B")
    assert "SM593" in result.stdout + result.stderr
    assert "'count' stays between 0 and 15, which is assumed." in result.stdout + result.stderr
    assert result.exit_code == 0


COMPOSITION = """package P {
    private import ScalarValues::*;
    item def Go;
    calc def cold { in x : Real; return : Boolean; }
    calc def warm { in x : Real; return : Boolean; }
    part def Sensor {
        attribute temp : Real;
        attribute count : Integer := 0;
        assert constraint { count * count < 1000 }
        out attribute hot : Boolean := false;
        exhibit state S {
            entry; then A; state A; state B;
            transition first A accept Go {} do assign hot := true then B;
            transition first A accept Go {} do assign count := count + 1 then B;
        }
    }
    part def Lamp { in attribute hot : Boolean; out attribute on : Boolean := false; }
    requirement def Dark {
        subject lamp : Lamp;
        assume constraint { language "ltl" /* G !hot */ }
        require constraint { language "ltl" /* G !on */ }
    }
    part def Plant { part sensor : Sensor; part lamp : Lamp; connect sensor.hot to lamp.hot; }
}"""


def check_composition(workspace, *guards):
    head, middle, tail = COMPOSITION.split("{} ")
    workspace.write("model.sysml", f"{head}{guards[0]} {middle}{guards[1]} {tail}")
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    return result.stdout.splitlines()[-1], result


def test_parts_that_an_unread_condition_separates_are_not_decided(workspace, all_passes):
    line, result = check_composition(workspace, "if cold(temp)", "if warm(temp)")
    reason = "it depends on 'cold(temp)' and 'warm(temp)'"
    assert line == f"P::Plant: the composition of its parts is not decided: {reason}"
    assert reason in result.stderr
    assert result.exit_code == 2
    assert "SM595" not in result.stdout + result.stderr


def test_the_verdict_about_parts_names_assumed_ranges(workspace, all_passes):
    line, result = check_composition(workspace, "", "")
    assert (
        line == "P::Plant: its 2 parts do not fit together within sensor.count in 0..15 (assumed)"
    )
    assert "SM595" in result.stdout + result.stderr


def test_a_run_that_breaks_a_formula_at_once_needs_no_condition(check):
    block = """
in attribute load : Real; attribute on : Boolean := false;
calc def light { in x : Real; return : Boolean; }
exhibit state M {
    entry; then A; state A; state B;
    transition first A accept Go if light(load) do assign on := true then B;
}"""
    formulas = "G (event!=Go)", "G (event=Go -> on)", "G (event=Go -> X on)"
    assert check(block, *formulas) == [
        "R0: broken: G (event!=Go)",
        "R1: broken: G (event=Go -> on)",
        "R2: not decided: it depends on 'light(load)': G (event=Go -> on')",
    ]


def test_all_behaviours_of_a_component_extend_an_assumed_range_in_the_same_way(check):
    """The machine knew values beyond 15 that the component did not know: nothing was decided."""
    block = """
attribute n : Integer := 0;
assert constraint { n * n < 1000 }
exhibit state M {
    entry; then A; state A;
    transition first A accept Go if n < 20 do assign n := n + 1 then A;
}
exhibit state W {
    entry; then Low; state Low; state High;
    transition first Low if n > 17 then High;
}"""
    assert check(block, "G W.state=Low", "G (n <= 20)", "G (W.state=High -> n > 17)") == [
        "R0: broken: G W.state=Low",
        "R1: holds within n in 0..20 (assumed): G (n<=20)",
        "R2: holds within n in 0..20 (assumed): G (W.state=High -> n>17)",
    ]


@pytest.mark.parametrize(
    ("guard", "range_"),
    [
        ("level < 0", "-1..15"),
        ("level >= 0", "-1..15"),
        ("0 > level", "-1..15"),
        ("level <= 15", "0..16"),
        ("level > 20", "0..21"),
        ("20 < level", "0..21"),
        ("level == 20", "0..20"),
        ("level > -3 and level < 18", "-3..18"),
    ],
)
def test_an_assumed_range_has_numbers_on_both_sides_of_each_threshold(check, guard, range_):
    """``level > 20`` was never true, because 0..20 was assumed."""
    block = LEVEL.replace("level * level > level + 400", f"({guard}) and level * level >= 0")
    broken, proved = check(block, "G state=B", "G (state=A -> G state=A)")
    assert broken == "R0: broken: G (state=B)"
    assert proved == f"R1: holds within level in {range_} (assumed): G (state=A -> G state=A)"


@pytest.mark.parametrize(
    ("declared", "range_"),
    [
        ("level >= 0", "0..15"),
        ("level >= 20", "20..40"),
        ("level <= 7", "0..7"),
        ("level <= -3", "-21..-3"),
    ],
)
def test_a_declared_bound_is_a_fact(check, declared, range_):
    block = LEVEL.replace(";", f"; assert constraint {{ {declared} }}", 1)
    block = block.replace("level * level > level + 400", "level * level == level + 5000")
    (line,) = check(block, "G state=B")
    assert line == f"R0: holds within level in {range_} (assumed): G (state=B)"
