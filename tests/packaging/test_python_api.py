"""The Python API: its names, and the examples of docs/python-api.md with their outputs."""

import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import sysmlc

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/python-api.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"<!-- example: (\w+) -->\n```python\n(.*?)```", PAGE, re.DOTALL)
OUTPUTS = dict(re.findall(r"<!-- output: (\w+) -->\n```text\n(.*?)```", PAGE, re.DOTALL))


@pytest.fixture
def restore_catalogue():
    """Remove the rule that an example defines, after the test."""
    yield
    catalogue = import_module("sysmlc.diagnostics.rule")
    catalogue._rules.pop("ACME003", None)
    catalogue._names.discard("port-prefix")


@pytest.mark.parametrize(("name", "code"), EXAMPLES)
def test_an_example_prints_the_output_on_the_page(
    name, code, restore_catalogue, monkeypatch, capsys
):
    monkeypatch.chdir(ROOT)
    exec(compile(code, name, "exec"), {"__name__": name})
    output = capsys.readouterr().out
    assert output == OUTPUTS.get(name, output)
    assert output


def test_the_three_examples_have_their_output_on_the_page():
    assert set(OUTPUTS) == {"ports", "dependencies", "check"} < {name for name, _ in EXAMPLES}


@pytest.mark.parametrize("name", sysmlc.__all__)
def test_every_name_of_the_interface_is_on_the_page(name):
    assert getattr(sysmlc, name) is not None
    assert f"`{name}" in PAGE


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'compile'"):
        sysmlc.compile  # noqa: B018 - the access is the test


def test_importing_the_package_imports_no_module_of_the_compiler():
    program = "import sys, sysmlc; print(sorted(m for m in sys.modules if m.startswith('sysmlc.')))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]"


def test_a_missing_file_is_a_diagnostic(tmp_path):
    compilation = sysmlc.compile_model(tmp_path / "plant.uml")
    assert [diagnostic.rule.code for diagnostic in compilation.diagnostics] == ["SM170"]


def test_outputs_are_not_written_to_files(tmp_path):
    model = tmp_path / "plant.ir"
    model.write_text('Class gate "Gate"\n')
    compilation = sysmlc.compile_model([model], emit=["ir"])
    assert [artefact.path for artefact in compilation.artefacts] == ["graph.ir"]
    assert list(tmp_path.iterdir()) == [model]


def test_a_request_can_be_compiled(tmp_path):
    model = tmp_path / "plant.ir"
    model.write_text('Class gate "Gate"\n')
    compilation = sysmlc.compile_model(sysmlc.Request((model,)))
    assert [element.name for element in compilation.graph] == ["Gate"]
