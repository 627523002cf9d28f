"""The pass ``resolve``: references to elements, and external stubs for absent elements."""

import pytest
from pass_runs import list_codes, list_diagnostics, run_until

from sysmlc.ir import Edge, Kind
from sysmlc.ir.text import print_text

PRIMITIVES = [
    ("pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Integer", "DataType", "", "Integer"),
    ("http://www.omg.org/spec/UML/20131001/PrimitiveTypes.xmi#Integer", "Class", "", "Integer"),
    ("https://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#Boolean", "Class", "", "Boolean"),
    ("pathmap://UML_LIBRARIES/EcorePrimitiveTypes.library.uml#EDouble", "Class", "", "Real"),
    ("pathmap://UML_LIBRARIES/JavaPrimitiveTypes.library.uml#int", "Class", "", "Integer"),
    (
        "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML.package_packagedElement_"
        "Libraries.package_packagedElement_PrimitiveValueTypes.dataType_packagedElement_String",
        "DataType",
        "",
        "String",
    ),
    (
        "http://www.omg.org/spec/SysML/20150709/SysML.xmi#_SysML_Libraries_PackageableElement-"
        "PrimitiveValueTypes_PackageableElement-String_PackageableElement",
        "DataType",
        "SysML::Libraries::PrimitiveValueTypes::String",
        "String",
    ),
    ("UML_Standard_Profile.mdzip#_9_0_2_91a0295_110", "DataType", "datatypes::Real", "Real"),
    (
        "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#UnlimitedNatural",
        "Class",
        "",
        "UnlimitedNatural",
    ),
]


def print_reference(href: str, kind: str = "Class", name: str = "", edge: str = "typed-by") -> str:
    """Return the property p with an unresolved reference."""
    suffix = f' "{name}"' if name else ""
    return f'Property p "p" @m/a.uml:1\n  ?> {edge} "{href}" {kind}{suffix}\n'


@pytest.mark.parametrize(("href", "kind", "path", "name"), PRIMITIVES)
def test_each_primitive_type_is_the_same_data_type_in_all_dialects(href, kind, path, name):
    graph, sink = run_until(print_reference(href, kind, path), "resolve")
    type_ = graph.target(graph["p"], Edge.TYPED_BY)
    assert (type_.kind, type_.name, type_.subkind) == (Kind.DATA_TYPE, name, "primitive")
    assert list_codes(sink) == []


@pytest.mark.parametrize(
    ("href", "name"),
    [
        ("pathmap://SYSMLC_PROFILES/sysmlc.profile.uml#Task", "Task"),
        ("http://www.omg.org/spec/SysML/20150709/SysML.xmi#SysML.NewInSysML9", "NewInSysML9"),
        (
            "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_New_u0026Old",
            "New&Old",
        ),
    ],
)
def test_an_unknown_element_of_a_standard_profile_becomes_a_stub_without_a_report(href, name):
    graph, sink = run_until(print_reference(href, edge="references"), "resolve")
    stub = graph.target(graph["p"], Edge.REFERENCES)
    assert (stub.name, stub.attrs["external"], stub.attrs["href"]) == (name, True, href)
    assert list_codes(sink) == []


@pytest.mark.parametrize(
    ("href", "count", "name"),
    [
        ("pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#Intger", 1, "Intger"),
        ("http://www.omg.org/spec/UML/20131001/PrimitiveTypes.xmi#Int32", 1, "Int32"),
        ("UML_Standard_Profile.mdzip#_9_0_2_91a0295_1_2_3", 1, "_9_0_2_91a0295_1_2_3"),
    ],
)  # fmt: skip
def test_an_element_that_no_version_of_a_library_has_is_reported(href, count, name):
    _, sink = run_until(print_reference(href, "DataType"), "resolve")
    assert list_diagnostics(sink) == [
        f"SM153 warning: the built-in description of '{href.partition('#')[0]}' lacks {count} "
        f"of the elements that the model uses"
    ]
    assert next(iter(sink)).notes == (f"DataType '{name}', used by p",)
    assert next(iter(sink)).subject.place.ordinal == 1


def test_a_type_of_magicdraws_profile_with_a_name_is_not_reported():
    text = print_reference("UML_Standard_Profile.mdzip#_9_0_2_91a0295_1_2_3", "DataType", "Date")
    _, sink = run_until(text, "resolve")
    assert list_codes(sink) == []


def test_a_stub_has_the_qualified_name_in_the_reference():
    text = print_reference("lib.mdzip#_19_0_4_25dc056a_1", name="Company::Robots::Arm")
    graph, _ = run_until(text, "resolve")
    stub = graph.target(graph["p"], Edge.TYPED_BY)
    assert (stub.name, stub.attrs["qualified_name"]) == ("Arm", "Company::Robots::Arm")
    plain, _ = run_until(print_reference("lib.mdzip#_19_0_4_25dc056a_1", name="Arm"), "resolve")
    assert "qualified_name" not in plain.target(plain["p"], Edge.TYPED_BY).attrs


def test_an_absent_library_is_one_warning_that_lists_its_elements():
    text = print_reference("lib.uml#a", name="A") + (
        'Property q "q"\n  ?> typed-by "lib.uml#b" Class\n'
        'Property r "r"\n  ?> typed-by "lib.uml#a" Class\n'
    )
    graph, sink = run_until(text, "resolve")
    assert list_diagnostics(sink) == [
        "SM152 warning: 'lib.uml' is not part of the compile unit; the model refers to 2 "
        "of its elements"
    ]
    assert next(iter(sink)).notes == ("Class 'A', used by p, r", "Class 'b', used by q")
    stubs = {element.name for element in graph if element.attrs.get("external")}
    assert stubs == {"A", "b"}


