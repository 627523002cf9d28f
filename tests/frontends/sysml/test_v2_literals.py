"""Literals that are attributes word for word, and those that mean more."""

import pytest

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND, forms
from sysmlc.frontends.sysml.literals import Facts, Literals
from sysmlc.ir import Graph
from sysmlc.ir.reads import Reads
from sysmlc.language.text.scan import TOKEN
from sysmlc.sources import Source

MODEL = """\
package P {
    attribute def Real;
    part def Cell {
        attribute speed : Real = 3;
        attribute size : Real = -(4);
        attribute sizes : Real [2] = (5, 6);
        attribute sum : Real = speed + 7 * 2;
        attribute label = "a \\"b\\"";
        part arms[8..9] : Cell;
        assert constraint { speed < 10 and label == "x" }
    }
}
"""


def read(text: str) -> Reads:
    """What is noted while a text is read."""
    graph = Graph()
    graph.reads = Reads()
    FRONTEND.read([Source("p.sysml", text.encode())], graph, Sink(), Coverage())
    return graph.reads


def said(found: Reads) -> list[str]:
    """Attributes with the literals of the text that they are."""
    return sorted(
        f"{one.key}: {' '.join(TOKEN.match(MODEL, at)[0] for at in forms.places(one.form))}"
        for one in found.literals
    )


def test_values_and_texts_of_expressions_say_where_their_literals_are():
    assert said(read(MODEL)) == [
        'body: 10 "x"',
        r'default: "a \"b\""',
        "default: 3",
        "default: 4",
        "default: 5 6",
        "default: 7 2",
    ]


def test_bounds_mean_more_than_an_attribute():
    found = read(MODEL)
    assert {MODEL[at : at + 1] for _, at in found.asked} >= {"8", "9"}


def test_no_literal_of_a_file_with_a_fault_is_known():
    assert read(MODEL.replace("attribute speed :", "attribute speed : :")).literals == []


@pytest.mark.parametrize(
    ("form", "values", "expected"),
    [
        (4, {4: 3}, 3),
        (("-", 4), {4: 3}, -3),
        (("-", 4), {4: True}, None),
        ((",", 4, 9), {4: 3, 9: "x"}, (3, "x")),
        ((",",), {}, ()),
        ((",", 4, 9), {4: 3}, None),
        (("tag", 4), {4: 3}, "3"),
        (("tag", 4), {4: False}, "false"),
        (("tag", 4), {4: "A::B"}, None),
        (("tag", (",", 4, 9)), {4: 1, 9: True}, ("1", "true")),
        (("text", "speed > ", 4, ""), {4: 2.5}, "speed > 2.5"),
        (("text", "", 4, " == ", 9, ""), {4: True, 9: 'a"b'}, 'true == "a\\"b"'),
        (("text", "speed > ", 4, ""), {}, None),
    ],
)
def test_a_form_gives_the_value_of_other_literals(form, values, expected):
    assert forms.value(form, values.get) == expected


@pytest.mark.parametrize(
    "ask",
    [
        lambda facts: facts["value"],
        lambda facts: facts.get("value"),
        lambda facts: dict(facts),
        lambda facts: {**facts},
        lambda facts: list(facts.items()),
        lambda facts: list(facts.values()),
        lambda facts: facts.copy(),
        lambda facts: facts | {},
        lambda facts: {} | facts,
        lambda facts: facts == {},
        lambda facts: facts != {},
    ],
)
def test_who_asks_for_the_facts_of_a_literal_is_noticed(ask):
    noted = []

    class Noting(Literals):
        def note(self, place):
            noted.append(place)

    ask(Facts({"value": 3}, ("p.sysml", 12), Noting()))
    assert ("p.sysml", 12) in noted


def test_values_of_another_text_of_the_same_shape():
    old, reads = Source("p.sysml", MODEL.encode()), read(MODEL)
    text = MODEL.replace("= 3;", "= 33; // faster").replace("10 and", "11 and")
    new = Source("p.sysml", text.encode())
    assert FRONTEND.shape(old) == FRONTEND.shape(new)
    asked = {place for _, place in reads.asked}
    found = FRONTEND.values(old, new, reads.literals, asked)
    assert sorted(map(str, (found or {}).values())) == ["33", 'speed < 11 and label == "x"']


@pytest.mark.parametrize(
    ("old", "new"), [("= 3;", "= 3.5;"), ("= 3;", "= true;"), ("= 3;", "= -3;"), ("Cell", "Cel")]
)
def test_texts_of_another_shape(old, new):
    texts = MODEL, MODEL.replace(old, new, 1)
    one, other = (Source("p.sysml", text.encode()) for text in texts)
    assert FRONTEND.shape(one) != FRONTEND.shape(other)


def test_a_bound_that_is_another_one_has_no_values():
    old, reads = Source("p.sysml", MODEL.encode()), read(MODEL)
    new = Source("p.sysml", MODEL.replace("[8..9]", "[8..10]").encode())
    assert FRONTEND.values(old, new, reads.literals, {at for _, at in reads.asked}) is None
