"""Pass ``resolve``: where references lead, and what stands in for what is not there."""

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


def pointing(target: str, kind: str = "Class", name: str = "", edge: str = "typed-by") -> str:
    shown = f' "{name}"' if name else ""
    return f'Property p "p" @m/a.uml:1\n  ?> {edge} "{target}" {kind}{shown}\n'


@pytest.mark.parametrize(("href", "kind", "path", "name"), PRIMITIVES)
def test_primitives_of_all_dialects_are_one_data_type_each(href, kind, path, name):
    graph, sink = run_until(pointing(href, kind, path), "resolve")
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
def test_what_is_new_in_a_standard_library_stands_in_without_complaint(href, name):
    graph, sink = run_until(pointing(href, edge="references"), "resolve")
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
def test_what_no_version_of_a_standard_library_has_is_told(href, count, name):
    _, sink = run_until(pointing(href, "DataType"), "resolve")
    assert list_diagnostics(sink) == [
        f"SM153 warning: the built-in description of '{href.partition('#')[0]}' lacks {count} "
        f"of the elements that the model uses"
    ]
    assert next(iter(sink)).notes == (f"DataType '{name}', used by p",)
    assert next(iter(sink)).subject.place.ordinal == 1


def test_a_type_of_magicdraws_profile_with_its_name_is_no_finding():
    text = pointing("UML_Standard_Profile.mdzip#_9_0_2_91a0295_1_2_3", "DataType", "Date")
    _, sink = run_until(text, "resolve")
    assert list_codes(sink) == []


def test_a_stub_keeps_the_qualified_name_that_the_reference_shows():
    text = pointing("lib.mdzip#_19_0_4_25dc056a_1", name="Company::Robots::Arm")
    graph, _ = run_until(text, "resolve")
    stub = graph.target(graph["p"], Edge.TYPED_BY)
    assert (stub.name, stub.attrs["qualified_name"]) == ("Arm", "Company::Robots::Arm")
    plain, _ = run_until(pointing("lib.mdzip#_19_0_4_25dc056a_1", name="Arm"), "resolve")
    assert "qualified_name" not in plain.target(plain["p"], Edge.TYPED_BY).attrs


def test_absent_library_is_one_warning_that_lists_what_it_takes_down():
    text = pointing("lib.uml#a", name="A") + (
        'Property q "q"\n  ?> typed-by "lib.uml#b" Class\n'
        'Property r "r"\n  ?> typed-by "lib.uml#a" Class\n'
    )
    graph, sink = run_until(text, "resolve")
    assert list_diagnostics(sink) == [
        "SM152 warning: 'lib.uml' is not part of the compile unit; its elements (2) are known "
        "by name only"
    ]
    assert next(iter(sink)).notes == ("Class 'A', used by p, r", "Class 'b', used by q")
    stubs = {one.name for one in graph if one.attrs.get("external")}
    assert stubs == {"A", "b"}


@pytest.mark.parametrize(
    "target",
    ["b.uml#x", "../n/b.uml#x", "pathmap://PLANT/b.uml#x", "platform:/resource/plant/b.uml#x"],
)
def test_file_of_the_unit_is_found_by_its_path_or_its_name(target):
    text = pointing(target) + 'Class x "X" @n/b.uml:1\n'
    graph, sink = run_until(text, "resolve")
    assert (graph.target(graph["p"], Edge.TYPED_BY).id, list_codes(sink)) == ("x", [])


def test_of_two_files_of_one_name_the_one_beside_is_meant():
    text = (
        pointing("b.uml#x")
        + 'Class n/b.uml#x "far" @n/b.uml:1\nClass m/b.uml#x "near" @m/b.uml:1\n'
    )
    graph, _ = run_until(text, "resolve")
    assert graph.target(graph["p"], Edge.TYPED_BY).name == "near"


def test_short_id_in_an_unknown_file_is_not_mistaken_for_one_of_the_unit():
    graph, sink = run_until(pointing("lib.uml#_0") + "Class _0 @n/b.uml:1\n", "resolve")
    assert graph.target(graph["p"], Edge.TYPED_BY).attrs["href"] == "lib.uml#_0"
    assert list_codes(sink) == ["SM152"]


def test_missing_element_of_a_file_of_the_unit_is_an_error_at_the_reference():
    graph, sink = run_until(pointing("b.uml#y") + "Class x @b.uml:1\n", "resolve")
    (found,) = sink
    assert (found.rule.code, found.subject.place.file, found.subject.id) == (
        "SM150",
        "m/a.uml",
        "p",
    )
    assert graph["p"].attrs["unresolved"] == ("typed-by",)
    assert not graph.pending


def test_what_follows_from_a_broken_reference_is_not_reported():
    text = 'Class gate "Gate"\n  Port gate.in "in" direction="in"\n    ?> typed-by nowhere Class\n'
    assert list_codes(run_until(text, "ports")[1]) == ["SM150"]


def test_files_in_another_order_give_the_same_edges_and_stand_ins():
    first, second = (
        pointing("lib.uml#a", name="A"),
        'Class c "C" @b.uml:1\n  ?> specializes m/a.uml#p Class\n',
    )
    one, other = (run_until(text, "resolve")[0] for text in (first + second, second + first))
    assert sorted(print_text(one).splitlines()) == sorted(print_text(other).splitlines())


def test_ids_in_attributes_become_ids_of_the_graph():
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
def test_an_attribute_that_names_what_does_not_exist_is_told(holder, attribute):
    graph, sink = run_until(f'{holder} {attribute}="gone"\n', "resolve")
    assert (list_codes(sink), graph["x"].attrs.get(attribute)) == (["SM151"], None)
    _, sink = run_until(f'{holder} {attribute}="x"\n', "resolve")
    assert list_codes(sink) == []


def test_a_long_list_that_leads_nowhere_is_one_finding():
    text = 'Class gate "Gate"\n  Operation open "open"\n' + "    ?> method x{} Activity\n" * 6
    numbered = text.format(*range(6))
    graph, sink = run_until(numbered, "resolve")
    (found,) = sink
    assert found.message == "'method' of 'Gate::open' leads to 'x0' and 5 more that do not exist"
    assert graph["open"].attrs["unresolved"] == ("method",)


def test_a_flow_with_two_targets_keeps_the_first():
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
