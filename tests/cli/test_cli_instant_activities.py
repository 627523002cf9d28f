"""Entries, exits and effects perform an activity of assignments within the step of the machine."""

import json

import pytest

from sysmlc import compile_model
from sysmlc.logic.contract import Contract, Owner

HEAD = """package P {
  private import ScalarValues::*;
  item def Go;
  %s
  part def B %s
    attribute n : Integer := 0;
    assert constraint { n >= 0 and n <= 3 }
    %s
  }
  requirement def R { subject it : B; %s }
}
"""
FLAGS = "attribute a : Boolean := false; attribute b : Boolean := false;"
INIT = """action init {
    first start; then action one assign a := true; then action two assign b := true; then done; }"""
CHAIN = "action { first start; then assign a := %s; then assign b := %s; then done; }"
MACHINE = """exhibit state M { entry; then S; state S; state T { %s }
    transition first S accept Go %s then T; transition first T accept Go then S; }"""


@pytest.fixture
def check(workspace, all_passes):
    """Return a function from a block and formulas to verdicts about them, and codes of findings."""

    def run(block, *formulas, others="", general=""):
        head = ":> A {" if general else f"{{ {FLAGS}"
        texts = (f'require constraint {{ language "ltl" /* {text} */ }}' for text in formulas)
        workspace.write("model.sysml", HEAD % (others + general, head, block, " ".join(texts)))
        result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
        verdicts = [entry["verdict"] for entry in json.loads(result.stdout)["requirements"]]
        text = workspace.sysmlc("contracts", "check", "model.sysml").stderr
        return verdicts, {code for code in ("SM558", "SM562") if code in text}

    return run


def test_entries_perform_chains_of_assignments(check):
    block = f"""{INIT} exhibit state M {{
        entry; then S; state S; state T {{ entry init; }}
        state Q {{ entry action {{ assign a := false; then assign b := true; }} }}
        state Z {{ entry {CHAIN % ("false", "false")} }}
        transition first S accept Go then T; transition first T accept Go then Q;
        transition first Q accept Go then Z; transition first Z accept Go then S; }}"""
    formulas = ("G (state=T -> a & b)", "G (state=Q -> !a & b)", "G (state=Z -> !a & !b)")
    assert check(block, *formulas) == (["holds"] * 3, set())


def test_the_contract_of_the_machine_has_the_assignments_drawn_in_it(tmp_path):
    path = tmp_path / "model.sysml"
    block = f"{FLAGS} {MACHINE % ('entry ' + CHAIN % ('true', 'a'), '')}"
    path.write_text(HEAD % ("", "{", block, ""), "utf-8")
    graph = compile_model(path).graph
    (contract,) = (item for item in graph.derived(Contract) if item.component == "P::B")
    owners = {variable.name: variable.owner for variable in contract.variables}
    assert owners["a"] is owners["b"] is owners["entry_T"] is Owner.SYSTEM


@pytest.mark.parametrize("behaviour", ["init", CHAIN % ("true", "true")])
@pytest.mark.parametrize(
    ("place", "formula"),
    [("entry", "G (state=T -> a & b)"), ("exit", "G (state=T & event=Go -> X (a & b))")],
)
def test_a_behaviour_of_a_state_is_described(check, behaviour, place, formula):
    block = INIT + MACHINE % (f"{place} {behaviour}" + ";" * (behaviour == "init"), "")
    assert check(block, formula, "G !a") == (["holds", "broken"], set())


@pytest.mark.parametrize("behaviour", ["init", CHAIN % ("true", "true")])
def test_an_effect_is_described(check, behaviour):
    block = INIT * (behaviour == "init") + MACHINE % ("", f"do {behaviour}")
    formulas = ("G (state=T -> a & b)", "G (state=S & event=none -> X (a <-> b))", "G !a")
    assert check(block, *formulas) == (["holds", "holds", "broken"], set())


def test_the_entry_of_the_first_state_is_described(check):
    block = (
        INIT + f"exhibit state M {{ entry; then S; state S {{ entry {CHAIN % ('true', 'a')} }} }}"
    )
    assert check(block, "a", "G b") == (["holds", "holds"], set())


def test_the_later_of_two_assignments_wins(check):
    chain = "action { first start; then assign n := 1; then assign n := n + 1; then done; }"
    block = MACHINE % (f"entry {chain}", "do assign n := 3")
    assert check(block, "G (state=T -> n = 2)") == (["holds"], set())


