"""Quotient, merging, conjunction and composition of contracts: examples, and algebraic laws.

Spot decides the laws on random contracts, so that they do not rest on the engine that simplifies
the results.
"""

import random

import pytest
import spot
from contracts_in_lines import parse_contract
from msgspec.structs import replace

from spot_formulas import print_for_spot
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Apply, Op
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.synthesis import Manager
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.algebra.operations import (
    OwnerError,
    align_domains,
    compose,
    conjoin,
    divide,
    merge,
)
from sysmlc.synthesis.algebra.refinement import find_refinement_failures

LINE = """
    env order: bool
    sys filled: bool
    sys packed: bool
    assume always order -> !order'
    promise always order -> filled'
    promise always filled -> packed'
"""
FILLER = """
    env order: bool
    sys filled: bool
    assume always order -> !order'
    promise always order -> filled'
"""


def show(contract):
    """Return the contract in the lines of ``contracts_in_lines``, without domains."""
    words = {Class.INIT: "at first ", Class.SAFETY: "always ", Class.LIVENESS: "recurs "}
    sides = {"assume": contract.assumptions, "promise": contract.guarantees}
    return [
        *(f"{variable.owner} {variable.name}" for variable in contract.variables),
        *(
            f"{side} {words.get(conjunct.class_, '')}{print_formula(conjunct.formula)}"
            for side, conjuncts in sides.items()
            for conjunct in conjuncts
        ),
    ]


def operate(operation, first, second):
    return operation(parse_contract(first, "A"), parse_contract(second, "B"), Manager)


# -- examples --------------------------------------------------------------------------------------


def test_the_quotient_promises_what_the_part_leaves_open():
    quotient = operate(divide, LINE, FILLER)
    assert quotient.component == "A_without_B"
    assert show(quotient) == [
        *("env order", "env filled", "sys packed"),
        "assume always order -> !order'",
        "assume always order -> filled'",
        "promise always filled -> packed'",
    ]


def test_the_quotient_has_to_satisfy_what_only_the_part_assumes():
    careful = f"{FILLER}\nenv air: bool\nassume always air"
    lines = show(operate(divide, LINE, careful))
    assert lines[:4] == ["env order", "env filled", "sys packed", "sys air"]
    assert "assume G air -> G (order -> filled')" in lines
    assert "promise always air" in lines


def test_a_part_that_does_everything_leaves_nothing_to_promise():
    assert operate(divide, LINE, LINE).guarantees == ()


def test_a_part_does_not_decide_an_input_of_the_system():
    with pytest.raises(OwnerError, match="'order' is an output of 'B' and an input of 'A'"):
        operate(divide, LINE, "sys order: bool")


def test_merged_viewpoints_assume_and_promise_what_both_do():
    speed = "env go: bool\nsys v: 0..3\nassume recurs go\npromise always !go -> v'=0"
    noise = "env go: bool\nenv night: bool\nsys v: 0..3\npromise always night -> v'<2"
    assert show(operate(merge, speed, noise)) == [
        *("env go", "sys v", "env night"),
        "assume recurs go",
        *("promise always !go -> v'=0", "promise always night -> v'<2"),
    ]


def test_the_conjunction_promises_each_side_under_its_own_assumption():
    calm = "env a: bool\nsys x: bool\nassume always a\npromise always x"
    wild = "env b: bool\nsys x: bool\nassume always b\npromise recurs !x"
    assert show(operate(conjoin, calm, wild))[3:] == [
        "assume G a | G b",
        "promise G a -> G x",
        "promise G b -> G F !x",
    ]


def test_the_conjunction_assumes_the_weaker_side():
    narrow = (
        "env a: bool\nenv b: bool\nsys x: bool\nassume always a\nassume recurs b\npromise always x"
    )
    wide = "env a: bool\nsys x: bool\nassume always a\npromise recurs x"
    assert show(operate(conjoin, narrow, wide))[3:] == [
        *("assume always a", "promise G F b -> G x", "promise recurs x"),
    ]


def test_a_composition_assumes_what_no_part_guarantees():
    packer = "env filled: bool\nsys packed: bool\nassume recurs filled\npromise recurs packed"
    filler = "env order: bool\nsys filled: bool\nassume recurs order\npromise recurs filled"
    assert show(operate(compose, filler, packer)) == [
        *("env order", "sys filled", "sys packed"),
        *("assume recurs order", "promise recurs filled", "promise recurs packed"),
    ]


