"""The other commands: explain, show, watch, and how the command line starts."""

import json
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from sysmlc.cli import watch
from sysmlc.cli.group import COMMANDS
from sysmlc.cli.progress import Progress
from sysmlc.cli.session import Settings

HEAVY = ("lxml", "networkx", "lark", "jinja2", "pyecore", "jsonschema", "ruamel")


def test_explain_shows_why_and_a_wrong_and_a_right_model(here):
    lines = here.sysmlc("explain", "test-nameless-port").stdout.splitlines()
    assert lines[0] == "SM942 test-nameless-port (error)"
    assert lines[2] == "  a port of '<owner>' has no name"
    assert lines[-6:] == [
        '  Class gate "Gate"',
        "    Port gate.in",
        "",
        "Right:",
        '  Class gate "Gate"',
        '    Port gate.in "in"',
    ]
    assert here.sysmlc("explain", "sm942").stdout == here.sysmlc("explain", "SM942").stdout


def test_explain_without_a_code_lists_all_rules_in_order(here):
    codes = [line.split()[0] for line in here.sysmlc("explain").stdout.splitlines()]
    assert codes == sorted(codes)
    assert {"SM170", "SM176", "SM900"} <= set(codes)


def test_explain_goes_on_without_a_back_end_that_cannot_be_imported(here, monkeypatch):
    every = here.sysmlc("explain").stdout
    monkeypatch.setitem(sys.modules, "sysmlc.backends.ecore", None)
    result = here.sysmlc("explain")
    assert result.exit_code == 0
    assert result.stdout == every
    assert "note: the rules of sysmlc.backends.ecore are missing" in result.stderr


def test_show_prints_the_graph_that_can_be_compiled_again(here):
    text = here.sysmlc("show", "plant.ir").stdout
    here.write("again.ir", text)
    assert here.sysmlc("show", "again.ir").stdout == text


def test_show_finds_an_element_by_qualified_name_name_or_id(here):
    shown = {
        here.sysmlc("show", "plant.ir", "-e", e).stdout for e in ("Plant::Gate", "Gate", "gate")
    }
    assert shown == {
        'Class gate "Gate" @plant.ir:-1\n'
        '  Port gate.in "in" @plant.ir:-1\n'
        "    -> typed-by pallet\n"
        "  <- owns Plant\n"
    }


def test_show_asks_which_one_when_there_are_several(here):
    here.write("two.ir", 'Package a "A"\n  Class x "X"\nPackage b "B"\n  Class y "X"\n')
    done = here.sysmlc("show", "two.ir", "-e", "X")
    assert done.exit_code == 2
    assert "A::X (Class, id x)" in done.stderr
    assert "B::X (Class, id y)" in done.stderr


# -- watch ---------------------------------------------------------------------------------------


def test_watch_keeps_the_last_good_outputs_while_the_model_has_errors(here):
    settings = Settings(emit=("graph",))
    model = here.folder / "plant.ir"
    assert watch.rebuild((model,), None, settings)
    good = here.read("out/graph.json")
    here.write("plant.ir", 'Package pkg "Plant"\n  Class gate "Gate"\n    Port gate.in\n')
    assert not watch.rebuild((model,), None, settings)
    assert here.read("out/graph.json") == good
    here.write("plant.ir", 'Package pkg "Plant"\n')
    assert watch.rebuild((model,), None, settings)
    assert here.read("out/graph.json") != good


def test_watch_does_not_start_again_because_of_its_own_outputs():
    assert watch._is_input(1, "/x/plant.uml")
    assert watch._is_input(1, "/x/sysmlc.toml")
    assert not watch._is_input(1, "/x/out/graph.json")


def test_watch_rebuilds_when_a_file_is_saved(here, monkeypatch):
    import watchfiles

    def saves(*folders, **_):
        here.write("plant.ir", 'Package pkg "Other"\n')
        yield {(1, "plant.ir")}

    monkeypatch.setattr(watchfiles, "watch", saves)
    done = here.sysmlc("watch", "plant.ir", "--emit", "graph")
    assert done.stdout == "out: 4 changed\nout: 3 changed\n"
    assert '"Other"' in here.read("out/graph.json")


