"""``sysmlc robots``: from a model to a mission that is validated, or to what goes wrong."""

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

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


def run(tmp_path, text, *arguments):
    (tmp_path / ".git").mkdir(exist_ok=True)
    path = tmp_path / "hall.sysml"
    path.write_text(text, encoding="utf-8")
    return CliRunner().invoke(sysmlc, ["robots", str(path), *arguments])


def test_a_mission_that_is_done_ends_with_0_and_is_told_in_files(tmp_path):
    made = run(tmp_path, HALL, "--no-relations", "-o", str(tmp_path / "out"))
    assert made.exit_code == 0, made.output
    assert made.stdout == (
        "Plant::Hall: 6 cells, 2 robots, 2 targets: done in 7 steps at most, from 1 start\n"
    )
    assert sorted(path.name for path in (tmp_path / "out" / "robots").iterdir()) == [
        "Plant.Hall.md",
        "Plant.Hall.mission.contract.json",
        "Plant.Hall.robot.machine.json",
        "Plant.Hall.seq.puml",
    ]


def test_what_the_thesis_claims_is_decided_and_told(tmp_path):
    made = run(tmp_path, HALL)
    assert made.exit_code == 0, made.output
    assert "SM570 environment-shares-cells" in made.stderr
    assert "SM573 claim-does-not-hold" in made.stderr
    assert "C_E discharges what C_R assumes of it" in made.stderr


def test_one_robot_shares_no_cell(tmp_path):
    alone = HALL.replace("part r2 : Robot { :>> row = 0; :>> column = 2; }", "")
    made = run(tmp_path, alone)
    assert made.exit_code == 0, made.output
    assert "SM570" not in made.stderr


def test_without_time_no_controller_is_made(tmp_path):
    made = run(tmp_path, HALL, "--question-limit", "0.0001")
    assert made.exit_code == 2
    assert "SM531" in made.stderr
    assert made.stdout.endswith("no controller\n")


def test_a_deadline_that_no_allocation_keeps_is_an_error(tmp_path):
    made = run(tmp_path, HALL.replace("deadline = 20", "deadline = 3"), "--no-relations")
    assert made.exit_code == 1
    assert "SM572 no-allocation" in made.stderr
    assert "the best one that was found takes" in made.stderr


def test_robots_that_cannot_pass_one_another_fail_with_a_run(tmp_path):
    made = run(tmp_path, HALL.replace("rows = 2", "rows = 1"), "--no-relations")
    assert made.exit_code == 1
    assert "SM571 mission-fails" in made.stderr
    assert "'left' is not reached within 20 steps" in made.stderr
    assert "note: step 0: 'r1' is at 'left'; 'r2' is at 'right'" in made.stderr
    assert "(2 allocations tried)" in made.stdout


def test_a_model_without_a_floor_cannot_be_studied(tmp_path):
    made = run(tmp_path, "package Plant { part def Hall; }")
    assert made.exit_code == 2
    assert "nothing specialises 'Floors::Floor'" in made.stderr


def test_an_error_in_the_model_ends_with_1(tmp_path):
    made = run(tmp_path, HALL.replace("row = 0; :>> column = 2; }", "row = 9; :>> column = 2; }"))
    assert made.exit_code == 1
    assert "SM564 place-off-floor" in made.stderr


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_has_examples(option):
    made = CliRunner().invoke(sysmlc, ["robots", option])
    assert "sysmlc robots hall.sysml" in made.output
    assert "Exit codes" in made.output


def test_new_targets_take_the_robots_of_the_run_before(tmp_path, tmp_path_factory, monkeypatch):
    """Through the cache folder, as the compiler uses it; without it all is made anew."""
    from sysmlc.driver import outcome_cache
    from sysmlc.robots import outcome

    monkeypatch.setattr(outcome_cache, "compute_tool_digest", lambda: "this version")
    monkeypatch.setenv("SYSMLC_CACHE", str(tmp_path_factory.mktemp("user") / "cache"))
    assert run(tmp_path, HALL).exit_code == 0

    def fail(*given):
        raise AssertionError("synthesised again")

    monkeypatch.setattr(outcome, "synthesise_robot", fail)
    other = HALL.replace("part left : Target { :>> row = 0;", "part left : Target { :>> row = 1;")
    made = run(tmp_path, other, "-o", str(tmp_path / "out"))
    assert made.exit_code == 0, made.output
    assert "done in 6 steps at most" in made.stdout
    assert "SM573 claim-does-not-hold" in made.stderr
    machine = (tmp_path / "out" / "robots" / "Plant.Hall.robot.machine.json").read_text()
    assert '"sysmlc-machine/2"' in machine
    anew = run(tmp_path, other, "--no-cache")
    assert isinstance(anew.exception, AssertionError)
