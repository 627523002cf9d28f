"""Declarations are compared beyond the elements of the graph: keywords, members, names."""

import pytest

from frontends.sysml.reading_v2 import read
from sysmlc.diagnostics import Severity
from sysmlc.ir.compare import compare

MODEL = """
package Plant {
    private import SI::*;
    part def Tank { attribute level; port drain; }
    constraint def Below { in value; in limit; value < limit }
    part plant {
        part tank : Tank;
        ref part spare : Tank;
        assert constraint safe : Below { in value = tank.level; in limit = 5; }
    }
    requirement def Level {
        subject tank : Tank;
        assume constraint { tank.level > 0 }
        require constraint { tank.level < 9 }
    }
    use case def Fill {
        subject tank : Tank;
        actor worker[1..2];
        objective { require constraint { tank.level == 9 } }
    }
    action def Empty { in item source : Tank; action open; }
    part line { part pump; part sink; connect near ::> pump to far ::> sink; }
    alias Vessel for Tank;
}
"""


def list_changes(before, after):
    """Return the differences that one replacement in the model makes."""
    assert MODEL.count(before) == 1
    changes = compare(read(MODEL).graph, read(MODEL.replace(before, after)).graph)
    return [f"{c.name}: {c.aspect}: {c.before} => {c.after}" for c in changes]


@pytest.mark.parametrize(
    ("before", "after", "change"),
    [
        ("part tank : Tank;", "item tank : Tank;", "tank: keyword: part => item"),
        ("in item source", "in source", "source: keyword: item => ref"),
        ("action open", "calc open", "open: keyword: action => calc"),
        ("ref part spare", "part spare", "spare: aggregation:  => composite"),
        ("part line {", "abstract part line {", "line: abstract:  => true"),
        ("in value = tank.level", "in value := tank.level", "safe: member"),
        ("in limit = 5", "in limit = 6", "safe: member: in limit = 5 => in limit = 6"),
        ("assume constraint", "require constraint", "Level: membership: assume => require"),
        ("import SI::*", "import SI::**", "Plant: import"),
        ("private import", "public import", "Plant: import"),
        ("worker[1..2]", "worker[2]", "<Association>: multiplicity: [1..2] => [2]"),
        ("== 9", "== 8", "Fill: objective"),
        ("near ::>", "", "pump -- sink: end: end near ::> pump => end ::> pump"),
        ("alias Vessel for", "alias <V> Vessel for", "Vessel: short name:  => <V>"),
    ],
)
def test_a_changed_token_is_one_difference(before, after, change):
    (difference,) = list_changes(before, after)
    assert difference.startswith(change)


def test_a_constraint_without_assertion_has_another_keyword():
    assert list_changes("assert constraint safe", "constraint safe") == [
        "safe: aggregation:  => composite",
        "safe: keyword: assert constraint => constraint",
    ]


def test_the_name_of_a_subject_is_compared():
    text = MODEL.replace(
        "subject tank : Tank;\n        assume", "subject t : Tank;\n        assume"
    )
    changes = compare(read(MODEL).graph, read(text.replace("{ tank.", "{ t.", 2)).graph)
    assert ("subject", "subject tank : Tank", "subject t : Tank") in [
        (change.aspect, change.before, change.after) for change in changes
    ]


def test_a_renamed_element_makes_no_difference_where_its_name_is_used():
    text = MODEL.replace("part def Tank", "part def Vat").replace(": Tank", ": Vat")
    text = text.replace("for Tank", "for Vat")
    changes = compare(read(MODEL).graph, read(text).graph)
    assert [(change.aspect, change.before, change.after) for change in changes] == [
        ("name", "Tank", "Vat")
    ]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("part tank : Tank;", "part tank defined by Tank;"),
        ("alias Vessel", "public alias Vessel"),
        ("in item source", "in ref item source"),
        ("actor worker[1..2];", "actor worker [1 .. 2] { }"),
        ("private import SI::*;", "private import SI::*; // units"),
    ],
)
def test_other_notations_of_the_same_declaration_are_no_difference(before, after):
    assert list_changes(before, after) == []


def test_declarations_are_ignored_on_request():
    changed = MODEL.replace("part tank : Tank;", "item tank : Tank;")
    assert compare(read(MODEL).graph, read(changed).graph, {"declaration"}) == []


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("def Tank;", "'def' goes with a keyword for the kind of the definition"),
        ("use case fill { include case stir; }", "'include' goes with 'use case'"),
        ("part plant { perform state stir; }", "'perform' goes with 'action'"),
        ("action fill { from a.b to c.d; }", "'from' goes with flows and messages"),
    ],
)
def test_a_missing_or_other_keyword_is_an_error(text, problem):
    findings = [
        finding
        for finding in read(f"package Plant {{ {text} }}").sink
        if finding.rule.code == "SM199" and finding.severity is Severity.ERROR
    ]
    assert [finding.message.startswith(problem) for finding in findings] == [True]


@pytest.mark.parametrize(
    "text",
    [
        "metadata def tank; #tank def Tank;",
        "individual def Tank;",
        "use case fill { include use case stir; }",
        "part plant { perform action stir; perform fill; } action fill;",
    ],
)
def test_keywords_that_go_together_are_no_error(text):
    reading = read(f"package Plant {{ {text} }}")
    assert "SM199" not in [finding.rule.code for finding in reading.sink]
