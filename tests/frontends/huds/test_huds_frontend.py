"""Models that MTIP exports from Cameo: the same graph as from XMI, as far as the export goes."""

from random import Random

import pytest

from dialects.mutations import damage, mutate
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver import Request, compile_model
from sysmlc.frontends.huds import FRONTEND
from sysmlc.frontends.huds.vocabulary import KINDS
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.text import print_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline
from sysmlc.sources import Fault, Source, SourceError, load


def attribute(key, *texts, dtype="str"):
    values = "".join(
        f'<attribute _dtype="{dtype}" key="value">{text}</attribute>' for text in texts
    )
    return f'<attribute key="{key}">{values}</attribute>'


def stereotype(name, profile="SysML", **tags):
    head = f'<attribute key="stereotypeName">{name}</attribute>'
    head += f'<attribute key="profileName">{profile}</attribute>'
    tags = "".join(
        f'<attribute key="stereotypeTaggedValue">{head}<attribute key="taggedValueName">{tag}'
        '</attribute><attribute key="values"><attribute key="value"><attribute key="value">'
        f"{value}</attribute></attribute></attribute></attribute>"
        for tag, value in tags.items()
    )
    return f'<attribute key="stereotype">{head}</attribute>{tags}'


def data(type, id, parent="", name="", more="", **relations):
    related = {"hasParent": parent, **relations} if parent else relations
    relationships = "".join(
        f"<{relation}><type>x</type><id>{target}</id><relationship_metadata/></{relation}>"
        for relation, targets in related.items()
        for target in targets.split()
    )
    return (
        f"<data><attributes>{attribute('name', name)}{more}</attributes>"
        f"<id><cameo>{id}</cameo></id><relationships>{relationships}</relationships>"
        f"<type>sysml.{type}</type></data>\n"
    )


def packet(*records, name="plant_mtip.xml"):
    head = "<metadata><mtipVersion>2022x v1.0.0</mtipVersion></metadata>"
    text = f'<?xml version="1.0" encoding="UTF-8"?><packet>{head}{"".join(records)}</packet>'
    return Source(name, text.encode())


class Read:
    def __init__(self, *sources, resolved=True):
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        FRONTEND.read(sources, self.graph, self.sink, self.coverage)
        if resolved:
            pipeline.load("resolve").run(self.graph, self.sink)
        assert verify(self.graph) == []
        self.findings = [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in self.sink]
        self.totals = {k: n for k, n in self.coverage.as_json()["total"].items() if n}


STRUCTURE = packet(
    data("Model", "m", name="Plant"),
    data("Block", "b", "m", "Gate", stereotype("Block")),
    data("ProxyPort", "p", "b", "in", stereotype("ProxyPort"), typedBy="i"),
    data("PartProperty", "q", "b", "belt", attribute("multiplicity", "0..*"), typedBy="c"),
    data("InterfaceBlock", "i", "m", "Pallets", stereotype("InterfaceBlock")),
    data("Block", "c", "m", "Belt", stereotype("Block")),
    data("Port", "cp", "c", "out"),
    data("Connector", "k", "b", supplier="cp", client="p", supplierPartWithPort="q"),
    data("Generalization", "g", "c", supplier="c", client="b"),
    data("Requirement", "r", "m", "Pass", attribute("id", "R1") + attribute("text", "Shall.")),
    data("Satisfy", "s", "m", more=stereotype("Satisfy"), supplier="b", client="r"),
    data("BlockDefinitionDiagram", "d", "m", "drawn"),
)


