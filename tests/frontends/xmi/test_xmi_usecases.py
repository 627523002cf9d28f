"""Use cases, collaborations in use, templates, and the rest of state machines."""

from reading_xmi import below_model, magicdraw, papyrus, read

from sysmlc.ir import Edge


def test_an_extension_of_a_use_case_has_a_condition_and_a_place():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:UseCase" xmi:id="u1" name="Produce" subject="k">
    <extensionPoint xmi:id="p1" name="before start" useCase="u1"/></packagedElement>
  <packagedElement xmi:type="uml:UseCase" xmi:id="u2" name="Refill">
    <extend xmi:id="e1" extendedCase="u1" extensionLocation="p1" extension="u2">
      <condition xmi:id="c1" constrainedElement="u1"><specification
        xmi:type="uml:OpaqueExpression" xmi:id="s1"><body>level &lt; 3</body></specification>
      </condition></extend>
    <include xmi:id="i1" addition="u3"/></packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="Plant" useCase="u2">
    <ownedUseCase xmi:id="u3" name="Stop"/></packagedElement>"""
        )
    )
    assert reading.findings == []
    assert (
        below_model(reading)
        == """\
UseCase u1 "Produce"
  ?> subject k Class
  ExtensionPoint p1 "before start"
UseCase u2 "Refill"
  ?> extends u1 Class
  ?> includes u3 Class
  ?> subject k Class
  Extend e1
    ?> extends u1 Class
    ?> references p1 Class
    Constraint c1 body="level < 3" subkind="condition"
      ?> references u1 Class
Class k "Plant"
  UseCase u3 "Stop"
"""
    )


def test_magicdraw_writes_use_cases_with_children():
    reading = read(
        magicdraw(
            """
  <packagedElement xmi:type='uml:UseCase' xmi:id='u1'><subject xmi:idref='k'/>
    <extensionPoint xmi:type='uml:ExtensionPoint' xmi:id='p1' name='p'/></packagedElement>
  <packagedElement xmi:type='uml:UseCase' xmi:id='u2'>
    <extend xmi:type='uml:Extend' xmi:id='e1'><extendedCase xmi:idref='u1'/>
      <extensionLocation xmi:idref='p1'/></extend></packagedElement>
  <packagedElement xmi:type='uml:Class' xmi:id='k'/>"""
        )
    )
    assert targets(reading, "u2", Edge.EXTENDS) == targets(reading, "e1", Edge.EXTENDS) == ["u1"]
    assert targets(reading, "e1", Edge.REFERENCES) == ["p1"]
    assert targets(reading, "u1", Edge.SUBJECT) == ["k"]


def test_a_collaboration_use_binds_roles():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Collaboration" xmi:id="c" name="Feeding" collaborationRole="r">
    <ownedAttribute xmi:id="r" name="feeder"/></packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="k"><ownedAttribute xmi:id="a" name="gate"/>
    <collaborationUse xmi:id="u" name="feeding" type="c">
      <roleBinding xmi:id="b" client="r" supplier="a"/></collaborationUse></packagedElement>"""
        )
    )
    assert reading.findings == []
    assert (
        below_model(reading)
        == """\
Class c "Feeding" subkind="collaboration"
  Property r "feeder"
Class k
  Property a "gate"
  CollaborationUse u "feeding"
    ?> typed-by c Class
    Dependency b subkind="role-binding"
      ?> client r Class
      ?> supplier a Class
"""
    )


TEMPLATES = """
  <packagedElement xmi:type="uml:Class" xmi:id="set" name="Set">
    <ownedTemplateSignature xmi:type="uml:RedefinableTemplateSignature" xmi:id="sig"
      parameter="t n">
      <ownedParameter xmi:type="uml:ClassifierTemplateParameter" xmi:id="t" parameteredElement="T"
        allowSubstitutable="false">
        <ownedParameteredElement xmi:type="uml:DataType" xmi:id="T" name="T" isAbstract="true"
          templateParameter="t"/></ownedParameter>
      <ownedParameter xmi:id="n" parameteredElement="size">
        <ownedDefault xmi:type="uml:LiteralInteger" xmi:id="nd" value="8"/></ownedParameter>
    </ownedTemplateSignature>
    <ownedAttribute xmi:id="size" name="size" type="T"/></packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="ints" name="Pallets">
    <templateBinding xmi:id="tb" signature="sig">
      <parameterSubstitution xmi:id="s1" formal="t" actual="pallet"/>
      <parameterSubstitution xmi:id="s2" formal="n">
        <ownedActual xmi:type="uml:LiteralInteger" xmi:id="oa" value="3"/></parameterSubstitution>
    </templateBinding></packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="pallet" name="Pallet"/>"""


