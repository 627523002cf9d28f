"""Links, commands, configurations and scenarios in the documentation are valid."""

import json
import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner
from documentation import read_block

from sysmlc import config
from sysmlc.cli.group import COMMANDS, sysmlc
from sysmlc.logic.contract import BooleanDomain
from sysmlc.logic.printing import print_formula
from sysmlc.logic.sentences import read_requirement

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *ROOT.glob("examples/*/*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_local_links_point_to_files(page):
    prose = re.sub(r"```.*?```|`[^`]*`|^    .*$", "", page.read_text("utf-8"), flags=re.S | re.M)
    links = re.findall(r"\]\(([^)#]+)", prose)
    local = [link for link in links if "://" not in link]
    assert [link for link in local if not (page.parent / link).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_commands_and_options_of_a_page_exist(page):
    """Commands are taken from code blocks and from sentences."""
    text = page.read_text(encoding="utf-8")
    lines = re.findall(r"^(?:    |- run: |\$ )(sysmlc [^>|#\n]*)", text, re.MULTILINE)
    for line in [*lines, *re.findall(r"`(sysmlc [^`]*)`", text)]:
        words = line.split()
        command = sysmlc.get_command(None, words[1] if words[1] in COMMANDS else "build")
        if isinstance(command, click.Group):
            command = command.get_command(None, words[2])
        existing = {
            option
            for parameter in command.params
            for option in (*parameter.opts, *parameter.secondary_opts)
        }
        options = [word for word in words if re.fullmatch(r"--?[a-z][a-z-]*", word)]
        assert set(options) <= existing | {"--help", "--version"}, line


def test_the_index_lists_every_page():
    index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"index.md"}
    assert [page for page in sorted(pages) if f"({page})" not in index] == []


def test_the_documented_configuration_is_valid(tmp_path):
    (tmp_path / "sysmlc.toml").write_text(read_block("docs/configuration.md", "sysmlc.toml"))
    loaded = config.read_config(tmp_path / "sysmlc.toml")
    assert loaded.models[0].files == ("models/plant.uml", "profiles/*.uml")


def test_the_documented_scenario_passes(tmp_path):
    scenario = tmp_path / "gripper.yaml"
    scenario.write_text(read_block("docs/simulate-a-scenario.md", "scenario"))
    model = str(ROOT / "examples/lego-recipe/lego-recipe.uml")
    report = tmp_path / "report.xml"
    args = ["simulate", model, "--scenario", str(scenario), "--junit", str(report)]
    result = CliRunner().invoke(sysmlc, [*args, "-o", str(tmp_path)])
    assert result.stdout == (
        "passed  LegoRecipe::Plant::Gripper: the gripper closes and opens (5 steps)\n"
        "1 of 1 scenario passed\n"
    )
    assert result.exit_code == 0
    assert 'failures="0"' in report.read_text()
    assert (tmp_path / "gripper.seq.puml").read_text().startswith("@startuml\n")


def test_the_documented_structured_requirements_hold(tmp_path):
    model = tmp_path / "gate.sysml"
    model.write_text(read_block("docs/contracts.md", "structured requirement"))
    result = CliRunner().invoke(sysmlc, ["contracts", "check", str(model), "--format", "json"])
    entries = json.loads(result.stdout)["requirements"]
    assert [(entry["requirement"], entry["verdict"]) for entry in entries] == [
        ("Plant::Lock", "holds"),
        ("Plant::Keep", "holds"),
    ]


def test_structured_sentences_have_the_documented_formulas():
    text = (ROOT / "docs/contracts.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (.* shall .*\.) \| `(.*)` \|$", text, re.MULTILINE)
    names = dict.fromkeys("MPQR", BooleanDomain())
    formulas = [print_formula(read_requirement(sentence, names, ["Gate"])) for sentence, _ in rows]
    assert formulas == [formula.replace("\\|", "|") for _, formula in rows]
    assert len(rows) == 9


@pytest.mark.parametrize("page", ["README.md", "docs/understand-a-message.md"])
def test_the_documented_diagnostic_is_printed_by_the_command(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    options = ["check", "examples/lego-recipe/lego-recipe.uml", "--min-severity", "info"]
    result = CliRunner().invoke(sysmlc, options)
    assert read_block(page, "finding") in result.stderr


def test_documented_severities_and_suppressions_are_valid(tmp_path, monkeypatch):
    text = (ROOT / "docs/understand-a-message.md").read_text(encoding="utf-8")
    parts = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    (tmp_path / "sysmlc.toml").write_text("\n".join(parts))
    monkeypatch.chdir(tmp_path)
    model = str(ROOT / "examples/lego-recipe/lego-recipe.uml")
    args = ["check", model, "--config", "sysmlc.toml", "--format", "concise"]
    result = CliRunner().invoke(sysmlc, args)
    assert "error[SM410 assumed-range]: property 'target'" in result.stderr
    assert "SM410 assumed-range]: property 'placed'" not in result.stderr


def test_a_failing_scenario_is_exit_code_1(tmp_path):
    scenario = tmp_path / "gripper.yaml"
    text = read_block("docs/simulate-a-scenario.md", "scenario")
    scenario.write_text(text.replace("closed: true", "closed: false"))
    model = str(ROOT / "examples/lego-recipe/lego-recipe.uml")
    result = CliRunner().invoke(sysmlc, ["simulate", model, "--scenario", str(scenario)])
    assert result.exit_code == 1
    assert "step 3: closed is true, expected false" in result.stdout


def test_make_has_the_documented_targets():
    targets = re.findall(r"^([a-z]+):.*## ", (ROOT / "Makefile").read_text(), re.MULTILINE)
    mentioned = set()
    for page in ("README.md", "CONTRIBUTING.md"):
        text = (ROOT / page).read_text(encoding="utf-8")
        mentioned |= set(re.findall(r"(?:^    |`)make ([a-z]+)", text, re.MULTILINE))
    assert {"demo", "test"} <= mentioned <= set(targets)