def test_blocks_ports_parts_connectors_and_requirements():
    read = Read(STRUCTURE)
    graph = read.graph
    assert (read.findings, read.totals) == (
        [],
        {"elements": 12, "mapped": 11, "ignored_notation": 1},
    )
    assert graph.qualified_name(graph["p"]) == "Plant::Gate::in"
    assert graph.target(graph["p"], Edge.TYPED_BY) is graph["i"]
    assert graph["q"].attrs == {"multiplicity": "*", "aggregation": "composite"}
    ends = graph.targets(graph["k"], Edge.END)
    assert [graph.target(end, Edge.ROLE).id for end in ends] == ["cp", "p"]
    assert [graph.targets(end, Edge.PATH) for end in ends] == [[graph["q"]], []]
    assert graph.target(graph["c"], Edge.SPECIALIZES) is graph["b"]
    assert graph["r"].attrs == {"req_id": "R1", "text": "Shall."}
    assert graph.target(graph["s"], Edge.CLIENT) is graph["b"]
    assert graph.target(graph["s"], Edge.SUPPLIER) is graph["r"]


def test_classify_finds_the_roles_by_the_stereotypes(tmp_path):
    (tmp_path / "plant.xml").write_bytes(STRUCTURE.data)
    graph = compile_model(Request((tmp_path / "plant.xml",))).graph
    roles = {id: graph[id].role for id in ("b", "i", "p", "q", "s")}
    assert roles == {
        "b": "block",
        "i": "interface block",
        "p": "proxy port",
        "q": "part",
        "s": "satisfy",
    }
    assert graph.targets(graph["b"], Edge.SATISFIES) == [graph["r"]]


def test_behaviour_has_the_shape_that_xmi_gives():
    read = Read(
        packet(
            data("Model", "m", name="M"),
            data("Activity", "a", "m", "Pull"),
            data("InitialNode", "n", "a"),
            data("CallBehaviorAction", "x", "a", "Lower", behavior="l"),
            data("OutputPin", "o", "x", "done", typedBy="t"),
            data(
                "ControlFlow", "f", "a", more=attribute("guard", "free"), supplier="n", client="x"
            ),
            data("Activity", "l", "m", "Lower"),
            data("Signal", "t", "m", "Done"),
            data("StateMachine", "sm", "m", "States"),
            data("Transition", "tr", "sm", supplier="s1", client="s2", trigger="tg"),
            data("Region", "re", "sm"),
            data("State", "s1", "re", "up"),
            data("State", "s2", "re", "down"),
            data("Trigger", "tg", "tr", event="e"),
            data("TimeEvent", "e", "m", more=attribute("when", "w")),
            data("TimeExpression", "w", "e", more=attribute("expr", "1s")),
        )
    )
    graph = read.graph
    assert read.findings == []
    assert "guard" in graph["f"].attrs
    assert graph.target(graph["x"], Edge.CALLS) is graph["l"]
    assert graph["o"].attrs["direction"] == "out"
    assert graph.owner(graph["tr"]) is graph["re"]
    assert graph.target(graph["tr"], Edge.TRIGGER) is graph["tg"]
    assert graph["tg"].attrs == {"subkind": "time", "when": "1s", "relative": True}


def test_each_type_of_mtip_is_read_as_its_kind(golden):
    """Elements whose owner may not have them are not read; each type stands below a fitting one."""
    owners = {Kind.REGION: "StateMachine", Kind.STATE: "Region", Kind.FINAL_STATE: "Region"}
    owners |= {Kind.ENUMERATION_LITERAL: "Enumeration", Kind.SLOT: "InstanceSpecification"}
    lines = []
    for name, (kind, _) in KINDS.items():
        owner = owners.get(kind, "Block")
        root = [data("StateMachine", "s", "m", "S")] if owner == "Region" else []
        above = data(owner, "o", "s" if root else "m", "owner")
        model = data("Model", "m", name="Plant")
        read = Read(packet(model, *root, above, data(name, "x", "o", "x")), resolved=False)
        element = read.graph["x"]
        lines.append(f"{name}: {element.kind} {element.subkind or ''}".strip())
    golden.check("huds", {"types.txt": "\n".join(lines) + "\n"})


