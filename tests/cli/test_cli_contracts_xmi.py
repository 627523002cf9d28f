"""Contracts of SysML v1 models in XMI: verdicts and synthesised controllers."""

import json

import pytest

pytestmark = pytest.mark.usefixtures("all_passes")

MODEL = """\
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" xmi:version="20131001"
  xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"
  xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks"
  xmlns:PortsAndFlows="http://www.eclipse.org/papyrus/sysml/1.6/SysML/PortsAndFlows"
  xmlns:Requirements="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Requirements">
<uml:Model xmi:id="m" name="Plant">
{}
</xmi:XMI>
"""
DOOR = """\
<packagedElement xmi:type="uml:PrimitiveType" xmi:id="bool" name="Boolean"/>
<packagedElement xmi:type="uml:Signal" xmi:id="open" name="open"/>
<packagedElement xmi:type="uml:SignalEvent" xmi:id="eo" signal="open"/>
<packagedElement xmi:type="uml:Signal" xmi:id="close" name="close"/>
<packagedElement xmi:type="uml:SignalEvent" xmi:id="ec" signal="close"/>
<packagedElement xmi:type="uml:Class" xmi:id="door" name="Door" classifierBehavior="sm">
 <ownedBehavior xmi:type="uml:StateMachine" xmi:id="sm" name="Behaviour">
  <region xmi:id="r" name="state">
   <subvertex xmi:type="uml:Pseudostate" xmi:id="i"/>
   <subvertex xmi:type="uml:State" xmi:id="sc" name="Closed"/>
   <subvertex xmi:type="uml:State" xmi:id="so" name="OpenedUnit"/>
   <transition xmi:id="t0" source="i" target="sc"/>
   <transition xmi:id="t1" source="sc" target="so">
    <trigger xmi:id="g1" event="eo"/>
</transition>
   <transition xmi:id="t2" source="so" target="sc">
    <trigger xmi:id="g2" event="ec"/>
</transition>
  </region>
 </ownedBehavior>
</packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="req" name="Obeys">
 <ownedRule xmi:type="uml:Constraint" xmi:id="rule" name="closes" constrainedElement="req">
  <specification xmi:type="uml:OpaqueExpression" xmi:id="sp">
   <language>LTL</language>
   <body>{rule}</body></specification>
 </ownedRule>
</packagedElement>
<packagedElement xmi:type="uml:Abstraction" xmi:id="sat" client="door" supplier="req"/>
</uml:Model>
<Blocks:Block xmi:id="b1" base_Class="door"/>
<Requirements:Requirement xmi:id="b2" base_NamedElement="req" base_Class="req" id="R1" text="x"/>
<Requirements:Satisfy xmi:id="b3" base_DirectedRelationship="sat" base_Abstraction="sat"/>
"""
CELL = """\
<packagedElement xmi:type="uml:PrimitiveType" xmi:id="bool" name="Boolean"/>
<packagedElement xmi:type="uml:Class" xmi:id="fe" name="Feeder">
 <ownedAttribute xmi:type="uml:Port" xmi:id="fe.p" name="ready" type="bool"
    aggregation="composite"/>
</packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="r1" name="FeederReq">
 <ownedRule xmi:type="uml:Constraint" xmi:id="c1" name="c1" constrainedElement="r1">
  <specification xmi:type="uml:OpaqueExpression" xmi:id="c1.s">
   <language>LTL</language>
   <body>{rule}</body>
  </specification>
 </ownedRule>
</packagedElement>
<packagedElement xmi:type="uml:Abstraction" xmi:id="fe.s" client="fe" supplier="r1"/>
<packagedElement xmi:type="uml:Class" xmi:id="pi" name="Picker">
 <ownedAttribute xmi:type="uml:Port" xmi:id="pi.p" name="ready" type="bool"
    aggregation="composite"/>
<ownedAttribute xmi:type="uml:Port" xmi:id="pi.t" name="taken" type="bool"
    aggregation="composite"/>
</packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="r2" name="PickerReq">
 <ownedRule xmi:type="uml:Constraint" xmi:id="c2" name="c2" constrainedElement="r2">
  <specification xmi:type="uml:OpaqueExpression" xmi:id="c2.s">
   <language>LTL assume</language>
   <body>G F ready</body>
  </specification>
 </ownedRule>
 <ownedRule xmi:type="uml:Constraint" xmi:id="c3" name="c3" constrainedElement="r2">
  <specification xmi:type="uml:OpaqueExpression" xmi:id="c3.s">
   <language>LTL</language>
   <body>G F taken</body>
  </specification>
 </ownedRule>
</packagedElement>
<packagedElement xmi:type="uml:Abstraction" xmi:id="pi.s" client="pi" supplier="r2"/>
<packagedElement xmi:type="uml:Class" xmi:id="cell" name="Cell">
 <ownedAttribute xmi:type="uml:Property" xmi:id="cell.f" name="feeder" type="fe"
    aggregation="composite"/>
 <ownedAttribute xmi:type="uml:Property" xmi:id="cell.p" name="picker" type="pi"
    aggregation="composite"/>
 <ownedConnector xmi:type="uml:Connector" xmi:id="k" name="k">
  <end xmi:type="uml:ConnectorEnd" xmi:id="k1" partWithPort="cell.f" role="fe.p"/>
  <end xmi:type="uml:ConnectorEnd" xmi:id="k2" partWithPort="cell.p" role="pi.p"/>
 </ownedConnector>
</packagedElement>
<packagedElement xmi:type="uml:InformationFlow" xmi:id="flow" name="flow"
    informationSource="fe.p" informationTarget="pi.p" conveyed="bool" realizingConnector="k"/>
</uml:Model>
<Blocks:Block xmi:id="s1" base_Class="fe"/>
<Blocks:Block xmi:id="s2" base_Class="pi"/>
<Blocks:Block xmi:id="s3" base_Class="cell"/>
<PortsAndFlows:FlowPort xmi:id="q1" base_Port="fe.p" direction="out"/>
<PortsAndFlows:FlowPort xmi:id="q2" base_Port="pi.p" direction="in"/>
<PortsAndFlows:FlowPort xmi:id="q3" base_Port="pi.t" direction="out"/>
<PortsAndFlows:ItemFlow xmi:id="q4" base_InformationFlow="flow"/>
<Requirements:Requirement xmi:id="x1" base_NamedElement="r1" base_Class="r1" id="R1"/>
<Requirements:Requirement xmi:id="x2" base_NamedElement="r2" base_Class="r2" id="R2"/>
<Requirements:Satisfy xmi:id="y1" base_Abstraction="fe.s" base_DirectedRelationship="fe.s"/>
<Requirements:Satisfy xmi:id="y2" base_Abstraction="pi.s" base_DirectedRelationship="pi.s"/>
"""
CLOSES = "G (state=OpenedUnit &amp; event=close -> X state=Closed)"
STAYS_OPEN = "G (state=OpenedUnit -> X state=OpenedUnit)"


