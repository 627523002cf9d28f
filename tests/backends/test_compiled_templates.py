"""Bytecode of our templates is kept as Python keeps that of modules, and never believed blindly."""

import sys
from pathlib import Path

import pytest
from jinja2 import Environment, FileSystemLoader

from sysmlc.backends import templates
from sysmlc.backends.compiled_templates import CompiledTemplates


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Templates in a folder of their own, and leave to write bytecode."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)
    (tmp_path / "greeting.j2").write_text("Good morning, {{ name }}!")
    return tmp_path


def rendered(folder: Path, options: object = None) -> tuple[str, int]:
    """The text of a new environment, and how many templates it had to compile."""
    made = Environment(
        loader=FileSystemLoader(folder),
        autoescape=False,
        bytecode_cache=CompiledTemplates(options),
    )
    compiled = []
    compile_, made.compile = made.compile, lambda *a, **k: compiled.append(a) or compile_(*a, **k)
    return made.get_template("greeting.j2").render(name="gate"), len(compiled)


def kept(folder: Path) -> list[Path]:
    return sorted(folder.glob("__pycache__/*"))


def test_a_template_is_compiled_once(folder):
    assert rendered(folder) == ("Good morning, gate!", 1)
    assert rendered(folder) == ("Good morning, gate!", 0)
    assert [path.name.partition(".")[0] for path in kept(folder)] == ["greeting"]


def test_another_text_or_other_options_are_compiled_anew(folder):
    rendered(folder)
    (folder / "greeting.j2").write_text("Good evening, {{ name }}!")
    assert rendered(folder) == ("Good evening, gate!", 1)
    assert rendered(folder, {"trim_blocks": True}) == ("Good evening, gate!", 1)


@pytest.mark.parametrize("keep", [0, 5, 40, -7])
def test_damaged_bytecode_is_compiled_anew(folder, keep):
    rendered(folder)
    (file,) = kept(folder)
    file.write_bytes(file.read_bytes()[:keep])
    assert rendered(folder) == ("Good morning, gate!", 1)
    assert rendered(folder) == ("Good morning, gate!", 0)


def test_nothing_is_written_where_python_writes_no_bytecode(folder, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert rendered(folder) == ("Good morning, gate!", 1)
    assert kept(folder) == []


def test_a_folder_that_cannot_be_written_costs_time_only(folder):
    (folder / "__pycache__").write_text("no folder")
    assert rendered(folder) == rendered(folder) == ("Good morning, gate!", 1)


def test_templates_of_the_user_are_left_alone(folder):
    made = templates.environment("plantuml", folder)
    assert made.get_template("greeting.j2").render(name="gate") == "Good morning, gate!"
    assert kept(folder) == []
