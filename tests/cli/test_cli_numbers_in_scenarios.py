"""Scenarios give real features numbers, with or without unit; differences show numbers."""

import pytest

MODEL = """package Plant {
    private import ScalarValues::*;
    private import SI::*;
    private import ISQ::*;
    part def Thermostat {
        in attribute temp : TemperatureValue;
        attribute low : TemperatureValue = 18 ['°C_abs'];
        assert constraint { 0 ['°C_abs'] <= temp and temp <= 100 ['°C_abs'] }
        exhibit state Control {
            entry; then Idle;
            state Idle;
            state Heating;
            transition first Idle if temp < low then Heating;
            transition first Heating if temp >= 22 ['°C_abs'] then Idle;
        }
    }
    part def Scale {
        in attribute gross : MassValue;
        in attribute tare : MassValue;
        exhibit state Control {
            entry; then Empty;
            state Empty;
            state Loaded;
            transition first Empty if gross > tare + 50 [g] then Loaded;
        }
    }
    part def Tank {
        attribute level : Real := 0.0;
        exhibit state Control {
            entry; then Filling;
            state Filling;
            state Full;
            transition first Filling if level < 10.0 do assign level := level + 2.5 then Filling;
            transition first Filling if level >= 10.0 then Full;
        }
    }
}
"""


@pytest.fixture
def play(workspace, all_passes):
    def run(component, *steps):
        workspace.write("plant.sysml", MODEL)
        lines = "".join(f"  - {step}\n" for step in steps)
        workspace.write("plant.yaml", f"component: {component}\nsteps:\n{lines}")
        options = "--scenario", "plant.yaml", "-o", "out"
        return workspace.sysmlc("simulate", "plant.sysml", *options)

    return run


@pytest.mark.parametrize("cold", ["17", "17.99", "17 °C", "290 K", "62.6 °F", "_0_C_to_low"])
def test_a_number_is_in_the_unit_of_the_model_or_in_its_own(play, cold):
    result = play(
        "Thermostat",
        f"inputs: {{temp: {cold}}}",
        "{inputs: {temp: 22}, expect: {state: Heating, temp: 22 °C}}",
        "expect: {state: Idle}",
    )
    assert [result.exit_code, result.stderr] == [0, ""]


def test_the_diagram_has_the_numbers_of_the_scenario(play, workspace):
    play("Thermostat", "inputs: {temp: 62.6 °F}", "{}", "inputs: {temp: 25}")
    diagram = workspace.read("out/plant.seq.puml")
    assert "environment -> component : temp = 17 °C (0 °C to low)\n" in diagram
    assert "environment -> component : temp = 25 °C (22 °C to 100 °C)\n" in diagram


def test_features_of_a_sum_have_numbers_of_their_own(play, workspace):
    steps = "inputs: {gross: 120, tare: 0.06 kg}", "expect: {state: Loaded}"
    result = play("Scale", *steps)
    assert [result.exit_code, result.stderr] == [0, ""]
    diagram = workspace.read("out/plant.seq.puml")
    assert "environment -> component : gross = 120 g (gross" in diagram
    assert "environment -> component : tare = 60 g\n" in diagram
    light = play("Scale", "inputs: {gross: 120, tare: 70}", steps[1])
    assert "step 2: state is Empty, expected Loaded\n" in light.stdout


def test_a_number_lasts_until_another_one_is_stated(play):
    first, loaded = "inputs: {gross: 120, tare: 70}", "expect: {state: Loaded}"
    assert play("Scale", first, "{}", "inputs: {tare: 69}", loaded).exit_code == 0


def test_what_the_component_assigns_is_compared_as_a_number(play, workspace):
    steps = "expect: {level: 0}", "expect: {level: 2.5}"
    assert play("Tank", *steps).exit_code == 0
    assert "component -> environment : level = 2.5\n" in workspace.read("out/plant.seq.puml")
    result = play("Tank", *steps, "expect: {level: 7}")
    assert "step 3: level is 5, expected 7\n" in result.stdout


@pytest.mark.parametrize("value", ["100.5", "-1 °C", "17 m", ".nan", "warm", "true", "17 18"])
def test_other_values_are_errors_with_a_location(play, value):
    result = play("Thermostat", f"inputs: {{temp: {value}}}")
    assert result.exit_code == 1
    assert (
        f"error[SM554 value-outside-domain]: {value} is not a value of 'temp', which takes "
        "numbers in °C, 0 °C to 100 °C\n  --> plant.yaml:3:14 (Thermostat)\n" in result.stderr
    )


def test_a_sum_needs_numbers_for_all_of_its_features(play):
    result = play("Scale", "inputs: {gross: 120}")
    assert (
        "error[SM551 scenario-not-valid]: in the scenario 'gross': the model compares "
        "'gross - tare', and 'tare' has no number\n  --> plant.yaml:3:14 (Scale)\n" in result.stderr
    )
    assert "help: give 'tare' a number, too; " in result.stderr


def test_the_numbers_are_listed(workspace, all_passes):
    workspace.write("plant.sysml", MODEL)
    lines = workspace.sysmlc("simulate", "plant.sysml", "--variables").stdout.splitlines()
    assert (
        "  input  temp: numbers in °C, 0 °C to 100 °C (_0_C_to_low, low_to_22_C, _22_C_to_100_C)"
        in lines
    )
    assert "  input  gross - tare: numbers for gross and tare (up_to_50_g, above_50_g)" in lines


@pytest.fixture
def accept(workspace, all_passes):
    def run(component, text, name="run.csv"):
        workspace.write("plant.sysml", MODEL)
        workspace.write(name, text)
        options = "-c", f"Plant::{component}"
        return workspace.sysmlc("contracts", "accept", "plant.sysml", name, *options)

    return run


def test_a_recorded_run_has_numbers(accept):
    run = "time;temp;state\n0;17;Idle\n1;296.15 K;Heating\n2;23;STATE\n"
    assert accept("Thermostat", run.replace("STATE", "Idle")).exit_code == 0
    broken = accept("Thermostat", run.replace("STATE", "Heating"))
    assert "it breaks a guarantee in step 3\n" in broken.stdout


def test_a_recorded_run_has_the_features_of_sums(accept):
    steps = '[{"gross": 0.12, "tare": 0, "state": "Empty"}, {"gross": 120, "tare": 60.5, "state"'
    # 0.12 is in grams, so that the scale stays empty.
    assert accept("Scale", f'{steps}: "Empty"}}]', "run.json").exit_code == 0
    assert accept("Scale", f'{steps}: "Loaded"}}]', "run.json").exit_code == 1
    skipped = accept("Scale", "gross,state\n120,Empty\n120,Loaded\n")
    assert "'run.csv' has no values for 'tare': 3 of 4 checks" in skipped.stderr


@pytest.mark.parametrize("value", ["100.5", "NaN", "", "17 m", "warm"])
def test_other_values_of_a_recorded_run_are_errors(accept, value):
    result = accept("Thermostat", f"temp,state\n17,Idle\n{value},Idle\n")
    assert f"{value!r} is not a value of 'temp', which takes" in result.stderr
    assert "--> run.csv:3:1" in result.stderr