@pytest.fixture
def check_contracts(workspace):
    """Return a function that checks the contracts: exit code, verdicts and errors."""

    def run(text, rule):
        workspace.write("plant.uml", MODEL.format(text.replace("{rule}", rule)))
        result = workspace.sysmlc("contracts", "check", "plant.uml")
        errors = [line for line in result.stderr.splitlines() if line.startswith("error")]
        return result.exit_code, result.stdout.splitlines(), errors

    return run


def test_a_state_machine_is_compared_with_the_requirement_that_its_block_satisfies(check_contracts):
    satisfied = ["Plant::Door: realizable, satisfies its requirements"]
    violated = [
        "Plant::Door: realizable, violates its requirements",
        "  Obeys: broken: G (state=OpenedUnit -> state'=OpenedUnit)",
    ]
    requirements = ["Plant::Door.requirements: realizable"]
    assert check_contracts(DOOR, CLOSES) == (0, [*satisfied, *requirements], [])
    code, verdicts, (error,) = check_contracts(DOOR, STAYS_OPEN)
    assert (code, verdicts) == (1, [*violated, *requirements])
    assert error.endswith("('closes' of 'Obeys' demands it)")


def test_two_blocks_are_composed_along_the_connector_of_their_ports(check_contracts):
    parts = ["Plant::Feeder: realizable", "Plant::Picker: realizable"]
    assert check_contracts(CELL, "G F ready") == (
        0,
        [*parts, "Plant::Cell: its 2 parts fit together"],
        [],
    )
    code, verdicts, (error,) = check_contracts(CELL, "G (ready -> X !ready)")
    assert (code, verdicts) == (1, [*parts, "Plant::Cell: its 2 parts do not fit together"])
    assert "part 'picker' of 'Plant::Cell' assumes 'feeder.ready', which neither" in error


