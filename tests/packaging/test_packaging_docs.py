"""What the documentation says can be done, can be done."""

import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from sysmlc import config
from sysmlc.cli.group import COMMANDS, sysmlc

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *ROOT.glob("examples/*/*.md")])


def block(page: str, title: str) -> str:
    """The code below the comment with this title."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.search(rf"<!-- {re.escape(title)} -->\n```\w+\n(.*?)```", text, re.DOTALL)
    assert found, (page, title)
    return found[1]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page):
    prose = re.sub(r"```.*?```|`[^`]*`|^    .*$", "", page.read_text("utf-8"), flags=re.S | re.M)
    links = re.findall(r"\]\(([^)#]+)", prose)
    local = [link for link in links if "://" not in link]
    assert [link for link in local if not (page.parent / link).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_commands_and_options_exist(page):
    """Commands in blocks, and those in the middle of a sentence."""
    text = page.read_text(encoding="utf-8")
    lines = re.findall(r"^(?:    |- run: |\$ )(sysmlc [^>|#\n]*)", text, re.MULTILINE)
    for line in [*lines, *re.findall(r"`(sysmlc [^`]*)`", text)]:
        words = line.split()
        command = sysmlc.get_command(None, words[1] if words[1] in COMMANDS else "build")
        if isinstance(command, click.Group):
            command = command.get_command(None, words[2])
        known = {option for p in command.params for option in (*p.opts, *p.secondary_opts)}
        options = [word for word in words if re.fullmatch(r"--?[a-z][a-z-]*", word)]
        assert set(options) <= known | {"--help", "--version"}, line


def test_the_index_lists_every_page():
    index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"index.md"}
    assert [page for page in sorted(pages) if f"({page})" not in index] == []


def test_the_configuration_shown_is_valid(tmp_path):
    (tmp_path / "sysmlc.toml").write_text(block("docs/configuration.md", "sysmlc.toml"))
    loaded = config.read_config(tmp_path / "sysmlc.toml")
    assert loaded.models[0].files == ("models/plant.uml", "profiles/*.uml")


def test_the_scenario_shown_passes(tmp_path):
    scenario = tmp_path / "gripper.yaml"
    scenario.write_text(block("docs/simulate-a-scenario.md", "scenario"))
    model = str(ROOT / "examples/lego-recipe/lego-recipe.uml")
    report = tmp_path / "report.xml"
    args = ["simulate", model, "--scenario", str(scenario), "--junit", str(report)]
    done = CliRunner().invoke(sysmlc, [*args, "-o", str(tmp_path)])
    assert done.stdout == (
        "passed  LegoRecipe::Plant::Gripper: the gripper closes and opens (5 steps)\n"
        "1 of 1 scenarios passed\n"
    )
    assert done.exit_code == 0
    assert 'failures="0"' in report.read_text()
    assert (tmp_path / "gripper.seq.puml").read_text().startswith("@startuml\n")


@pytest.mark.parametrize("page", ["README.md", "docs/understand-a-message.md"])
def test_the_finding_shown_is_what_the_command_says(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    done = CliRunner().invoke(sysmlc, ["check", "examples/lego-recipe/lego-recipe.uml"])
    assert block(page, "finding") in done.stderr


def test_severities_and_acceptances_shown_are_valid(tmp_path, monkeypatch):
    text = (ROOT / "docs/understand-a-message.md").read_text(encoding="utf-8")
    parts = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    (tmp_path / "sysmlc.toml").write_text("\n".join(parts))
    monkeypatch.chdir(tmp_path)
    model = str(ROOT / "examples/lego-recipe/lego-recipe.uml")
    args = ["check", model, "--config", "sysmlc.toml", "--format", "concise"]
    done = CliRunner().invoke(sysmlc, args)
    assert "error[SM410 assumed-range]: property 'target'" in done.stderr
    assert "SM410 assumed-range]: property 'placed'" not in done.stderr


def test_a_failing_scenario_is_exit_code_1(tmp_path):
    scenario = tmp_path / "gripper.yaml"
    text = block("docs/simulate-a-scenario.md", "scenario")
    scenario.write_text(text.replace("closed: true", "closed: false"))
    model = str(ROOT / "examples/lego-recipe/lego-recipe.uml")
    done = CliRunner().invoke(sysmlc, ["simulate", model, "--scenario", str(scenario)])
    assert done.exit_code == 1
    assert "step 2: closed is true, expected false" in done.stdout


def test_make_has_the_targets_that_are_named():
    targets = re.findall(r"^([a-z]+):.*## ", (ROOT / "Makefile").read_text(), re.MULTILINE)
    named = set()
    for page in ("README.md", "CONTRIBUTING.md"):
        text = (ROOT / page).read_text(encoding="utf-8")
        named |= set(re.findall(r"(?:^    |`)make ([a-z]+)", text, re.MULTILINE))
    assert {"demo", "test"} <= named <= set(targets)
