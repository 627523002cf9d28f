"""``sysmlc contracts check``: one line for each contract, diagnostics, exit codes."""

import json
import re
from pathlib import Path

import pytest

from sysmlc.synthesis import composition_check, contract_checks, rules


def test_a_realizable_contract_is_one_line(workspace):
    workspace.write("lamp.gr1.json", rules.NO_FAIRNESS.read_page().right)
    result = workspace.sysmlc("contracts", "check", "lamp.gr1.json")
    assert [result.exit_code, result.stdout] == [0, "lamp: realizable\n"]


def test_a_vacuous_contract_is_a_warning(workspace):
    workspace.write("lamp.gr1.json", rules.IDLE.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "lamp.gr1.json")
    assert result.exit_code == 0
    assert "warning[SM541 vacuous-win]: 'lamp' satisfies its contract without ever" in result.stderr


def test_an_unrealizable_contract_is_an_error(workspace):
    workspace.write("lamp.gr1.json", rules.NO_FAIRNESS.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "lamp.gr1.json")
    assert [result.exit_code, result.stdout] == [1, "lamp: unrealizable\n"]
    assert "for instance if 'go' recurred" in result.stderr


def test_a_behaviour_that_violates_a_requirement_is_an_error_with_a_run(workspace, all_passes):
    workspace.write("gate.sysml", contract_checks.BREAKS.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "gate.sysml")
    assert result.exit_code == 1
    assert "Plant::Gate: realizable, violates its requirements\n" in result.stdout
    assert "error[SM560 behaviour-breaks-requirement]" in result.stderr
    assert "step 2: event=Stop, state=open" in result.stderr


def test_a_run_shows_no_history_bits_and_no_tokens_on_flows(workspace, all_passes):
    activity = "action pick { first start then close; action close; then done; }"
    machine = "exhibit state S { entry; then A; state A { do pick; } }"
    workspace.write(
        "gate.sysml",
        f"""package Plant {{
            part def Gate {{ {activity} {machine} }}
            requirement def R {{
                subject gate : Gate;
                require constraint {{ language "ltl" /* G (O running(close) -> running(close)) */ }}
            }}
        }}""",
    )
    result = workspace.sysmlc("contracts", "check", "gate.sysml", "--verbose")
    assert "violates 'G (O running(close) -> running(close))'" in result.stderr
    steps = [line for line in result.stderr.splitlines() if "note: step" in line]
    assert any("running(close)=true" in step for step in steps)
    assert not any(bit in step for step in steps for bit in ("since_", "was_", "at_start_to_close"))


def test_a_run_uses_the_names_that_requirements_use(workspace, all_passes):
    """Step 1 lists actions only if they run; the end of an action of one step is not repeated."""
    workspace.write(
        "cell.sysml",
        """package Shop {
            private import ScalarValues::*;
            item def Close;
            part def Gripper {
                exhibit state Jaw {
                    entry; then Open;
                    state Open;
                    transition first Open accept Close then Closed;
                    state Closed;
                }
            }
            part def Robot {
                attribute holds : Boolean := false;
                part gripper : Gripper;
                exhibit state Work { entry; then Busy; state Busy { do handle; } }
                action handle {
                    first start then pick;
                    action pick { action close; first start then close; then done; }
                    then action store assign holds := true;
                    then done;
                }
            }
            requirement def R {
                subject robot : Robot;
                require constraint { language "ltl" /* G !(holds & gripper.state=Closed) */ }
            }
        }""",
    )
    shown = workspace.sysmlc("contracts", "check", "cell.sysml", "--verbose", "-o", "out").stderr
    assert [line[8:] for line in shown.splitlines() if line.startswith("  note: ")] == [
        "step 1: gripper.event=Close, holds=false, gripper.state=Open, running(handle)=true, "
        "running(pick)=true, finished(pick)=true, running(close)=true, finished(close)=true",
        "step 2: gripper.event=none, gripper.state=Closed, finished(handle)=true, "
        "running(pick)=false, finished(pick)=false, running(close)=false, finished(close)=false, "
        "running(store)=true",
        "step 3: holds=true, running(handle)=false, finished(handle)=false, running(store)=false"
        "  <-- violated here",
        "step 4: nothing changes",
        "then again from step 4",
    ]
    drawn = workspace.read("out/Shop.Robot.run1.puml")
    assert r"p0 -> p1 : gripper.event=none,\nfinished(close)=false" in drawn
    assert r"hnote over p1 : gripper.state=Closed,\nfinished(handle)=true," in drawn
    report = workspace.sysmlc("contracts", "check", "cell.sysml", "--format", "json").stdout
    (requirement,) = json.loads(report)["requirements"]
    assert requirement["witness"]["steps"][1] == {
        "gripper.event": "none",
        "holds": False,
        "state": "Busy",
        "gripper.state": "Closed",
        "running(handle)": True,
        "finished(handle)": True,
        "running(pick)": False,
        "finished(pick)": False,
        "running(close)": False,
        "finished(close)": False,
        "running(store)": True,
    }


