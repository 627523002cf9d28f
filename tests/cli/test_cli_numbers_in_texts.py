"""Pages and messages show comparisons of numbers, with the words and the unit of the author."""

import pytest

MODEL = """package Home {
    private import ScalarValues::*;
    private import ISQ::*;
    private import SI::*;
    part def Heater {
        constant attribute low : ThermodynamicTemperatureValue = 18 ['°C_abs'];
        in attribute temp : ThermodynamicTemperatureValue;
        in attribute inner : Real;
        in attribute outer : Real;
        exhibit state modes {
            entry; then Off;
            state Off;
            state On;
            transition first Off if temp < low then On;
            transition first On if temp >= 22 ['°C_abs'] or inner > outer + 0.5 then Off;
        }
    }
    requirement def Frugal {
        subject heater : Heater;
        require constraint { heater.temp < 22 ['°C_abs'] or heater.inner <= heater.outer }
    }
}
"""


@pytest.fixture
def heater(workspace, all_passes):
    workspace.write("home.sysml", MODEL)
    return workspace


def test_the_page_of_a_contract_explains_literals_and_shows_comparisons(heater):
    assert heater.sysmlc("build", "home.sysml", "-o", "out").exit_code == 0
    lines = heater.read("out/contracts/Home.Heater.md").splitlines()
    assert [line for line in lines if line.startswith(("| `temp`", "| `inner"))] == [
        "| `temp` | `below_low`: `temp < low`, `low_to_22_C`: `low <= temp < 22 °C`, "
        "`from_22_C`: `temp >= 22 °C`; `low` = 18 °C | property 'temp' of 'Heater' |",
        "| `inner - outer` | `up_to_0`: `inner <= outer`, `_0_to_0_5`: "
        "`outer < inner <= outer + 0.5`, `above_0_5`: `inner > outer + 0.5`; "
        "`inner_minus_outer` in the other files | property 'inner' of 'Heater' |",
    ]
    assert [line for line in lines if line.startswith("- In 'O") or "-> state'=O" in line] == [
        "- In 'Off', when 'Off' is complete and [temp < low]: the next state is 'On'. "
        "*(transition 'Off' to 'On')*",
        "  `state=Off & temp < low -> state'=On`",
        "- In 'On', when 'On' is complete and [temp >= 22 ['°C_abs'] or inner > outer + 0.5]: "
        "the next state is 'Off'. *(transition 'On' to 'Off')*",
        "  `state=On & (temp >= 22 °C | inner > outer + 0.5) -> state'=Off`",
    ]


def test_messages_show_comparisons(heater):
    result = heater.sysmlc("contracts", "check", "home.sysml")
    assert "  Frugal: broken: G (temp < 22 °C | inner <= outer)" in result.stdout.splitlines()
    titles = [line for line in result.stderr.splitlines() if line.startswith(("error", "warning"))]
    assert titles == [
        "error[SM560 behaviour-breaks-requirement]: the behaviour of 'Home::Heater' violates "
        "'G (temp < 22 °C | inner <= outer)' ('Frugal' demands it)",
        "error[SM532 contract-unrealizable]: no system can satisfy the contract of "
        "'Home::Heater.requirements'",
        "warning[SM537 decided-by-the-other]: 'Home::Heater.requirements' promises "
        "'temp < 22 °C | inner <= outer', which the environment decides alone",
    ]


def test_files_with_different_thresholds_are_compared(heater):
    """The file of a tolerant heater has the threshold 25 instead of 22."""
    heater.write("tolerant.sysml", MODEL.replace("22 [", "25 ["))
    for model in ("home", "tolerant"):
        heater.sysmlc("build", f"{model}.sysml", "-o", model)
    strict, tolerant = (
        f"{model}/contracts/Home.Heater.requirements.contract.json"
        for model in ("home", "tolerant")
    )
    assert heater.sysmlc("contracts", "refine", tolerant, strict).exit_code == 0
    result = heater.sysmlc("contracts", "refine", strict, tolerant)
    assert result.exit_code == 1
    assert (
        "'Home::Heater.requirements' does not guarantee 'G (temp < 22 °C | inner <= outer)'"
        in result.stderr
    )
    result = heater.sysmlc("contracts", "compose", strict, tolerant)
    assert '"from": "295.15",\n            "below": "298.15"' in result.stdout


def test_the_summary_of_an_activity_shows_comparisons(heater):
    heater.write(
        "robot.sysml",
        """package Hall {
    private import ScalarValues::*;
    part def Robot {
        in attribute load : Real;
        perform action work {
            first start;
            then decide;
            if load >= 20.5 then slow;
            if load < 20.5 then fast;
            action slow;
            action fast;
        }
    }
}
""",
    )
    assert heater.sysmlc("build", "robot.sysml", "-o", "out").exit_code == 0
    page = heater.read("out/contracts/Hall.Robot.md")
    assert "**Inputs.** It reads `load` (`load < 20.5`, `load >= 20.5`)." in page


def test_an_equal_name_of_another_quantity_is_no_threshold(heater):
    """In the formula about the tank, 'low' could be a temperature."""
    tank = """
    part def Tank {
        in attribute level : LengthValue;
        constant attribute low : LengthValue = 40 [cm];
        exhibit state modes {
            entry; then Waiting;
            state Waiting;
            transition first Waiting if level < 2 [m] then Filling;
            state Filling;
        }
    }
    requirement def Filled {
        subject tank : Tank;
        require constraint { language "ltl" /* G (level < low -> X state=Filling) */ }
    }
}
"""
    heater.write("home.sysml", MODEL.rstrip().removesuffix("}") + tank)
    heater.sysmlc("build", "home.sysml", "-o", "out")
    lines = heater.read("out/contracts/Home.Tank.md").splitlines()
    assert [line for line in lines if line.startswith("| `level`")] == [
        "| `level` | `below_low`: `level < low`, `low_to_2_m`: `low <= level < 2 m`, "
        "`from_2_m`: `level >= 2 m`; `low` = 0.4 m | property 'level' of 'Tank' |",
    ]


def test_the_output_of_an_action_is_a_number(workspace, all_passes):
    action = """package Car {
    private import ScalarValues::*;
    action def Charge {
        first start;
        then merge again;
        then action monitor { out charge : Real; }
        then decide;
            if monitor.charge < 99.5 then fill;
            if monitor.charge >= 99.5 then done;
        action fill;
        then again;
    }
}
"""
    workspace.write("car.sysml", action)
    assert workspace.sysmlc("build", "car.sysml", "-o", "out").stderr == ""
    page = workspace.read("out/contracts/Car.Charge.md")
    assert "'monitor' comes 'fill' if `monitor.charge < 99.5`, the end if `monitor" in page
