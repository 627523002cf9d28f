"""Formulas about numbers: comparisons for people, and the same formula with finer regions."""

from fractions import Fraction
from itertools import product

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.logic import formats
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.domains import make_region_domain, regions_of
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.region_formulas import print_worded, split_regions, unite_regions, word_contract
from sysmlc.logic.regions import Cut, Interval, Regions, list_cuts, split_line


def make_number(name, conditions, term="", constants=(), **facts):
    """Return a number that is compared by *conditions*, such as ``<18 ==20``."""
    pairs = [
        (word.rstrip("-.0123456789"), Fraction(word.strip("<=>!"))) for word in conditions.split()
    ]
    cuts = [cut for op, number in pairs for cut in list_cuts(op, number)]
    regions = Regions(split_line(cuts, facts.pop("limits", Interval())), **facts)
    factors = [
        (key.strip("-"), Fraction(-1 if key[0] == "-" else 1)) for key in (term or name).split()
    ]
    return Variable(
        name,
        Owner.ENVIRONMENT,
        make_region_domain(regions),
        "",
        term=tuple(factors),
        constants=constants,
    )


KELVIN = {"unit": "K", "symbol": "°C_abs", "labels": ((Fraction("291.15"), "low"),)}
VARIABLES = (
    make_number("t", "<18 <22"),
    make_number("u", "==5"),
    make_number("kelvin", "<291.15 >295.15", **KELVIN),
    make_number(
        "percent", "<20", limits=Interval(Cut(Fraction(0)), Cut(Fraction(100), is_above=True))
    ),
    make_number("a_minus_b", "<-0.5 >0", "a -b"),
    make_number("sum", "<2", "a b"),
    make_number("low_minus_x", ">0 >2", "low -x", ("low",)),
)
DOMAINS = {variable.name: variable.domain for variable in VARIABLES}


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        # Neighbouring regions are one comparison.
        ("t=below_18", "t < 18"),
        ("t=below_18 | t=_18_to_22", "t < 22"),
        ("t=_18_to_22 | t=from_22", "t >= 18"),
        ("t=_18_to_22", "18 <= t < 22"),
        ("t=below_18 | t=from_22", "t < 18 | t >= 22"),
        ("!(t=below_18)", "t >= 18"),
        ("t!=below_18 & t!=from_22", "18 <= t < 22"),
        ("u=at_5", "u == 5"),
        ("u!=at_5", "u != 5"),
        ("u=below_5 | u=above_5", "u != 5"),
        # The words and the unit of the author; Celsius is stored in kelvin.
        ("kelvin=below_low", "kelvin < low"),
        ("kelvin=above_22_C", "kelvin > 22 °C"),
        # A bound of all values is not repeated.
        ("percent=_0_to_20", "percent < 20"),
        ("percent=_20_to_100", "percent >= 20"),
        # A difference is compared by sides.
        ("a_minus_b=above_0", "a > b"),
        ("a_minus_b=below_minus_0_5", "a < b - 0.5"),
        ("a_minus_b=minus_0_5_to_0", "b - 0.5 <= a <= b"),
        ("sum=below_2", "a + b < 2"),
        # A number is compared with a constant, not the other way round.
        ("low_minus_x!=up_to_0", "x < low"),
        ("low_minus_x=above_2", "x < low - 2"),
        ("low_minus_x'=_0_to_2", "low - 2 <= x' < low"),
        # The rest of the formula stays.
        ("G (t'=below_18 -> t=below_18 | u=at_5 | t=_18_to_22)", "G (t' < 18 -> t < 22 | u == 5)"),
        ("t'=t", "t'=t"),
        ("t=below_18 & t=from_22", "false"),
    ],
)
def test_people_read_comparisons(formula, text):
    assert print_worded(parse_formula(formula, DOMAINS), VARIABLES) == text


def test_the_text_of_a_conjunct_has_comparisons_and_its_formula_has_literals():
    contract = make_contract(VARIABLES, "t=below_18 -> t'!=from_22")
    (conjunct,) = word_contract(contract).guarantees
    assert print_formula(conjunct.formula) == "t=below_18 -> t'!=from_22"
    assert print_formula(conjunct.wording) == "G (t < 18 -> t' < 22)"


