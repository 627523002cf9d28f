"""Recipes of SysML v2 models: a small model, ``sysmlc MODEL -o out``, and what the file says."""

import json
from pathlib import Path

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


# -- units -------------------------------------------------------------------------------------

CUT = """
    attribute <cyc> cycle : ISQ::DurationUnit;
    attribute <tick> tickUnit : ISQ::DurationUnit {{
        :>> unitConversion : MeasurementReferences::ConversionByConvention {{
            :>> referenceUnit = SI::s;
            :>> conversionFactor = 1/4;
        }}
    }}
    attribute <round> roundUnit : ISQ::DurationUnit {{
        :>> unitConversion : MeasurementReferences::ConversionByConvention {{
            :>> referenceUnit = tick;
            :>> conversionFactor = 1.2;
        }}
    }}
    attribute cutTime : ISQ::DurationValue = 9 [SI::s];
    action def Cut :> MachineService;
    dependency from Cut to Mill {{ @Capability {{ {capability} }} }}
    action def MakePart :> Task {{
        {task}
        first start then cut; action cut : Cut; {then} then done;
    }}
    dependency from MakePart to Mill {{ @Capability; }}"""


def compile_cut(folder, capability, *, task="", then=""):
    body = CUT.format(capability=capability, task=task, then=then)
    recipe, findings = compile_shop(folder, body)
    provider = None if recipe is None else recipe["services"][0]["providers"][0]
    return recipe, provider, findings


def test_times_are_milliseconds_and_power_is_watts(tmp_path):
    capability = "duration = 9 [SI::s]; minPower = 1 [SI::W]; maxPower = 1.5 [SI::kW];"
    task = "attribute :>> maxDuration = 5 [SI::min];"
    recipe, provider, findings = compile_cut(tmp_path, capability, task=task)
    assert (provider["duration"], provider["power"]) == (9000, {"min": 1, "max": 1500})
    (made,) = recipe["recipes"][0]["tasks"]
    assert made["maxDuration"] == 300_000
    assert made["derived"]["duration"] == {"min": 9000, "max": 9000}
    assert findings == {}


@pytest.mark.parametrize(
    ("value", "milliseconds"),
    [
        ("9", 9),
        ("0.29 [SI::s]", 290),
        ("1.5 [SI::h]", 5_400_000),
        ("2 [SI::minute]", 120_000),
        ("cutTime", 9000),
        ('"9 s"', 9000),
        ('"9.5 seconds"', 9500),
        ('"250ms"', 250),
        ("3 [tick]", 750),
        ("5 [round]", 1500),
        ("9007199254740992", 9007199254740992),
    ],
)
def test_a_duration_may_have_any_unit_of_time(tmp_path, value, milliseconds):
    _, provider, _ = compile_cut(tmp_path, f"duration = {value};")
    assert provider["duration"] == milliseconds


@pytest.mark.parametrize(
    ("capability", "message"),
    [
        ("duration = 9 [SI::kg];", "is '9 kg', but 'kg' is a unit of mass, not of time"),
        ("duration = 9 [SI::m];", "is '9 m', but 'm' is a unit of length, not of time"),
        ("maxPower = 2 [SI::s];", "is '2 s', but 's' is a unit of time, not of power"),
        ("minPower = 2 [SI::J];", "is '2 J', but 'J' is a unit of energy, not of power"),
    ],
)
def test_a_unit_of_another_quantity_withholds_the_recipe(tmp_path, capability, message):
    recipe, _, findings = compile_cut(tmp_path, capability)
    assert recipe is None
    assert findings["SM643"].endswith(message)


