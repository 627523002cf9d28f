"""The oracle of derived contracts: ``contracts check`` answers every property as expected.

The answers were obtained without sysmlc (see the README beside the models).
"""

import json

import pytest

from contract_oracle import list_models, require

MODELS = list_models()
ORDER = ("broken", "not-decided", "holds-if-actions-end", "holds")

pytestmark = pytest.mark.skipif(not MODELS, reason="SYSMLC_CORPUS names no folder")


def check(model, workspace):
    """Return the result of the command, and the entries about each property by its name."""
    formulas = {item.name: item.ltl for item in model.properties}
    workspace.write("model.sysml", require(model, formulas))
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
    document = json.loads(result.stdout)
    entries = {}
    for entry in document["requirements"]:
        entries.setdefault(entry["requirement"].rpartition("::R_")[2], []).append(entry)
    return document, entries


def combine(entries):
    """Return the verdict about a formula from the verdicts about its conjuncts."""
    return min((entry["verdict"] for entry in entries), key=ORDER.index)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.path.stem)
def test_every_property_has_the_expected_answer(model, workspace, all_passes):
    document, entries = check(model, workspace)
    verdicts = {item.name: combine(entries[item.name]) for item in model.properties}
    assert verdicts == {item.name: item.verdict for item in model.properties}
    vacuous = {name for name, group in entries.items() if any(e["vacuous"] for e in group)}
    assert vacuous == {item.name for item in model.properties if item.vacuous}
    needing = {name for name, group in entries.items() if any(e["needs"] for e in group)}
    assert needing == {item.name for item in model.properties if item.needs_derived}
    (behaviour,) = (
        entry for entry in document["behaviours"] if entry["component"] == model.component
    )
    assert behaviour["unreachable"] == model.unreachable
    assert behaviour["write_conflicts"] == model.write_conflicts
    codes = {diagnostic["code"] for diagnostic in document["diagnostics"]}
    assert not codes & {"SM561", "SM562", "SM595", "SM596", "SM597"}
