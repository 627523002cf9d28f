"""Interactions in every dialect: fragments in their order, messages, executions, times."""

from reading_xmi import below_model, magicdraw, papyrus, read, source

from sysmlc.ir import Edge, Kind

PAPYRUS_MODEL = """
  <packagedElement xmi:type="uml:Interaction" xmi:id="sd" name="Feed">
    <ownedAttribute xmi:id="pa" name="gate" type="k"/>
    <lifeline xmi:id="l1" name="gate" represents="pa" coveredBy="o1 o4 st"/>
    <lifeline xmi:id="l2" name="belt" coveredBy="o2 ex o3">
      <selector xmi:type="uml:LiteralInteger" xmi:id="sel" value="2"/></lifeline>
    <fragment xmi:type="uml:MessageOccurrenceSpecification" xmi:id="o1" covered="l1" message="m1"/>
    <fragment xmi:type="uml:MessageOccurrenceSpecification" xmi:id="o2" covered="l2" message="m1"/>
    <fragment xmi:type="uml:BehaviorExecutionSpecification" xmi:id="ex" name="run" covered="l2"
      start="o2" finish="o3" behavior="b"/>
    <fragment xmi:type="uml:CombinedFragment" xmi:id="cf" interactionOperator="loop"
      covered="l1 l2">
      <operand xmi:id="op"><guard xmi:id="gu">
          <specification xmi:type="uml:OpaqueExpression" xmi:id="gs"><body>n &lt; 3</body>
          </specification><minint xmi:type="uml:LiteralInteger" xmi:id="mi" value="1"/>
          <maxint xmi:type="uml:LiteralUnlimitedNatural" xmi:id="ma" value="3"/></guard>
        <fragment xmi:type="uml:MessageOccurrenceSpecification" xmi:id="o3" covered="l2"
          message="m2"/>
        <fragment xmi:type="uml:MessageOccurrenceSpecification" xmi:id="o4" covered="l1"
          message="m2"/></operand></fragment>
    <fragment xmi:type="uml:StateInvariant" xmi:id="st" covered="l1"><invariant xmi:id="in">
      <specification xmi:type="uml:LiteralString" xmi:id="is" value="open"/></invariant></fragment>
    <fragment xmi:type="uml:InteractionUse" xmi:id="use" refersTo="other" covered="l1 l2">
      <argument xmi:type="uml:LiteralInteger" xmi:id="ua" value="7"/>
      <actualGate xmi:id="ga" name="in"/></fragment>
    <message xmi:id="m1" name="start" sendEvent="o1" receiveEvent="o2" signature="op1"/>
    <message xmi:id="m2" name="done" messageSort="reply" sendEvent="o3" receiveEvent="o4"/>
    <message xmi:id="m3" name="noise" messageSort="asynchSignal" receiveEvent="o2"/>
  </packagedElement>"""


def test_an_interaction_keeps_its_fragments_in_their_order():
    reading = read(papyrus(PAPYRUS_MODEL))
    assert reading.findings == []
    assert (
        below_model(reading)
        == """\
Interaction sd "Feed"
  Property pa "gate"
    ?> typed-by k Class
  Lifeline l1 "gate"
    ?> represents pa Class
  Lifeline l2 "belt" selector="2"
  Occurrence o1 subkind="message"
    ?> covers l1 Class
  Occurrence o2 subkind="message"
    ?> covers l2 Class
  Execution ex "run" subkind="behavior"
    ?> covers l2 Class
    ?> start o2 Class
    ?> finish o3 Class
    ?> calls b Class
  Fragment cf subkind="loop"
    ?> covers l1 Class
    ?> covers l2 Class
    Operand op guard="n < 3" max=3 min=1
      -> guard gu
      Constraint gu body="n < 3" subkind="interaction"
      Occurrence o3 subkind="message"
        ?> covers l2 Class
      Occurrence o4 subkind="message"
        ?> covers l1 Class
  Fragment st subkind="state-invariant"
    ?> covers l1 Class
    Constraint in body="open" subkind="invariant"
  Fragment use arguments="7" subkind="ref"
    ?> calls other Class
    ?> covers l1 Class
    ?> covers l2 Class
    Gate ga "in"
  Message m1 "start" subkind="synch-call"
    ?> send-event o1 Class
    ?> receive-event o2 Class
    ?> calls op1 Class
    ?> flow-source l1 Class
    ?> flow-target l2 Class
  Message m2 "done" subkind="reply"
    ?> send-event o3 Class
    ?> receive-event o4 Class
    ?> flow-source l2 Class
    ?> flow-target l1 Class
  Message m3 "noise" message_kind="found" subkind="asynch-signal"
    ?> receive-event o2 Class
    ?> flow-target l2 Class
"""
    )
    assert set(reading.totals) == {"elements", "mapped"}


