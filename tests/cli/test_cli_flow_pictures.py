"""Flows in internal block diagrams of SysML v2 models."""

SERIAL = """\
package Serial {
    item def Signal;
    port def SerialPort { in item rx : Signal; out item tx : Signal; }
    part def A { port s : SerialPort; }
    part def B { port s : ~SerialPort; }
    part assembly {
        part a : A;
        part b : B;
        connect a.s to b.s;
        flow of Signal from a.s.tx to b.s.tx;
        flow of Signal from b.s.rx to a.s.rx;
    }
}
"""
TRANSFER = """\
package Filling {
    item def Bottle;
    port def BottlePort { out item bottle : Bottle; }
    interface def Transfer {
        end a : BottlePort;
        end b : ~BottlePort;
        flow of Bottle from a.bottle to b.bottle;
    }
}
"""


def test_ends_of_the_same_name_are_shown_with_their_paths(workspace, all_passes):
    workspace.write("serial.sysml", SERIAL)
    workspace.sysmlc("serial.sysml", "--emit", "plantuml")
    diagram = workspace.read("out/diagrams/Serial.assembly.ibd.puml")
    assert "to b.s: Signal" in diagram
    assert "to a.s: Signal" in diagram


def test_a_flow_within_an_interface_has_no_picture_of_the_port(workspace, all_passes):
    workspace.write("filling.sysml", TRANSFER)
    result = workspace.sysmlc("filling.sysml", "--emit", "plantuml", "--min-severity", "info")
    assert [path for path in workspace.list_files() if path.endswith(".puml")] == [
        "diagrams/Filling.bdd.puml"
    ]
    assert "SM701" not in result.stderr