GENERAL = """part def A { attribute a : Boolean := false; attribute b : Boolean := false;
    %s } """


@pytest.mark.parametrize("features", ["", "attribute :>> a;"])
def test_an_inherited_activity_assigns_the_features_of_the_object(check, features):
    block = features + MACHINE % ("entry init;", "")
    verdicts = check(block, "G (state=T -> a)", "G (state=T -> b)", general=GENERAL % INIT)
    assert verdicts == (["holds", "holds"], set())


def test_a_redefined_activity_is_not_described(check):
    block = "action :>> init { first start; then assign a := false; then done; }"
    block += MACHINE % ("entry init;", "")
    verdicts, _ = check(block, "G !a", "G (state=T -> a)", general=GENERAL % INIT)
    assert "holds" not in verdicts


def test_a_do_behaviour_may_perform_the_activity_too(check):
    """Its steps take time, so that the second assignment is seen when the state is left."""
    clear = "action { assign a := false; then assign b := false; }"
    block = f"""{INIT} exhibit state M {{
        entry; then S; state S {{ entry {clear} }} state T {{ entry init; exit {clear} }}
        state D {{ do init; exit action {{ assign n := 1; }} }}
        transition first S accept Go then T; transition first T accept Go then D;
        transition first D then S; }}"""
    formulas = (
        "G (state=T -> a)",
        "G (state=T -> b)",
        "G (finished(one) -> X a)",
        "G (state=D -> !b)",
        "G (running(one) -> !a)",
        "G (state=D -> !a)",
    )
    assert check(block, *formulas) == (["holds"] * 5 + ["broken"], set())


def test_the_owner_may_perform_the_activity_too(check):
    block = f"perform init; {INIT} {MACHINE % ('entry init;', 'do assign a := false')}"
    verdicts, _ = check(block, "G (state=T & !running(init) -> a)", "G (state=S -> !b)", "F b")
    assert verdicts == ["holds", "broken", "holds"]


def test_another_block_may_have_an_activity_of_the_same_name(check):
    other = f"part def Other {{ {FLAGS} {INIT} {MACHINE % ('entry init;', '')} }}"
    block = INIT + MACHINE % ("entry init;", "")
    formulas = ("G (state=T -> a)", "G (state=S & event=none & !a -> X !a)")
    assert check(block, *formulas, others=other) == (["holds", "holds"], set())


CELL = """part def Cell { attribute a : Boolean := false;
    action init { first start; then action set assign a := true; then done; } }"""


def test_an_activity_of_a_part_is_not_described(check):
    block = "part c : Cell;" + MACHINE % ("entry c.init;", "")
    assert check(block, "G !(c.a)", others=CELL) == (["not-decided"], {"SM562"})


def test_an_activity_of_the_owner_is_not_described_for_a_part(check):
    cell = f"part def Cell {{ {MACHINE % ('entry init;', '')} }}"
    assert check(f"part c : Cell; {INIT}", "G !a", others=cell) == (["not-decided"], {"SM562"})


@pytest.mark.parametrize(
    "steps",
    [
        "action x assign a := true; action y assign a := false; first x then y; first y then x;",
        "action x assign a := true; action y assign a := false;",
        "first start; then fork f; then action x assign a := true; first f then y; "
        "action y assign a := false;",
        "first start; then assign a := true; then assign b := r * r > 1.5; then done;",
    ],
)
def test_another_activity_is_not_described(check, steps):
    block = "attribute r : Real;" + MACHINE % (f"entry action {{ {steps} }}", "")
    verdicts, _ = check(block, "G !a", "G (state=T -> a)")
    assert "holds" not in verdicts


def test_an_attribute_of_the_activity_hides_that_of_the_object(check):
    steps = "attribute a : Boolean := false; first start; then assign a := true; then done;"
    block = MACHINE % (f"entry action {{ {steps} }}", "")
    assert check(block, "G !a", "G !b")[0] == ["holds", "holds"]


def test_an_attribute_of_the_machine_hides_that_of_the_object(check):
    machine = MACHINE.replace("entry;", "attribute a : Boolean := false; entry;", 1)
    verdicts, _ = check(INIT + machine % ("entry init;", ""), "G (state=T -> b)", "G !b")
    assert "holds" not in verdicts


