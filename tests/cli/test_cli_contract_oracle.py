"""The oracle of derived contracts: ``contracts check`` answers every property as expected.

The answers were obtained without sysmlc (see the README beside the models).
"""

import json

import pytest

from contract_oracle import combine_verdicts, group_entries, list_models, require, satisfy
from json_documents import Document, find_violations
from long_runs import quick_first

MODELS = list_models()
# In SysML v1, a block does not see the features of the block around it.
XMI_MODELS = [
    model for model in MODELS if model.path.stem not in ("mutex_race", "mutex_turn", "owner_writer")
]
# The entry of the next state overwrites what the exit assigns to 'last'.
NEVER = {
    "entry_exit": {"never_changed": ["last"]},
    "unreachable": {"never_taken": ["transition 'Ready to Overfull [level > 2]'"]},
}

pytestmark = pytest.mark.corpus


def check(file, workspace):
    """Return the result of the command, and the entries about each property by its name."""
    result = workspace.sysmlc("contracts", "check", "--format", "json", file)
    document = json.loads(result.stdout)
    assert find_violations(Document(file, "sysmlc-diagnostics", document)) == []
    return document, group_entries(document)


def compare(model, file, workspace):
    """Compare what the command reports about a file with what is expected of the model."""
    document, entries = check(file, workspace)
    verdicts = {item.name: combine_verdicts(entries[item.name]) for item in model.properties}
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
    expected = NEVER.get(model.path.stem, {})
    for member in ("never_taken", "never_accepted", "never_true", "never_changed"):
        assert behaviour[member] == expected.get(member, []), member
    codes = {diagnostic["code"] for diagnostic in document["diagnostics"]}
    assert not codes & {"SM561", "SM562", "SM595", "SM596", "SM597"}


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.path.stem)
def test_every_property_has_the_expected_answer(model, workspace, all_passes):
    workspace.write("model.sysml", require(model))
    compare(model, "model.sysml", workspace)


@pytest.mark.parametrize("model", quick_first(XMI_MODELS), ids=lambda model: model.path.stem)
def test_every_property_has_the_same_answer_in_xmi(model, workspace, all_passes):
    workspace.write("model.sysml", satisfy(model))
    workspace.sysmlc("model.sysml", "--emit", "uml", "-o", "out")
    compare(model, "out/uml/model.uml", workspace)
