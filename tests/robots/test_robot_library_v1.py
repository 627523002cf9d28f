"""The libraries of floors for SysML v1 and v2 give the same studies and contracts."""

from xml.etree import ElementTree

from floors_v1 import FOLDER, convert_library

from sysmlc.driver import Request, compile_model
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.robots.study import Study

LIBRARY = FOLDER / "Floors.uml"
XMI = "{http://www.omg.org/spec/XMI/20131001}"
TEXT = """
package Plant {
    private import Floors::*;
    part def Hall :> Floor {
        constant attribute :>> columns = 4;
        constant attribute :>> counted = 5;
        part r1 : Robot { :>> row = 1; :>> column = 2; }
        part spare : Robot;
        part pillar : Obstacle { :>> row = 0; :>> column = 1; }
        part work : Mission {
            constant attribute :>> deadline = 30;
            part shelf : Target { :>> row = 0; :>> column = 3; }
            part dock : Target { :>> row = 2; :>> column = 0; }
            part charger : Target { :>> row = 2; :>> column = 3; }
            connection : Carry connect shelf to dock;
            connection : Before connect dock to charger;
        }
    }
}
"""


def read_ids():
    """Return the ids of blocks and features of the library by qualified name."""
    ids_by_name = {}
    for block in ElementTree.parse(LIBRARY).getroot().iter("packagedElement"):
        ids_by_name[block.get("name")] = block.get(f"{XMI}id")
        for feature in block.iter("ownedAttribute"):
            ids_by_name[f"{block.get('name')}.{feature.get('name')}"] = feature.get(f"{XMI}id")
    return ids_by_name


IDS = read_ids()


def build_block(name, general, content="", **values):
    """Return a block that specialises *general* of the library and sets attributes."""
    owners = {"columns": "Floor", "counted": "Floor", "deadline": "Mission"}
    feature_ids = {feature: IDS[f"{owners.get(feature, 'Placed')}.{feature}"] for feature in values}
    features = "".join(
        f'<ownedAttribute xmi:id="{name}.{feature}" name="{feature}">'
        f'<redefinedProperty href="Floors.uml#{feature_ids[feature]}"/>'
        f'<defaultValue xmi:type="uml:LiteralInteger" xmi:id="{name}.{feature}v" value="{value}"/>'
        "</ownedAttribute>"
        for feature, value in values.items()
    )
    return (
        f'<packagedElement xmi:type="uml:Class" xmi:id="{name}" name="{name}">'
        f'<generalization xmi:id="{name}.g"><general href="Floors.uml#{IDS[general]}"/>'
        f"</generalization>{features}{content}</packagedElement>"
    )


def build_part(name, type_):
    kind = f'type="{type_}"' if type_ else ""
    href = "" if type_ else f'<type href="Floors.uml#{IDS["Robot"]}"/>'
    head = f'<ownedAttribute xmi:id="p.{name}" name="{name}" aggregation="composite" {kind}'
    return f"{head}>{href}</ownedAttribute>"


def build_connector(association, *targets):
    ends = "".join(
        f'<end xmi:id="{association}.{target}" role="p.{target}"/>' for target in targets
    )
    return (
        f'<ownedConnector xmi:id="c.{association}"><type href="Floors.uml#{IDS[association]}"/>'
        f"{ends}</ownedConnector>"
    )


def build_model():
    """Return the hall of TEXT in XMI; its blocks refer to those of the library."""
    robots = (
        build_part("r1", "R1")
        + build_part("spare", "")
        + build_part("pillar", "Pillar")
        + build_part("work", "Work")
    )
    targets = (
        build_part("shelf", "Shelf") + build_part("dock", "Dock") + build_part("charger", "Charger")
    )
    orders = build_connector("Carry", "shelf", "dock") + build_connector(
        "Before", "dock", "charger"
    )
    blocks = (
        build_block("Hall", "Floor", robots, columns=4, counted=5)
        + build_block("R1", "Robot", row=1, column=2)
        + build_block("Pillar", "Obstacle", row=0, column=1)
        + build_block("Work", "Mission", targets + orders, deadline=30)
        + build_block("Shelf", "Target", row=0, column=3)
        + build_block("Dock", "Target", row=2, column=0)
        + build_block("Charger", "Target", row=2, column=3)
    )
    names = ("Hall", "R1", "Pillar", "Work", "Shelf", "Dock", "Charger")
    stereotypes = "".join(f'<Blocks:Block xmi:id="b{name}" base_Class="{name}"/>' for name in names)
    return (
        '<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
        ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"'
        ' xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks">'
        f'<uml:Model xmi:id="m" name="Plant">{blocks}</uml:Model>{stereotypes}</xmi:XMI>'
    )


def compile_study(*files):
    result = compile_model(Request(files))
    assert [(diagnostic.rule.code, diagnostic.message) for diagnostic in result.diagnostics] == []
    (study,) = result.graph.derived(Study)
    return study, [
        (contract.component, sorted(print_formula(conjunct.formula) for conjunct in side))
        for contract in result.graph.derived(Contract)
        for side in (contract.assumptions, contract.guarantees)
    ]


def test_both_libraries_give_equal_studies_and_contracts(tmp_path):
    first, second = tmp_path / "hall.uml", tmp_path / "hall.sysml"
    first.write_text(build_model(), encoding="utf-8")
    second.write_text(TEXT, encoding="utf-8")
    v1_study, contracts = compile_study(first, LIBRARY)
    v2_study, expected = compile_study(second)
    assert contracts == expected
    assert (v1_study.grid, v1_study.deadline, v1_study.counter_size) == (
        v2_study.grid,
        v2_study.deadline,
        5,
    )
    assert [robot.start for robot in v1_study.robots] == [6, None]
    for study in (v1_study, v2_study):
        pairs = [(order.earlier, order.later, order.is_carried) for order in study.orders]
        assert pairs == [(0, 1, True), (1, 2, False)]


def test_the_library_is_compiled_from_the_one_for_sysml_v2():
    """After a change of Floors.sysml, run ``python tests/robots/floors_v1.py``."""
    assert LIBRARY.read_bytes() == convert_library()


def test_the_library_has_no_diagnostics_and_no_floor():
    result = compile_model(Request((LIBRARY,)))
    assert [diagnostic.message for diagnostic in result.diagnostics] == []
    assert result.graph.derived(Study) == ()
