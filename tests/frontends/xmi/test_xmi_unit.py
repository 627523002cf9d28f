"""Several files: ids, references between files, and independence of their order."""

import itertools

from reading_xmi import magicdraw, papyrus, read


def test_ids_shared_by_two_files_are_qualified_by_the_file():
    one = magicdraw("<packagedElement xmi:type='uml:Class' xmi:id='k' name='K'/>", name="1.xml")
    two = magicdraw(
        "<packagedElement xmi:type='uml:Class' xmi:id='k' name='K'>"
        "<ownedAttribute xmi:type='uml:Property' xmi:id='a' type='k'/></packagedElement>",
        name="sub/2.xml",
    )
    reading = read(one, two)
    assert [element.id for element in reading.graph] == [
        "1.xml#m",
        "1.xml#k",
        "sub/2.xml#m",
        "sub/2.xml#k",
        "a",
    ]
    assert [r.target for r in reading.graph.pending] == ["sub/2.xml#k"]


def test_an_href_into_the_unit_leads_to_the_element():
    library = papyrus('<packagedElement xmi:type="uml:Class" xmi:id="c" name="C"/>', name="l/l.uml")
    model = papyrus(
        '<packagedElement xmi:type="uml:Class" xmi:id="k"><ownedAttribute xmi:id="a">'
        '<type xmi:type="uml:Class" href="../l/l.uml#c"/></ownedAttribute></packagedElement>',
        name="m/m.uml",
    )
    alone = read(model)
    assert [(r.target, r.kind) for r in alone.graph.pending] == [("l/l.uml#c", "Class")]
    assert alone.totals["external"] == 1
    together = read(model, library)
    assert [r.target for r in together.graph.pending] == ["c"]
    assert "external" not in together.totals


def test_a_pathmap_leads_to_the_file_of_that_name():
    profile = papyrus('<packagedElement xmi:type="uml:Class" xmi:id="c"/>', name="p/x.profile.uml")
    model = papyrus(
        '<packagedElement xmi:type="uml:Class" xmi:id="k"><ownedAttribute xmi:id="a">'
        '<type href="pathmap://PLANT/x.profile.uml#c"/><type href="pathmap://PLANT/y.uml#c"/>'
        "</ownedAttribute></packagedElement>"
    )
    targets = [r.target for r in read(model, profile).graph.pending]
    assert targets == ["c", "pathmap://PLANT/y.uml#c"]


def test_external_targets_are_named_as_the_tools_name_them():
    reading = read(
        magicdraw(
            """<packagedElement xmi:type='uml:Class' xmi:id='k'>
  <ownedAttribute xmi:type='uml:Property' xmi:id='a'><type href='ISO.mdzip#_18_0beta_1'>
    <xmi:Extension extender='MagicDraw UML 19.0'><referenceExtension
      referentPath='ISO-80000::length::length[metre]' referentType='DataType'/></xmi:Extension>
  </type></ownedAttribute>
  <ownedAttribute xmi:type='uml:Property' xmi:id='b'>
    <type href='http://www.omg.org/spec/UML/20131001/PrimitiveTypes.xmi#Integer'/></ownedAttribute>
  <ownedAttribute xmi:type='uml:Port' xmi:id='c'><type href='lib.uml#_Xgk'/></ownedAttribute>
</packagedElement>"""
        )
    )
    assert [(r.kind, r.name) for r in reading.graph.pending] == [
        ("DataType", "ISO-80000::length::length[metre]"),
        ("DataType", "Integer"),
        ("Class", ""),
    ]


def test_the_order_of_files_does_not_matter():
    files = [
        papyrus('<packagedElement xmi:type="uml:Class" xmi:id="a"/>', name="a.uml"),
        papyrus('<packagedElement xmi:type="uml:Class" xmi:id="b"/>', name="b.uml"),
        magicdraw("<packagedElement xmi:type='uml:Class' xmi:id='b'/>", name="c.xml"),
    ]
    assert len({read(*order).text for order in itertools.permutations(files)}) == 1


def test_an_id_that_one_file_uses_twice_is_an_error():
    twice = '<packagedElement xmi:type="uml:Class" xmi:id="a"/>' * 2
    reading = read(papyrus(twice))
    assert reading.findings == ["repeated-id: the id 'a' is used by two elements of 'm.uml'"]
    assert len(reading.graph) == 3
    near = twice.replace('"a"', '"b"', 1)
    assert read(papyrus(near)).findings == []


def test_events_may_be_in_another_file():
    events = papyrus(
        '<packagedElement xmi:type="uml:Signal" xmi:id="s"/>'
        '<packagedElement xmi:type="uml:SignalEvent" xmi:id="ev" signal="s"/>',
        name="events.uml",
    )
    machine = papyrus(
        '<packagedElement xmi:type="uml:StateMachine" xmi:id="sm"><region xmi:id="r">'
        '<transition xmi:id="t"><trigger xmi:id="tr"><event xmi:type="uml:SignalEvent"'
        ' href="events.uml#ev"/></trigger></transition></region></packagedElement>'
    )
    reading = read(machine, events)
    assert reading.graph["tr"].attrs == {"subkind": "signal"}
    assert [(r.source, r.target, r.ordinal) for r in reading.graph.pending] == [("tr", "s", -1)]


def test_ids_in_attributes_lead_into_other_files():
    functions = papyrus(
        '<packagedElement xmi:type="uml:FunctionBehavior" xmi:id="f"/>', name="functions.uml"
    )
    activity = papyrus(
        '<packagedElement xmi:type="uml:Activity" xmi:id="a"><node xmi:type="uml:DecisionNode"'
        ' xmi:id="d"><decisionInput href="functions.uml#f"/></node></packagedElement>'
    )
    assert read(activity, functions).graph["d"].attrs["decision_input"] == "f"
    assert read(activity).graph["d"].attrs["decision_input"] == "functions.uml#f"


def test_missing_events_and_guards_are_left_to_the_pass_resolve():
    reading = read(
        papyrus(
            '<packagedElement xmi:type="uml:StateMachine" xmi:id="sm"><region xmi:id="r">'
            '<transition xmi:id="t" guard="gone"><trigger xmi:id="tr" event="lost"/>'
            '<trigger xmi:id="tt"><event xmi:type="uml:TimeEvent" href="e.uml#x"/></trigger>'
            "</transition></region></packagedElement>"
        )
    )
    waiting = sorted((str(r.edge), r.source, r.target) for r in reading.graph.pending)
    assert waiting == [
        ("guard", "t", "gone"),
        ("references", "tr", "lost"),
        ("references", "tt", "e.uml#x"),
    ]
    assert reading.graph["tt"].subkind == "time"