def test_a_port_that_no_requirement_of_its_block_mentions_is_free(check_contracts):
    full = (
        '<ownedAttribute xmi:type="uml:Port" xmi:id="fe.f" name="full" type="bool" '
        'aggregation="composite"/>\n</packagedElement>\n'
        '<packagedElement xmi:type="uml:Class" xmi:id="r1"'
    )
    direction = '<PortsAndFlows:FlowPort xmi:id="q5" base_Port="fe.f" direction="out"/>\n'
    model = CELL.replace(
        '</packagedElement>\n<packagedElement xmi:type="uml:Class" xmi:id="r1"', full
    )
    code, verdicts, (error,) = check_contracts(model + direction, "G F full")
    assert (code, verdicts[-1]) == (1, "Plant::Cell: its 2 parts do not fit together")
    assert "part 'picker' of 'Plant::Cell' assumes 'feeder.ready', which neither" in error


@pytest.mark.parametrize(
    ("text", "rule", "component", "machine"),
    [
        (DOOR, CLOSES, "Plant::Door", "2 states, 4 moves, checked"),
        (
            CELL,
            "G F ready",
            "Plant::Picker",
            "2 states, 3 moves, checked; vacuous: the controller needs to do nothing, since its "
            "outputs may stay as they are",
        ),
    ],
)
def test_a_controller_is_synthesised_from_each_contract(workspace, text, rule, component, machine):
    workspace.write("plant.uml", MODEL.format(text.replace("{rule}", rule)))
    result = workspace.sysmlc("synth", "plant.uml", "-c", component, "-o", "out")
    assert result.exit_code == 0
    assert result.stdout.startswith(f"{component}: realizable (")
    assert result.stdout.endswith(f"machine: {machine}\n")
    assert (workspace.folder / "out" / f"{component.replace('::', '.')}.machine.json").is_file()


@pytest.mark.parametrize(("rule", "code"), [("G F state=Closed", 0), ("G F state=Shut", 1)])
def test_a_requirement_that_cannot_be_read_is_an_error(workspace, rule, code):
    """The contract lacks the requirement, which might be the one that makes it unrealizable."""
    workspace.write("plant.uml", MODEL.format(DOOR.replace("{rule}", rule)))
    result = workspace.sysmlc("synth", "plant.uml", "-c", "Plant::Door", "--realizable")
    assert result.stdout.startswith("Plant::Door: realizable")
    assert result.exit_code == code
    assert ("error[SM522" in result.stderr) is (code == 1)


@pytest.mark.parametrize("language", ["English", "Natural language", "OCL", "Requirement", ""])
@pytest.mark.parametrize(
    ("rule", "verdict"),
    [
        ("state = Closed always holds", "broken"),
        ("state = OpenedUnit responds to event = open", "holds"),
        ("event = open precedes state = OpenedUnit", "holds"),
        ("After event = open, not (state = Closed) eventually holds.", "holds"),
        ("The door always holds its state.", "not-decided"),
    ],
)
def test_a_sentence_is_read_under_any_name_of_a_language(workspace, rule, verdict, language):
    model = MODEL.format(DOOR.replace("{rule}", rule))
    workspace.write("plant.uml", model.replace("<language>LTL<", f"<language>{language}<"))
    result = workspace.sysmlc("contracts", "check", "plant.uml", "--format", "json")
    (requirement,) = json.loads(result.stdout)["requirements"]
    assert requirement["verdict"] == verdict
    assert result.exit_code == (verdict == "broken")