def test_parts_do_not_decide_the_same_output():
    with pytest.raises(OwnerError, match="'filled' is an output of 'A' and of 'B'"):
        operate(compose, FILLER, FILLER)


def test_a_wider_range_of_an_input_is_accepted_and_a_narrower_one_is_assumed():
    wide, narrow = parse_contract("env n: 0..5"), parse_contract("env n: 1..3")
    assert list(find_refinement_failures(*align_domains(wide, narrow), Manager)) == []
    (failure,) = find_refinement_failures(*align_domains(narrow, wide), Manager)
    assert (failure.is_assumption, print_formula(failure.conjunct.formula)) == (
        True,
        "n>=1 & n<=3",
    )


def test_a_narrower_set_of_values_of_an_output_is_guaranteed():
    wide, narrow = parse_contract("sys c: red green"), parse_contract("sys c: green")
    assert list(find_refinement_failures(*align_domains(narrow, wide), Manager)) == []
    (failure,) = find_refinement_failures(*align_domains(wide, narrow), Manager)
    assert failure.trace.steps[0]["c"] == "red"


def test_domains_of_different_kinds_have_no_common_domain():
    with pytest.raises(DomainError, match="'n'"):
        align_domains(parse_contract("env n: 0..5"), parse_contract("env n: bool"))


# -- numbers with different thresholds -------------------------------------------------------------

WARNER = """
    env temp: number 18
    sys warm: bool
    promise always temp=from_18 -> warm'
"""
FAN = """
    env temp: number 22
    sys fan: bool
    promise always temp=from_22 -> fan'
"""
HEATED_TO_18 = "sys temp: number 18\npromise always temp=from_18"
HEATED_TO_22 = "sys temp: number 22\npromise always temp=from_22"


def does_refine(concrete, abstract):
    """Whether a contract refines another one."""
    pair = align_domains(parse_contract(concrete, "C"), parse_contract(abstract, "A"))
    return not list(find_refinement_failures(*pair, Manager))


def test_the_composition_tells_the_thresholds_of_both_apart():
    composition = operate(compose, WARNER, FAN)
    assert show(composition)[3:] == [
        "promise always temp=_18_to_22 | temp=from_22 -> warm'",
        "promise always temp=from_22 -> fan'",
    ]
    temp = composition.variables[0].domain
    assert temp.literals == ("below_18", "_18_to_22", "from_22")
    assert temp.regions.list_conditions("temp") == ["temp < 18", "18 <= temp < 22", "temp >= 22"]


@pytest.mark.parametrize(
    ("concrete", "abstract"),
    [
        # Who promises more refines who promises less, and not the other way round.
        (WARNER, WARNER.replace("18", "22")),
        (HEATED_TO_22, HEATED_TO_18),
        # What an input assumes is the other way round.
        (
            "env temp: number 18\nassume always temp=from_18",
            "env temp: number 22\nassume always temp=from_22",
        ),
        (
            "sys t: number 18\npromise always t=below_18 -> t'=from_18",
            "sys t: number 10 18\npromise always t=below_10 -> t'=from_18",
        ),
    ],
)
def test_thresholds_of_two_contracts_are_compared(concrete, abstract):
    assert does_refine(concrete, abstract)
    assert not does_refine(abstract, concrete)


def test_equal_regions_are_not_equal_numbers():
    """A temperature that stays on one side of 18 may still pass 22."""
    stays_at_18 = "sys temp: number 18\npromise always temp'=temp"
    stays_at_22 = "sys temp: number 22\npromise always temp'=temp"
    assert not does_refine(stays_at_18, stays_at_22)
    assert not does_refine(stays_at_22, stays_at_18)
    assert does_refine("sys temp: number 18 22\npromise always temp'=temp", stays_at_18)


def test_a_constant_stays_in_its_finer_region():
    def read(cut):
        contract = parse_contract(f"env low: number {cut}\nassume always low'=low")
        return replace(contract, variables=(replace(contract.variables[0], constants=("low",)),))

    first, second = align_domains(read(18), read(22))
    assert [print_formula(item.formula) for item in first.assumptions] == ["low'=low"]
    assert [print_formula(item.formula) for item in second.assumptions] == ["low'=low"]


