"""The libraries of actions for SysML v1 give the same contracts as those for SysML v2."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
from library_v1 import FOLDER, LIBRARIES
from pass_runs import list_diagnostics, print_conjuncts

from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.logic.contract import Contract
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

XMI = "{http://www.omg.org/spec/XMI/20131001}"
OPERATIONS = ("Clamping", "Dismantling", "Embedding", "Emptying", "Screwing", "Shifting")
"""The operations that section 5.2.1 of the thesis composes of elementary actions."""
ACTIONS = {
    "DIN8580": ("Turn", "Move", "Pick", "Place", "Compose", "Decompose", *OPERATIONS),
    "LineMachines": ("Convey", "Print", "Check", "Mill"),
}
MACHINES = {
    "DIN8580": ("Supplied", "Moving", "Turning", "Mounting", "Dismounting", "Operating"),
    "LineMachines": (),
}
HEAD = (
    '<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"'
    ' xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks">'
)


def read_ids(library):
    """Return the ids of the elements of a library by name."""
    root = ElementTree.parse(FOLDER / f"{library}.uml").getroot()
    elements = [element for element in root.iter("packagedElement") if element.get("name")]
    return {element.get("name"): element.get(f"{XMI}id") for element in elements}


def print_model_v1(library):
    """Return a cell with an operation for each action, and a machine that coordinates them."""
    ids = read_ids(library)
    operations = "".join(
        f'<ownedOperation xmi:id="o{name}" name="{name.lower()}">'
        f'<method href="{library}.uml#{ids[name]}"/></ownedOperation>'
        for name in ACTIONS[library]
    )
    generals = "".join(
        f'<generalization xmi:id="g{name}"><general href="{library}.uml#{ids[name]}"/>'
        "</generalization>"
        for name in MACHINES[library]
    )
    classes = {"Cell": operations, "Machine": generals}
    return (
        f'{HEAD}<uml:Model xmi:id="m" name="Cells">'
        + "".join(
            f'<packagedElement xmi:type="uml:Class" xmi:id="c{name}" name="{name}">{content}'
            "</packagedElement>"
            for name, content in classes.items()
        )
        + "</uml:Model>"
        + "".join(f'<Blocks:Block xmi:id="b{n}" base_Class="c{n}"/>' for n in classes)
        + "</xmi:XMI>"
    )


def print_model_v2(library):
    """Return the same model in SysML v2."""
    actions = "".join(f"action {name.lower()} : {name};" for name in ACTIONS[library])
    generals = ", ".join(MACHINES[library])
    specialization = f" :> {generals}" if generals else ""
    return (
        f"package Cells {{ private import {library}::*;"
        f" part def Cell {{ {actions} }} part def Machine{specialization}; }}"
    )


def read_contracts(*files: Path):
    """Return the content of the contracts of the cells by component."""
    outcome = compile_model(Request(files))
    assert [d for d in outcome.diagnostics if d.severity == "error"] == []
    return {
        contract.component: sort_content(contract)
        for contract in outcome.graph.derived(Contract)
        if contract.component.startswith("Cells::")
    }


def sort_content(contract):
    """Return the variables and the conjuncts of a contract, sorted by their text."""
    variables = sorted((v.name, str(v.owner), v.domain) for v in contract.variables)
    sides = (contract.assumptions, contract.guarantees)
    return str(variables), [sorted(print_conjuncts(side)) for side in sides]


@pytest.mark.parametrize("library", LIBRARIES)
def test_the_libraries_for_v1_and_v2_give_equal_contracts(library, tmp_path):
    file_v1, file_v2 = tmp_path / "cell.uml", tmp_path / "cell.sysml"
    file_v1.write_text(print_model_v1(library), encoding="utf-8")
    file_v2.write_text(print_model_v2(library), encoding="utf-8")
    contracts_v1 = read_contracts(file_v1, FOLDER / f"{library}.uml")
    contracts_v2 = read_contracts(file_v2)
    assert sorted(contracts_v1) == sorted(contracts_v2)
    assert len(contracts_v1) == len(ACTIONS[library]) + bool(MACHINES[library])
    for component, contract in contracts_v1.items():
        assert contract == contracts_v2[component], component


@pytest.mark.parametrize("library", LIBRARIES)
def test_the_library_alone_is_clean_and_only_its_operations_have_contracts(library):
    outcome = compile_model(Request((FOLDER / f"{library}.uml",)))
    assert [d for d in outcome.diagnostics if d.severity in ("error", "warning")] == []
    assert not [c for c in outcome.graph.derived(Contract) if "ing" not in c.component]


def check_model(file):
    """Return whether each contract is realizable, and the diagnostics of the check."""
    graph, sink = compile_model(Request((file,))).graph, Sink()
    contracts = graph.derived(Contract)
    results = check_contracts(
        contracts, contracts, lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    verdicts = {result.verdict.component: result.verdict.is_realizable for result in results}
    return verdicts, list_diagnostics(sink)


def test_contracts_of_composed_operations_are_realizable_without_diagnostics():
    verdicts, diagnostics = check_model(FOLDER / "DIN8580.uml")
    assert verdicts == {f"DIN8580::{name}": True for name in OPERATIONS}
    assert diagnostics == []


SMALL_MOVE = (
    "action move : Move { constant attribute :>> columns = 3; constant attribute :>> rows = 3; }"
)


@pytest.mark.parametrize("library", LIBRARIES)
def test_contracts_of_actions_and_machines_are_realizable_without_diagnostics(library, tmp_path):
    path = tmp_path / "cell.sysml"
    text = print_model_v2(library).replace("action move : Move;", SMALL_MOVE)
    path.write_text(text, encoding="utf-8")
    verdicts, diagnostics = check_model(path)
    assert len(verdicts) == len(ACTIONS[library]) + bool(MACHINES[library])
    assert set(verdicts.values()) == {True}
    assert diagnostics == []