@pytest.mark.parametrize(
    ("value", "code", "end"),
    [
        ("3 [cycle]", "SM644", "the size of unit 'cyc' is unknown, and the value is ignored"),
        ('"1,5 s"', "SM622", "must be a whole number of milliseconds, 0 or more; it is ignored"),
        ("-3 [SI::s]", "SM622", "must be a whole number of milliseconds, 0 or more; it is ignored"),
        ('"0.5 ms"', "SM622", "must be a whole number of milliseconds, 0 or more; it is ignored"),
    ],
)
def test_a_duration_that_is_no_time_is_reported_and_ignored(tmp_path, value, code, end):
    _, provider, findings = compile_cut(tmp_path, f"duration = {value};")
    assert "duration" not in provider
    assert findings[code].endswith(end)


LARGEST = "9007199254740992 ms, the largest number that recipes store exactly"


@pytest.mark.parametrize(
    ("capability", "code", "end"),
    [
        ("duration = 9007199254740993;", "SM652", f"'9007199254740993', more than {LARGEST}"),
        ("duration = 9007199254741 [SI::s];", "SM652", f"'9007199254741 s', more than {LARGEST}"),
        ("maxPower = 1E16;", "SM652", LARGEST.replace(" ms", " W")),
        (
            "minPower = 10; maxPower = 3;",
            "SM653",
            "' is 10 W, more than 'maxPower', which is 3 W",
        ),
        (
            "minPower = 2 [SI::kW]; maxPower = 1999;",
            "SM653",
            "more than 'maxPower', which is 1999 W",
        ),
    ],
)
def test_numbers_without_an_exact_or_sensible_value_withhold_the_recipe(
    tmp_path, capability, code, end
):
    recipe, _, findings = compile_cut(tmp_path, capability)
    assert (recipe, list(findings)) == (None, [code])
    assert findings[code].endswith(end)


@pytest.mark.parametrize(
    ("usage", "limits"),
    [
        ("MakePart { attribute :>> maxDuration = 40; }", [40, 50]),
        ('MakePart { attribute :>> pre = "true"; }', [50, 50]),
        ("Special;", [70, 50]),
        ("Special { :>> maxDuration = 60; }", [60, 50]),
    ],
)
def test_a_usage_or_a_special_task_states_its_own_values(tmp_path, usage, limits):
    task = "attribute :>> maxDuration = 50;"
    body = CUT.format(capability="duration = 9;", task=task, then="")
    special = """action def Special :> MakePart { attribute :>> maxDuration = 70; }
        dependency from Special to Mill { @Capability; }"""
    steps = f"first start then one; action one : {usage} then two; action two : MakePart;"
    recipe, findings = compile_shop(tmp_path, body + special, recipe=steps)
    tasks = recipe["recipes"][0]["tasks"]
    assert ([task["maxDuration"] for task in tasks], findings) == (limits, {})


def test_a_metre_is_not_a_minute(tmp_path):
    then = "then accept after 2 [SI::m];"
    recipe, _, findings = compile_cut(tmp_path, "duration = 9;", then=then)
    assert "duration" not in recipe["recipes"][0]["tasks"][0]["derived"]
    assert "'2 [SI::m]'" in findings["SM616"]


@pytest.mark.parametrize(
    "capability", ["duration = nothing;", "duration = 9 [SI::sekunde];", "speed = 9;"]
)
def test_an_unknown_name_in_a_capability_withholds_the_recipe(tmp_path, capability):
    recipe, _, findings = compile_cut(tmp_path, capability)
    assert recipe is None
    assert findings["SM205"].startswith("unknown name")


def test_a_capability_of_an_unknown_machine_withholds_the_recipe(tmp_path):
    body = CUT.format(capability="duration = 9;", task="", then="")
    more = "dependency from Cut to Lathe { @Capability { duration = 5; } }"
    recipe, findings = compile_shop(tmp_path, body + more)
    assert recipe is None
    assert findings["SM205"] == "unknown name 'Lathe'"