COUNTED = """
    sys level: 0..7
    promise at first level=0
    promise always level'=level | level'=level + 1 | level' + 1=level
"""


@pytest.mark.parametrize(
    ("demand", "is_met"),
    [
        ("promise always level!=from_9", True),
        ("promise always level=_5_to_9 -> level'=_5_to_9 | level'=_3_to_5", True),
        ("promise always level=below_3", False),
        ("promise at first level=below_3", True),
        ("promise always level=below_3 -> level'=below_3", False),
        ("promise always level=_3_to_5 -> level'!=from_9", True),
    ],
)
def test_a_range_is_compared_with_thresholds(demand, is_met):
    """One contract counts a level from 0 to 7, the other one only compares it."""
    assert does_refine(COUNTED, f"sys level: number 3 5 9 Integer\n{demand}") is is_met


def test_a_large_range_and_reals_are_not_compared_with_thresholds():
    for level in ("number 3", "number 3 m"):
        with pytest.raises(DomainError, match=r"'level' has different values"):
            operate(compose, COUNTED, f"env level: {level}")
    with pytest.raises(DomainError, match=r"\(0..200 and numbers without a unit\)"):
        operate(compose, COUNTED.replace("0..7", "0..200"), "env level: number 3 Integer")


def test_numbers_in_different_units_are_not_compared():
    message = r"'temp' has different values .* \(numbers in K and numbers without a unit\)"
    with pytest.raises(DomainError, match=message):
        operate(compose, WARNER.replace("18", "18 K").replace("from_18 K", "from_18_K"), FAN)
    with pytest.raises(DomainError, match=r"\(numbers without a unit and Boolean\)"):
        operate(compose, WARNER, "env temp: bool")


# -- laws on random contracts ----------------------------------------------------------------------

NAMES = {"a": Owner.ENVIRONMENT, "x": Owner.SYSTEM, "y": Owner.SYSTEM}


def draw_formula(die, depth=2):
    if depth == 0 or die.random() < 0.25:
        return f.var(die.choice(list(NAMES)))
    unary = (Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY)
    binary = (Op.AND, Op.OR, Op.IMPLIES, Op.UNTIL)
    if die.random() < 0.5:
        return Apply(die.choice(unary), (draw_formula(die, depth - 1),))
    return Apply(die.choice(binary), (draw_formula(die, depth - 1), draw_formula(die, depth - 1)))


def draw_conjunct(die):
    class_ = die.choice(list(Class))
    if class_ is Class.OTHER:
        return Conjunct(draw_formula(die), class_, "")
    left, right = f.var(die.choice(list(NAMES))), f.var(die.choice(list(NAMES)))
    if class_ is Class.SAFETY and die.random() < 0.6:
        right = f.prime(right)
    return Conjunct(f.implies(left, f.negate(right) if die.random() < 0.5 else right), class_, "")


def draw_contract(die):
    sides = [
        tuple(draw_conjunct(die) for _ in range(count))
        for count in (die.randint(0, 2), die.randint(1, 2))
    ]
    variables = [Variable(name, owner, BooleanDomain()) for name, owner in NAMES.items()]
    return Contract("c", "", tuple(variables), *sides)


def draw_related_contract(die, contract):
    """Draw a contract, often with the conjuncts of another, so that refinements are not rare."""
    drawn = replace(draw_contract(die), variables=contract.variables)
    if die.random() < 0.5:
        return drawn
    fewer = replace(drawn, assumptions=drawn.assumptions[1:], guarantees=drawn.guarantees[1:])
    return merge(fewer, contract, Manager)


def assume(contract):
    return f.both(*map(as_ltl, contract.assumptions))


def guarantee(contract):
    """Return the saturated guarantees."""
    return f.implies(assume(contract), f.both(*map(as_ltl, contract.guarantees)))


def is_valid(formula):
    return spot.translate(spot.formula(print_for_spot(f.negate(formula)))).is_empty()


def refines(concrete, abstract):
    return is_valid(f.implies(assume(abstract), assume(concrete))) and is_valid(
        f.implies(guarantee(concrete), guarantee(abstract))
    )