@pytest.mark.parametrize(
    ("dtype", "texts", "value"),
    [
        ("float", ["0.5"], 0.5),
        ("float", ["1.0", "2.0"], (1.0, 2.0)),
        ("int", ["-1"], -1),
        ("boolean", ["true"], True),
        ("str", ["0.5"], "0.5"),
        ("float", ["INF"], "INF"),
        ("int", ["9" * 5000], "9" * 5000),
        ("int", ["many"], "many"),
    ],
)
def test_the_value_of_a_slot_has_the_type_that_mtip_states(dtype, texts, value):
    slot = data("Slot", "v", "i", "Slot", attribute("value", *texts, dtype=dtype), property="p")
    read = Read(
        packet(
            data("Block", "b", name="Belt"),
            data("ValueProperty", "p", "b", "speed"),
            data("InstanceSpecification", "i", name="belt", classifiedBy="b"),
            slot,
        )
    )
    assert (read.graph["v"].name, read.graph["v"].attrs) == ("", {"value": value})


@pytest.mark.parametrize(
    ("text", "type", "attrs"),
    [
        ("0.0", "Real", {"default": 0.0}),
        ("8.0E-4", "Real", {"default": 0.0008}),
        ("-2", "second", {"default": -2}),
        ("true", "", {"default": True}),
        ("true", "String", {"default": "true"}),
        ("red", "c", {"default": "red", "default_instance": "r"}),
        ("green", "c", {"default": "green", "default_language": ""}),
        ("spare", "b", {"default": "spare", "default_instance": "i"}),
        ("twin", "b", {"default": "twin", "default_language": ""}),
        ("2 + 1", "Integer", {"default": "2 + 1", "default_language": ""}),
        ("1E999", "Real", {"default": "1E999", "default_language": ""}),
    ],
)
def test_a_default_is_the_literal_that_its_text_denotes_for_the_type(text, type, attrs):
    default = attribute("defaultValue", text)
    read = Read(
        packet(
            data("Block", "b", name="Belt"),
            data(
                "ValueProperty", "p", "b", "value", default, **({"typedBy": type} if type else {})
            ),
            data("Enumeration", "c", name="Colour"),
            data("EnumerationLiteral", "r", "c", "red"),
            data("InstanceSpecification", "i", name="spare", classifiedBy="b"),
            data("InstanceSpecification", "t1", name="twin", classifiedBy="b"),
            data("InstanceSpecification", "t2", name="twin", classifiedBy="b"),
        )
    )
    assert read.graph["p"].attrs == attrs


@pytest.mark.parametrize(
    ("type", "kind"), [("sysml.ValueType", "DataType"), ("sysml.Metaclass", "Class")]
)
def test_a_type_that_is_not_exported_has_the_kind_that_mtip_states(type, kind):
    record = data("ValueProperty", "p", "b", "time", typedBy="gone")
    record = record.replace("<typedBy><type>x</type>", f"<typedBy><type>{type}</type>")
    read = Read(packet(data("Block", "b", name="Belt"), record))
    assert str(read.graph.target(read.graph["p"], Edge.TYPED_BY).kind) == kind


@pytest.mark.parametrize(
    ("default", "types", "findings"),
    [
        ("false", ["Boolean"], []),
        ("", [], ["SM181 1 element of type 'PrimitiveValueType' not read"]),
        ("1", [], ["SM181 1 element of type 'PrimitiveValueType' not read"]),
    ],
)
def test_a_type_that_mtip_does_not_name_is_boolean_if_the_default_is(default, types, findings):
    text = attribute("defaultValue", default)
    record = data("ValueProperty", "p", "b", "free", text).replace(
        "</relationships>",
        "<typedBy><id></id><type>PrimitiveValueType</type></typedBy></relationships>",
    )
    read = Read(packet(data("Block", "b", name="Belt"), record))
    assert [type.name for type in read.graph.targets(read.graph["p"], Edge.TYPED_BY)] == types
    assert read.findings == findings


