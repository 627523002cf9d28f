"""The oracle of derived contracts: no false alarm and no false proof in ``contracts check``.

Undecided properties are allowed, because the check looks at one behaviour at a time. Run with
``-s`` to see the answer to each property.
"""

import json

import pytest

from contract_oracle import list_models, require, translate
from sysmlc import compile_model
from sysmlc.logic.contract import Contract

MODELS = list_models()
PROOFS = ("holds", "holds-if-actions-end")
UNDECIDED_MODELS = {
    "chain_requirement",
    "default_values",
    "mutex_race",
    "mutex_turn",
    "owner_writer",
    "signals_parts",
}
"""Models whose component has parts or an inherited behaviour, but no behaviour of its own."""

pytestmark = pytest.mark.skipif(not MODELS, reason="SYSMLC_CORPUS names no folder")


def list_variables(model):
    graph = compile_model(model.path).graph
    contracts = [item for item in graph.derived(Contract) if item.component == model.component]
    return [variable.name for contract in contracts for variable in contract.variables]


def check(model, workspace):
    """Return the result of the command and the verdict about each property by its name."""
    variables = list_variables(model)
    formulas = {item.name: translate(item.ltl, variables) for item in model.properties}
    workspace.write("model.sysml", require(model, formulas))
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
    verdicts = {}
    for entry in json.loads(result.stdout)["requirements"]:
        name = entry["requirement"].rpartition("::R_")[2]
        verdicts.setdefault(name, []).append(entry["verdict"])
    return json.loads(result.stdout), {name: combine(items) for name, items in verdicts.items()}


def combine(verdicts):
    """Return the verdict about a formula from the verdicts about its conjuncts."""
    order = ("broken", "not-decided", "holds-if-actions-end", "holds")
    return min(verdicts, key=order.index)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.path.stem)
def test_no_property_is_called_broken_or_proved_wrongly(model, workspace, all_passes):
    document, verdicts = check(model, workspace)
    print({item.name: (item.holds, verdicts[item.name]) for item in model.properties})
    false_alarms = [
        item.name for item in model.properties if item.holds and verdicts[item.name] == "broken"
    ]
    false_proofs = [
        item.name for item in model.properties if not item.holds and verdicts[item.name] in PROOFS
    ]
    assert (false_alarms, false_proofs) == ([], [])
    for item in model.properties:
        if item.holds and verdicts[item.name] != "not-decided":
            # Safety needs no assumption that actions end.
            is_conditional = verdicts[item.name] == "holds-if-actions-end"
            assert is_conditional == item.needs_derived, item.name
    codes = {diagnostic["code"] for diagnostic in document["diagnostics"]}
    assert not codes & {"SM561", "SM595", "SM596", "SM597"}
    is_decided = set(verdicts.values()) != {"not-decided"}
    assert is_decided == (model.path.stem not in UNDECIDED_MODELS)
