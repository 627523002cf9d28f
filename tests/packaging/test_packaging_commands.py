"""Every command in README, docs and ``--help`` succeeds after an installation without extras.

The commands of a page are run by a shell in one folder, in their order. ``reader_files`` creates
the files that they refer to.
"""

import os
import re
import signal
import subprocess
import time

import pytest
from documentation import Command, find_commands
from reader_files import supply_files

from sysmlc.cli.group import COMMANDS

pytestmark = pytest.mark.long

NOT_RUN = {
    r"pip install ": "the environment of this test is made by installing",
    r"uses: ": "actions of a service for continuous integration",
    r"make ": "targets of the Makefile, which test_packaging_docs looks up",
    r"java -jar plantuml\.jar ": "the reader downloads PlantUML",
}
"""Commands that are not run, with the reason."""

EXIT_CODES = {
    r"sysmlc diff ": 1,
    r"sysmlc contracts check .* # draws the runs that break a contract": 1,
}
"""Exit codes other than 0 that pages state: models differ, a contract is violated."""

PREPARATION = {"docs/check-in-ci.md": ["sysmlc build plant.uml -o out/"]}
"""Commands that a page assumes to have been run before its first one."""

BOUND = 300
ALL_COMMANDS = find_commands()
COMMANDS_BY_PAGE = {
    page: [command for command in ALL_COMMANDS if command.page == page]
    for page in dict.fromkeys(command.page for command in ALL_COMMANDS)
}


def can_run(command: Command) -> bool:
    return not any(re.match(pattern, command.text) for pattern in NOT_RUN)


PAGES = [page for page, commands in COMMANDS_BY_PAGE.items() if any(map(can_run, commands))]


def test_commands_of_every_kind_of_page_are_found():
    commands = {(command.page, command.text) for command in ALL_COMMANDS}
    assert {
        ("README.md", "sysmlc examples/lego-recipe/lego-recipe.uml -o out/"),
        ("docs/check-in-ci.md", "sysmlc check models/ --format github"),
        ("docs/simulate-a-scenario.md",
         "sysmlc simulate examples/lego-recipe/lego-recipe.uml --scenario gripper.yaml"),
        ("sysmlc synth --help", "sysmlc synth gate.contract.json --realizable"),
    } <= commands  # fmt: skip
    without_examples = {"backends"}
    assert {page.split()[1] for page in COMMANDS_BY_PAGE if page.endswith("--help")} == {
        "--help",
        *COMMANDS,
    } - without_examples


def test_every_exception_matches_a_command():
    texts = [command.text for commands in COMMANDS_BY_PAGE.values() for command in commands]
    for pattern in (*NOT_RUN, *EXIT_CODES):
        assert any(re.match(pattern, text) for text in texts), pattern
    assert set(PREPARATION) <= set(COMMANDS_BY_PAGE)


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_succeed(page, environment, tmp_path):
    folder = tmp_path / "repository"
    folder.mkdir()
    variables = {
        **environment.variables(),
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
        "HOME": str(tmp_path / "home"),
    }
    variables.pop("SYSMLC_CACHE", None)

    def sysmlc(*arguments):
        subprocess.run(["sysmlc", *arguments], cwd=folder, env=variables, check=True)

    supply_files(page, folder, sysmlc)
    problems = []
    texts = [command.text for command in COMMANDS_BY_PAGE[page] if can_run(command)]
    for text in [*PREPARATION.get(page, []), *texts]:
        run = run_watch if text.startswith("sysmlc watch ") else run_command
        problem = run(text, folder, variables)
        if problem:
            problems.append(f"{text}\n{problem}")
    assert not problems, "\n\n".join(problems)


def run_command(text, folder, variables):
    """Run a command in a shell; return the problem, or an empty text."""
    run = ["/bin/sh", "-c", text]
    result = subprocess.run(
        run, cwd=folder, env=variables, input="", capture_output=True, text=True, timeout=BOUND
    )
    expected = next((code for line, code in EXIT_CODES.items() if re.match(line, text)), 0)
    return (
        "" if result.returncode == expected else f"exit code {result.returncode}\n{result.stderr}"
    )


def run_watch(text, folder, variables):
    """Run a watch command until its first build is done, then interrupt it."""
    lines, errors = folder.parent / "lines.txt", folder.parent / "errors.txt"
    with lines.open("w") as stdout, errors.open("w") as stderr:
        process = subprocess.Popen(
            ["/bin/sh", "-c", f"exec {text}"],
            cwd=folder,
            env={**variables, "PYTHONUNBUFFERED": "1"},
            stdout=stdout,
            stderr=stderr,
            start_new_session=True,
            # Background processes of a shell ignore SIGINT, and children inherit that.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        deadline = time.monotonic() + BOUND
        while not lines.read_text() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.1)
        os.killpg(process.pid, signal.SIGINT)
        code = process.wait(BOUND)
    is_built = "changed" in lines.read_text()
    return "" if is_built and code in (0, 130) else f"exit code {code}\n{errors.read_text()}"