# -- start-up ------------------------------------------------------------------------------------


def executable() -> str:
    return str(Path(sysconfig.get_path("scripts")) / "sysmlc")


def test_the_installed_command_and_the_module_say_the_version():
    for command in ([executable()], [sys.executable, "-m", "sysmlc"]):
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, check=True)
        assert done.stdout.startswith("sysmlc 0.")


@pytest.mark.parametrize("args", [["--version"], ["--help"], ["build", "--help"]])
def test_help_and_version_import_nothing_heavy(args):
    script = (
        "import sys\nfrom sysmlc.cli.group import sysmlc\n"
        f"sysmlc({args!r}, standalone_mode=False)\n"
        f"print('imported:', [m for m in {HEAVY!r} if m in sys.modules])"
    )
    run = [sys.executable, "-c", script]
    assert "imported: []" in subprocess.run(run, capture_output=True, text=True, check=True).stdout


def test_the_version_takes_at_most_0_15_s_of_cpu():
    resource = pytest.importorskip("resource")

    def cpu() -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([executable(), "--version"], capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    assert min(cpu() for _ in range(5)) < 0.15


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(here, command):
    done = here.sysmlc(command, "--help")
    assert done.exit_code == 0
    assert f"sysmlc {command}" in done.stdout


def test_a_fault_of_ours_is_one_sentence(tmp_path):
    env = {**os.environ, "PYTHONPATH": str(tmp_path)}
    script = (
        "import sys, sysmlc.config\n"
        "def fails(*_): raise ZeroDivisionError('by zero')\n"
        "sysmlc.config.find_config_file = fails\n"
        "from sysmlc.cli import main\nsys.argv = ['sysmlc', 'x.uml']\nmain()"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=env)
    assert done.returncode == 2
    assert done.stderr.startswith("sysmlc: fault of sysmlc: ZeroDivisionError: by zero\n")
    assert "Traceback" not in done.stderr


# -- progress ------------------------------------------------------------------------------------


def test_progress_is_drawn_on_terminals_only_and_after_a_second(capsys, monkeypatch):
    times = iter([0.0, 0.5, 1.5, 2.0])
    progress = Progress(clock=lambda: next(times))
    progress._on_terminal = True
    progress.step("read", 0, 3)
    assert capsys.readouterr().err == ""
    progress.step("pass ports", 1, 2)
    assert "[############------------] pass ports" in capsys.readouterr().err
    piped = Progress(clock=lambda: 9.0)
    piped.step("read", 0, 3)
    assert capsys.readouterr().err == ""


def many_findings(here, ports):
    lines = [f'  Port g.p{n} "p{n}" direction="in" @many.ir:{n}\n' for n in range(ports)]
    wrong = "  Port g.nameless\n"
    here.write("many.ir", 'Class g "Gate"\n' + "".join(lines) + wrong)


def test_of_very_many_findings_the_worst_are_shown_and_the_others_counted(here):
    many_findings(here, 5)
    made = here.sysmlc("check", "many.ir", "--max-diagnostics", "2", "--format", "concise")
    told = [line.split(": ")[1] for line in made.stderr.splitlines()[:2]]
    assert sorted(told) == ["error[SM942 test-nameless-port]", "warning[SM943 test-untyped-port]"]
    assert made.stderr.splitlines()[2:] == [
        "1 error, 5 warnings in 1 file",
        "4 more are not shown; --max-diagnostics 0 shows all",
    ]
    assert made.exit_code == 1


@pytest.mark.parametrize("most", ["6", "0"])
def test_all_findings_are_shown_when_there_are_no_more(here, most):
    many_findings(here, 5)
    made = here.sysmlc("check", "many.ir", "--max-diagnostics", most, "--format", "concise")
    assert len(made.stderr.splitlines()) == 7
    assert "not shown" not in made.stderr


def test_readers_get_a_thousand_findings_and_programs_all(here):
    many_findings(here, 1_010)
    assert here.sysmlc("check", "many.ir").stderr.count("SM943") == 999
    made = here.sysmlc("check", "many.ir", "--format", "json")
    assert len(json.loads(made.stdout)["diagnostics"]) == 1_011
    assert made.stderr == ""