@pytest.mark.parametrize(
    ("target", "advice"),
    [
        ("../n/b.uml#x", "give the file 'b.uml' as a further input"),
        (
            "pathmap://PLANT/b.uml#_7oikoBKMEd-W7uZ4pU2b1w",
            "give the file 'b.uml' as a further input; the modelling tool installs it with its "
            "plug-ins",
        ),
    ],
)
def test_the_advice_on_an_absent_library_names_a_file_and_not_its_address(target, advice):
    _, sink = run_until(print_reference(target), "resolve")
    (diagnostic,) = sink
    assert (diagnostic.rule.code, diagnostic.help) == ("SM152", advice)


@pytest.mark.parametrize(
    "target",
    ["b.uml#x", "../n/b.uml#x", "pathmap://PLANT/b.uml#x", "platform:/resource/plant/b.uml#x"],
)
def test_a_file_of_the_unit_is_found_by_its_path_or_its_name(target):
    text = print_reference(target) + 'Class x "X" @n/b.uml:1\n'
    graph, sink = run_until(text, "resolve")
    assert (graph.target(graph["p"], Edge.TYPED_BY).id, list_codes(sink)) == ("x", [])


def test_of_two_files_of_the_same_name_the_nearer_one_is_used():
    text = (
        print_reference("b.uml#x")
        + 'Class n/b.uml#x "far" @n/b.uml:1\nClass m/b.uml#x "near" @m/b.uml:1\n'
    )
    graph, _ = run_until(text, "resolve")
    assert graph.target(graph["p"], Edge.TYPED_BY).name == "near"


def test_a_short_id_in_an_unknown_file_does_not_refer_to_the_unit():
    graph, sink = run_until(print_reference("lib.uml#_0") + "Class _0 @n/b.uml:1\n", "resolve")
    assert graph.target(graph["p"], Edge.TYPED_BY).attrs["href"] == "lib.uml#_0"
    assert list_codes(sink) == ["SM152"]


def test_a_missing_element_of_a_file_of_the_unit_is_an_error_at_the_reference():
    graph, sink = run_until(print_reference("b.uml#y") + "Class x @b.uml:1\n", "resolve")
    (diagnostic,) = sink
    assert diagnostic.rule.code == "SM150"
    assert (diagnostic.subject.place.file, diagnostic.subject.id) == ("m/a.uml", "p")
    assert graph["p"].attrs["unresolved"] == ("typed-by",)
    assert not graph.pending


def test_consequences_of_a_broken_reference_are_not_reported():
    text = 'Class gate "Gate"\n  Port gate.in "in" direction="in"\n    ?> typed-by nowhere Class\n'
    assert list_codes(run_until(text, "ports")[1]) == ["SM150"]


def test_files_in_another_order_give_the_same_edges_and_stubs():
    first = print_reference("lib.uml#a", name="A")
    second = 'Class c "C" @b.uml:1\n  ?> specializes m/a.uml#p Class\n'
    graph, _ = run_until(first + second, "resolve")
    reordered, _ = run_until(second + first, "resolve")
    assert sorted(print_text(graph).splitlines()) == sorted(print_text(reordered).splitlines())


def test_ids_in_attributes_are_resolved():
    text = (
        'Control d subkind="decision" decision_input="b.uml#isFree" @a.uml:1\n'
        'Structured c clauses=[[["t"], ["gone"]]] @a.uml:2\nAction t @a.uml:3\n'
        "Activity b.uml#isFree @b.uml:1\n"
    )
    graph, sink = run_until(text, "resolve")
    assert graph["d"].attrs["decision_input"] == "b.uml#isFree"
    assert graph["c"].attrs["clauses"] == ((("t",), ()),)
    assert list_codes(sink) == ["SM151"]


@pytest.mark.parametrize(
    ("holder", "attribute"),
    [
        ('Action x subkind="call-operation"', "on_port"),
        ("Trigger x", "port"),
        ("ConnectorEnd x", "defining_end"),
        ("Message x", "connector"),
        ("Operation x", "raised_exception"),
    ],
)
def test_an_attribute_that_names_no_element_is_reported_and_removed(holder, attribute):
    graph, sink = run_until(f'{holder} {attribute}="gone"\n', "resolve")
    assert (list_codes(sink), graph["x"].attrs.get(attribute)) == (["SM151"], None)
    _, sink = run_until(f'{holder} {attribute}="x"\n', "resolve")
    assert list_codes(sink) == []


def test_several_broken_references_of_an_edge_are_one_diagnostic():
    text = 'Class gate "Gate"\n  Operation open "open"\n' + "    ?> method x{} Activity\n" * 6
    numbered = text.format(*range(6))
    graph, sink = run_until(numbered, "resolve")
    (diagnostic,) = sink
    assert (
        diagnostic.message == "'method' of 'Gate::open' leads to 'x0' and 5 more that do not exist"
    )
    assert graph["open"].attrs["unresolved"] == ("method",)


def test_a_flow_with_two_targets_retains_the_first():
    text = """\
Activity pull "Pull in"
  Control start "start" subkind="initial"
  Action lower "Lower" subkind="opaque"
  Action raise "Raise" subkind="opaque"
  ControlFlow go
    ?> flow-source start Control
    ?> flow-target raise Action
    ?> flow-target lower Action
"""
    graph, sink = run_until(text, "resolve")
    assert [target.id for target in graph.targets(graph["go"], Edge.FLOW_TARGET)] == ["raise"]
    assert list_codes(sink) == ["SM167"]