def test_the_classifier_of_a_value_type_is_its_general():
    read = Read(
        packet(
            data("ValueType", "v", name="Speed", classifiedBy="Real"),
            data("InstanceSpecification", "i", name="slow", classifiedBy="v"),
        )
    )
    assert [t.name for t in read.graph.targets(read.graph["v"], Edge.SPECIALIZES)] == ["Real"]
    assert read.graph.targets(read.graph["i"], Edge.INSTANCE_OF) == [read.graph["v"]]


def test_a_slot_with_a_verdict_of_sysml_refers_to_the_literal_of_the_library():
    read = Read(
        packet(
            data("Block", "b", name="Belt"),
            data("ValueProperty", "p", "b", "verdict"),
            data("InstanceSpecification", "i", name="belt", classifiedBy="b"),
            data(
                "Slot",
                "v",
                "i",
                property="p",
                instanceValue="_11_5EAPbeta_be00301_1147937861492_957324_2636",
            ),
        )
    )
    literal = read.graph.target(read.graph["v"], Edge.REFERENCES)
    assert read.graph.qualified_name(literal) == "SysML::Libraries::Verdicts::VerdictKind::pass"


def read_association(*properties, **types):
    return Read(
        packet(
            data("Block", "g", name="Gate"),
            data("Block", "b", name="Belt"),
            data("Composition", "a", **types),
            *properties,
        )
    ).graph


def test_an_association_owns_the_end_that_no_class_owns():
    """MTIP exports only the ends that classes own, and the types of both ends."""
    belt = data("PartProperty", "p", "g", "belt", typedBy="b", association="a")
    graph = read_association(belt, supplier="b", client="g")
    _, end = graph.targets(graph["a"], Edge.END)
    assert graph.owner(end) is graph["a"]
    assert graph.targets(end, Edge.TYPED_BY) == [graph["g"]]


def test_an_association_between_two_properties_owns_no_end():
    belt = data("PartProperty", "p", "g", "belt", typedBy="b", association="a")
    gate = data("ReferenceProperty", "q", "b", "gate", typedBy="g", association="a")
    graph = read_association(belt, gate, supplier="b", client="g")
    assert graph.targets(graph["a"], Edge.END) == [graph["p"], graph["q"]]


@pytest.mark.parametrize("types", [{}, {"supplier": "b", "client": "b"}, {"client": "gone"}])
def test_an_association_without_the_type_of_the_other_end_has_one_end(types):
    belt = data("PartProperty", "p", "g", "belt", typedBy="b", association="a")
    graph = read_association(belt, **types)
    assert graph.targets(graph["a"], Edge.END) == [graph["p"]]


# -- facts that MTIP does not state ----------------------------------------------------------------


def read_parameters(*records):
    """Return the parameter and the direction of each node of an activity with these records."""
    graph = Read(packet(data("Activity", "a", name="Track"), *records)).graph
    nodes = [element for element in graph if element.kind == "ActivityParameter"]
    return {
        node.id: ([e.id for e in graph.targets(node, Edge.REFERENCES)], node.attrs.get("direction"))
        for node in nodes
    }


def parameter(id, name, direction, type="t"):
    return data("Parameter", id, "a", name, attribute("direction", direction), typedBy=type)


def node(id, name, type="t"):
    return data("ActivityParameterNode", id, "a", name, typedBy=type)


def test_a_parameter_node_has_the_parameter_of_its_name_and_type():
    assert read_parameters(
        parameter("p", "speed", "in"),
        parameter("q", "done", "out"),
        node("n", "done"),
        node("o", "speed"),
    ) == {"n": (["q"], "out"), "o": (["p"], "in")}


def test_a_renamed_parameter_node_has_the_only_parameter_that_fits_its_type_and_flows():
    assert read_parameters(
        parameter("p", "speed", "in"),
        parameter("q", "done", "out"),
        node("n", "result"),
        data("Action", "x", "a"),
        data("ObjectFlow", "f", "a", supplier="x", client="n"),
    ) == {"n": (["q"], "out")}


