"""Change triggers: SysML v2 fires at once if the condition is true, UML waits for a change.

Each model is written in SysML v2. Saved as UML, it has change events.
"""

import re

import pytest
from test_simulation_component import assert_steps_agree

from sysmlc import compile_model, driver
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, select_backends
from sysmlc.ir import Kind
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source

KETTLE = """package P {{
private import ScalarValues::*;
item def Go; item def Tick;
part def Kettle {{
    in attribute hot : Boolean;
    in attribute armed : Boolean;
    exhibit state M {{
        entry; then Idle;
        state Idle;
        transition first Idle accept Go then Heat;
        state Heat;
        state Off;
        {0}
    }}
}}
}}
"""
PLAIN = KETTLE.format("transition first Heat accept when hot then Off;")
IN_ACTION = """package P {
private import ScalarValues::*;
part def Kettle {
    in attribute hot : Boolean;
    perform action boil {
        first start; then action warm; then action wait accept when hot; then action pour;
        then done;
    }
}
}
"""


def save_as(path, backend):
    """Return the model as text of UML or SysML v2, with the codes of the notes about it."""
    compilation = driver.compile_model(Request((path,), backends=tuple(select_backends([backend]))))
    (text,) = [
        output.text
        for output in compilation.list_published()
        if output.path.startswith(f"{backend}/") and not output.path.endswith("SysMLC.sysml")
    ]
    codes = {diagnostic.rule.code for diagnostic in compilation.diagnostics}
    return text, codes & {"SM463", "SM490"}


@pytest.fixture
def write(tmp_path):
    """Return a function that writes a text of SysML v2 in a notation and returns the file."""

    def run(text, notation):
        path = tmp_path / "model.sysml"
        path.write_text(text, "utf-8")
        if notation == "uml":
            saved, codes = save_as(path, "uml")
            assert codes == {"SM490"}
            path = tmp_path / "model.uml"
            path.write_text(saved, "utf-8")
        return path

    return run


@pytest.fixture
def states(write):
    """Return a function that plays inputs and returns the values of a variable in each step."""

    def run(text, notation, steps, variable="state"):
        graph = compile_model(write(text, notation)).graph
        lines = ["component: P::Kettle", "steps:", *(f"  - inputs: {{{step}}}" for step in steps)]
        sink = Sink()
        report = run_scenarios(graph, Source("s.yaml", "\n".join(lines).encode()), sink)
        assert list(sink) == []
        (result,) = report.results
        return " ".join(str(valuation[variable]) for valuation in result.trace)

    return run


def print_transitions(path):
    """Return the formulas of the contract that lead from 'Heat' to 'Off'."""
    (contract,) = compile_model(path).graph.derived(Contract)
    formulas = [print_formula(conjunct.formula) for conjunct in contract.guarantees]
    return [formula for formula in formulas if formula.endswith("-> state'=Off")]


@pytest.mark.parametrize(
    ("notation", "states_taken"),
    [("v2", "Idle Heat Off Off Off"), ("uml", "Idle Heat Heat Heat Off")],
)
def test_a_kettle_that_is_already_hot_leaves_at_once_or_goes_on_heating(
    states, notation, states_taken
):
    steps = ["event: Go, hot: true", "event: none", "hot: false", "hot: true", "hot: true"]
    assert states(PLAIN, notation, steps) == states_taken


@pytest.mark.parametrize(
    ("notation", "formula"),
    [
        ("v2", "state=Heat & hot -> state'=Off"),
        ("uml", "state=Heat & hot & !was_hot -> state'=Off"),
    ],
)
def test_the_contract_states_the_reading_of_each_notation(write, notation, formula):
    assert print_transitions(write(PLAIN, notation)) == [formula]


GUARDED = "transition first Heat accept when hot if armed then Off;"
AGAIN = "transition first Heat accept Tick then Heat;"
BOTH = """transition first Heat accept when hot then Off;
    transition first Heat accept when not hot then Idle;"""
NESTED = """state Pot { entry; then Cold; state Cold; state Warm;
        transition first Cold accept Tick then Warm; }
    transition first Off accept Go then Pot;
    transition first Pot accept when armed then Off;
    transition first Heat accept when hot then Off;"""


