"""Behaviour: activities, state machines with events folded into triggers, interactions."""

import pytest
from reading_xmi import below_model, magicdraw, papyrus, read

from sysmlc.ir import Edge


def test_activities():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Activity" xmi:id="act" name="Act" node="n1 n2">
    <ownedParameter xmi:id="p" name="x" direction="out"/>
    <node xmi:type="uml:InitialNode" xmi:id="n1" outgoing="f1"/>
    <node xmi:type="uml:CallBehaviorAction" xmi:id="n2" name="read" behavior="fun" inPartition="pa">
      <result xmi:type="uml:OutputPin" xmi:id="r" name="id"/></node>
    <node xmi:type="uml:DecisionNode" xmi:id="n3" decisionInput="fun" decisionInputFlow="f2"/>
    <node xmi:type="uml:ActivityParameterNode" xmi:id="n4" parameter="p"/>
    <node xmi:type="uml:ValueSpecificationAction" xmi:id="n5"><value xmi:type="uml:LiteralInteger"
      xmi:id="v" value="3"/><result xmi:id="r5"/></node>
    <edge xmi:type="uml:ControlFlow" xmi:id="f1" source="n1" target="n2"/>
    <edge xmi:type="uml:ObjectFlow" xmi:id="f2" source="r" target="n3">
      <guard xmi:type="uml:LiteralBoolean" xmi:id="g"/>
      <weight xmi:type="uml:LiteralUnlimitedNatural" xmi:id="w" value="2"/></edge>
    <edge xmi:type="uml:ObjectFlow" xmi:id="f3" source="n3" target="n4">
      <guard xmi:type="uml:OpaqueExpression" xmi:id="g3"><body>id = ours</body></guard></edge>
    <group xmi:type="uml:ActivityPartition" xmi:id="pa" name="gate" node="n2" represents="act"/>
  </packagedElement>
  <packagedElement xmi:type="uml:FunctionBehavior" xmi:id="fun" name="f">
    <language>OCL</language><body>1</body></packagedElement>"""
        )
    )
    assert (
        below_model(reading)
        == """\
Activity act "Act"
  Parameter p "x" direction="out"
  Control n1 subkind="initial"
  Action n2 "read" subkind="call-behavior"
    ?> calls fun Class
    ?> in-partition pa Class
    ?> in-partition pa Class
    Pin r "id" direction="out" subkind="result"
  Control n3 decision_input="fun" decision_input_flow="f2" subkind="decision"
  ActivityParameter n4 direction="out"
    ?> references p Class
  Action n5 subkind="value" value=3
    Pin r5 direction="out" subkind="result"
  ControlFlow f1
    ?> flow-source n1 Class
    ?> flow-target n2 Class
  ObjectFlow f2 guard="false" guard_literal=true weight=2
    ?> flow-source r Class
    ?> flow-target n3 Class
  ObjectFlow f3 guard="id = ours"
    ?> flow-source n3 Class
    ?> flow-target n4 Class
  Partition pa "gate"
    ?> represents act Class
Activity fun "f" body="1" language="OCL" subkind="function"
"""
    )
    assert reading.totals == {"elements": 23, "mapped": 23}


def test_structured_nodes():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Activity" xmi:id="act">
    <structuredNode xmi:type="uml:LoopNode" xmi:id="loop" isTestedFirst="true" test="t"
      bodyPart="b" decider="d">
      <node xmi:type="uml:OpaqueAction" xmi:id="b"/>
      <node xmi:type="uml:ValueSpecificationAction" xmi:id="t"><result xmi:id="d"/></node>
    </structuredNode>
    <structuredNode xmi:type="uml:ConditionalNode" xmi:id="cond">
      <node xmi:type="uml:OpaqueAction" xmi:id="b1"/><node xmi:type="uml:OpaqueAction" xmi:id="t1"/>
      <clause xmi:id="c1" test="t1" body="b1" decider="d"/><clause xmi:id="c2" test="t1"/>
    </structuredNode>
    <group xmi:type="uml:InterruptibleActivityRegion" xmi:id="region" node="loop"/>
  </packagedElement>"""
        )
    )
    graph = reading.graph
    assert graph["loop"].attrs == {
        "subkind": "loop",
        "tested_first": True,
        "test": ("t",),
        "body_part": ("b",),
        "decider": "d",
    }
    assert graph["cond"].attrs["clauses"] == ((("t1",), ("b1",)), (("t1",), ()))
    assert graph["cond"].attrs["clause_outputs"] == ((("d",), ()), ((), ()))
    assert [(r.source, r.edge, r.target) for r in graph.pending] == [
        ("loop", "in-partition", "region")
    ]


