"""Structure: the same constructs in the dialects of Papyrus and of MagicDraw."""

from reading_xmi import below_model, magicdraw, papyrus, read, source

BLOCKS = """\
Class gate "Gate"
  ?> specializes device Class
  Port in "in" aggregation="composite" conjugated=true
    ?> typed-by pallet Class
  Property belt "belt" aggregation="composite" multiplicity="0..*"
    ?> typed-by device Class
Class device "Device" abstract=true
Class pallet "Pallet"
"""


def test_blocks_of_papyrus():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Class" xmi:id="gate" name="Gate">
    <generalization xmi:type="uml:Generalization" xmi:id="g" general="device"/>
    <ownedAttribute xmi:type="uml:Port" xmi:id="in" name="in" type="pallet"
      aggregation="composite" isConjugated="true"/>
    <ownedAttribute xmi:type="uml:Property" xmi:id="belt" name="belt" type="device"
      aggregation="composite">
      <lowerValue xmi:type="uml:LiteralInteger" xmi:id="l"/>
      <upperValue xmi:type="uml:LiteralUnlimitedNatural" xmi:id="u" value="*"/>
    </ownedAttribute>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="device" name="Device" isAbstract="true"/>
  <packagedElement xmi:type="uml:Class" xmi:id="pallet" name="Pallet"/>"""
        )
    )
    assert below_model(reading) == BLOCKS.replace("0..*", "*")
    assert reading.findings == []
    assert reading.totals == {"elements": 10, "mapped": 10}


def test_blocks_of_magicdraw():
    reading = read(
        magicdraw(
            """
  <packagedElement xmi:type='uml:Class' xmi:id='gate' name='Gate'>
    <generalization xmi:type='uml:Generalization' xmi:id='g'>
      <general xmi:idref='device'/></generalization>
    <ownedAttribute xmi:type='uml:Port' xmi:id='in' name='in' visibility='public'
      aggregation='composite' type='pallet' isConjugated='true'/>
    <ownedAttribute xmi:type='uml:Property' xmi:id='belt' name='belt' aggregation='composite'>
      <type xmi:idref='device'/>
      <xmi:Extension extender='MagicDraw UML 19.0'><modelExtension>
        <lowerValue xmi:type='uml:LiteralInteger' xmi:id='l' value='0'/>
        <upperValue xmi:type='uml:LiteralUnlimitedNatural' xmi:id='u' value='*'/>
      </modelExtension></xmi:Extension>
    </ownedAttribute>
  </packagedElement>
  <packagedElement xmi:type='uml:Class' xmi:id='device' name='Device' isAbstract='true'/>
  <packagedElement xmi:type='uml:Class' xmi:id='pallet' name='Pallet'/>"""
        )
    )
    assert below_model(reading) == BLOCKS.replace("0..*", "*")
    assert reading.totals == {"elements": 16, "mapped": 12, "ignored_notation": 4}


def test_an_omitted_type_is_the_declared_type_of_the_feature():
    reading = read(
        papyrus(
            """
  <ownedComment xmi:id="c" annotatedElement="k"><body>why</body></ownedComment>
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
    <ownedAttribute xmi:id="a" name="a"/>
    <ownedOperation xmi:id="o" name="o"><ownedParameter xmi:id="p" name="p"/></ownedOperation>
    <ownedConnector xmi:id="x"><end xmi:id="e1" role="a"/><end xmi:id="e2" role="a"/>
    </ownedConnector>
    <ownedRule xmi:id="r"><specification xmi:type="uml:OpaqueExpression" xmi:id="s">
      <language>OCL</language><body>a &gt; 0</body></specification></ownedRule>
  </packagedElement>"""
        )
    )
    assert (
        below_model(reading)
        == """\
Comment c body="why"
  ?> references k Class
Class k "K"
  Property a "a"
  Operation o "o"
    Parameter p "p" direction="in"
  Connector x
    -> end e1 e2
    ConnectorEnd e1
      ?> role a Class
    ConnectorEnd e2
      ?> role a Class
  Constraint r body="a > 0" language="OCL"
"""
    )


def test_the_path_of_a_connector_end_ends_with_the_part_that_has_the_port():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
    <ownedAttribute xmi:id="line" name="line"/>
    <ownedConnector xmi:type="uml:Connector" xmi:id="x">
      <end xmi:type="uml:ConnectorEnd" xmi:id="e1" role="p" partWithPort="gate"/>
      <end xmi:type="uml:ConnectorEnd" xmi:id="e2" role="p" partWithPort="gate"/>
    </ownedConnector>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="l" name="L">
    <ownedAttribute xmi:id="gate" name="gate"/>
    <ownedAttribute xmi:type="uml:Port" xmi:id="p" name="p"/>
  </packagedElement>""",
            '<Blocks:NestedConnectorEnd xmi:id="n" base_ConnectorEnd="e1"'
            ' propertyPath="line gate"/>',
        )
    )
    ends = [(r.source, r.target) for r in reading.graph.pending if r.edge == "path"]
    assert ends == [("e1", "line"), ("e1", "gate"), ("e2", "gate")]
    assert reading.graph["n"].attrs["tag.propertyPath"] == ("line", "gate")