@pytest.mark.parametrize(
    ("notation", "transitions", "steps", "states_taken"),
    [
        # The change is lost if the guard is false; the next change counts.
        ("v2", GUARDED, "hot Go|hot|hot armed|hot armed|armed|hot armed|", "IHHHHHO"),
        ("uml", GUARDED, "hot Go|hot|hot armed|hot armed|armed|hot armed|", "IHHHHHO"),
        ("v2", GUARDED, "hot armed Go|hot armed|hot armed|", "IHOO"),
        ("uml", GUARDED, "hot armed Go|hot armed|hot armed|", "IHHH"),
        # A state that is entered again begins to wait again.
        ("v2", GUARDED + AGAIN, "hot Go|hot|hot armed|hot armed Tick|hot armed|", "IHHHHO"),
        ("uml", GUARDED + AGAIN, "hot Go|hot|hot armed|hot armed Tick|hot armed|", "IHHHHH"),
        ("v2", BOTH, "hot Go|hot|", "IHO"),
        ("v2", BOTH, "hot Go||", "IHI"),
        ("uml", BOTH, "hot Go|hot|hot||", "IHHHI"),
        # A change that coincides with an inner transition is lost.
        ("v2", NESTED, "hot Go|hot|armed Go|armed|", "IHOPO"),
        ("v2", NESTED, "hot Go|hot|armed Go|armed Tick|armed||armed|", "IHOPPPPO"),
        ("uml", NESTED, "Go|hot|armed Go|armed||armed|", "IHOPPPO"),
    ],
)
def test_the_states_of_a_run(states, notation, transitions, steps, states_taken):
    features = [name for name in ("hot", "armed") if name in transitions]
    inputs = []
    for step in steps.split("|"):
        events = [word for word in step.split() if word in ("Go", "Tick")]
        truths = [f"{name}: {str(name in step.split()).lower()}" for name in features]
        inputs.append(", ".join([f"event: {events[0] if events else 'none'}", *truths]))
    taken = states(KETTLE.format(transitions), notation, inputs)
    assert "".join(name[0] for name in taken.split()) == states_taken


def test_conditions_that_exclude_each_other_leave_no_choice(write):
    compilation = compile_model(write(KETTLE.format(BOTH), "v2"))
    assert not [d for d in compilation.diagnostics if d.rule.code in ("SM422", "SM432")]


@pytest.mark.parametrize(
    ("notation", "runs"),
    [("v2", "False True False False False"), ("uml", "False True True True False")],
)
def test_an_action_waits_as_its_notation_says(states, notation, runs):
    steps = ["hot: true, done_warm: true", "hot: true", "hot: false", "hot: true", ""]
    assert states(IN_ACTION, notation, steps, "running(wait)") == runs


LONG = """package P {
private import ScalarValues::*;
item def Go;
part def Kettle {
    in attribute hot : Boolean;
    in attribute armed : Boolean;
    attribute lit : Boolean := false;
    action warm {
        first start; then action wait accept when hot; then action light assign lit := not lit;
        then done;
    }
    exhibit state M {
        entry; then Heat;
        state Heat { entry warm; }
        transition first Heat accept when hot if armed then Pot;
        state Pot { entry; then Cold; state Cold; state Warm;
            transition first Cold accept Go then Warm;
            transition first Warm accept when not lit then Cold; }
        transition first Pot accept when hot then Keep;
        state Keep { do warm; }
        transition first Keep accept when lit then Heat;
        transition first Keep accept when not armed then Keep;
    }
}
}
"""


@pytest.mark.parametrize("notation", ["v2", "uml"])
def test_the_player_and_the_relation_agree_about_changes(write, notation):
    assert_steps_agree(write(LONG, notation), "P::Kettle", rounds=20)


@pytest.mark.parametrize("model", [PLAIN, KETTLE.format(GUARDED), IN_ACTION])
def test_text_that_is_written_from_uml_waits_as_in_uml(write, tmp_path, model):
    original = write(model, "uml")
    text, codes = save_as(original, "sysml")
    assert codes == {"SM463"}
    assert '@Kept { attributes = ("trigger.immediate=false"); }' in text
    written = tmp_path / "written.sysml"
    written.write_text(text, "utf-8")

    def list_formulas(path):
        contracts = compile_model(path).graph.derived(Contract)
        return {print_formula(item.formula) for each in contracts for item in each.guarantees}

    assert list_formulas(written) == list_formulas(original)
    assert save_as(written, "uml")[1] == set()


def test_text_of_sysml_v2_is_written_without_a_note(write):
    text, codes = save_as(write(PLAIN, "v2"), "sysml")
    assert codes == set()
    assert "immediate" not in text


def test_each_trigger_of_a_transition_waits_as_in_uml(write, tmp_path):
    """SysML v2 has a transition for each trigger."""
    original = write(PLAIN, "uml")
    saved = original.read_text("utf-8")
    (trigger,) = re.findall(r"<trigger [^>]*/>", saved.partition('name="Heat"')[2])
    second = re.sub(r'xmi:id="[^"]*"', 'xmi:id="second"', trigger)
    original.write_text(saved.replace(trigger, trigger + second), "utf-8")
    text, codes = save_as(original, "sysml")
    assert codes == {"SM463"}
    assert text.count("accept when hot then Off {") == 2
    written = tmp_path / "written.sysml"
    written.write_text(text, "utf-8")
    graph = compile_model(written).graph
    triggers = [each for each in graph.of_kind(Kind.TRIGGER) if each.subkind == "change"]
    assert [each.attrs["immediate"] for each in triggers] == [False, False]
