"""Numbers in runs: each lies in its region, and constants have one number."""

import random
from fractions import Fraction

import pytest

from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.domains import make_region_domain
from sysmlc.logic.quantities import NumberReader, choose_numbers
from sysmlc.logic.regions import Cut, Interval, Regions, split_line
from sysmlc.support.units import measure


def make_variable(term, regions, constants=(), owner=Owner.ENVIRONMENT):
    name = term[0][0] if len(term) == 1 else " ".join(f"{factor}{key}" for key, factor in term)
    domain = make_region_domain(regions)
    return Variable(name, owner, domain, term=term, constants=constants)


def find_literals(variables, numbers):
    """Return the regions of numbers of the features, which the regions cover."""
    literals = {}
    for variable in variables:
        number = sum(factor * numbers[key] for key, factor in variable.term)
        index = variable.domain.regions.find(Fraction(number))
        literals[variable.name] = variable.domain.literals[index]
    return literals


def make_random_variables(generator, unit):
    base = measure(Fraction(0), unit)[1]
    terms = {}
    for _ in range(generator.randint(1, 4)):
        keys = sorted(generator.sample(["c", "d", "x", "y"], generator.choice([1, 2, 2, 3])))
        factors = [1, *(generator.choice([-2, -1, 1, Fraction(1, 2)]) for _ in keys[1:])]
        term = tuple(zip(keys, map(Fraction, factors), strict=True))
        numbers = [Fraction(generator.randint(-60, 60), 4) for _ in range(generator.randint(1, 3))]
        cuts = [Cut(number, generator.random() < 0.5) for number in numbers]
        terms[term] = Regions(split_line(cuts), base, symbol=unit)
    constants = ("c", "d")
    return [make_variable(term, regions, constants) for term, regions in terms.items()]


@pytest.mark.parametrize("unit", ["", "cm", "°C_abs"])
def test_each_number_lies_in_its_region(unit):
    generator = random.Random(32)
    for _ in range(40):
        variables = make_random_variables(generator, unit)
        constants = {key: Fraction(generator.randint(-40, 40), 4) for key in "cd"}
        steps = []
        for _ in range(5):
            changing = {key: Fraction(generator.randint(-40, 40), 4) for key in "xy"}
            steps.append(find_literals(variables, changing | constants))
        reader = NumberReader(variables)
        values = {"c": set(), "d": set()}
        for step, quantities in zip(steps, choose_numbers(variables, steps), strict=True):
            shown = {
                name: item for features in quantities.values() for name, item in features.items()
            }
            read = {
                name: reader.read(name, f"{item.number} {item.unit}".strip())
                for name, item in shown.items()
            }
            exact = {name: measure(item.number, unit)[0] for name, item in shown.items()}
            assert find_literals(variables, exact) == step
            for name in values.keys() & shown.keys():
                values[name].add(shown[name].number)
            if all(number is not None for number in read.values()):
                assert {v.name: region for v, region in reader.find_regions(read)} == step
        assert all(len(numbers) <= 1 for numbers in values.values())


def test_a_number_of_a_region_that_the_component_decides_is_not_known():
    regions = Regions(split_line([Cut(Fraction(5)), Cut(Fraction(5), is_above=True)]))
    level = make_variable((("level", Fraction(1)),), regions, owner=Owner.SYSTEM)
    steps = [{"level": "below_5"}, {"level": "at_5"}, {"level": "above_5"}]
    (first, second, third) = choose_numbers([level], steps)
    assert [first, third] == [{}, {}]
    assert str(second["level"]["level"]) == "5"


def test_regions_without_common_numbers_have_none():
    """The relation of many sums may be left out of a contract (512 cells)."""
    half = Regions((Interval(None, Cut(Fraction(0))), Interval(Cut(Fraction(0)), None)))
    x, y = (make_variable(((key, Fraction(1)),), half) for key in "xy")
    total = make_variable((("x", Fraction(1)), ("y", Fraction(1))), half)
    step = {"x": "below_0", "y": "below_0", total.name: "from_0"}
    assert choose_numbers([x, y, total], [step]) == ()


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("17", "290.15"),
        ("17 °C", "290.15"),
        ("17 [°C_abs]", "290.15"),
        ("290.15K", "290.15"),
        ("62.6 °F", "290.15"),
        ("-0.0", "273.15"),
        ("1e1", "283.15"),
        ("17 m", None),
        ("nan", None),
        ("inf", None),
        ("", None),
        ("1e999", None),
        ("0x11", None),
        ("17 18", None),
    ],
)
def test_a_text_has_a_number_in_the_unit_of_the_model(text, number):
    regions = Regions(split_line([Cut(Fraction("291.15"))]), "K", symbol="°C_abs")
    reader = NumberReader([make_variable((("temp", Fraction(1)),), regions)])
    assert reader.read("temp", text) == (None if number is None else Fraction(number))


def test_an_integer_has_no_fraction():
    regions = Regions(split_line([Cut(Fraction(5))]), is_integral=True)
    reader = NumberReader([make_variable((("count", Fraction(1)),), regions)])
    assert reader.read("count", "4.0") == 4
    assert reader.read("count", "4.5") is None
