"""Rules of the front end for SysML v2 (SM480 to SM482, SM484)."""

import pytest
from reading_v2 import read

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND, rules
from sysmlc.ir import Graph
from sysmlc.sources import Source

CODES = ("SM480", "SM481", "SM482")
RULES = (rules.UNSUPPORTED, rules.APPROXIMATED, rules.NOT_IN_GRAPH)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.code)
def test_the_wrong_model_is_reported_and_the_right_one_is_not(rule):
    assert rule.code in CODES
    assert rule.code in read(rule.read_page().wrong).list_codes()
    assert rule.code not in read(rule.read_page().right).list_codes()


def test_sm480_unread_elements_are_reported_once_with_their_number_and_location():
    reading = read("package P {\n    rendering def A;\n    rendering def B { part x; }\n}")
    diagnostics = [diagnostic for diagnostic in reading.sink if diagnostic.rule.code == "SM480"]
    assert [diagnostic.message for diagnostic in diagnostics] == [
        "rendering definition is not read (2 in the unit, with all that they own)"
    ]
    assert diagnostics[0].subject.place.ordinal == 30
    assert reading.count_verdicts() == {"elements": 5, "mapped": 2, "unsupported": 3}


def test_individuals_portions_variations_and_variants_are_in_the_graph():
    portions = "snapshot begun; timeslice shift; individual part one : Cell;"
    variants = "variation part tool { variant part gripper; }"
    reading = read(f"package P {{ individual part def Cell {{ {portions} {variants} part x; }} }}")
    assert reading.list_codes() == []
    assert reading.find_element("P::Cell").attrs["individual"] is True
    assert reading.find_element("P::Cell::begun").attrs["portion"] == "snapshot"
    assert reading.find_element("P::Cell::shift").attrs["portion"] == "timeslice"
    assert reading.find_element("P::Cell::tool", "Class").attrs["variation"] is True
    assert reading.find_element("P::Cell::tool::gripper").attrs["variant"] is True
    assert (
        reading.find_element("P::Cell::x")
        .attrs.keys()
        .isdisjoint({"variation", "variant", "portion"})
    )


