"""The library of floors for SysML v1 gives the studies and contracts of that for SysML v2."""

from xml.etree import ElementTree

from floors_v1 import FOLDER, library

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


def ids():
    """Ids of what the library has, by name; features behind the name of their owner."""
    found = {}
    for one in ElementTree.parse(LIBRARY).getroot().iter("packagedElement"):
        found[one.get("name")] = one.get(f"{XMI}id")
        for feature in one.iter("ownedAttribute"):
            found[f"{one.get('name')}.{feature.get('name')}"] = feature.get(f"{XMI}id")
    return found


KNOWN = ids()


def block(name, general, inside="", **values):
    """A block that specialises one of the library and gives its attributes values."""
    owners = {"columns": "Floor", "counted": "Floor", "deadline": "Mission"}
    known = {one: KNOWN[f"{owners.get(one, 'Placed')}.{one}"] for one in values}
    features = "".join(
        f'<ownedAttribute xmi:id="{name}.{feature}" name="{feature}">'
        f'<redefinedProperty href="Floors.uml#{known[feature]}"/>'
        f'<defaultValue xmi:type="uml:LiteralInteger" xmi:id="{name}.{feature}v" value="{value}"/>'
        "</ownedAttribute>"
        for feature, value in values.items()
    )
    return (
        f'<packagedElement xmi:type="uml:Class" xmi:id="{name}" name="{name}">'
        f'<generalization xmi:id="{name}.g"><general href="Floors.uml#{KNOWN[general]}"/>'
        f"</generalization>{features}{inside}</packagedElement>"
    )


def part(name, type_):
    kind = f'type="{type_}"' if type_ else ""
    href = "" if type_ else f'<type href="Floors.uml#{KNOWN["Robot"]}"/>'
    head = f'<ownedAttribute xmi:id="p.{name}" name="{name}" aggregation="composite" {kind}'
    return f"{head}>{href}</ownedAttribute>"


def connector(association, *targets):
    ends = "".join(f'<end xmi:id="{association}.{one}" role="p.{one}"/>' for one in targets)
    return (
        f'<ownedConnector xmi:id="c.{association}"><type href="Floors.uml#{KNOWN[association]}"/>'
        f"{ends}</ownedConnector>"
    )


def model():
    """The same hall in XMI, its blocks over the library's by reference."""
    robots = part("r1", "R1") + part("spare", "") + part("pillar", "Pillar") + part("work", "Work")
    targets = part("shelf", "Shelf") + part("dock", "Dock") + part("charger", "Charger")
    orders = connector("Carry", "shelf", "dock") + connector("Before", "dock", "charger")
    blocks = (
        block("Hall", "Floor", robots, columns=4, counted=5)
        + block("R1", "Robot", row=1, column=2)
        + block("Pillar", "Obstacle", row=0, column=1)
        + block("Work", "Mission", targets + orders, deadline=30)
        + block("Shelf", "Target", row=0, column=3)
        + block("Dock", "Target", row=2, column=0)
        + block("Charger", "Target", row=2, column=3)
    )
    names = ("Hall", "R1", "Pillar", "Work", "Shelf", "Dock", "Charger")
    stereotypes = "".join(f'<Blocks:Block xmi:id="b{one}" base_Class="{one}"/>' for one in names)
    return (
        '<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
        ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"'
        ' xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks">'
        f'<uml:Model xmi:id="m" name="Plant">{blocks}</uml:Model>{stereotypes}</xmi:XMI>'
    )


def said(*files):
    made = compile_model(Request(files))
    assert [(one.rule.code, one.message) for one in made.diagnostics] == []
    (study,) = made.graph.derived(Study)
    return study, [
        (one.component, sorted(print_formula(part.formula) for part in side))
        for one in made.graph.derived(Contract)
        for side in (one.assumptions, one.guarantees)
    ]


def test_both_give_equal_studies_and_contracts(tmp_path):
    first, second = tmp_path / "hall.uml", tmp_path / "hall.sysml"
    first.write_text(model(), encoding="utf-8")
    second.write_text(TEXT, encoding="utf-8")
    ours, contracts = said(first, LIBRARY)
    theirs, wanted = said(second)
    assert contracts == wanted
    assert (ours.grid, ours.deadline, ours.counter_size) == (theirs.grid, theirs.deadline, 5)
    assert [one.start for one in ours.robots] == [6, None]
    for study in (ours, theirs):
        pairs = [(one.earlier, one.later, one.is_carried) for one in study.orders]
        assert pairs == [(0, 1, True), (1, 2, False)]


def test_the_library_is_the_one_for_sysml_v2_in_the_other_notation():
    """When Floors.sysml changes, ``python tests/robots/floors_v1.py`` writes it anew."""
    assert LIBRARY.read_bytes() == library()


def test_the_library_alone_is_clean_and_is_no_floor():
    made = compile_model(Request((LIBRARY,)))
    assert [one.message for one in made.diagnostics] == []
    assert made.graph.derived(Study) == ()
