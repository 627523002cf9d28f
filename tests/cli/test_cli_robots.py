"""``sysmlc robots``: from a model to a validated mission, or to the reason why it fails."""

import pytest

from sysmlc.driver import outcome_cache
from sysmlc.robots import outcome

HALL = """
package Plant {
    private import Floors::*;
    part def Hall :> Floor {
        constant attribute :>> columns = 3;
        constant attribute :>> rows = 2;
        part r1 : Robot { :>> row = 0; :>> column = 0; }
        part r2 : Robot { :>> row = 0; :>> column = 2; }
        part work : Mission {
            constant attribute :>> deadline = 20;
            part left : Target { :>> row = 0; :>> column = 0; }
            part right : Target { :>> row = 0; :>> column = 2; }
            connection : Carry connect right to left;
        }
    }
}
"""


@pytest.fixture
def run_robots(workspace, all_passes):
    """Return a function that writes a model and runs the command."""

    def run(text, *arguments):
        workspace.write("hall.sysml", text)
        return workspace.sysmlc("robots", "hall.sysml", *arguments)

    return run


def test_a_successful_mission_is_exit_code_0_and_described_in_files(workspace, run_robots):
    result = run_robots(HALL, "--no-relations", "-o", "out")
    assert result.exit_code == 0, result.output
    assert result.stdout == (
        "Plant::Hall: 6 cells, 2 robots, 2 targets: done in 7 steps at most, from 1 start\n"
    )
    assert workspace.list_files() == [
        "manifest.results.json",
        "robots/Plant.Hall.md",
        "robots/Plant.Hall.mission.contract.json",
        "robots/Plant.Hall.robot.machine.json",
        "robots/Plant.Hall.seq.puml",
    ]


def test_the_claims_of_the_thesis_are_decided_and_reported(run_robots):
    result = run_robots(HALL)
    assert result.exit_code == 0, result.output
    assert "SM570 environment-shares-cells" in result.stderr
    assert "SM573 claim-does-not-hold" in result.stderr
    assert "C_E discharges what C_R assumes of it" in result.stderr


def test_the_cells_of_a_single_robot_are_not_shared(run_robots):
    alone = HALL.replace("part r2 : Robot { :>> row = 0; :>> column = 2; }", "")
    result = run_robots(alone)
    assert result.exit_code == 0, result.output
    assert "SM570" not in result.stderr


def test_no_controller_is_synthesised_without_time(run_robots):
    result = run_robots(HALL, "--question-limit", "0.0001")
    assert result.exit_code == 2
    assert "SM531" in result.stderr
    assert result.stdout.endswith("no controller\n")


def test_a_deadline_that_no_allocation_meets_is_an_error(run_robots):
    result = run_robots(HALL.replace("deadline = 20", "deadline = 3"), "--no-relations")
    assert result.exit_code == 1
    assert "SM572 no-allocation" in result.stderr
    assert "the best one that was found takes" in result.stderr


def test_robots_that_cannot_pass_one_another_fail_and_a_run_shows_why(run_robots):
    result = run_robots(HALL.replace("rows = 2", "rows = 1"), "--no-relations")
    assert result.exit_code == 1
    assert "SM571 mission-fails" in result.stderr
    assert "'left' is not reached within 20 steps" in result.stderr
    assert "note: step 0: 'r1' is at 'left'; 'r2' is at 'right'" in result.stderr
    assert "(2 allocations tried)" in result.stdout


def test_a_model_without_a_floor_is_exit_code_2(run_robots):
    result = run_robots("package Plant { part def Hall; }")
    assert result.exit_code == 2
    assert "nothing specialises 'Floors::Floor'" in result.stderr


def test_an_error_in_the_model_is_exit_code_1(run_robots):
    text = HALL.replace("row = 0; :>> column = 2; }", "row = 9; :>> column = 2; }")
    result = run_robots(text)
    assert result.exit_code == 1
    assert "SM564 place-off-floor" in result.stderr


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_has_examples(workspace, option):
    result = workspace.sysmlc("robots", option)
    assert "sysmlc robots hall.sysml" in result.output
    assert "Exit codes" in result.output


def test_new_targets_reuse_the_controllers_in_the_cache(
    workspace, run_robots, tmp_path_factory, monkeypatch
):
    """The controllers come from the cache folder; ``--no-cache`` synthesises them again."""
    monkeypatch.setattr(outcome_cache, "compute_tool_digest", lambda: "this version")
    monkeypatch.setenv("SYSMLC_CACHE", str(tmp_path_factory.mktemp("user") / "cache"))
    assert run_robots(HALL).exit_code == 0

    def refuse_synthesis(*arguments):
        raise AssertionError("synthesised again")

    monkeypatch.setattr(outcome, "synthesise_robot", refuse_synthesis)
    changed = HALL.replace("part left : Target { :>> row = 0;", "part left : Target { :>> row = 1;")
    result = run_robots(changed, "-o", "out")
    assert result.exit_code == 0, result.output
    assert "done in 6 steps at most" in result.stdout
    assert "SM573 claim-does-not-hold" in result.stderr
    machine = workspace.read("out/robots/Plant.Hall.robot.machine.json")
    assert '"sysmlc-machine/2"' in machine
    with pytest.raises(AssertionError, match="synthesised again"):
        run_robots(changed, "--no-cache")


def test_the_printed_algorithm_ignores_that_a_target_is_carried(run_robots):
    result = run_robots(HALL, "--no-relations", "--allocation", "printed")
    assert result.exit_code == 1
    assert "assigns a carried target to another robot" in result.stderr


def test_the_allocation_of_the_printed_algorithm_is_validated(workspace, run_robots):
    hall = HALL.replace("connection : Carry connect right to left;", "")
    result = run_robots(hall, "--no-relations", "--allocation", "printed", "-o", "out")
    assert result.exit_code == 0, result.output
    assert "- Algorithm 1 as printed: r1 left; r2 right" in workspace.read(
        "out/robots/Plant.Hall.md"
    )