def test_an_activity_of_the_machine_is_not_described(check):
    """The do behaviour would be taken to perform the activity of the block."""
    own = "action init { first start; then assign a := true; then done; }"
    block = (
        INIT.replace("assign a := true", "assign a := false")
        + f"""exhibit state M {{ {own}
        entry; then S; state S; state T {{ entry init; exit assign a := false; }}
        state D {{ do init; }} transition first S accept Go then T;
        transition first T accept Go then D; transition first D then S; }}"""
    )
    verdicts, _ = check(block, "G (state=T -> a)", "G (state=D -> !a)")
    assert "holds" not in verdicts


def test_a_text_with_an_undescribed_assignment_is_not_decided(check):
    text = "entry action { assign a := true; then assign b := r * r > 1.5; }"
    block = "attribute r : Real;" + MACHINE % (text, "")
    assert check(block, "G !b")[0] == ["not-decided"]


def test_an_action_that_calls_the_activity_makes_it_undecided(check):
    call = "perform action work { first start; then action x; then perform init; then done; }"
    block = INIT + call + MACHINE % ("entry init;", "")
    assert check(block, "G (!a | !b)")[0] == ["not-decided"]


UML = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"
    xmlns:sysml="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Requirements">
<uml:Model xmi:id="m" name="P">
  <packagedElement xmi:type="uml:Signal" xmi:id="go" name="Go"/>
  <packagedElement xmi:type="uml:SignalEvent" xmi:id="event" name="GoEvent" signal="go"/>
  <packagedElement xmi:type="uml:Class" xmi:id="block" name="B" classifierBehavior="machine">
    <ownedAttribute xmi:type="uml:Property" xmi:id="a" name="a">
      <type xmi:type="uml:PrimitiveType"
        href="pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Boolean"/>
      <defaultValue xmi:type="uml:LiteralBoolean" xmi:id="default" value="false"/>
    </ownedAttribute>
    <ownedBehavior xmi:type="uml:StateMachine" xmi:id="machine" name="M">
      <region xmi:type="uml:Region" xmi:id="region" name="r">
        <subvertex xmi:type="uml:Pseudostate" xmi:id="initial"/>
        <subvertex xmi:type="uml:State" xmi:id="S" name="S"/>
        <subvertex xmi:type="uml:State" xmi:id="T" name="T">
          <entry xmi:type="uml:Activity" xmi:id="setup" name="setup">
            <edge xmi:type="uml:ControlFlow" xmi:id="f0" source="n0" target="n1">
              <guard xmi:type="uml:LiteralBoolean" xmi:id="guard" value="true"/>
              <weight xmi:type="uml:LiteralInteger" xmi:id="weight" value="WEIGHT"/>
            </edge>
            <edge xmi:type="uml:ControlFlow" xmi:id="f1" source="n1" target="n2"/>
            <node xmi:type="uml:InitialNode" xmi:id="n0"/>
            <node xmi:type="uml:OpaqueAction" xmi:id="n1" name="one"><body>a := true</body></node>
            <node xmi:type="uml:ActivityFinalNode" xmi:id="n2"/>
          </entry>
        </subvertex>
        <transition xmi:type="uml:Transition" xmi:id="t0" source="initial" target="S"/>
        <transition xmi:type="uml:Transition" xmi:id="t1" source="S" target="T">
          <trigger xmi:type="uml:Trigger" xmi:id="trigger" event="event"/>
        </transition>
      </region>
    </ownedBehavior>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="required" name="R">
    <ownedRule xmi:type="uml:Constraint" xmi:id="rule">
      <specification xmi:type="uml:OpaqueExpression" xmi:id="formula">
        <language>LTL</language><body>G (state=T -> a)</body>
      </specification>
    </ownedRule>
  </packagedElement>
  <packagedElement xmi:type="uml:Abstraction" xmi:id="link" client="block" supplier="required"/>
</uml:Model>
<sysml:Requirement xmi:id="requirement" base_Class="required" id="1" text="x"/>
<sysml:Satisfy xmi:id="satisfy" base_Abstraction="link"/>
</xmi:XMI>
"""


@pytest.mark.parametrize(("weight", "verdict"), [("1", "holds"), ("2", "not-decided")])
def test_an_activity_of_opaque_actions_in_xmi_is_described(workspace, all_passes, weight, verdict):
    workspace.write("model.uml", UML.replace("WEIGHT", weight))
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.uml")
    (requirement,) = json.loads(result.stdout)["requirements"]
    assert requirement["verdict"] == verdict
