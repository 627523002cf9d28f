"""Runs over real features show numbers: in the unit of the author, inside the region."""

import json
from pathlib import Path

import pytest

from json_documents import Document, find_violations

MODEL = """package Plant {
    private import ScalarValues::*;
    private import SI::*;
    private import ISQ::*;
    part def Thermostat {
        in attribute temp : TemperatureValue;
        attribute low : TemperatureValue = 18 ['°C_abs'];
        exhibit state Control {
            entry; then Idle;
            state Idle;
            state Heating;
            transition first Idle if temp < low then Heating;
            transition first Heating if temp >= 22 ['°C_abs'] then Idle;
        }
    }
    part def Switch {
        in attribute x : Real;
        constant attribute least : Real;
        constant attribute most : Real;
        assert constraint { least < most }
        exhibit state Control {
            entry; then Off;
            state Off;
            state On;
            transition first Off if x < least then On;
            transition first On if x > most then Off;
        }
    }
    part def Scale {
        in attribute gross : MassValue;
        in attribute tare : MassValue;
        exhibit state Control {
            entry; then Empty;
            state Empty;
            state Loaded;
            transition first Empty if gross > tare + 50 [g] then Loaded;
        }
    }
    part def Mixer {
        in attribute a : Real;
        in attribute b : Real;
        assert constraint { a + b <= 10.2 }
        exhibit state Control {
            entry; then Off;
            state Off;
            state On;
            transition first Off if a > 3.0 and b > 6.5 then On;
        }
    }
    part def Tank {
        attribute level : LengthValue := 0 [cm];
        exhibit state Control {
            entry; then Filling;
            state Filling;
            state Full;
            transition first Filling if level < 100 [cm]
                do assign level := level + 25 [cm] then Filling;
            transition first Filling if level >= 1 [m] then Full;
        }
    }
    requirement def Rule {
        subject s : PART;
        require constraint { language "ltl" /* FORMULA */ }
    }
}
"""


@pytest.fixture
def check(workspace, all_passes):
    def run(part, formula, *options):
        text = MODEL.replace("PART", part).replace("FORMULA", formula)
        workspace.write("plant.sysml", text)
        return workspace.sysmlc("contracts", "check", "plant.sysml", "--verbose", *options)

    return run


def list_steps(result):
    return [line.partition("note: ")[2] for line in result.stderr.splitlines() if "note: " in line]


def test_a_number_has_the_unit_of_the_threshold_and_the_name_of_the_region(check):
    steps = list_steps(check("Thermostat", "G state=Idle"))
    assert steps[0] == "step 1: temp = 0 °C (below low), state=Idle"


def test_a_number_stays_as_long_as_it_fits(check):
    # The requirement is wrong, because it forgets that the heating goes on up to 22 °C.
    steps = list_steps(check("Thermostat", "G (temp >= 20 ['°C_abs'] -> state=Idle)"))
    assert steps[:2] == [
        "step 1: temp = 0 °C (below low), state=Idle",
        "step 2: temp = 20 °C (20 °C to 22 °C), state=Heating  <-- violated here",
    ]


def test_constants_without_value_get_one_value_for_the_whole_run(check):
    steps = list_steps(check("Switch", "G !(state=On & x > most)"))
    assert steps[:2] == [
        "step 1: least = -1, x = -2 (below least, up to most), most = 0, state=Off",
        "step 2: x = 1 (from least, above most), state=On  <-- violated here",
    ]


def test_features_of_a_sum_have_numbers_instead_of_the_sum(check):
    steps = list_steps(check("Scale", "G state=Empty"))
    assert steps[0] == "step 1: gross = 60 g (gross > tare + 50 g), tare = 0 g, state=Empty"


def test_numbers_respect_constraints_between_features(check):
    # The shortest numbers, 4 and 7, are more than 10.2 together.
    steps = list_steps(check("Mixer", "G state=Off"))
    assert steps[0] == "step 1: a = 3.1 (above 3), b = 7 (above 6.5), state=Off"


def test_a_number_that_the_component_sets_is_the_one_that_it_sets(check):
    steps = list_steps(check("Tank", "G level < 75 [cm]"))
    assert steps[:4] == [
        "step 1: level = 0 cm, state=Filling",
        "step 2: level = 25 cm",
        "step 3: level = 50 cm",
        "step 4: level = 75 cm  <-- violated here",
    ]


def test_json_has_regions_and_numbers(check):
    document = json.loads(check("Thermostat", "G state=Idle", "--format", "json").stdout)
    assert find_violations(Document(Path(), "sysmlc-diagnostics", document)) == []
    (entry,) = document["requirements"]
    assert entry["witness"]["steps"][1] == {"temp": "below_low", "state": "Heating"}
    assert entry["witness"]["numbers"][1] == {"temp": {"number": 0, "unit": "°C"}}


def test_diagrams_have_the_same_numbers(check, workspace):
    check("Switch", "G !(state=On & x > most)", "-o", "out")
    (diagram,) = workspace.folder.glob("out/**/*.run1.puml")
    assert "p0 -> p1 : x = 1 (from least, above most)\n" in diagram.read_text(encoding="utf-8")


EQUAL_NAMES = """package Plant {
    private import ScalarValues::*;
    private import SI::*;
    private import ISQ::*;
    part def Thermostat {
        in attribute temp : TemperatureValue;
        attribute low : TemperatureValue = 18 ['°C_abs'];
        exhibit state Control {
            entry; then Idle;
            state Idle;
            state Heating;
            transition first Idle if temp < low then Heating;
        }
    }
    part def Switch {
        in attribute x : Real;
        constant attribute low : Real;
        exhibit state Control {
            entry; then Off;
            state Off;
            state On;
            transition first Off if x < low then On;
        }
    }
    requirement def Above {
        subject s : Switch;
        require constraint { language "ltl" /* G (x > low -> state=Off) */ }
    }
    requirement def Five {
        subject s : Switch;
        require constraint { language "ltl" /* G (x > 5 -> state=Off) */ }
    }
}
"""


def test_a_feature_of_another_component_gives_no_unit_and_no_name(workspace, all_passes):
    workspace.write("plant.sysml", EQUAL_NAMES)
    steps = list_steps(workspace.sysmlc("contracts", "check", "plant.sysml"))
    assert steps[0] == "step 1: x = -2 (up to 5, below low), low = -1, state=Off"
