"""What a model does not have is not imported: each of these would cost every run its time."""

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
"""A part, its states and its steps; nothing is wrong with the text."""


def imported(model: Path, folder: Path) -> set[str]:
    """The modules that a compile of the model has imported."""
    command = [sys.executable, "-c", PROGRAM, str(model), "-o", str(folder), "--no-cache"]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=True)
    return set(done.stdout.rpartition("imported:")[2].split())


@pytest.mark.parametrize(
    "module",
    [
        "sysmlc.frontends.caex.reading",
        "sysmlc.frontends.huds.lowering",
        "ruamel.yaml",
        "urllib.request",
    ],
)
def test_a_model_of_uml_brings_no_readers_of_other_things(uml_modules, module):
    assert "sysmlc.frontends.xmi.lowering" in uml_modules
    assert module not in uml_modules


@pytest.fixture(scope="module")
def uml_modules(tmp_path_factory):
    model = EXAMPLES / "baygate-behaviour" / "baygate-behaviour.uml"
    return imported(model, tmp_path_factory.mktemp("out"))


NOT_IN_A_RUN_OF_SYSML = [
    "sysmlc.frontends.xmi.reading",
    "sysmlc.ir.text",
    "jsonschema",
    "lark",
    "lxml",
    "networkx",
    "pyecore",
]


def test_a_model_of_sysml_v2_brings_no_readers_of_what_it_does_not_have(tmp_path):
    model = tmp_path / "lamp.sysml"
    model.write_text(LAMP, encoding="utf-8")
    found = imported(model, tmp_path / "out")
    assert {"sysmlc.frontends.sysml.states", "sysmlc.passes.contracts"} <= found
    assert sorted(found.intersection(NOT_IN_A_RUN_OF_SYSML)) == []


def test_a_plant_with_an_overlay_brings_both_readers(tmp_path):
    found = imported(EXAMPLES / "baygate" / "baygate.aml", tmp_path)
    assert {"sysmlc.frontends.caex.reading", "ruamel.yaml"} <= found