def make_contract(variables, *formulas):
    domains = {variable.name: variable.domain for variable in variables}
    guarantees = (Conjunct(parse_formula(text, domains), Class.SAFETY, "") for text in formulas)
    return Contract("C", "", tuple(variables), (), tuple(guarantees))


@pytest.mark.parametrize(
    "formula", ["t=below_18", "t!=_18_to_22", "t'=t", "s=t", "s!=t' | s=from_22", "below_18=t"]
)
def test_a_formula_with_finer_regions_has_the_same_truth(formula):
    """For all values of two numbers in two steps; only one of them is cut at 20 and 25, too."""
    coarse = make_number("t", "<18 <22"), make_number("s", "<18 <22")
    (t, s), contract = coarse, make_contract(coarse, formula)
    finer = unite_regions([t.domain, make_number("t", "<20 >25").domain])
    split = split_regions(contract, {"t": finer})
    numbers = [Fraction(number) for number in (17, 18, 19, 20, 22, 23, 25, 26)]
    for now, then in product(product(numbers, repeat=2), repeat=2):
        assert [is_true(contract.guarantees[0].formula, *locate((t, s), now, then))] == [
            is_true(split.guarantees[0].formula, *locate(split.variables, now, then))
        ]


def locate(variables, *steps):
    """Return the literals of numbers in each step."""
    return [
        {
            variable.name: variable.domain.literals[regions_of(variable.domain).find(number)]
            for variable, number in zip(variables, step, strict=True)
        }
        for step in steps
    ]


def test_regions_outside_of_the_limits_of_both_stay_outside():
    low = make_number("x", "<5", limits=Interval(Cut(Fraction(0)), Cut(Fraction(10))))
    high = make_number("x", "<8", limits=Interval(Cut(Fraction(4)), None))
    assert unite_regions([low.domain, high.domain]).regions.list_conditions("x") == [
        *("0 <= x < 4", "4 <= x < 5", "5 <= x < 8", "8 <= x < 10", "x >= 10"),
    ]
    own = split_regions(make_contract([low]), {"x": unite_regions([low.domain, high.domain])})
    assert regions_of(own.variables[0].domain).list_conditions("x")[-1] == "8 <= x < 10"


def test_regions_in_different_units_and_other_values_are_not_united():
    metres = make_number("x", "<5", unit="m").domain
    assert unite_regions([metres, make_number("x", "<5").domain]) is None
    assert unite_regions([metres, make_contract([]).variables and None]) is None


# -- files -----------------------------------------------------------------------------------------


def read(text):
    sink = Sink()
    contracts = formats.read(text, "C.contract.json", sink)
    return contracts, [diagnostic.message for diagnostic in sink]


def test_a_contract_file_keeps_the_numbers():
    numbers = (
        *VARIABLES,
        make_number("third", f"<{Fraction(1, 2)}", "low high", ("low", "high"), is_integral=True),
    )
    contract = make_contract(numbers, "t=below_18 -> t'!=from_22")
    text = formats.write(contract, "contract")
    assert '"format": "sysmlc-contract/2"' in text
    assert read(text) == ((contract,), [])


def test_a_contract_without_numbers_is_written_in_the_first_version():
    assert '"format": "sysmlc-contract/1"' in formats.write(make_contract([]), "contract")


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('"below": "18"', '"below": "23"', "the intervals of 't' are not one for each literal"),
        ('"below": "18"', '"below": "18", "up_to": "18"', "one of 'below' and 'up_to'"),
        ('"below": "18"', '"below": "1/0"', "1/0"),
        ('"below": "18"', '"until": "18"', "until"),
        (
            '"type": [\n        "below_18",',
            '"type": [\n        "less", "below_18",',
            "not one for each",
        ),
    ],
)
def test_faulty_numbers_are_reported(old, new, fault):
    text = formats.write(make_contract(VARIABLES[:1]), "contract")
    assert old in text
    contracts, (message,) = read(text.replace(old, new, 1))
    assert contracts == ()
    assert fault in message