def test_one_component_can_be_selected(workspace, all_passes):
    workspace.write("gate.sysml", contract_checks.BREAKS.read_page().right)
    result = workspace.sysmlc("contracts", "check", "gate.sysml", "-c", "Plant::Gate.requirements")
    assert result.stdout == "Plant::Gate.requirements: realizable\n"
    result = workspace.sysmlc("contracts", "check", "gate.sysml", "-c", "Plant::Gat")
    assert [result.exit_code, result.stdout] == [2, ""]


def test_a_selected_component_is_compared_with_its_requirements(workspace, all_passes):
    workspace.write("gate.sysml", contract_checks.BREAKS.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "gate.sysml", "-c", "Plant::Gate")
    assert [result.exit_code, result.stdout] == [
        1,
        "Plant::Gate: realizable, violates its requirements\n"
        "  StaysOpen: broken: G (state=open -> state'=open)\n",
    ]


def test_parts_of_a_block_are_composed_and_violating_runs_are_drawn(workspace, all_passes):
    workspace.write("cell.sysml", composition_check.OPEN.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "cell.sysml", "-c", "Line::Cell", "-o", "out")
    assert result.exit_code == 1
    assert result.stdout == (
        "Line::Cell: realizable\nLine::Cell: its 2 parts together violate its contract\n"
    )
    assert "error[SM595 part-assumption-open]: part 'picker' of 'Line::Cell'" in result.stderr
    assert workspace.list_files("out") == [
        "Line.Cell.run1.puml",
        "Line.Cell.run2.puml",
        "manifest.results.json",
    ]


def test_errors_of_the_model_are_reported_when_it_has_no_contracts(workspace, all_passes):
    workspace.write(
        "cell.sysml",
        composition_check.OPEN.read_page().wrong.replace("import ScalarValues::*", "import Units"),
    )
    result = workspace.sysmlc("contracts", "check", "cell.sysml")
    assert result.exit_code == 2
    assert "SM205 unresolved-name" in result.stderr


# -- behaviours of whole components ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("fault", "verdict"),
    [
        (("$", ""), "satisfies"),
        # A part without behaviour may send anything.
        ((r"exhibit state S .*?Ready;\n +}", ""), "violates"),
        # A specialisation of the signal would be accepted, too.
        (("item def Stop;", "item def Stop; item def HardStop :> Stop;"), "violates"),
        # The environment sends to the port of the whole.
        (("port lid;", "port lid : ~Chute; connect lid to receiver.inlet;"), "violates"),
        (("connect sender.*?;", ""), "violates"),
    ],
)
def test_a_connected_port_receives_only_what_its_connections_send(
    workspace, all_passes, fault, verdict
):
    text = """package Shop {
        item def Go; item def Piece; item def Stop;
        port def Chute { out item piece : Piece; out item stop : Stop; }
        part def Line {
            port lid;
            part sender {
                port outlet : Chute;
                exhibit state S {
                    entry; then Ready;
                    state Ready;
                    transition first Ready accept Go do send new Piece() via outlet then Ready;
                }
            }
            part receiver {
                port inlet : ~Chute;
                exhibit state R {
                    entry; then Empty;
                    state Empty;
                    transition first Empty accept Piece via inlet then Full;
                    transition first Empty accept Stop via inlet then Stopped;
                    state Full;
                    state Stopped;
                }
            }
            connect sender.outlet to receiver.inlet;
        }
        requirement def R {
            subject line : Line;
            require constraint { language "ltl" /* G !receiver.state=Stopped */ }
        }
    }"""
    workspace.write("line.sysml", re.sub(*fault, text, count=1, flags=re.DOTALL))
    result = workspace.sysmlc("contracts", "check", "line.sysml")
    assert f"Shop::Line: realizable, {verdict} its requirements\n" in result.stdout


def check_rule_example(rule, text, workspace):
    """Return whether the command reports the rule about an example of its page."""
    workspace.write("plant.sysml", text)
    result = workspace.sysmlc("contracts", "check", "--min-severity", "info", "plant.sysml")
    return f"[{rule.code} {rule.name}]" in result.stderr


BEHAVIOUR_RULES = {
    "SM516": rules.NEVER_ACCEPTED,
    "SM517": rules.NEVER_TAKEN,
    "SM518": rules.GUARD_NEVER_HOLDS,
    "SM519": rules.NEVER_CHANGED,
    "SM557": rules.VACUOUS,
    "SM558": rules.CONFLICT,
    "SM559": rules.UNREACHABLE,
}