@pytest.mark.parametrize("name", ["speed", "other"])
def test_a_parameter_node_to_which_no_single_parameter_fits_has_none(name):
    parameters = (parameter("p", "speed", "in"), parameter("q", "speed", "in"))
    assert read_parameters(*parameters, node("n", name)) == {"n": ([], None)}
    assert read_parameters(parameter("p", "speed", "in", "u"), node("n", name)) == {"n": ([], None)}


def test_a_behaviour_of_a_transition_is_its_effect():
    graph = Read(
        packet(
            data("StateMachine", "sm", name="States"),
            data("Region", "re", "sm"),
            data("State", "s", "re", "up"),
            data("Transition", "tr", "sm", supplier="s", client="s"),
            data("OpaqueBehavior", "b", "tr", "lower"),
            data("OpaqueBehavior", "c", "s", "check"),
        )
    ).graph
    assert graph.targets(graph["tr"], Edge.EFFECT) == [graph["b"]]
    assert graph.sources(graph["c"], Edge.EFFECT) == []


def test_a_message_has_its_sort_and_lifelines():
    graph = Read(
        packet(
            data("Interaction", "i", name="Scenario"),
            data("Lifeline", "a", "i", "a"),
            data("Lifeline", "b", "i", "b"),
            data(
                "Message",
                "m",
                "i",
                more=attribute("messageSort", "synchCall"),
                supplier="a",
                client="b",
            ),
        )
    ).graph
    assert graph["m"].attrs == {"subkind": "synch-call"}
    assert graph.target(graph["m"], Edge.FLOW_TARGET) is graph["b"]


def test_tagged_values_belong_to_their_stereotype():
    read = Read(packet(data("Class", "c", "", "C", stereotype("Cost", "Own", euro="5"))))
    (application,) = [element for element in read.graph if element.name == "Cost"]
    assert application.attrs == {"stereotype": "Cost", "namespace": "Own", "tag.euro": "5"}


def test_elements_that_mtip_omits_are_stubs():
    read = Read(
        packet(data("Property", "p", "c", "speed", typedBy="gone"), data("Class", "c", name="C"))
    )
    assert read.findings == [
        "SM152 'MTIP:not-exported' is not part of the compile unit; the model refers "
        "to 1 of its elements"
    ]
    assert read.graph.target(read.graph["p"], Edge.TYPED_BY).attrs["external"] is True


def test_a_flow_from_a_missing_node_has_no_source_and_is_reported():
    read = Read(
        packet(
            data("Activity", "a", name="A"),
            data("FlowFinalNode", "n", "a"),
            data("ControlFlow", "f", "a", supplier="gone", client="n"),
        )
    )
    assert read.totals == {"elements": 3, "mapped": 2, "approximated": 1}
    assert read.graph["f"].attrs["unresolved"] == ("flow-source",)
    assert [line[:5] for line in read.findings] == ["SM184"]


def test_unread_records_are_counted_and_reported():
    read = Read(
        packet(
            data("Model", "m", name="M"),
            data("DurationInterval", "d1", "m"),
            data("DurationInterval", "d2", "m"),
            data("InputPin", "p", "gone"),
            data("Class", "m", name="Again"),
        )
    )
    assert read.totals == {"elements": 5, "mapped": 1, "unsupported": 4}
    assert [line.partition(" ")[0] for line in read.findings] == ["SM183", "SM181", "SM182"]


def test_a_wholly_read_model_gives_no_diagnostics():
    read = Read(packet(data("Model", "m", name="M"), data("Class", "n", "m", "N")))
    assert read.findings == []


def test_the_order_of_records_does_not_matter():
    records = [data("Class", f"c{n}", f"c{n - 1}" if n else "", f"C{n}") for n in range(5)]
    forwards, backwards = Read(packet(*records)), Read(packet(*reversed(records)))
    names = [
        {e.id: reading.graph.qualified_name(e) for e in reading.graph}
        for reading in (forwards, backwards)
    ]
    assert names[0] == names[1]


