"""Expressions in their context: domains of properties, and elaboration to formulas."""

from functools import partial

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.expressions.context import find_symbol as context_symbol
from sysmlc.logic.expressions.elaboration import elaborate_condition
from sysmlc.logic.expressions.parsing import parse_expression
from sysmlc.logic.expressions.symbols import ElaborationError, Fault, Symbol
from sysmlc.logic.formula import Const, Var
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline

CLASS = """\
Class g "General"
  Property g.x "inherited"
    -> typed-by bool
Class c "C"
  -> specializes g
  Property c.b "open"
    -> typed-by bool
  Property c.n "bay"{default}
    -> typed-by count
  Property c.m "mode" default="Mode::hand"
    -> typed-by mode
  Property c.s "serial"
    -> typed-by string
  Property c.u "untyped" default=false
{members}DataType bool "Boolean" external=true href="lib#Boolean"
DataType int "Integer"
DataType count "Count"
  -> specializes int
DataType string "String"
Enumeration mode "Mode"
  EnumerationLiteral mode.a "full auto"
  EnumerationLiteral mode.h "hand"
"""


def read_features(members="", default=""):
    """Return the features of class C, with *members* and a default value of 'bay' added."""
    graph = parse_text(CLASS.replace("{members}", members).replace("{default}", default))
    return context_of(graph, graph["c"]).features


@pytest.mark.parametrize(
    "name",
    [
        *("Integer", "int", "Natural", "Positive", "UnlimitedNatural", "EInt", "short", "long"),
        "byte",
    ],
)
def test_names_of_integer_types_are_those_of_uml_sysml_ecore_and_java(name):
    text = f'Class c "C"\n  Property p "p"\n    -> typed-by t\nDataType t "{name}"\n'
    graph = parse_text(text)
    assert isinstance(context_of(graph, graph["c"]).features["p"].domain, IntegerDomain)


def test_domains_come_from_types():
    features = read_features()
    assert {name: feature.domain for name, feature in features.items()} == {
        "bay": IntegerDomain(0, 15),
        "inherited": BooleanDomain(),
        "mode": EnumerationDomain(("full_auto", "hand")),
        "open": BooleanDomain(),
        "serial": None,
        "untyped": BooleanDomain(),
    }
    assert features["bay"].is_assumed
    assert features["mode"].default == "hand"


@pytest.mark.parametrize(
    ("body", "low", "high"),
    [
        ("0 <= bay <= 7", 0, 7),
        ("bay >= 1 and bay < 5", 1, 4),
        ("5 > bay && bay > -2", -1, 4),
        ("bay == 3", 3, 3),
        ("self.bay >= 0 and bay <= 2", 0, 2),
    ],
)
def test_ranges_come_from_constraints(body, low, high):
    features = read_features(members=f'  Constraint k body="{body}"\n')
    assert features["bay"].domain == IntegerDomain(low, high)


def test_only_the_open_bound_of_a_constraint_is_assumed():
    features = read_features(members='  Constraint k body="bay >= 3 and bay * bay > 9"\n')
    assert features["bay"].domain == IntegerDomain(3, 15)
    assert features["bay"].is_assumed


def test_zero_is_a_lower_bound_of_unsigned_types():
    constraint = '  Constraint k body="bay <= 3 and bay * bay < 9"\n'
    model = CLASS.replace("{members}", constraint).replace("{default}", "")
    natural, integer = model.replace("Integer", "Natural"), model
    features = [
        context_of(graph, graph["c"]).features["bay"]
        for graph in map(parse_text, (natural, integer))
    ]
    assert [feature.domain for feature in features] == [IntegerDomain(0, 3), IntegerDomain(0, 3)]
    assert [feature.is_assumed for feature in features] == [False, True]


def test_ranges_come_from_tagged_values_of_the_type():
    graph = parse_text(
        CLASS.replace("{members}", "").replace("{default}", "")
        + 'Application t stereotype="Range" tag.min="2" tag.max="4"\n  -> subject count\n'
    )
    assert context_of(graph, graph["c"]).features["bay"].domain == IntegerDomain(2, 4)


def test_an_assumed_range_contains_the_default_value():
    features = read_features(default=" default=40")
    assert features["bay"].domain == IntegerDomain(0, 40)


