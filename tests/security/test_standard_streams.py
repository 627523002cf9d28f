"""A standard stream that is closed or full is exit code 2, not 1."""

import subprocess
import sys
from pathlib import Path

import pytest

from long_runs import quick_first

WRONG = 'Class a "A"\n  -> specializes a\n'
CLEAN = 'Class a "A"\n'

pytestmark = pytest.mark.skipif(
    not Path("/dev/full").exists(), reason="the system has no device that is always full"
)


@pytest.fixture
def run_shell(tmp_path):
    """Return a function that runs a shell command in a folder with a clean and a faulty model."""
    (tmp_path / ".git").mkdir()
    (tmp_path / "clean.ir").write_text(CLEAN)
    (tmp_path / "wrong.ir").write_text(WRONG)

    def run_in_shell(command):
        define = f'sysmlc() {{ "{sys.executable}" -m sysmlc "$@"; }}; set -o pipefail; '
        return subprocess.run(
            ["bash", "-c", define + command], cwd=tmp_path, capture_output=True, text=True
        )

    return run_in_shell


@pytest.mark.parametrize(
    "redirection", [">&-", "2>&-", ">&- 2>&-", "2>/dev/full", "--format json >/dev/full"]
)
def test_a_closed_or_full_stream_is_exit_code_2(run_shell, redirection):
    result = run_shell(f"sysmlc check wrong.ir {redirection}")
    assert result.returncode == 2
    assert "Traceback" not in result.stderr
    assert "ignored" not in result.stderr


@pytest.mark.parametrize(
    "redirection", quick_first(["<&-", "| cat", "", ">/dev/null", "2>/dev/null"], 2)
)
def test_other_redirections_do_not_change_the_exit_code(run_shell, redirection):
    assert run_shell(f"sysmlc check wrong.ir {redirection}").returncode == 1
    assert run_shell(f"sysmlc check clean.ir {redirection}").returncode == 0


def test_messages_name_the_stream(run_shell):
    closed = run_shell("sysmlc check clean.ir >&-")
    assert closed.stderr == (
        "sysmlc: standard output is closed; redirect it to /dev/null to discard it\n"
    )
    full = run_shell("sysmlc --help >/dev/full")
    assert full.stderr == "sysmlc: cannot write to standard output: No space left on device\n"
    assert full.returncode == 2


@pytest.mark.parametrize(
    "command", quick_first(["--help", "show clean.ir", "explain", "nonsense 2>&1"], 2)
)
def test_a_closed_pipe_is_exit_code_2_without_a_message(run_shell, command):
    # The subshell waits until 'true' has closed its end of the pipe.
    result = run_shell(f"(sleep 0.2; sysmlc {command}) | true")
    assert (result.returncode, result.stdout, result.stderr) == (2, "", "")


def test_formatting_closed_standard_input_is_refused(run_shell):
    result = run_shell("sysmlc format - <&-")
    assert (result.returncode, result.stderr) == (2, "sysmlc: standard input is closed\n")
