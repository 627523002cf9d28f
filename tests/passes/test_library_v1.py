"""The libraries of actions for SysML v1 give the contracts of those for SysML v2."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
from library_v1 import FOLDER, LIBRARIES

from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

XMI = "{http://www.omg.org/spec/XMI/20131001}"
OPERATIONS = ("Clamping", "Dismantling", "Embedding", "Emptying", "Screwing", "Shifting")
"""What the thesis makes of elementary actions (5.2.1)."""
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


def ids(library):
    """Ids of what the library has, by name."""
    root = ElementTree.parse(FOLDER / f"{library}.uml").getroot()
    found = [one for one in root.iter("packagedElement") if one.get("name")]
    return {one.get("name"): one.get(f"{XMI}id") for one in found}


def model_v1(library):
    """A cell with an operation for each action, and a machine that coordinates all of them."""
    known = ids(library)
    operations = "".join(
        f'<ownedOperation xmi:id="o{name}" name="{name.lower()}">'
        f'<method href="{library}.uml#{known[name]}"/></ownedOperation>'
        for name in ACTIONS[library]
    )
    generals = "".join(
        f'<generalization xmi:id="g{name}"><general href="{library}.uml#{known[name]}"/>'
        "</generalization>"
        for name in MACHINES[library]
    )
    classes = {"Cell": operations, "Machine": generals}
    return (
        f'{HEAD}<uml:Model xmi:id="m" name="Cells">'
        + "".join(
            f'<packagedElement xmi:type="uml:Class" xmi:id="c{name}" name="{name}">{inside}'
            "</packagedElement>"
            for name, inside in classes.items()
        )
        + "</uml:Model>"
        + "".join(f'<Blocks:Block xmi:id="b{n}" base_Class="c{n}"/>' for n in classes)
        + "</xmi:XMI>"
    )


def model_v2(library):
    actions = "".join(f"action {name.lower()} : {name};" for name in ACTIONS[library])
    generals = ", ".join(MACHINES[library])
    special = f" :> {generals}" if generals else ""
    return (
        f"package Cells {{ private import {library}::*;"
        f" part def Cell {{ {actions} }} part def Machine{special}; }}"
    )


def contracts(*files: Path):
    made = compile_model(Request(files))
    assert [one for one in made.diagnostics if one.severity == "error"] == []
    found = made.graph.derived(Contract)
    return {one.component: said(one) for one in found if one.component.startswith("Cells::")}


def said(contract):
    """What a contract says, without the order in which it does."""
    variables = sorted((one.name, str(one.owner), one.domain) for one in contract.variables)
    sides = (contract.assumptions, contract.guarantees)
    lines = [
        sorted(f"{one.class_}: {print_formula(one.formula)}" for one in side) for side in sides
    ]
    return str(variables), lines


@pytest.mark.parametrize("library", LIBRARIES)
def test_both_give_equal_contracts(library, tmp_path):
    first, second = tmp_path / "cell.uml", tmp_path / "cell.sysml"
    first.write_text(model_v1(library), encoding="utf-8")
    second.write_text(model_v2(library), encoding="utf-8")
    ours = contracts(first, FOLDER / f"{library}.uml")
    theirs = contracts(second)
    assert sorted(ours) == sorted(theirs)
    assert len(ours) == len(ACTIONS[library]) + bool(MACHINES[library])
    for component, contract in ours.items():
        assert contract == theirs[component], component


@pytest.mark.parametrize("library", LIBRARIES)
def test_the_library_alone_is_clean_and_has_no_contracts_but_of_its_operations(library):
    made = compile_model(Request((FOLDER / f"{library}.uml",)))
    assert [one for one in made.diagnostics if one.severity in ("error", "warning")] == []
    assert not [one for one in made.graph.derived(Contract) if "ing" not in one.component]


def checked(file):
    """Verdicts of a model's contracts, and what is suspicious in them."""
    made, sink = compile_model(Request((file,))), Sink()
    graph = made.graph
    found = graph.derived(Contract)
    results = check_contracts(
        found, found, lambda origin: graph.subject(graph[origin]), sink, Options()
    )
    verdicts = {one.verdict.component: one.verdict.is_realizable for one in results}
    return verdicts, [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in sink]


def test_operations_made_of_actions_can_be_kept_and_nothing_in_them_is_suspicious():
    verdicts, findings = checked(FOLDER / "DIN8580.uml")
    assert verdicts == {f"DIN8580::{name}": True for name in OPERATIONS}
    assert findings == []


@pytest.mark.parametrize("library", LIBRARIES)
def test_actions_and_machines_can_be_kept_and_nothing_in_them_is_suspicious(library, tmp_path):
    path = tmp_path / "cell.sysml"
    text = model_v2(library).replace("action move : Move;", SMALL)
    path.write_text(text, encoding="utf-8")
    verdicts, findings = checked(path)
    assert len(verdicts) == len(ACTIONS[library]) + bool(MACHINES[library])
    assert set(verdicts.values()) == {True}
    assert findings == []


SMALL = (
    "action move : Move { constant attribute :>> columns = 3; constant attribute :>> rows = 3; }"
)