@pytest.mark.parametrize(
    ("guard", "low", "high"),
    [
        ("bay < 20", 0, 20),
        ("open and self.bay > 20", 0, 21),
        ("20 <= bay", 0, 20),
        ("0 <= bay <= 20", -1, 21),
        ("not (bay == -1 or bay == 20)", -1, 20),
        ("bay < 300", 0, 15),
        ("bay < 4 * 5", 0, 15),
        ("until bay >= 20 holds", 0, 15),
    ],
)
def test_an_assumed_range_reaches_beyond_the_thresholds_of_guards(guard, low, high):
    machine = (
        f'  StateMachine s\n    Region r\n      Transition t guard="{guard}"\n'
        '  Constraint k body="bay * bay >= 0"\n'
    )
    graph = parse_text(CLASS.replace("{members}", machine).replace("{default}", ""))
    pipeline.load("expressions").run(graph, Sink())
    features = context_of(graph, graph["c"], behaviour=graph["s"]).features
    assert features["bay"].domain == IntegerDomain(low, high)


# -- elements of the same name in several packages ---------------------------------------------

PACKAGES = """\
Package near "Near"
  Enumeration near.mode "Mode"
    EnumerationLiteral near.off "off" value=1
    EnumerationLiteral near.slow "slow" value=2
  Enumeration near.drive "Drive"
    EnumerationLiteral near.off2 "off"
    EnumerationLiteral near.slow2 "slow"
  Instance near.limit "LIMIT" value=3
Package far "Far"
  Enumeration far.mode "Mode"
    EnumerationLiteral far.slow "slow" value=5
    EnumerationLiteral far.off "off" value=6
    EnumerationLiteral far.auto "auto"
  Instance far.limit "LIMIT" value=5
Package p "P"
  Class c "C"
    Property a "a"
      -> typed-by near.mode
    Property b "b"
      -> typed-by far.mode
    Property d "d"
      -> typed-by near.drive
    Property n "n"
      -> typed-by int
    StateMachine s
      Region r
        Transition t guard="{guard}"
      {scope}
DataType int "Integer"
"""
CONSTANTS = """\
Instance normal "NORMAL" value="slow" value_instance="near.slow"
Instance rest "REST" value="slow" value_instance="near.slow2"
Instance sleep "SLEEP" value="slow" value_instance="near.slow2"
"""
IMPORT = 'Import i subkind="package"\n        -> references '


def print_guard(guard, scope=""):
    """Return the formula of a guard in a model with two enumerations and two constants."""
    graph = parse_text(PACKAGES.replace("{guard}", guard).replace("{scope}", scope))
    pipeline.load("expressions").run(graph, Sink())
    context = context_of(graph, graph["c"], behaviour=graph["s"])
    tree = graph["t"].attrs["guard"].tree
    return print_formula(elaborate_condition(tree, partial(context_symbol, context)))


@pytest.mark.parametrize(
    ("guard", "formula"),
    [
        ("Near::Mode::slow == a and Far::Mode::slow == b", "slow=a & slow=b"),
        ("Mode::slow == a and Mode::slow == b", "slow=a & slow=b"),
        ("Mode::auto == b", "auto=b"),
        (
            "(if n == 0 ? Far::Mode::off else Far::Mode::auto) == b",
            "n=at_0 & off=b | !n=at_0 & auto=b",
        ),
        ("n == Near::Mode::slow and n != Far::Mode::slow", "n=2 & n!=5"),
        (
            "n >= Near::LIMIT and n <= Far::LIMIT",
            "(n=LIMIT_to_6 | n=from_6) & (n=below_LIMIT | n=LIMIT_to_6)",
        ),
    ],
)
def test_enumerations_and_constants_of_one_name_are_distinct(guard, formula):
    assert print_guard(guard) == formula


@pytest.mark.parametrize(("package", "number", "limit"), [("near", 2, 3), ("far", 5, 5)])
def test_an_import_decides_which_of_them_a_name_denotes(package, number, limit):
    guard = "n == Mode::slow and n < LIMIT"
    assert print_guard(guard, IMPORT + package) == f"n={number} & n<{limit}"


def test_a_literal_of_another_enumeration_is_a_type_mismatch():
    for guard in ("a == Far::Mode::off", "Far::Mode::off == a"):
        with pytest.raises(ElaborationError, match="is one of") as caught:
            print_guard(guard)
        assert caught.value.fault is Fault.TYPE


@pytest.mark.parametrize(
    "guard",
    [
        "a == d",
        "Drive::off == a",
        "a == Near::Drive::off",
        "(if n == 0 ? a else d) == a",
        "(if n == 0 ? Mode::off else Drive::off) == a",
    ],
)
def test_so_is_a_value_of_another_enumeration_with_the_same_literals(guard):
    """The values of two enumerations are never equal, whatever their names are."""
    with pytest.raises(ElaborationError, match=r"'Near::(Drive|Mode)', not of 'Near::") as caught:
        print_guard(guard)
    assert caught.value.fault is Fault.TYPE


def test_a_literal_of_several_enumerations_has_no_number():
    with pytest.raises(ElaborationError, match="'Mode::slow' is a literal of several enum"):
        print_guard("n == Mode::slow")