@pytest.mark.parametrize("rule", BEHAVIOUR_RULES.values(), ids=BEHAVIOUR_RULES)
def test_findings_about_the_behaviour_of_a_component(rule, workspace, all_passes):
    page = rule.read_page()
    assert check_rule_example(rule, page.wrong, workspace)
    assert not check_rule_example(rule, page.right, workspace)


@pytest.mark.parametrize(("second", "is_reported"), [("sort", False), ("clear", True)])
def test_a_guard_that_holds_in_one_of_several_calls_is_not_reported(
    second, is_reported, workspace, all_passes
):
    """The guard never holds in the first call, in which nothing has set the feature."""
    text = f"""package P {{
        private import ScalarValues::*;
        part def B {{
            attribute full : Boolean := false;
            action sort {{ first start then d; decide d; if full then store; else reject;
                action store; then done; action reject; then done; }}
            action clear assign full := false;
            perform action work {{ first start then a; perform action a references sort;
                then load; action load assign full := true;
                then b; perform action b references {second}; then done; }}
        }}
        requirement def Starts {{
            subject b : B;
            require constraint {{ language "ltl" /* !full */ }}
        }}
    }}"""
    assert check_rule_example(rules.GUARD_NEVER_HOLDS, text, workspace) == is_reported


def test_a_state_that_the_author_requires_to_be_unreachable_is_not_reported(workspace, all_passes):
    text = rules.UNREACHABLE.read_page().wrong
    required = text.replace("/* state=Idle */", "/* G !(state=Service) */")
    assert not check_rule_example(rules.UNREACHABLE, required, workspace)


def test_a_transition_to_a_state_that_is_required_to_be_unreachable_is_not_reported(
    workspace, all_passes
):
    text = rules.NEVER_TAKEN.read_page().wrong
    text = text.replace("state Busy;", "state Busy; state Lost;").replace(
        "if not locked then Busy", "if not locked then Lost"
    )
    assert check_rule_example(rules.NEVER_TAKEN, text, workspace)
    required = text.replace("/* state=Idle */", "/* G !(state=Lost) */")
    assert not check_rule_example(rules.NEVER_TAKEN, required, workspace)


ARM = """package Line {
    item def Go;
    part def Robot {
        attribute mode : ScalarValues::Boolean := false;
        exhibit state S {
            entry; then Idle;
            state Idle;
            transition first Idle accept Go do assign mode := false then Busy;
            state Busy;
            state Service;
        }
    }
    part def Cell { part robot : Robot; }
    requirement def OfCell {
        subject cell : Cell; require constraint { language "ltl" /* robot.state=Idle */ }
    }
    OF_ROBOT
}
"""
OF_ROBOT = """requirement def OfRobot {
    subject robot : Robot; require constraint { language "ltl" /* state=Idle */ }
}"""


@pytest.mark.parametrize(
    ("of_robot", "findings"),
    [
        ("", ["'Line::Cell' reaches 'robot.Service'", "'robot.mode' of 'Line::Cell' is assigned"]),
        (OF_ROBOT, ["'Line::Robot' reaches 'Service'", "'mode' of 'Line::Robot' is assigned"]),
        # The author of the part requires that the state is never reached.
        (
            OF_ROBOT.replace("state=Idle", "G !(state=Service)"),
            ["'mode' of 'Line::Robot' is assigned"],
        ),
    ],
)
def test_a_block_does_not_repeat_what_the_check_of_its_part_finds(
    of_robot, findings, workspace, all_passes
):
    workspace.write("line.sysml", ARM.replace("OF_ROBOT", of_robot))
    result = workspace.sysmlc("contracts", "check", "--min-severity", "info", "line.sysml")
    lines = [line for line in result.stderr.splitlines() if "SM559" in line or "SM519" in line]
    assert len(lines) == len(findings)
    assert all(finding in line for finding, line in zip(findings, lines, strict=True))


ROBOT = """
    part def Robot {
        attribute gripped : ScalarValues::Boolean := false;
        action pick {
            first start then close;
            action close assign gripped := true;
            then ITS_END;
        }
        exhibit state S {
            entry; then Idle;
            state Idle;
            transition first Idle accept Go then Busy;
            state Busy { PERFORMS pick; }
            transition first Busy then Idle;
        }
    }
"""
CALLER = """
    part def Cell {
        part robot : Robot;
        perform action job { first start; then perform robot.pick; then done; }
    }
"""
GRIPS_IN_BUSY = "G (!gripped & X gripped -> state=Busy)"
"""It holds where only state Busy performs the activity."""