def test_pin_bounds_in_extensions_of_magicdraw():
    reading = read(
        magicdraw(
            """
  <packagedElement xmi:type='uml:Activity' xmi:id='act'>
    <node xmi:type='uml:OpaqueAction' xmi:id='a'>
      <inputValue xmi:type='uml:InputPin' xmi:id='p'><xmi:Extension extender='MagicDraw UML 19.0'>
        <modelExtension><lowerValue xmi:type='uml:LiteralInteger' xmi:id='l' value='2'/>
        <upperValue xmi:type='uml:LiteralUnlimitedNatural' xmi:id='u' value='5'/></modelExtension>
      </xmi:Extension></inputValue><body>go()</body></node></packagedElement>"""
        )
    )
    assert reading.graph["p"].attrs["multiplicity"] == "2..5"
    assert reading.graph["a"].attrs["body"] == "go()"


CLAUSES = """<packagedElement xmi:type="uml:Activity" xmi:id="a">
<node xmi:type="uml:ConditionalNode" xmi:id="n">{}
 <node xmi:type="uml:OpaqueAction" xmi:id="t1"/><node xmi:type="uml:OpaqueAction" xmi:id="t2"/>
 <node xmi:type="uml:OpaqueAction" xmi:id="t3"/></node></packagedElement>"""


@pytest.mark.parametrize(
    ("relations", "order"),
    [
        (("", "", ""), "t1 t2 t3"),
        (('predecessorClause="c3"', "", 'predecessorClause="c2"'), "t2 t3 t1"),
        (("", 'successorClause="c1"', 'successorClause="c2"'), "t3 t2 t1"),
        (('predecessorClause="c2"', 'predecessorClause="c1"', ""), "t1 t2 t3"),
        (('predecessorClause="gone"', "", ""), "t1 t2 t3"),
    ],
)
def test_clauses_are_sorted_by_predecessor_and_successor(relations, order):
    clauses = (
        f'<clause xmi:id="c{number}" test="t{number}" {relation}/>'
        for number, relation in enumerate(relations, 1)
    )
    records = read(papyrus(CLAUSES.format("".join(clauses)))).graph["n"].attrs["clauses"]
    assert " ".join(test for (test,), _ in records) == order


@pytest.mark.parametrize(
    ("model", "lost"),
    [
        ('<generalization xmi:id="g" general="k" isSubstitutable="false"/>', "'isSubstitutable'"),
        ('<interfaceRealization xmi:id="g" contract="k" client="x" name="how"/>', "'name'"),
        ('<interfaceRealization xmi:id="g" contract="k" client="x" name=""/>', ""),
        ('<profileApplication xmi:id="g" appliedProfile="k" isStrict="true"/>', "'isStrict'"),
        ('<generalization xmi:id="g" general="k" isSubstitutable="true"/>', ""),
    ],
)
def test_attributes_that_an_edge_cannot_store_are_reported(model, lost):
    text = '<packagedElement xmi:type="uml:Class" xmi:id="x">{}</packagedElement>{}'
    other = '<packagedElement xmi:type="uml:Interface" xmi:id="k"/>'
    reading = read(papyrus(text.format(model, other)))
    assert reading.totals.get("approximated", 0) == bool(lost)
    assert [finding.split("without ")[1] for finding in reading.findings] == (
        [lost] if lost else []
    )


@pytest.mark.parametrize(
    ("written", "mode"),
    [("", "iterative"), ('mode="iterative"', "iterative"), ('mode="parallel"', "parallel")],
)
def test_an_expansion_region_is_iterative_by_default(written, mode):
    """UML 2.5.1 clause 16.14; an element of the graph without a mode would be parallel."""
    region = f'<node xmi:type="uml:ExpansionRegion" xmi:id="r" {written}/>'
    model = f'<packagedElement xmi:type="uml:Activity" xmi:id="a">{region}</packagedElement>'
    assert read(papyrus(model)).graph["r"].attrs["mode"] == mode


@pytest.mark.parametrize(
    "owned",
    [
        "<ownedAttribute xmi:type='uml:Property' xmi:id='p'>{}</ownedAttribute>",
        "<ownedAttribute xmi:type='uml:Port' xmi:id='p'>{}</ownedAttribute>",
        "<ownedOperation xmi:type='uml:Operation' xmi:id='o'><ownedParameter xmi:type="
        "'uml:Parameter' xmi:id='p'>{}</ownedParameter></ownedOperation>",
    ],
)
def test_other_bounds_in_extensions_of_magicdraw(owned):
    bounds = """<xmi:Extension extender='MagicDraw UML 19.0'><modelExtension>
  <upperValue xmi:type='uml:LiteralUnlimitedNatural' xmi:id='u' value='*'/></modelExtension>
</xmi:Extension>"""
    model = "<packagedElement xmi:type='uml:Class' xmi:id='c'>{}</packagedElement>"
    reading = read(magicdraw(model.format(owned.format(bounds))))
    assert reading.graph["p"].attrs["multiplicity"] == "1..*"