def test_a_bound_class_knows_its_template_and_the_actual_parameters():
    reading = read(papyrus(TEMPLATES))
    assert reading.findings == []
    assert (
        below_model(reading)
        == """\
Class set "Set"
  TemplateParameter t "T" allow_substitutable=false subkind="classifier"
    ?> references T Class
    ?> references T Class
    DataType T "T" abstract=true
  TemplateParameter n "size" default=8
    ?> references size Class
  Property size "size"
    ?> typed-by T Class
Class ints "Pallets"
  TemplateBinding tb
    ?> binds set Class
    TemplateSubstitution s1
      ?> instance-of t Class
      ?> references pallet Class
    TemplateSubstitution s2 value=3
      ?> instance-of n Class
Class pallet "Pallet"
"""
    )
    assert set(reading.totals) == {"elements", "mapped"}


def test_a_template_of_another_file_is_bound_by_its_signature():
    template = papyrus(TEMPLATES, name="library.uml")
    user = papyrus(
        """
  <packagedElement xmi:type="uml:Activity" xmi:id="act"><templateBinding xmi:id="tb2">
    <signature xmi:type="uml:RedefinableTemplateSignature" href="library.uml#sig"/>
    <parameterSubstitution xmi:id="s3"><formal xmi:type="uml:ClassifierTemplateParameter"
      href="library.uml#t"/></parameterSubstitution></templateBinding></packagedElement>""",
        name="user.uml",
    )
    reading = read(template, user)
    assert targets(reading, "tb2", Edge.BINDS) == ["set"]
    assert targets(reading, "s3", Edge.INSTANCE_OF) == ["t"]


def test_a_name_expression_joins_its_operands():
    """UML 2.5.1, 7.4.3: in templates the name depends on what the parameters stand for."""
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
    <nameExpression xmi:type="uml:StringExpression" xmi:id="e">
      <operand xmi:type="uml:LiteralString" xmi:id="o1" value="SetOf"/>
      <subExpression xmi:type="uml:StringExpression" xmi:id="s">
        <operand xmi:type="uml:LiteralString" xmi:id="o2" value="Pallet"/></subExpression>
    </nameExpression></packagedElement>"""
        )
    )
    assert reading.graph["k"].attrs["name_expression"] == "SetOfPallet"


def test_connection_points_protocols_and_parameter_sets():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:ProtocolStateMachine" xmi:id="psm">
    <conformance xmi:id="co" specificMachine="psm" generalMachine="general"/>
    <connectionPoint xmi:id="en" name="in" kind="entryPoint"/>
    <region xmi:id="r"><subvertex xmi:type="uml:State" xmi:id="s" submachine="sub">
        <connection xmi:id="cr" entry="en" state="s"/></subvertex>
      <transition xmi:type="uml:ProtocolTransition" xmi:id="t" source="s" target="cr">
        <preCondition xmi:id="pre"><specification xmi:type="uml:LiteralString" xmi:id="ps"
          value="ready"/></preCondition>
        <postCondition xmi:id="post"/></transition></region></packagedElement>
  <packagedElement xmi:type="uml:Activity" xmi:id="act"><ownedParameter xmi:id="p" name="x"
    parameterSet="set"/><ownedParameterSet xmi:id="set" name="either" parameter="p">
    <condition xmi:id="c"/></ownedParameterSet></packagedElement>
  <packagedElement xmi:type="uml:GeneralizationSet" xmi:id="gs" generalization="g"
    isCovering="true" powertype="k"/>
  <packagedElement xmi:type="uml:Class" xmi:id="k"><generalization xmi:id="g" general="act"/>
  </packagedElement>"""
        )
    )
    assert reading.findings == []
    graph = reading.graph
    assert targets(reading, "psm", Edge.REALIZES) == ["general"]
    assert graph["cr"].subkind == "connection-point"
    assert targets(reading, "cr", Edge.REFERENCES) == ["en"]
    assert graph["t"].attrs == {"subkind": "protocol", "guard": "ready"}
    assert [graph[id].subkind for id in ("pre", "post", "c")] == [
        "precondition",
        "postcondition",
        "condition",
    ]
    assert targets(reading, "set", Edge.REFERENCES) == ["p"]
    assert graph["gs"].attrs == {"covering": True}
    assert targets(reading, "gs", Edge.REFERENCES) == ["k"]
    assert targets(reading, "gs", Edge.TYPED_BY) == ["k"]


def targets(reading, id, edge):
    return [r.target for r in reading.graph.pending if r.source == id and r.edge is edge]
