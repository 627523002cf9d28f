"""Recipes of SysML v2 models: a small model, ``sysmlc MODEL -o out``, and what the file says."""

import json

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc

BUILD = "first start then make; action make : MakePart; then done;"


def compile_shop(folder, body, *, recipe=BUILD):
    """Return the recipe of a shop with a mill (None if it is withheld), and the findings."""
    text = f"""package Shop {{
        private import RecipeLevels::*; private import ScalarValues::*;
        part def Mill :> Machine;
        {body}
        action def Build :> Recipe {{ {recipe} }}
    }}"""
    model = folder / "shop.sysml"
    model.write_text(text, encoding="utf-8")
    command = [str(model), "-o", str(folder / "out"), "--emit", "recipe", "--format", "json"]
    result = CliRunner().invoke(sysmlc, command)
    assert result.exit_code in (0, 1), result.output
    diagnostics = json.loads(result.stdout)["diagnostics"]
    findings = {found["code"]: found["message"] for found in diagnostics}
    file = folder / "out" / "recipes" / "Shop.Build.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else None, findings


# -- outputs of calls --------------------------------------------------------------------------

INSPECT = """
    action def Check :> InfrastructureService {{
        {direction} attribute result : Boolean; attribute :>> duration = 100;
    }}
    action def Keep :> MachineService;
    action def Reject :> MachineService;
    dependency from Keep to Mill {{ @Capability {{ duration = 1000; }} }}
    dependency from Reject to Mill {{ @Capability {{ duration = 5000; }} }}
    action def MakePart :> Task {{
        {variable}
        first start then check;
        action check : Check {binding}
        then decide;
            if {guard} then keep;
            else reject;
        action keep : Keep; then done;
        action reject : Reject; then done;
    }}
    dependency from MakePart to Mill {{ @Capability; }}"""
GOOD = "attribute good : Boolean := false;"


@pytest.mark.parametrize(
    ("variable", "binding", "direction"),
    [
        (GOOD, "{ out attribute :>> result = good; }", "out"),
        (GOOD, "{ out result = good; }", "out"),
        (GOOD, "{ inout attribute :>> result = good; }", "inout"),
        (f"{GOOD} bind good = check.result;", ";", "out"),
        (f"{GOOD} bind check.result = good;", ";", "out"),
        ("attribute good : Boolean = check.result;", ";", "out"),
        ("attribute good : Boolean = fits; attribute fits : Boolean = check.result;", ";", "out"),
        (GOOD, "; then assign good := check.result;", "out"),
    ],
)
def test_a_guard_reads_the_variable_that_an_output_is_bound_to(
    tmp_path, variable, binding, direction
):
    body = INSPECT.format(variable=variable, binding=binding, direction=direction, guard="good")
    recipe, findings = compile_shop(tmp_path, body)
    derived = recipe["recipes"][0]["tasks"][0]["derived"]
    assert derived["duration"] == {"min": 1100, "max": 5100}
    assert {"SM606", "SM645"}.isdisjoint(findings)


def test_the_output_assigns_the_bound_variable(tmp_path):
    binding = "{ out attribute :>> result = good; }"
    body = INSPECT.format(variable=GOOD, binding=binding, direction="out", guard="check.result")
    recipe, _ = compile_shop(tmp_path, body)
    (graph,) = recipe["serviceGraphs"]
    (check,) = [node for node in graph["nodes"] if node["id"] == "Shop::MakePart::check"]
    assert check["assign"] == {"result": "good"}
    guards = [edge["guard"]["var"] for edge in graph["edges"] if "guard" in edge]
    assert (guards, [v["name"] for v in graph["variables"]]) == (["good"], ["good"])


@pytest.mark.parametrize("value", ["not good", "true", "good and fits"])
def test_an_output_bound_to_another_expression_is_reported(tmp_path, value):
    variable = f"{GOOD} attribute fits : Boolean := true;"
    binding = f"{{ out attribute :>> result = {value}; }}"
    body = INSPECT.format(variable=variable, binding=binding, direction="out", guard="good")
    _, findings = compile_shop(tmp_path, body)
    assert findings["SM645"] == (
        f"output 'result' of 'Shop::MakePart::check' is bound to '{value}', which is not a "
        "variable; the recipe assigns it to 'result' only"
    )
