"""The time and memory limit of every command, enforced while Python or a C library works."""

import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from sysmlc.cli import group
from sysmlc.cli.limits import LIMITS

MODEL = "package Plant { part def Gate; }"
PATIENCE = 120
"""Seconds that a test waits for a process; a machine under load needs many of them."""

WORK = {
    "python": "while True: pass",
    "sleep": "import time; time.sleep(1000)",
    "big integer": "10 ** 10 ** 9",
    "regular expression": "import re; re.match('(a+)+$', 'a' * 50 + 'b')",
    "swallowed exceptions": """
while True:
    try:
        while True: pass
    except BaseException: pass
""",
}
ALLOCATION = {
    "python": "rows = []\nwhile True: rows.append(bytearray(1 << 20))",
    "at once": "bytes(1 << 40)",
    "xml": """
from lxml import etree
root = etree.Element("a")
while True: etree.SubElement(root, "b", c="d" * 1000)
""",
}


def run_as_command(work: str, *args: str, **options) -> subprocess.Popen:
    """Start ``sysmlc backends`` with its work replaced by the statements *work*."""
    body = "".join(f"    {line}\n" for line in work.strip().splitlines())
    script = (
        "import os, sys\nfrom sysmlc.cli import backends, main\n"
        f"def work():\n{body}\nbackends.command.callback = work\nsys.argv = {['sysmlc', *args]!r}\n"
        "main()\n"
    )
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen([sys.executable, "-c", script], text=True, **pipes, **options)


def list_commands(command: click.Command, path: tuple[str, ...] = ()):
    """Yield the words and the object of each command below *command*."""
    if not isinstance(command, click.Group):
        yield path, command
        return
    context = click.Context(command)
    for name in command.list_commands(context):
        yield from list_commands(command.get_command(context, name), (*path, name))


COMMANDS = dict(list_commands(group.sysmlc))


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_command_has_both_limits(command):
    text = CliRunner().invoke(group.sysmlc, [*command, "--help"]).output
    assert "--time-limit S" in text
    assert "--memory-limit GIB" in text


@pytest.mark.parametrize("work", WORK.values(), ids=WORK)
def test_the_time_limit_ends_any_work(work):
    process = run_as_command(work, "backends", "--time-limit", "0.5")
    stdout, stderr = process.communicate(timeout=PATIENCE)
    assert process.returncode == 2
    assert stdout == ""
    assert stderr.startswith("error[SM904 time-limit]: the command did not end within 0.5 s\n")
    assert "Traceback" not in stderr


@pytest.mark.parametrize("work", ALLOCATION.values(), ids=ALLOCATION)
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux enforces memory limits")
def test_the_memory_limit_ends_any_allocation(work):
    process = run_as_command(work, "backends", "--memory-limit", "0.05")
    stdout, stderr = process.communicate(timeout=PATIENCE)
    assert process.returncode == 2
    assert stdout == ""
    assert stderr.startswith("error[SM905 memory-limit]: 0.05 GiB of memory are not enough")
    assert "Traceback" not in stderr


def test_a_crash_is_reported():
    process = run_as_command("os.kill(os.getpid(), 11)", "backends")
    _, stderr = process.communicate(timeout=PATIENCE)
    assert process.returncode == 2
    assert stderr.startswith("error[SM906 crash]: the command was ended by SIGSEGV\n")


def test_exit_code_and_output_of_a_command_are_preserved():
    process = run_as_command("print('done'); sys.exit(1)", "backends")
    assert process.communicate(timeout=PATIENCE) == ("done\n", "")
    assert process.returncode == 1


def is_alive(pid: int) -> bool:
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False


@pytest.fixture
def default_signals():
    """Let child processes start with default handlers: nohup leaves these signals ignored."""
    handlers = {number: signal.signal(number, signal.SIG_DFL) for number in (1, 2)}
    yield
    for number, handler in handlers.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("module", ["sysmlc.cli.supervisor", "sysmlc.cli.group"])
def test_ctrl_c_while_modules_are_imported_ends_without_a_traceback(module):
    process = subprocess.Popen(
        # Python prints each module when it has imported it.
        [sys.executable, "-X", "importtime", "-m", "sysmlc", "backends"],
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        # Background processes of a shell ignore SIGINT, and children inherit that.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )
    while not process.stderr.readline().rstrip().endswith(module):
        pass
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode in (-signal.SIGINT, 130)
    assert "Traceback" not in errors


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.usefixtures("default_signals")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL, signal.SIGINT, signal.SIGHUP])
def test_a_signal_to_the_command_ends_the_work(number):
    work = "print(os.getpid(), flush=True)\nwhile True: pass"
    process = run_as_command(work, "backends", start_new_session=True)
    worker = int(process.stdout.readline())
    process.send_signal(number)
    process.communicate(timeout=PATIENCE)
    assert process.returncode == (130 if number == signal.SIGINT else -number)
    deadline = time.monotonic() + PATIENCE
    while is_alive(worker):
        assert time.monotonic() < deadline
        time.sleep(0.01)


