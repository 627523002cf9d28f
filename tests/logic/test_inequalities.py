"""Systems of linear inequalities: solutions, systems without any, and numbers with few digits."""

from fractions import Fraction
from itertools import product
from random import Random

import pytest

from sysmlc.logic.inequalities import Inequality, choose_number, find_solution


def at_most(bound, *, is_strict=False, **coefficients):
    terms = {name: Fraction(number) for name, number in coefficients.items()}
    return Inequality(terms, Fraction(bound), is_strict)


def less(bound, **coefficients):
    return at_most(bound, is_strict=True, **coefficients)


def equal(bound, **coefficients):
    opposite = {name: -number for name, number in coefficients.items()}
    return at_most(bound, **coefficients), at_most(-bound, **opposite)


def holds(inequality, values):
    total = sum(c * values[name] for name, c in inequality.coefficients.items())
    return total < inequality.bound or (total == inequality.bound and not inequality.is_strict)


def show(solution):
    return {name: str(value) for name, value in solution.items()}


@pytest.mark.parametrize(
    ("system", "solution"),
    [
        ([], {}),
        ([at_most(3)], {}),
        ([less(18, x=1)], {"x": "0"}),
        ([less(-18, x=-1)], {"x": "20"}),
        ([*equal(18.5, x=1)], {"x": "37/2"}),
        ([less(0, a=-1, b=1)], {"a": "1", "b": "0"}),  # a > b
        ([less(-10, a=-1), less(5, b=1), at_most(0, a=-1, b=1)], {"a": "20", "b": "0"}),
        ([*equal(7, a=2, b=1), *equal(1, a=1, b=-1)], {"a": "8/3", "b": "5/3"}),
        ([less(2, x=1), less(1, x=1), less(0, x=-1), less(3, y=1)], {"x": "1/10", "y": "0"}),
        ([less(0, x=1, low=-1), less(0, low=1, high=-1)], {"high": "2", "low": "1", "x": "0"}),
    ],
)
def test_a_solution_has_few_digits(system, solution):
    found = find_solution(system)
    assert all(holds(inequality, found) for inequality in system)
    assert show(found) == solution


@pytest.mark.parametrize(
    "system",
    [
        [less(0)],
        [at_most(-1)],
        [less(0, x=1), less(0, x=-1)],
        [less(0, x=1), at_most(0, x=-1)],
        [less(-10, a=-1), less(5, b=1), less(0, a=1, b=-1)],  # a > 10, b < 5 and a < b
        [less(0, a=1, b=-1), less(0, b=1, c=-1), at_most(0, c=1, a=-1)],
        [*equal(7, a=2, b=2), less(-4, a=-1), at_most(0, b=-1)],
    ],
)
def test_a_system_may_have_no_solution(system):
    assert find_solution(system) is None


def make_system(random):
    numbers = [Fraction(number, 2) for number in range(-6, 7)]
    system = []
    for _ in range(random.randint(2, 6)):
        names = random.sample("abc", random.randint(1, 3))
        terms = {name: Fraction(random.choice((-2, -1, 1, 1, 3))) for name in names}
        row = Inequality(terms, random.choice(numbers), random.random() < 0.5)
        opposite = {name: -coefficient for name, coefficient in terms.items()}
        is_equality = random.random() < 0.2
        system += [row, Inequality(opposite, -row.bound, False)] if is_equality else [row]
    return system


def test_random_systems_have_a_solution_if_a_grid_has_one():
    """A system without solution has none on a grid; a solution satisfies its system."""
    random = Random(32)
    grid = [Fraction(number, 2) for number in range(-3, 4)]
    counts = [0, 0]
    for _ in range(150):
        system = make_system(random)
        solution = find_solution(system)
        counts[solution is None] += 1
        if solution is not None:
            assert all(holds(inequality, solution) for inequality in system), system
            continue
        for values in product(grid, repeat=3):
            point = dict(zip("abc", values, strict=True))
            assert not all(holds(inequality, point) for inequality in system), (system, point)
    assert min(counts) > 20


@pytest.mark.parametrize(
    ("interval", "number"),
    [
        ("(None, None)", "0"),
        ("(None, 18)", "0"),
        ("[-4, 0]", "0"),
        ("(0, None)", "1"),
        ("(0, 0.5)", "1/10"),
        ("(18, None)", "20"),
        ("[18, 22]", "20"),
        ("[18, 20)", "18"),
        ("(18, 19)", "181/10"),
        ("(99, 131]", "100"),
        ("(None, 0)", "-1"),
        ("(None, -273.15]", "-300"),
        ("(-1, -0.99)", "-991/1000"),
        ("[0.333, 0.333]", "333/1000"),
        ("(1000000, 1000000.001)", "10000000001/10000"),
    ],
)
def test_the_chosen_number_has_few_digits(interval, number):
    low, high = (None if text == "None" else Fraction(text) for text in interval[1:-1].split(", "))
    assert str(choose_number(low, interval[0] == "(", high, interval[-1] == ")")) == number


@pytest.mark.parametrize(
    "interval", [(2, False, 1, False), (1, True, 1, False), (1, False, 1, True)]
)
def test_an_empty_interval_has_no_number(interval):
    with pytest.raises(ValueError, match="no number between"):
        choose_number(*interval)