@pytest.mark.parametrize(
    ("member", "owner"),
    [
        ("assert constraint safe { attribute x; 1 == 2 }", "a constraint"),
        ("satisfy q { attribute x; }", "a satisfaction"),
        ("flow from a.x to b.x { attribute x; }", "a flow"),
        ("allocate a to b { attribute x; }", "an allocation"),
        ("enum def E { enum e { attribute x; } }", "an enumerated value"),
        ("action stop { terminate { attribute x; } }", "a terminate action"),
        ("exhibit state s : S { attribute x; } state def S;", "an exhibit state usage"),
        ("state t { state f; transition first f then f { attribute x; } }", "a transition usage"),
        (
            "action go { action k { out e; in g; } flow k.e to k.g { attribute x; } }",
            "a flow or message",
        ),
        ("action go { in h; out i; bind h = i { attribute x; } }", "a binding"),
        ("action go { action k { in h { attribute x; } } }", "a reference usage"),
        ("port h { out : M { attribute x; } }", "a reference usage"),
        ("verification v { objective { verify q { attribute x; } } }", "a verification"),
    ],
)
def test_sm481_members_of_elements_without_members_in_the_graph_are_reported(member, owner):
    around = "requirement q; part def M { attribute x; } part a : M; part b : M;"
    sink = read(f"package P {{ part def Cell {{ {around} {member} }} }}").sink
    messages = [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM481"]
    assert messages == [f"a member of {owner} is not read (1 in the unit)"]
    nearly = member.replace("attribute x;", "doc /* x */")
    assert (
        "SM481" not in read(f"package P {{ part def Cell {{ {around} {nearly} }} }}").list_codes()
    )


@pytest.mark.parametrize(
    ("member", "expected"),
    [
        ("action a { action b[4]; }", "the multiplicity of an action usage is not read"),
        ("state a { state b[4]; }", "the multiplicity of a state usage is not read"),
        ("action a { variation action b; }", "a variation is read as a plain usage"),
        (
            "use case u { include use case v : V { doc /* x */ } } use case def V;",
            "a member of an include use case usage is not read",
        ),
        (
            "part def D { @M { y { :>> z = 3; } } }",
            "a member of a reference usage is not read",
        ),
    ],
)
def test_sm481_every_omission_is_reported(member, expected):
    around = "metadata def M { attribute y { attribute z; } }"
    sink = read(f"package P {{ {around} {member} }}").sink
    messages = [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM481"]
    assert messages == [f"{expected} (1 in the unit)"]
    plain = member.replace("[4]", "").replace("variation ", "").replace("{ :>> z = 3; }", "= 3;")
    plain = plain.replace("doc /* x */", "")
    assert "SM481" not in read(f"package P {{ {around} {plain} }}").list_codes()


def test_documentation_of_aliases_imports_and_nested_allocations_is_kept():
    reading = read("""
package P {
    part def A; part a : A { part c; } part b { part d; }
    alias z for A { doc /* one */ }
    public import Q::* { doc /* two */ }
    allocate a to b { allocate a.c to b.d; }
}
package Q;""")
    bodies = [element.attrs["body"] for element in reading.graph if element.kind == "Comment"]
    assert sorted(bodies) == ["one", "two"]
    assert len([element for element in reading.graph if element.role == "allocate"]) == 2
    assert reading.list_codes() == []


@pytest.mark.parametrize(
    ("body", "name"),
    [
        ("state def A { state a; then action z; state b; }", "Transition"),
        ("action def A { action a; then part z; action b; }", "ControlFlow"),
    ],
)
def test_sm480_a_succession_to_no_step_does_not_lead_to_the_next_step(body, name):
    reading = read(f"package P {{ {body} }}")
    messages = [
        diagnostic.message for diagnostic in reading.sink if diagnostic.rule.code == "SM480"
    ]
    assert messages == ["succession is not read (1 in the unit, with all that they own)"]
    assert [element for element in reading.graph if element.kind == name] == []
    nearly = body.replace("action z", "state z").replace("part z", "action z")
    reading = read(f"package P {{ {nearly} }}")
    assert len([element for element in reading.graph if element.kind == name]) == 1
    assert "SM480" not in reading.list_codes()


def test_aliases_of_states_are_in_the_graph_wherever_they_stand():
    plain = "state def A { entry; then a; state a; alias b for a; alias <c> for a; }"
    beside = "state def B parallel { state r { state s; alias d for s; } alias e for r; }"
    reading = read(f"package P {{ {plain} {beside} }}")
    assert [element.name for element in reading.graph if element.kind == "Alias"] == list("bcde")
    assert "unsupported" not in reading.count_verdicts()


DAMAGED = b'<sysml:Namespace xmlns:sysml="https://www.omg.org/spec/SysML/20250201"><a>'


def test_a_damaged_interchange_file_is_reported_and_omitted():
    sink, graph = Sink(), Graph()
    FRONTEND.read([Source("a.sysmlx", DAMAGED)], graph, sink, Coverage())
    assert [diagnostic.rule.code for diagnostic in sink if diagnostic.is_error] == ["SM750"]
    assert len(graph) == 0


def test_sm484_a_missing_library_is_reported(tmp_path):
    sink, graph = Sink(), Graph()
    front = FRONTEND.with_library(str(tmp_path / "nowhere"))
    front.read([Source("a.sysml", b"package P { part def A; }")], graph, sink, Coverage())
    assert [diagnostic.rule.code for diagnostic in sink if diagnostic.is_error] == ["SM484"]
    assert [element.name for element in graph] == ["P", "A"]


def test_sm484_names_the_library_of_the_environment(tmp_path, monkeypatch):
    monkeypatch.setenv("SYSML_LIBRARY_PATH", str(tmp_path / "nowhere"))
    sink = Sink()
    FRONTEND.read([Source("a.sysml", b"package P;")], Graph(), sink, Coverage())
    (error,) = [diagnostic for diagnostic in sink if diagnostic.is_error]
    assert (error.rule.code, "nowhere" in error.message) == ("SM484", True)


@pytest.mark.parametrize(
    ("name", "data", "is_ours"),
    [
        ("a.sysml", b"package P;", True),
        ("b.txt", b"/* x */ // y\nprivate import A::*;", True),
        ("c.sysml", b"", True),
        (
            "d.xml",
            b'<sysml:Namespace xmlns:sysml="https://www.omg.org/spec/SysML/20250201"/>',
            True,
        ),
        ("e.uml", b'<uml:Model xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"/>', False),
        ("f.ir", b'Package p "Plant"', False),
        ("g.yaml", b"blocks:\n  - a", False),
    ],
)
def test_files_are_recognised_by_their_content(name, data, is_ours):
    assert (FRONTEND.detect(Source(name, data)) > 0) is is_ours