MATERIALS = """
    part def Steel :> Material {{
        attribute :>> available = 5 [SI::kg];
        attribute weight : ISQ::MassValue = 800 [SI::g];
    }}
    part def Screw :> Material {{ attribute :>> available = 50; attribute :>> unit = "pcs"; }}
    action def Cut :> MachineService {{
        in pause : ISQ::DurationValue = 3 [SI::s];
        constant attribute load : ISQ::MassValue = 2 [SI::kg];
    }}
    dependency from Cut to Mill {{ @Capability {{ duration = 9; }} }}
    action def MakePart :> Task {{
        in item steel : Steel; in item screw : Screw;
        first start then cut; action cut : Cut {{ in :>> pause = 2 [SI::min]; }} then done;
    }}
    dependency from MakePart to Mill {{ @Capability; }}"""
USES = """
    item steel : Steel; item screw : Screw;
    first start then make; action make : MakePart; then done;
    bind make.steel = steel {{ @MaterialUse {{ quantity = 500 [SI::g]; }} }}
    bind make.screw = screw {{ @MaterialUse {{ quantity = {screws}; }} }}"""


def test_quantities_are_in_the_unit_of_the_material(tmp_path):
    recipe, findings = compile_shop(tmp_path, MATERIALS.format(), recipe=USES.format(screws=5))
    screw, steel = recipe["materials"]
    assert (steel["available"], steel["unit"]) == (5, "kg")
    assert (steel["properties"], steel["propertyUnits"]) == ({"weight": 800}, {"weight": "g"})
    assert (screw["available"], screw["unit"]) == (50, "pcs")
    uses = [use["quantity"] for use in recipe["recipes"][0]["tasks"][0]["materials"]]
    assert (uses, findings) == ([5, 0.5], {})


def test_a_unit_that_is_not_that_of_the_material_is_reported(tmp_path):
    recipe, findings = compile_shop(
        tmp_path, MATERIALS.format(), recipe=USES.format(screws="5 [SI::g]")
    )
    assert recipe is None
    assert findings["SM643"].endswith("is '5 g', but the material is counted in 'pcs'")


def test_values_of_parameters_have_their_unit(tmp_path):
    recipe, _ = compile_shop(tmp_path, MATERIALS.format(), recipe=USES.format(screws=5))
    (cut,) = recipe["services"]
    (pause,) = cut["inputs"]
    (load,) = cut["constants"]
    assert (pause["value"], pause["unit"]) == (3000, "ms")
    assert (load["value"], load["unit"]) == (2, "kg")
    bound = [node["bind"] for node in recipe["serviceGraphs"][0]["nodes"] if "bind" in node]
    assert bound == [{"pause": {"lit": 120_000}}]


# -- contradictions ----------------------------------------------------------------------------


def test_a_machine_that_is_not_available_is_reported_and_listed(tmp_path):
    recipe, provider, findings = compile_cut(tmp_path, "duration = 9; available = false;")
    (sub_task,) = recipe["recipes"][0]["tasks"][0]["derived"]["subTasks"]
    assert (provider["available"], sub_task["alternatives"][0]["available"]) == (False, False)
    assert findings["SM646"] == (
        "'Shop::Mill' is not available for 'Shop::Cut', and nothing else can perform it"
    )


def test_another_machine_may_be_available(tmp_path):
    body = CUT.format(capability="duration = 9; available = false;", task="", then="")
    body += """
        part def Saw :> Machine;
        dependency from Cut to Saw { @Capability { duration = 9; } }
        dependency from MakePart to Saw { @Capability; }"""
    _, findings = compile_shop(tmp_path, body)
    assert findings["SM646"] == "'Shop::Mill' is not available for 'Shop::Cut'"


def test_availability_is_true_or_false(tmp_path):
    _, _, findings = compile_cut(tmp_path, 'duration = 9; available = "no";')
    assert findings["SM622"].endswith("is 'no', but must be true or false; it is ignored")


def test_a_recipe_that_needs_more_than_is_available_is_reported(tmp_path):
    _, findings = compile_shop(tmp_path, MATERIALS.format(), recipe=USES.format(screws=51))
    assert findings["SM647"] == (
        "recipe 'Shop::Build' needs 51 pcs of 'Shop::Screw', but 50 pcs is available"
    )