@pytest.mark.parametrize(
    ("performs", "end", "further", "verdict"),
    [
        ("do", "done", "", "holds"),
        # Another component starts it, too.
        ("do", "done", CALLER, "broken"),
        # It calls itself, so that there is no finite number of copies.
        ("do", "perform pick", "", "not-decided"),
        # An entry performs it within the step that enters the state.
        ("entry", "done", "", "broken"),
    ],
)
def test_no_performance_of_an_activity_is_forgotten(
    performs, end, further, verdict, workspace, all_passes
):
    robot = ROBOT.replace("PERFORMS", performs).replace("ITS_END", end)
    requirement = f"""requirement def R {{
        subject robot : Robot; require constraint {{ language "ltl" /* {GRIPS_IN_BUSY} */ }}
    }}"""
    text = f"package Plant {{ item def Go; {robot} {further} {requirement} }}"
    workspace.write("plant.sysml", text)
    result = workspace.sysmlc("contracts", "check", "plant.sysml", "--format", "json")
    (entry,) = json.loads(result.stdout)["requirements"]
    assert entry["verdict"] == verdict


COUNTER = """package Plant {
    private import ScalarValues::*;
    action def Count {
        attribute n : Integer START;
        assert constraint { n >= 0 and n <= 2 }
        first start then pick;
        action pick;
        then count;
        action count assign n := 1;
        then done;
    }
    requirement def R {
        subject task : Count;
        require constraint { language "ltl" /* G (running(pick) -> n=0) */ }
        require constraint { language "ltl" /* G (n=1 -> G n=1) */ }
    }
}
"""


@pytest.mark.parametrize(
    ("start", "verdicts"),
    [
        # The environment may start the activity again: n is 0 again.
        ("default = 0", ["holds", "broken"]),
        # Nothing says with which value a performance begins.
        ("", ["broken", "broken"]),
    ],
)
def test_each_start_of_an_activity_gives_its_features_their_initial_values(
    start, verdicts, workspace, all_passes
):
    workspace.write("plant.sysml", COUNTER.replace("START", start))
    result = workspace.sysmlc("contracts", "check", "plant.sysml", "--format", "json")
    entries = json.loads(result.stdout)["requirements"]
    assert [entry["verdict"] for entry in entries] == verdicts


TEXTS = """package Line {
    private import RecipeLevels::*;
    item def Go;
    part def Gate {
        exhibit state S { entry; then A; state A; transition first A accept Go then B; state B; }
        satisfy Polite;
    }
    requirement <R1> Polite { doc /* The gate is polite. */ }
    requirement <R2> Alone { doc /* Nobody satisfies it. */ }
    requirement <R3> Formal {
        doc /* Text and formula. */
        subject gate : Gate;
        require constraint { language "ltl" /* G (state=B -> X state=B) */ }
    }
}
"""


def test_requirements_that_are_only_text_are_listed_as_not_formalised(workspace, all_passes):
    workspace.write("line.sysml", TEXTS)
    result = workspace.sysmlc("contracts", "check", "line.sysml", "--format", "json")
    assert [
        (entry["requirement"], entry["component"], entry["verdict"], entry["reason"])
        for entry in json.loads(result.stdout)["requirements"]
    ] == [
        ("Line::Formal", "Line::Gate", "holds", None),
        ("Line::Polite", "Line::Gate", "not-decided", ONLY_TEXT),
        ("Line::Alone", None, "not-decided", ONLY_TEXT),
    ]
    result = workspace.sysmlc("contracts", "check", "line.sysml")
    assert result.stdout.endswith("2 requirements not formalised: Polite, Alone\n")
    workspace.sysmlc("line.sysml", "-o", "out")
    page = Path("out/contracts/Line.Gate.md").read_text()
    assert page.endswith("- R1 Polite: The gate is polite.\n")


ONLY_TEXT = "not formalised: the requirement is only text"


def test_a_text_about_a_time_is_decided_by_the_recipe(workspace, all_passes):
    model = Path("examples/lego-recipe-v2/lego-recipe.sysml")
    arguments = ("contracts", "check", str(Path(__file__).parents[2] / model), "--format", "json")
    arguments += ("-c", "LegoRecipe::Tasks::Store")
    entries = {
        entry["requirement"].rpartition("::")[2]: entry
        for entry in json.loads(workspace.sysmlc(*arguments).stdout)["requirements"]
    }
    assert entries["StoreTime"]["verdict"] == "holds"
    assert entries["StoreTime"]["reason"] == (
        f"{ONLY_TEXT}; the recipe decides it: "
        "'LegoRecipe::Recipes::BuildLegoStack::store' takes 16300 ms, "
        "and at most 20000 ms is allowed"
    )