def test_the_other_dialects_write_references_as_children():
    model = """
  <packagedElement xmi:type='uml:Collaboration' xmi:id='c' name='EA_Collaboration1'>
   <ownedBehavior xmi:type='uml:Interaction' xmi:id='sd' name='Feed'>
    <lifeline xmi:type='uml:Lifeline' xmi:id='l1'/>
    <fragment xmi:type='uml:OccurrenceSpecification' xmi:id='o1'><covered xmi:idref='l1'/>
    </fragment>
    <fragment xmi:type='uml:OccurrenceSpecification' xmi:id='o2' covered='l1'/>
    <fragment xmi:type='uml:OccurrenceSpecification' xmi:id='o3' covered='l1'/>
    <message xmi:type='uml:Message' xmi:id='m1' messageKind='complete' messageSort='asynchCall'>
      <sendEvent xmi:idref='o1'/><receiveEvent xmi:idref='o2'/></message>
   </ownedBehavior></packagedElement>"""
    reading = read(magicdraw(model))
    graph = reading.graph
    assert graph["m1"].attrs == {"subkind": "asynch-call"}
    assert [graph[id].subkind for id in ("o1", "o2", "o3")] == ["message", "message", ""]
    edges = {(str(r.edge), r.target) for r in graph.pending if r.source == "m1"}
    assert edges == {
        ("send-event", "o1"),
        ("receive-event", "o2"),
        ("flow-source", "l1"),
        ("flow-target", "l1"),
    }


def test_consider_names_the_messages_and_a_lifeline_its_destruction():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Interaction" xmi:id="sd">
    <lifeline xmi:id="l1"/>
    <fragment xmi:type="uml:ConsiderIgnoreFragment" xmi:id="cf" interactionOperator="consider"
      message="op1 op2"><cfragmentGate xmi:id="g"/><operand xmi:id="op"/></fragment>
    <fragment xmi:type="uml:ConsiderIgnoreFragment" xmi:id="ig" interactionOperator="ignore"/>
    <fragment xmi:type="uml:DestructionOccurrenceSpecification" xmi:id="x" covered="l1"/>
    <fragment xmi:type="uml:Continuation" xmi:id="con" name="ok" setting="false" covered="l1"/>
    <generalOrdering xmi:id="go" before="x" after="con"/>
  </packagedElement>"""
        )
    )
    graph = reading.graph
    kinds = [(e.kind, e.subkind) for e in graph.owned(graph["sd"])]
    assert kinds == [
        (Kind.LIFELINE, ""),
        (Kind.FRAGMENT, "consider"),
        (Kind.FRAGMENT, "ignore"),
        (Kind.OCCURRENCE, "destruction"),
        (Kind.FRAGMENT, "continuation"),
        (Kind.GENERAL_ORDERING, ""),
    ]
    assert graph["con"].attrs["setting"] is False
    assert targets(graph, "cf", Edge.REFERENCES) == ["op1", "op2"]
    assert targets(graph, "go", Edge.FLOW_SOURCE) + targets(graph, "go", Edge.FLOW_TARGET) == [
        "x",
        "con",
    ]


def test_times_refer_to_occurrences():
    """Papyrus packages durations; MagicDraw writes them inside the interval."""
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Interaction" xmi:id="sd">
    <ownedRule xmi:type="uml:DurationConstraint" xmi:id="dc" constrainedElement="o1 o2"
      firstEvent="true false">
      <specification xmi:type="uml:DurationInterval" xmi:id="di" min="d1" max="d2"/></ownedRule>
    <ownedRule xmi:type="uml:TimeConstraint" xmi:id="tc" constrainedElement="o1" firstEvent="true">
      <specification xmi:type="uml:TimeInterval" xmi:id="ti">
        <min xmi:type="uml:TimeExpression" xmi:id="t1"><expr xmi:type="uml:LiteralString"
          xmi:id="e1" value="t"/></min>
        <max xmi:type="uml:TimeExpression" xmi:id="t2" observation="to"/></specification>
    </ownedRule>
    <fragment xmi:type="uml:OccurrenceSpecification" xmi:id="o1"/>
    <fragment xmi:type="uml:OccurrenceSpecification" xmi:id="o2"/>
  </packagedElement>
  <packagedElement xmi:type="uml:Duration" xmi:id="d1">
    <expr xmi:type="uml:LiteralInteger" xmi:id="e3" value="2"/></packagedElement>
  <packagedElement xmi:type="uml:Duration" xmi:id="d2">
    <expr xmi:type="uml:LiteralString" xmi:id="e4" value="5 s"/></packagedElement>
  <packagedElement xmi:type="uml:TimeObservation" xmi:id="to" name="now" event="o1"
    firstEvent="false"/>
  <packagedElement xmi:type="uml:DurationObservation" xmi:id="do" event="o1 o2">
    <firstEvent>false</firstEvent><firstEvent>true</firstEvent></packagedElement>"""
        )
    )
    assert reading.findings == []
    graph = reading.graph
    assert graph["dc"].attrs == {
        "subkind": "duration",
        "body": "2..5 s",
        "first_event": (True, False),
    }
    assert graph["tc"].attrs == {"subkind": "time", "body": "t..now", "observations": ("to",)}
    assert targets(graph, "dc", Edge.REFERENCES) == ["o1", "o2"]
    assert graph["d2"].attrs == {"subkind": "duration", "value": "5 s"}
    assert graph["to"].attrs == {"subkind": "time", "first_event": False}
    assert targets(graph, "do", Edge.REFERENCES) == ["o1", "o2"]
    assert graph["do"].attrs["first_event"] == (False, True)


