"""Outputs and diagnostics do not depend on the order of the inputs."""

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sysmlc.cli import group

CELLS = {
    "cells.sysml": """\
package Cells {
    private import Arms::*;
    alias Reach for Shared;
    part def Cell { part arm : Arm; part lost : Nowhere; port out1 : Tray; }
    part line { part one : Cell; part two : Cell; connect one.out1 to two.out1; }
}
""",
    "arms.sysml": """\
package Arms {
    public import Cells::Reach;
    part def Arm { attribute load; action pick { first start; then action grip; then done; } }
    part def Shared :> Arm;
}
""",
    "again.sysml": """\
package Cells { part def Cell { part other : Arms::Arm; } }
package Arms { port def Tray; }
""",
    "trays.sysml": """\
package Trays { private import Cells::**; part def Tray; part tray : Tray; part cell : Cell; }
""",
}
CLASSES = """\
<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="{name}">
  <packagedElement xmi:type="uml:Class" xmi:id="{name}_c" name="Cell">
    <generalization xmi:type="uml:Generalization" xmi:id="g">
      <general xmi:type="uml:Class" href="{next}.uml#{next}_c"/>
    </generalization>
    <ownedAttribute xmi:type="uml:Property" xmi:id="p" name="part" type="gone"/>
  </packagedElement>
</uml:Model>
"""
MODELS = {
    f"{name}.uml": CLASSES.format(name=name, next=next_name)
    for name, next_name in (("one", "two"), ("two", "three"), ("three", "four"), ("four", "one"))
}
PLANT = """\
<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="{name}.aml">
  <ExternalReference Path="{next}.aml" Alias="Next"/>
  <InstanceHierarchy Name="Plant">
    <InternalElement Name="Cell" ID="1" RefBaseSystemUnitPath="Next@Lib/{next}"/>
  </InstanceHierarchy>
  <SystemUnitClassLib Name="Lib">
    <SystemUnitClass Name="{name}" RefBaseClassPath="Lib/Gone"/>
  </SystemUnitClassLib>
</CAEXFile>
"""
PLANTS = {
    f"{name}.aml": PLANT.format(name=name, next=next_name)
    for name, next_name in (("a", "b"), ("b", "c"), ("c", "d"), ("d", "a"))
}


@pytest.mark.parametrize("texts", [CELLS, MODELS, PLANTS], ids=["v2", "xmi", "aml"])
@settings(
    max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(random=st.randoms(use_true_random=False))
def test_the_order_of_the_inputs_changes_neither_outputs_nor_diagnostics(
    tmp_path, monkeypatch, texts, random
):
    monkeypatch.chdir(tmp_path)
    expected = compile_in_order(sorted(texts), texts)
    order = sorted(texts)
    random.shuffle(order)
    assert compile_in_order(order, texts) == expected
    assert expected[1][0] == 1, (
        "the models have errors, so that the order of diagnostics is compared"
    )


def compile_in_order(order, texts):
    """Write and compile the files in this order; return the outputs and what the command prints."""
    for folder in ("unit", "out"):
        shutil.rmtree(folder, ignore_errors=True)
    Path("unit").mkdir()
    for name in order:
        Path("unit", name).write_text(texts[name])
    paths = [f"unit/{name}" for name in order]
    options = ["-o", "out", "--emit", "+ir", "--no-cache", "--format", "json"]
    result = CliRunner().invoke(group.sysmlc, [*paths, *options])
    files = {file.as_posix(): file.read_text() for file in Path("out").rglob("*.*")}
    return files, (result.exit_code, result.stdout, result.stderr)