def compose_exactly(first, second):
    """Compose as Benveniste et al. define it, in one formula for each side."""
    guarantees = f.both(guarantee(first), guarantee(second))
    assumptions = f.implies(guarantees, f.both(assume(first), assume(second)))
    return Contract(
        "c",
        "",
        first.variables,
        (Conjunct(assumptions, Class.OTHER, ""),),
        (Conjunct(guarantees, Class.OTHER, ""),),
    )


SEEDS = range(60)


@pytest.mark.parametrize("start", range(0, 120, 40))
def test_refinement_agrees_with_spot(start):
    answers = set()
    for seed in range(start, start + 40):
        die = random.Random(seed)
        abstract = draw_contract(die)
        concrete = draw_related_contract(die, abstract)
        is_refined = not list(find_refinement_failures(concrete, abstract, Manager))
        assert is_refined == refines(concrete, abstract), seed
        answers.add(is_refined)
    assert answers == {True, False}


def test_refinement_is_a_preorder():
    chains = 0
    for seed in SEEDS:
        die = random.Random(seed)
        third = draw_contract(die)
        second = draw_related_contract(die, third)
        first = draw_related_contract(die, second)
        assert list(find_refinement_failures(first, first, Manager)) == []
        steps = [
            not list(find_refinement_failures(concrete, abstract, Manager))
            for concrete, abstract in ((first, second), (second, third), (first, third))
        ]
        assert steps[2] or not (steps[0] and steps[1]), seed
        chains += steps[0] and steps[1]
    assert chains


def test_the_quotient_completes_the_part_to_the_system():
    for seed in SEEDS:
        die = random.Random(seed)
        system = draw_contract(die)
        part = as_part(draw_related_contract(die, system))
        quotient = divide(system, part, Manager)
        assert refines(compose_exactly(part, quotient), system), seed


def as_part(contract):
    """Return the contract with ``y`` as an input, which the missing component decides."""
    variables = tuple(
        Variable(name, Owner.ENVIRONMENT if name == "y" else owner, BooleanDomain())
        for name, owner in NAMES.items()
    )
    return Contract("part", "", variables, contract.assumptions, contract.guarantees)


def test_a_contract_completes_the_part_if_and_only_if_it_refines_the_quotient():
    answers = set()
    for seed in SEEDS:
        die = random.Random(seed)
        system = draw_contract(die)
        part = as_part(draw_related_contract(die, system))
        quotient = divide(system, part, Manager)
        candidate = draw_related_contract(die, quotient)
        is_complete = refines(compose_exactly(part, candidate), system)
        assert is_complete == refines(candidate, quotient), seed
        answers.add(is_complete)
    assert answers == {True, False}


def test_the_conjunction_is_the_greatest_lower_bound():
    answers = set()
    for seed in SEEDS:
        die = random.Random(seed)
        first, second = draw_contract(die), draw_contract(die)
        conjunction = conjoin(first, second, Manager)
        assert refines(conjunction, first), seed
        assert refines(conjunction, second), seed
        candidate = draw_related_contract(die, conjunction)
        is_lower_bound = refines(candidate, first) and refines(candidate, second)
        assert is_lower_bound == refines(candidate, conjunction), seed
        answers.add(is_lower_bound)
    assert answers == {True, False}


def test_merging_is_dual_to_composition():
    """Exchange assumptions and guarantees: composition becomes merging (Passerone et al.)."""

    def exchange(contract):
        sides = (
            (Conjunct(side, Class.OTHER, ""),) for side in (guarantee(contract), assume(contract))
        )
        return Contract("c", "", contract.variables, *sides)

    for seed in SEEDS:
        die = random.Random(seed)
        first, second = draw_contract(die), draw_contract(die)
        merged = merge(exchange(first), exchange(second), Manager)
        composition = exchange(compose_exactly(first, second))
        assert refines(merged, composition), seed
        assert refines(composition, merged), seed


def test_a_composition_is_refined_by_the_exact_one():
    for seed in SEEDS:
        die = random.Random(seed)
        first = draw_contract(die)
        second = as_part(draw_related_contract(die, first))
        first, second = only_outputs(first, "y"), only_outputs(second, "x")
        assert refines(compose_exactly(first, second), compose(first, second, Manager)), seed


def only_outputs(contract, *names):
    variables = tuple(
        Variable(name, Owner.SYSTEM if name in names else Owner.ENVIRONMENT, BooleanDomain())
        for name in NAMES
    )
    return Contract("c", "", variables, contract.assumptions, contract.guarantees)
