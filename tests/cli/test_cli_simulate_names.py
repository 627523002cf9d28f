"""Scenarios use the names of formulas; ``simulate --variables`` lists them."""

from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "contracts.md"
SCENARIO = """name: the oven heats while the job runs
component: Oven
steps:
  - expect: {Heater.state: Cold, running(job): true, running(left.grip): true}
  - inputs: {event: Go, finished(left.grip): true}
  - expect: {Heater.state: Hot, Fan.state: Turning, running(left): false, running(right): true}
"""


@pytest.fixture
def oven(workspace, all_passes):
    text = PAGE.read_text(encoding="utf-8").partition("<!-- names in formulas -->\n```sysml\n")[2]
    workspace.write("oven.sysml", text.partition("```")[0])
    return workspace


def test_the_names_of_a_component_are_listed(oven):
    result = oven.sysmlc("simulate", "oven.sysml", "--variables")
    assert result.exit_code == 0
    assert result.stdout.startswith(
        """Names::Oven
  input  event: none, Go, Stop
  output mode: slow, fast
  output Heater.state: Cold, Hot
  output Fan.state: Still, Turning
  output running(job): Boolean
  output finished(job): Boolean
  output running(left): Boolean
  output finished(left): Boolean
  output running(left.grip): Boolean
  input  finished(left.grip): Boolean
"""
    )


def test_a_scenario_and_its_diagram_have_the_names_of_formulas(oven):
    oven.write("oven.yaml", SCENARIO)
    result = oven.sysmlc("simulate", "oven.sysml", "--scenario", "oven.yaml", "-o", "out")
    assert [result.exit_code, result.stderr] == [0, ""]
    assert "passed  Names::Oven: the oven heats while the job runs (3 steps)\n" in result.stdout
    diagram = oven.read("out/oven.seq.puml")
    assert "== step 1 ==\n" in diagram
    assert "environment -> component : finished(left.grip) = true\n" in diagram
    assert "run_" not in diagram
    assert "done_" not in diagram


def test_a_difference_has_the_name_and_the_step_of_the_scenario(oven):
    oven.write("oven.yaml", SCENARIO.replace("Turning", "Still"))
    result = oven.sysmlc("simulate", "oven.sysml", "--scenario", "oven.yaml")
    assert "oven.yaml:6: step 3: Fan.state is Turning, expected Still\n" in result.stdout


def test_a_command_without_scenario_says_what_to_name(oven):
    result = oven.sysmlc("simulate", "oven.sysml")
    assert result.exit_code == 2
    assert "name a file with --scenario, or list the names with --variables" in result.stderr


def test_an_activity_alone_has_the_names_of_formulas(workspace, all_passes):
    workspace.write(
        "shop.sysml",
        "package Shop { part def Press { exhibit state Run { entry; then On; state On; }"
        " perform action work {"
        " first start; then action load { first start; then action grip; then done; }"
        " then action turn; then done; } } }",
    )
    result = workspace.sysmlc("simulate", "shop.sysml", "--variables")
    own = result.stdout.partition("Shop::Press.work\n")[2].splitlines()
    assert own[:2] == ["  input  finished(grip): Boolean", "  input  finished(turn): Boolean"]
    workspace.write(
        "turns.yaml",
        "name: turns\ncomponent: Shop::Press.work\nsteps:\n"
        "  - expect: {running(load): true, finished(grip): false}\n"
        "  - inputs: {finished(grip): true}\n"
        "  - expect: {running(grip): false, running(turn): true}\n",
    )
    result = workspace.sysmlc("simulate", "shop.sysml", "--scenario", "turns.yaml")
    assert result.stdout.endswith("1 of 1 scenario passed\n")
