"""A compilation imports only the modules that its model needs, because imports take time."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
PROGRAM = """
import sys
from sysmlc.cli.group import sysmlc
try:
    sysmlc(sys.argv[1:])
except SystemExit:
    pass
print("imported:", *sorted(sys.modules))
"""

LAMP = """
package Lamps {
    part def Lamp {
        attribute level : ScalarValues::Integer;
        state def Glow {
            entry; then off;
            state off;
            accept after 5 then on;
            state on;
        }
        exhibit state glow : Glow;
        action blink { first start; then action wait; then done; }
    }
}
"""
"""A part with states and actions, without errors."""


def list_imported_modules(model: Path, folder: Path) -> set[str]:
    """Compile the model in a process of its own; return the imported modules."""
    command = [sys.executable, "-c", PROGRAM, str(model), "-o", str(folder), "--no-cache"]
    result = subprocess.run(command, capture_output=True, encoding="utf-8", check=True)
    return set(result.stdout.rpartition("imported:")[2].split())


@pytest.mark.parametrize(
    "module",
    [
        "sysmlc.frontends.caex.reading",
        "sysmlc.frontends.huds.lowering",
        "ruamel.yaml",
        "urllib.request",
    ],
)
def test_a_uml_model_imports_no_readers_of_other_formats(uml_modules, module):
    assert "sysmlc.frontends.xmi.lowering" in uml_modules
    assert module not in uml_modules


@pytest.fixture(scope="module")
def uml_modules(tmp_path_factory):
    model = EXAMPLES / "baygate-behaviour" / "baygate-behaviour.uml"
    return list_imported_modules(model, tmp_path_factory.mktemp("out"))


NOT_NEEDED_FOR_SYSML_V2 = [
    "sysmlc.analyses.verdicts",
    "sysmlc.frontends.xmi.reading",
    "sysmlc.ir.text",
    "sysmlc.robots",
    "sysmlc.synthesis",
    "jsonschema",
    "lark",
    "lxml",
    "networkx",
    "pyecore",
]


def test_a_sysml_v2_model_imports_no_readers_of_other_formats(tmp_path):
    model = tmp_path / "lamp.sysml"
    model.write_text(LAMP, encoding="utf-8")
    modules = list_imported_modules(model, tmp_path / "out")
    assert {"sysmlc.frontends.sysml.states", "sysmlc.analyses.contracts"} <= modules
    assert sorted(modules.intersection(NOT_NEEDED_FOR_SYSML_V2)) == []


def test_a_plant_with_an_overlay_imports_the_readers_of_both(tmp_path):
    modules = list_imported_modules(EXAMPLES / "baygate" / "baygate.aml", tmp_path)
    assert {"sysmlc.frontends.caex.reading", "ruamel.yaml"} <= modules