MACHINE = """\
StateMachine sm "SM"
  Region r
    Pseudostate i subkind="initial"
    State s "S"
      -> entry en
      Activity en "up" subkind="opaque"
    Transition t {guard}
      -> trigger tr
      -> guard c
      -> effect ef
      ?> flow-source i Class
      ?> flow-target s Class
      Trigger tr "Arrived" subkind="signal"
        ?> typed-by sig Class
      Constraint c body="free"
      Activity ef "note" subkind="opaque"
    Transition t2 subkind="internal"
      -> trigger tr2
      ?> flow-source s Class
      ?> flow-target s Class
      Trigger tr2 "tick" relative=true subkind="time" when="5"
Signal sig "Arrived"
"""


def test_state_machines_with_their_events():
    guarded = 'guard="c"'
    reading = read(papyrus(machine(f"<transition xmi:id='t' source='i' target='s' {guarded}>")))
    assert below_model(reading) == MACHINE.format(guard='guard="free"')


def test_state_machines_of_magicdraw_refer_by_children():
    start = (
        "<transition xmi:type='uml:Transition' xmi:id='t'><source xmi:idref='i'/>"
        "<target xmi:idref='s'/><guard xmi:idref='c'/>"
    )
    reading = read(magicdraw(machine(start)))
    assert below_model(reading) == MACHINE.format(guard='guard="free"')


def machine(start):
    return f"""
  <packagedElement xmi:type="uml:StateMachine" xmi:id="sm" name="SM"><region xmi:id="r">
    <subvertex xmi:type="uml:Pseudostate" xmi:id="i"/>
    <subvertex xmi:type="uml:State" xmi:id="s" name="S">
      <entry xmi:type="uml:OpaqueBehavior" xmi:id="en" name="up"/></subvertex>
    {start}
      <trigger xmi:id="tr" event="ev"/>
      <ownedRule xmi:id="c"><specification xmi:type="uml:OpaqueExpression" xmi:id="sp">
        <body>free</body></specification></ownedRule>
      <effect xmi:type="uml:OpaqueBehavior" xmi:id="ef" name="note"/></transition>
    <transition xmi:id="t2" source="s" target="s" kind="internal"><trigger xmi:id="tr2" name="tick"
      event="te"/></transition>
  </region></packagedElement>
  <packagedElement xmi:type="uml:Signal" xmi:id="sig" name="Arrived"/>
  <packagedElement xmi:type="uml:SignalEvent" xmi:id="ev" name="Arrived" signal="sig"/>
  <packagedElement xmi:type="uml:TimeEvent" xmi:id="te" isRelative="true"><when xmi:id="w"
    xmi:type="uml:TimeExpression"><expr xmi:type="uml:LiteralInteger" value="5"/></when>
  </packagedElement>"""


def test_all_triggers_of_an_event_get_its_content():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:StateMachine" xmi:id="sm"><region xmi:id="r">
    <subvertex xmi:type="uml:State" xmi:id="s"/>
    <transition xmi:id="t1" source="s" target="s"><trigger xmi:id="a" event="te"/></transition>
    <transition xmi:id="t2" source="s" target="s"><trigger xmi:id="b" event="te"/></transition>
    <transition xmi:id="t3" source="s" target="s"><trigger xmi:id="c" event="ev"/></transition>
    <transition xmi:id="t4" source="s" target="s"><trigger xmi:id="d" event="ev"/></transition>
  </region></packagedElement>
  <packagedElement xmi:type="uml:Signal" xmi:id="sig"/>
  <packagedElement xmi:type="uml:SignalEvent" xmi:id="ev" name="Arrived" signal="sig"/>
  <packagedElement xmi:type="uml:TimeEvent" xmi:id="te" isRelative="true"><when xmi:id="w"
    xmi:type="uml:TimeExpression"><expr xmi:type="uml:LiteralInteger" value="5"/></when>
  </packagedElement>"""
        )
    )
    graph = reading.graph
    timed = {"subkind": "time", "when": "5", "relative": True}
    assert graph["a"].attrs == graph["b"].attrs == timed
    signals = {r.source: r.target for r in graph.pending if r.edge is Edge.TYPED_BY}
    assert signals == {"c": "sig", "d": "sig"}
    assert [graph[id].name for id in "cd"] == ["Arrived", "Arrived"]


def test_pre_and_postconditions():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Class" xmi:id="k"><ownedOperation xmi:id="o" precondition="c">
    <ownedRule xmi:id="c"><specification xmi:type="uml:LiteralString" value="x &gt; 0"/></ownedRule>
    <postcondition xmi:id="d"/></ownedOperation></packagedElement>"""
        )
    )
    assert reading.graph["c"].attrs == {"body": "x > 0", "subkind": "precondition"}
    assert reading.graph["d"].attrs == {"subkind": "postcondition"}


def test_variables_are_properties_of_their_scope():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Activity" xmi:id="act"><variable xmi:id="v" name="n" type="k"
      activityScope="act"/>
    <node xmi:type="uml:ReadVariableAction" xmi:id="a" variable="v"/></packagedElement>"""
        )
    )
    assert (
        below_model(reading)
        == """\
Activity act
  Property v "n" subkind="variable"
    ?> typed-by k Class
  Action a subkind="read-variable"
    ?> calls v Class
"""
    )