WATCH = """
import os, signal, sys, time
from pathlib import Path
from sysmlc.cli import main, watching
from sysmlc.cli.limits import LIMITS
real_compile_all = watching.compile_all
def compile_or_fail(*args):
    text = Path("plant.sysml").read_text()
    if "Endless" in text:
        LIMITS.lower(0.5, 0)
        while True: pass
    if "Huge" in text:
        bytes(1 << 40)
    if "Crash" in text:
        os.kill(os.getpid(), signal.SIGSEGV)
    return real_compile_all(*args)
watching.compile_all = compile_or_fail
sys.argv = ["sysmlc", "watch", "plant.sysml", "-o", "out", "--settle", "0"]
main()
"""
"""Only the endless compilation has a short limit: a machine under load needs seconds for others."""


def wait_for(process, condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.02)


def save_at_once(model, text):
    """Replace the file *model*, so that no build reads a file that is still empty."""
    complete = model.parent / ".git" / model.name
    complete.write_text(text)
    complete.replace(model)


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux enforces memory limits")
@pytest.mark.usefixtures("default_signals")
def test_watch_continues_after_a_limit_or_a_crash(project):
    errors, lines = project / "errors.txt", project / "lines.txt"
    model = project / "plant.sysml"
    with errors.open("w") as stderr, lines.open("a") as stdout:
        process = subprocess.Popen(
            [sys.executable, "-u", "-c", WATCH],
            stdout=stdout,
            stderr=stderr,
            start_new_session=True,
        )
    try:
        wait_for(process, lambda: "out: " in lines.read_text())
        for name, code in (("Endless", "SM904"), ("Huge", "SM905"), ("Crash", "SM906")):
            save_at_once(model, MODEL.replace("Gate", name))
            wait_for(process, lambda code=code: code in errors.read_text())
            lines.write_text("")
            save_at_once(model, MODEL.replace("Gate", "Repaired"))
            wait_for(process, lambda: "out: " in lines.read_text())
    finally:
        process.send_signal(signal.SIGINT)
    # 0 between two builds, 130 at the end of one.
    assert process.wait(PATIENCE) in (0, 130)
    assert errors.read_text().count("error[SM90") == 3


@pytest.fixture
def project(tmp_path, monkeypatch):
    (tmp_path / ".git").mkdir()
    (tmp_path / "plant.sysml").write_text(MODEL)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(LIMITS, "seconds", 0.0)
    monkeypatch.setattr(LIMITS, "gibibytes", 0.0)
    return tmp_path


@pytest.mark.parametrize(
    ("config", "options", "seconds", "gibibytes"),
    [
        ("", (), 300, 8),
        ("time-limit = 20\nmemory-limit = 0.5", (), 20, 0.5),
        ("time-limit = 900\nmemory-limit = 64", (), 300, 8),
        ("time-limit = 20", ("--time-limit", "10"), 10, 8),
        ("time-limit = 20", ("--time-limit", "0"), 20, 8),
        ("memory-limit = 2.5", ("--memory-limit", "0"), 300, 2.5),
        ("", ("--time-limit", "0", "--memory-limit", "0"), 0, 0),
    ],
)
def test_a_configuration_only_lowers_limits(project, config, options, seconds, gibibytes):
    (project / "sysmlc.toml").write_text(config)
    result = CliRunner().invoke(group.sysmlc, ["check", "plant.sysml", *options])
    assert "Error" not in result.output
    assert (LIMITS.seconds, LIMITS.gibibytes) == (seconds, gibibytes)


@pytest.mark.parametrize("value", ["0", "-1", '"long"', "inf"])
def test_a_limit_in_a_configuration_is_a_positive_number(project, value):
    (project / "sysmlc.toml").write_text(f"time-limit = {value}")
    result = CliRunner().invoke(group.sysmlc, ["check", "plant.sysml"])
    assert result.exit_code == 2
    assert "time-limit" in result.stderr


def test_a_limit_leaves_standard_output_empty_and_writes_nothing(project):
    (project / "sysmlc.toml").write_text("time-limit = 0.001")
    command = [sys.executable, "-m", "sysmlc", "plant.sysml", "-o", "out", "--format", "json"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    assert (result.returncode, result.stdout) == (2, "")
    assert "SM904" in result.stderr
    assert not (project / "out").exists()