# -- elaboration -------------------------------------------------------------------------------

SYMBOLS = {
    "open": Symbol(Var("open"), BooleanDomain()),
    "bay": Symbol(Var("bay"), IntegerDomain(0, 7)),
    "mode": Symbol(Var("mode"), EnumerationDomain(("full", "hand"))),
    "limit": Symbol(Const(3), IntegerDomain(0, 7)),
    "serial": Symbol(Var("serial"), None),
}


def find_symbol(name, _element):
    return SYMBOLS.get(name)


@pytest.mark.parametrize(
    ("text", "formula"),
    [
        ("open", "open"),
        ("not open or bay > limit", "!open | bay>3"),
        ("mode == hand", "mode=hand"),
        ("hand == mode", "mode=hand"),
        ("mode != Mode::full", "mode!=full"),
        ("open == true", "open"),
        ("(if open ? bay else bay + 1) > 2", "open & bay>2 | !open & bay + 1>2"),
        ("open xor bay == 1", "!(open <-> bay=1)"),
        ("self.open implies this.bay <= 6", "open -> bay<=6"),
    ],
)
def test_expressions_become_formulas(text, formula):
    printed = print_formula(elaborate_condition(parse_expression(text), find_symbol))
    assert printed in (formula, formula.replace("mode=hand", "hand=mode"))


@pytest.mark.parametrize(
    ("text", "fault", "name"),
    [
        ("opne", Fault.UNKNOWN, "opne"),
        ("bay", Fault.TYPE, "bay"),
        ("open and bay", Fault.TYPE, "bay"),
        ("bay == hand", Fault.UNKNOWN, "hand"),
        ("mode == bay", Fault.TYPE, "bay"),
        ("mode == open", Fault.TYPE, "open"),
        ("bay == 9", Fault.OUTSIDE, "9"),
        ("bay > 20", Fault.OUTSIDE, "20"),
        ('mode == "fast"', Fault.OUTSIDE, "fast"),
        ("serial == serial", Fault.UNSUPPORTED, "serial"),
        ("free(bay)", Fault.UNSUPPORTED, "free(bay)"),
        ("bay > 1.5", Fault.UNSUPPORTED, "1.5"),
    ],
)
def test_an_expression_without_a_formula_is_rejected_with_the_reason(text, fault, name):
    with pytest.raises(ElaborationError) as caught:
        elaborate_condition(parse_expression(text), find_symbol)
    assert (caught.value.fault, caught.value.name) == (fault, name)


COMPUTED = ' default="{}" default_language=""'


def test_a_constant_expression_as_default_value_is_evaluated():
    features = read_features(default=COMPUTED.format("2 + 1"))
    assert (features["bay"].default, features["bay"].invalid_default) == (3, "")
    assert read_features(default=COMPUTED.format("4 * 5"))["bay"].domain == IntegerDomain(0, 20)


def test_a_default_value_that_depends_on_features_is_not_checked():
    for text in ("bay2 + 1", "mode", "not mode"):
        bay = read_features(default=COMPUTED.format(text))["bay"]
        assert (bay.default, bay.invalid_default) == (None, "")


@pytest.mark.parametrize(
    ("value", "default", "invalid"),
    [
        ('"Near::Mode::slow" default_language=""', "slow", ""),
        ('"slow" default_instance="near.slow"', "slow", ""),
        ('"NORMAL" default_instance="normal"', "slow", ""),
        ('"Near::Drive::slow" default_language=""', None, "Near::Drive::slow"),
        ('"slow" default_instance="near.slow2"', None, "Near::Drive::slow"),
        ('"REST" default_instance="rest"', None, "Near::Drive::slow"),
        ('"SLEEP" default_language=""', None, "Near::Drive::slow"),
    ],
)
def test_a_literal_of_another_enumeration_is_no_default_value(value, default, invalid):
    """Neither is it by a constant: NORMAL has the type Mode, REST and SLEEP have the type Drive."""
    text = PACKAGES.replace('Property a "a"', f'Property a "a" default={value}')
    text = text.replace("{guard}", "").replace("{scope}", "") + CONSTANTS
    graph = parse_text(text)
    pipeline.load("expressions").run(graph, Sink())
    feature = context_of(graph, graph["c"]).features["a"]
    assert (feature.default, feature.invalid_default) == (default, invalid)


def test_a_name_that_is_no_feature_is_no_default_value():
    bay = read_features(default=COMPUTED.format("missing"))["bay"]
    assert bay.invalid_default == "missing"


def test_a_bound_next_to_the_range_is_no_fault():
    assert print_formula(elaborate_condition(parse_expression("bay < 8"), find_symbol)) == "bay<8"