def test_item_flows_know_their_item_property():
    reading = read(
        magicdraw(
            """
  <packagedElement xmi:type='uml:InformationFlow' xmi:id='f'><conveyed xmi:idref='pallet'/>
    <informationSource xmi:idref='a'/><informationTarget xmi:idref='b'/>
    <realizingConnector xmi:idref='x'/></packagedElement>
  <packagedElement xmi:type='uml:Class' xmi:id='pallet' name='Pallet'>
    <ownedAttribute xmi:type='uml:Property' xmi:id='a'/>
    <ownedAttribute xmi:type='uml:Property' xmi:id='b'/>
    <ownedConnector xmi:type='uml:Connector' xmi:id='x'/></packagedElement>""",
            "<sysml:ItemFlow xmi:id='s' base_InformationFlow='f' itemProperty='a'/>",
        )
    )
    assert below_model(reading).startswith(
        """\
ItemFlow f item_property="a"
  ?> conveys pallet Class
  ?> flow-source a Class
  ?> flow-target b Class
  ?> realizing x Class
"""
    )


def test_default_values_are_literals_or_expressions():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Class" xmi:id="k">
    <ownedAttribute xmi:id="a"><defaultValue xmi:type="uml:LiteralInteger" xmi:id="1"/>
    </ownedAttribute>
    <ownedAttribute xmi:id="b"><defaultValue xmi:type="uml:LiteralBoolean" xmi:id="2"/>
    </ownedAttribute>
    <ownedAttribute xmi:id="c"><defaultValue xmi:type="uml:LiteralReal" xmi:id="3" value="2.5"/>
    </ownedAttribute>
    <ownedAttribute xmi:id="d"><defaultValue xmi:type="uml:OpaqueExpression" xmi:id="4">
      <language>C</language><body>x+1</body></defaultValue></ownedAttribute>
    <ownedAttribute xmi:id="e"><defaultValue xmi:type="uml:InstanceValue" xmi:id="5"
      instance="free"/></ownedAttribute>
  </packagedElement>
  <packagedElement xmi:type="uml:Enumeration" xmi:id="s"><ownedLiteral xmi:id="free" name="free"/>
  </packagedElement>"""
        )
    )
    graph = reading.graph
    assert [graph[id].attrs for id in "abcde"] == [
        {"default": 0},
        {"default": False},
        {"default": 2.5},
        {"default": "x+1", "default_language": "C"},
        {"default": "free", "default_instance": "free"},
    ]


def test_instances_have_slots():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:InstanceSpecification" xmi:id="i" name="i" classifier="k">
    <slot xmi:id="s" definingFeature="a"><value xmi:type="uml:LiteralString" value="x"/>
      <value xmi:type="uml:LiteralString" value="y"/></slot>
    <slot xmi:id="t" definingFeature="a"><value xmi:type="uml:InstanceValue" instance="i"/></slot>
  </packagedElement>
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K"><ownedAttribute xmi:id="a"/>
  </packagedElement>"""
        )
    )
    assert below_model(reading).startswith(
        """\
Instance i "i"
  ?> instance-of k Class
  Slot s value=["x", "y"]
    ?> instance-of a Class
  Slot t
    ?> instance-of a Class
    ?> references i Class
"""
    )


def test_relations_without_properties_are_edges():
    reading = read(
        papyrus(
            """
  <packagedElement xmi:type="uml:Class" xmi:id="k" name="K">
    <interfaceRealization xmi:type="uml:InterfaceRealization" xmi:id="r" client="k" supplier="i"
      contract="i"/></packagedElement>
  <packagedElement xmi:type="uml:Interface" xmi:id="i" name="I"/>
  <packagedElement xmi:type="uml:UseCase" xmi:id="u" name="U">
    <include xmi:id="in" addition="u2"/></packagedElement>
  <packagedElement xmi:type="uml:UseCase" xmi:id="u2" name="U2"/>
  <packagedElement xmi:type="uml:Abstraction" xmi:id="d" client="k" supplier="u"/>"""
        )
    )
    assert (
        below_model(reading)
        == """\
Class k "K"
  ?> realizes i Class
Interface i "I"
UseCase u "U"
  ?> includes u2 Class
UseCase u2 "U2"
Dependency d subkind="abstraction"
  ?> client k Class
  ?> supplier u Class
"""
    )


def test_magicdraw_17_writes_a_placeholder_for_the_namespace_of_uml():
    model = "<packagedElement xmi:type='uml:Class' xmi:id='gate' name='Gate'/>"
    file = magicdraw(model)
    data = file.data.replace(b"http://www.omg.org/spec/UML/20131001'", b"uml_namespace'", 1)
    assert b"xmlns:uml='uml_namespace'" in data
    assert below_model(read(source(data, "m.mdxml"))) == below_model(read(file))
