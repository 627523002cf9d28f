"""Value specifications as JSON values and text, however deep and odd (UML 2.5.1 clause 8)."""

import pytest
from reading_xmi import papyrus, read

RULE = '<ownedRule xmi:id="r">{}</ownedRule>'
DEFAULT = (
    '<packagedElement xmi:type="uml:Class" xmi:id="k"><ownedAttribute xmi:id="r">{}'
    "</ownedAttribute></packagedElement>"
)


def body(specification):
    return read(papyrus(RULE.format(specification))).graph["r"].attrs["body"]


def default(type_name, value):
    literal = f'<defaultValue xmi:type="uml:{type_name}" value="{value}"/>'
    return read(papyrus(DEFAULT.format(literal))).graph["r"].attrs["default"]


def test_an_expression_is_written_with_its_operands():
    assert (
        body(
            '<specification xmi:type="uml:Expression" symbol="and">'
            '<operand xmi:type="uml:Expression" symbol="&lt;">'
            '<operand xmi:type="uml:OpaqueExpression"><body>level</body></operand>'
            '<operand xmi:type="uml:LiteralInteger" value="7"/></operand>'
            '<operand xmi:type="uml:LiteralBoolean" value="true"/></specification>'
        )
        == "((level < 7) and true)"
    )


@pytest.mark.parametrize(
    ("symbol", "operands", "text"),
    [
        ("and", "xy", "(x and y)"),
        ("or", "xyz", "(x or y or z)"),
        ("implies", "xy", "(x implies y)"),
        ("not", "x", "not(x)"),
        ("-", "x", "-(x)"),
        ("max", "xy", "max(x, y)"),
        ("and", "x", "and(x)"),
    ],
)
def test_words_of_logic_stand_between_their_operands(symbol, operands, text):
    inside = "".join(
        f'<operand xmi:type="uml:OpaqueExpression"><body>{operand}</body></operand>'
        for operand in operands
    )
    assert (
        body(f'<specification xmi:type="uml:Expression" symbol="{symbol}">{inside}</specification>')
        == text
    )


@pytest.mark.parametrize(
    ("type_name", "feature"), [("InstanceValue", "instance"), ("ElementValue", "element")]
)
def test_a_slot_may_refer_to_an_element(type_name, feature):
    graph = read(
        papyrus(
            '<packagedElement xmi:type="uml:InstanceSpecification" xmi:id="i"><slot xmi:id="s">'
            f'<value xmi:type="uml:{type_name}" xmi:id="v"><{feature} xmi:idref="k"/></value>'
            '</slot></packagedElement><packagedElement xmi:type="uml:Class" xmi:id="k" name="K"/>'
        )
    ).graph
    assert [(r.source, r.edge, r.target) for r in graph.pending] == [("s", "references", "k")]


@pytest.mark.parametrize("depth", [10, 490])
def test_expressions_may_nest_as_deep_as_a_file_may(depth):
    inside = '<operand xmi:type="uml:Expression" symbol="not">' * depth + "</operand>" * depth
    text = body(f'<specification xmi:type="uml:Expression" symbol="not">{inside}</specification>')
    assert text == "not(" * depth + "not" + ")" * depth


def test_times_may_nest_as_deep_as_a_file_may():
    inside = '<expr xmi:type="uml:TimeExpression">' * 480 + "</expr>" * 480
    leaf = '<expr xmi:type="uml:LiteralInteger" value="5"/>'
    nested = inside.replace("></expr>", f">{leaf}</expr>", 1)
    assert body(f'<specification xmi:type="uml:TimeExpression">{nested}</specification>') == "5"


@pytest.mark.parametrize(
    ("type_name", "written", "value"),
    [
        ("LiteralInteger", "-3", -3),
        ("LiteralInteger", "+3", 3),
        ("LiteralInteger", "1_000", "1_000"),
        ("LiteralInteger", "\u0663", "\u0663"),
        ("LiteralInteger", "9" * 5000, "9" * 5000),
        ("LiteralInteger", "n", "n"),
        ("LiteralReal", "2.5e1", 25.0),
        ("LiteralReal", "INF", "INF"),
        ("LiteralReal", "NaN", "NaN"),
        ("LiteralReal", "1e999", "1e999"),
        ("LiteralUnlimitedNatural", "*", "*"),
        ("LiteralUnlimitedNatural", "-1", "*"),
        ("LiteralBoolean", "true", True),
        ("LiteralString", "", ""),
    ],
)
def test_a_literal_is_a_json_value_or_stays_text(type_name, written, value):
    literal = default(type_name, written)
    assert (literal, type(literal)) == (value, type(value))


@pytest.mark.parametrize(("written", "meant"), [("true", True), ("1", True), ("false", False)])
def test_truth_is_written_in_two_ways(written, meant):
    port = f'<ownedAttribute xmi:type="uml:Port" xmi:id="p" isConjugated="{written}"/>'
    classed = f'<packagedElement xmi:type="uml:Class" xmi:id="c">{port}</packagedElement>'
    assert read(papyrus(classed)).graph["p"].attrs.get("conjugated", False) is meant
    assert default("LiteralBoolean", written) is meant


@pytest.mark.parametrize(
    "comment",
    [
        '<ownedComment xmi:id="c" body="why" annotatedElement="v"/>',
        '<ownedComment xmi:id="c"><body>why</body><annotatedElement xmi:idref="v"/></ownedComment>',
    ],
)
def test_a_comment_on_a_value_belongs_to_the_element_with_the_value(comment):
    value = f'<defaultValue xmi:type="uml:LiteralInteger" xmi:id="v" value="3">{comment}'
    owned = f'<ownedAttribute xmi:id="p">{value}</defaultValue></ownedAttribute>'
    model = f'<packagedElement xmi:type="uml:Class" xmi:id="k">{owned}</packagedElement>'
    reading = read(papyrus(model))
    assert reading.graph["c"].owner == "p"
    assert reading.graph["c"].attrs == {"body": "why"}
    assert [r.target for r in reading.graph.pending] == ["p"]
    assert reading.findings == []