def test_an_attribute_that_was_meant_to_redefine_is_reported(tmp_path):
    _, _, findings = compile_cut(
        tmp_path, "duration = 9;", task="attribute maxDuration : Natural = 5;"
    )
    assert findings["SM648"] == (
        "'maxDuration' of 'MakePart' is a new feature; it gives no value to the 'maxDuration' of "
        "the library's 'Task'"
    )


LOOP = """
    action def Cut :> MachineService;
    dependency from Cut to Mill {{ @Capability {{ duration = 9; }} }}
    action def MakePart :> Task {{
        attribute n : Integer := 0;
        first start then again;
        merge again; then cut; action cut : Cut; then assign n := n + 1;
        then decide {{ @Loop {{ maxIterations = {bound}; }} }} if n < 5 then again; else done;
    }}
    dependency from MakePart to Mill {{ @Capability; }}"""


@pytest.mark.parametrize("bound", [5, 8])
def test_a_bound_that_the_guards_keep_is_right(tmp_path, bound):
    _, findings = compile_shop(tmp_path, LOOP.format(bound=bound))
    assert "SM649" not in findings


def test_a_bound_below_the_counted_rounds_is_reported(tmp_path):
    _, findings = compile_shop(tmp_path, LOOP.format(bound=3))
    assert findings["SM649"] == (
        "the guards let the loop at 'Shop::MakePart::decision' run up to 5 times, but "
        "maxIterations is 3"
    )


def test_a_capability_far_from_the_services_is_reported(tmp_path):
    body = CUT.format(capability="duration = 9;", task="", then="")
    body = body.replace("{ @Capability; }", "{ @Capability { duration = 500; } }")
    _, findings = compile_shop(tmp_path, body)
    assert findings["SM650"] == (
        "task 'Shop::Build::make' takes 9 ms by its services, but 500 ms on 'Shop::Mill', more "
        "than twice as long"
    )


def test_a_missing_duration_is_named(tmp_path):
    more = "then action drill : Drill;"
    body = CUT.format(capability="duration = 9;", task="", then=more)
    body += "action def Drill :> MachineService; dependency from Drill to Mill { @Capability; }"
    recipe, findings = compile_shop(tmp_path, body)
    assert "duration" not in recipe["recipes"][0]["tasks"][0]["derived"]
    assert findings["SM651"] == (
        "no times are derived for task 'Shop::Build::make': 'Shop::Drill' has no duration"
    )


def test_a_model_without_times_needs_none(tmp_path):
    _, _, findings = compile_cut(tmp_path, "")
    assert findings == {}


def test_an_unreadable_duration_is_not_missing_too(tmp_path):
    task = "attribute :>> maxDuration = 50;"
    _, _, findings = compile_cut(tmp_path, "duration = 3 [cycle];", task=task)
    assert list(findings) == ["SM644"]


# -- models in UML -----------------------------------------------------------------------------

LEGO = Path(__file__).parents[2] / "examples" / "lego-recipe" / "lego-recipe.uml"


@pytest.mark.parametrize(("duration", "milliseconds"), [("9 s", 9000), ("9 kg", None)])
def test_a_tag_of_a_model_in_uml_may_have_a_unit(tmp_path, duration, milliseconds):
    model = tmp_path / "lego.uml"
    model.write_text(LEGO.read_text().replace('duration="2400"', f'duration="{duration}"', 1))
    command = [str(model), "-o", str(tmp_path / "out"), "--emit", "recipe"]
    result = CliRunner().invoke(sysmlc, command)
    assert ("SM643" in result.stderr) == (milliseconds is None)
    for file in (tmp_path / "out" / "recipes").glob("*.json"):
        services = json.loads(file.read_text(encoding="utf-8"))["services"]
        times = [p.get("duration") for s in services for p in s.get("providers", ())]
        assert milliseconds in times