def test_events_of_uml_before_2_4_give_signatures_and_destructions():
    old = """<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="2.1" xmlns:xmi="http://schema.omg.org/spec/XMI/2.1"
 xmlns:uml="http://www.eclipse.org/uml2/3.0.0/UML" xmi:id="m" name="M">
  <packagedElement xmi:type="uml:Interaction" xmi:id="sd">
    <lifeline xmi:id="l1" coveredBy="o1 o2 x"/>
    <fragment xmi:type="uml:MessageOccurrenceSpecification" xmi:id="o1" covered="l1" event="se"/>
    <fragment xmi:type="uml:MessageOccurrenceSpecification" xmi:id="o2" covered="l1" event="re"/>
    <fragment xmi:type="uml:OccurrenceSpecification" xmi:id="x" covered="l1" event="de"/>
    <message xmi:id="m1" sendEvent="o1" receiveEvent="o2"/></packagedElement>
  <packagedElement xmi:type="uml:SendOperationEvent" xmi:id="se" operation="open"/>
  <packagedElement xmi:type="uml:ReceiveOperationEvent" xmi:id="re" operation="open"/>
  <packagedElement xmi:type="uml:DestructionEvent" xmi:id="de"/>
</uml:Model>"""
    reading = read(source(old))
    assert reading.findings == []
    assert targets(reading.graph, "m1", Edge.CALLS) == ["open"]
    assert reading.graph["x"].subkind == "destruction"


def test_uml_2_0_had_other_names():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Interaction" xmi:id="sd"><lifeline xmi:id="l"/>
    <fragment xmi:type="uml:EventOccurrence" xmi:id="o" covered="l"/>
    <fragment xmi:type="uml:ExecutionOccurrence" xmi:id="x" covered="l" start="o" finish="s"/>
    <fragment xmi:type="uml:InteractionOccurrence" xmi:id="u" refersTo="sd" covered="l"/>
    <fragment xmi:type="uml:Stop" xmi:id="s" covered="l"/></packagedElement>"""
        )
    )
    graph = reading.graph
    assert reading.findings == []
    assert [(e.kind, e.subkind) for e in graph.owned(graph["sd"])] == [
        (Kind.LIFELINE, ""),
        (Kind.OCCURRENCE, "message"),
        (Kind.EXECUTION, "behavior"),
        (Kind.FRAGMENT, "ref"),
        (Kind.OCCURRENCE, "destruction"),
    ]


def test_an_operand_without_a_fragment_is_not_read():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Interaction" xmi:id="sd">
    <fragment xmi:type="uml:InteractionOperand" xmi:id="op"/></packagedElement>"""
        )
    )
    assert reading.totals["unsupported"] == 1


def targets(graph, id, edge):
    return [r.target for r in graph.pending if r.source == id and r.edge is edge]
