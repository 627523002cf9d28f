"""Real features in the formats of other tools: enumerations whose literals name regions."""

import pytest
import spot
from msgspec.structs import replace
from test_promela_models import needs_spin, verify, write_model

from sysmlc import compile_texts
from sysmlc.diagnostics import Sink
from sysmlc.logic import domains, formats
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.unrealizable import is_won

MODEL = """package Home {
    private import ScalarValues::*;
    private import SI::*;
    part def Heater {
        constant attribute 'niedrig-größe' : ISQ::ThermodynamicTemperatureValue = -0.5 ['°C_abs'];
        in attribute outer : ISQ::ThermodynamicTemperatureValue;
        in attribute temp : Real;
        in attribute goal : Real;
        exhibit state modes {
            entry; then Off;
            state Off;
            state On;
            transition first Off if temp < goal - 0.5 or outer < 'niedrig-größe' then On;
            transition first On if temp >= goal and outer >= -20 ['°C_abs'] then Off;
        }
    }
    requirement def Rules {
        subject heater : Heater;
        require constraint heats { language "ltl"
            /* G (temp < 18 & goal > 20 & state=Off -> X state=On) */ }
        require constraint sums { language "ltl" /* G !(temp < 18 & goal > 20 & temp >= goal) */ }
        require constraint rests { language "ltl" /* G (state=Off & temp > goal -> X state=Off) */ }
    }
}
"""


def emit(name):
    """Return the contracts, the files by path, and the messages."""
    compilation = compile_texts({"home.sysml": MODEL}, emit=[name])
    contracts = {
        item.component.replace("::", "."): item for item in compilation.graph.derived(Contract)
    }
    files = {item.path.removeprefix("contracts/"): item.text for item in compilation.artefacts}
    return contracts, files, [item.message for item in compilation.diagnostics]


def list_values(contract):
    return {item.name: tuple(domains.values(item.domain)) for item in contract.variables}


@pytest.mark.parametrize("name", ["gr1c", "slugs", "tlsf", "smv", "chase", "contracts"])
def test_files_with_regions_are_read_again(name):
    contracts, files, messages = emit(name)
    assert messages == []
    files = {path: text for path, text in files.items() if path.startswith("Home.Heater")}
    for path, text in files.items():
        sink = Sink()
        if path.endswith((".md", ".spin.ltl")):
            continue
        (contract,) = formats.read(text, path, sink)
        assert [diagnostic.message for diagnostic in sink] == []
        if not path.startswith("Home.Heater.requirements"):
            lowered = formats.lower(contracts["Home.Heater"], formats.detect_format(text, path))
            assert list_values(contract) == list_values(lowered)
    assert len(files) >= 2


def test_identifiers_are_plain_although_the_words_of_the_author_are_not():
    contracts, _, _ = emit("smv")
    assert list_values(contracts["Home.Heater"]) == {
        "outer": ("below_minus_20_C", "minus_20_C_to_niedrig_gr_e", "from_niedrig_gr_e"),
        "temp": ("below_18", "from_18"),
        "goal": ("up_to_20", "above_20"),
        "goal_minus_temp": ("below_0", "at_0", "_0_to_0_5", "above_0_5"),
        "state": ("Off", "On"),
    }


def test_the_environment_chooses_no_impossible_numbers():
    """Who controls the heater need not answer to 'temp < 18 & goal > 20 & temp >= goal'."""
    contracts, files, _ = emit("tlsf")
    assumptions = contracts["Home.Heater.requirements"].assumptions
    facts = [
        "!(temp=below_18 & goal=above_20 & goal_minus_temp=below_0)",
        "!(temp=below_18 & goal=above_20 & goal_minus_temp=at_0)",
        "!(temp=below_18 & goal=above_20 & goal_minus_temp=_0_to_0_5)",
    ]
    shown = [print_formula(item.formula) for item in assumptions if item.class_ is Class.INIT]
    assert shown == facts
    assert all(item.is_derived for item in assumptions)
    tlsf = files["Home.Heater.requirements.tlsf"]
    (contract,) = formats.read(tlsf, "Heater.tlsf", Sink())
    assert is_realizable(contract)
    assert not is_realizable(replace(contract, assumptions=()))


def is_realizable(contract):
    return is_won(make_game(reduce_contract(contract).contract, Manager()))


def test_spot_reads_formulas_about_regions():
    _, files, _ = emit("spot")
    for path, text in files.items():
        if path.endswith(".spot.ltl"):
            names = {str(item) for item in spot.atomic_prop_collect(spot.formula(text))}
            partition = files[path.replace(".ltl", ".part")]
            assert names <= set(partition.split())


@needs_spin
def test_spin_decides_requirements_about_numbers(tmp_path):
    model, messages = write_model(MODEL, tmp_path, "Home.Heater.requirements")
    assert messages == []
    assert verify(model, tmp_path) == {"Rules": True, "Rules_2": True, "Rules_3": False}