def test_cyclic_owners_are_not_read():
    read = Read(packet(data("Class", "a", "b"), data("Class", "b", "a"), data("Class", "c")))
    assert [element.id for element in read.graph] == ["c"]


def test_owners_nested_too_deeply_are_refused():
    records = [data("Class", f"c{n}", f"c{n - 1}" if n else "") for n in range(600)]
    with pytest.raises(SourceError, match="nested more than 500 deep") as raised:
        Read(packet(*records))
    assert raised.value.fault is Fault.LIMIT


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda text: text[:-12], "not well-formed XML: unclosed token"),
        (
            lambda text: text.replace(b"<packet>", b"<!DOCTYPE x [<!ENTITY e 'f'>]><packet>"),
            "DOCTYPE",
        ),
    ],
)
def test_a_damaged_file_is_located_and_skipped(spoil, reason):
    spoilt = Source("plant_mtip.xml", spoil(STRUCTURE.data))
    assert FRONTEND.detect(spoilt) == 1.0
    sink, graph = Sink(), Graph()
    FRONTEND.read([spoilt, packet(data("Class", "z"), name="z.xml")], graph, sink, Coverage())
    (diagnostic,) = sink
    assert (diagnostic.rule.code, [element.id for element in graph]) == ("SM185", ["z"])
    assert reason in diagnostic.message
    assert diagnostic.subject.place.offset > 0


def test_other_files_are_not_detected():
    assert FRONTEND.detect(STRUCTURE) == 1.0
    for text in (b"<packet/>", b"<x><packet mtipVersion=''/></x>", b"", b"<uml:Model/>"):
        assert FRONTEND.detect(Source("m.xml", text)) == 0.0


def test_damaged_files_give_a_graph_or_a_located_fault(tmp_path):
    """Whatever is done to a file, no exception of ours comes of it."""
    for seed in range(200):
        random = Random(seed)
        spoil = mutate if seed % 4 else damage
        _, spoilt = spoil(STRUCTURE.data, random)
        path = tmp_path / "plant.xml"
        path.write_bytes(spoilt)
        compilation = compile_model(Request((path,), verify_each=True))
        assert not [f for f in compilation.diagnostics if f.rule.code.startswith("SM9")], seed


@pytest.mark.long
@pytest.mark.corpus
def test_the_telescope_is_read(corpus):
    """94 MB: each record has one verdict, 94 percent of them are in the graph."""
    (source,) = load(corpus / "xmi" / "huds" / "TMT_mtip.zip", "TMT_mtip.zip")
    assert FRONTEND.detect(source) == 1.0
    read = Read(source)
    assert read.totals["elements"] == source.data.count(b"<data>")
    shares = [read.totals[k] for k in ("mapped", "approximated", "ignored_notation", "unsupported")]
    assert sum(shares) == read.totals["elements"]
    assert read.totals["mapped"] >= 0.93 * read.totals["elements"]
    assert {line[:5] for line in read.findings} == {"SM152", "SM181", "SM182", "SM184"}


def test_the_text_form_shows_what_was_read():
    lines = print_text(Read(STRUCTURE, resolved=False).graph).splitlines()
    assert lines[0] == 'Package m "Plant" subkind="model" @plant_mtip.xml:3'


def test_consequences_of_a_missing_node_are_no_errors(tmp_path):
    """MTIP leaves nodes out; that is one warning, not an error for each of their flows."""
    records = (
        data("Activity", "a", name="A"),
        data("FlowFinalNode", "n", "a"),
        data("ControlFlow", "f", "a", supplier="gone", client="n"),
    )
    (tmp_path / "plant.xml").write_bytes(packet(*records).data)
    compilation = compile_model(Request((tmp_path / "plant.xml",)))
    assert [f.rule.code for f in compilation.diagnostics if f.severity != "info"] == ["SM184"]
