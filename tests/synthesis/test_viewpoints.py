"""Conjunction of viewpoints: the guarantees of each hold under its own assumptions."""

import pytest
from contracts_in_lines import parse_contract
from explicit import ExplicitGame
from msgspec.structs import replace

from sysmlc.logic.contract import Contract
from sysmlc.synthesis import Manager, OutsideGr1Error
from sysmlc.synthesis.algebra.composition import conjoin_viewpoints
from sysmlc.synthesis.algebra.refinement import find_refinement_failures

VARIABLES = "env power: bool\nenv door: bool\nsys lit: bool\n"
POWERED = "assume always power'\nassume at first power\npromise always lit' -> power'"
SHINES = "promise always door' -> lit'"


def merge_viewpoints(**sides):
    """Return one contract that consists of several viewpoints."""
    contracts = {name: parse_contract(VARIABLES + text) for name, text in sides.items()}

    def list_conjuncts(name, side):
        return [replace(conjunct, viewpoint=name) for conjunct in getattr(contracts[name], side)]

    return Contract(
        "Lamp",
        "",
        next(iter(contracts.values())).variables,
        tuple(conjunct for name in contracts for conjunct in list_conjuncts(name, "assumptions")),
        tuple(conjunct for name in contracts for conjunct in list_conjuncts(name, "guarantees")),
    )


def select_viewpoint(whole, name):
    """Return the contract of one viewpoint."""
    assumptions, guarantees = (
        tuple(conjunct for conjunct in side if conjunct.viewpoint == name)
        for side in (whole.assumptions, whole.guarantees)
    )
    return replace(whole, assumptions=assumptions, guarantees=guarantees)


def test_a_conjunction_refines_every_viewpoint():
    whole = merge_viewpoints(powered=POWERED, shines=SHINES)
    conjunction = conjoin_viewpoints(whole)
    for name in ("powered", "shines"):
        assert (
            list(find_refinement_failures(conjunction, select_viewpoint(whole, name), Manager))
            == []
        )


def test_the_union_of_viewpoints_need_not_refine_each_viewpoint():
    whole = merge_viewpoints(powered=POWERED, shines=SHINES)
    failures = list(find_refinement_failures(whole, select_viewpoint(whole, "shines"), Manager))
    assert {failure.is_assumption for failure in failures} == {True}


def test_a_viewpoint_that_needs_the_assumptions_of_another_is_unrealizable_in_conjunction():
    strict = f"promise always lit' -> power'\n{SHINES}"
    whole = merge_viewpoints(powered=POWERED, shines=strict)
    assert ExplicitGame(whole).is_realizable()
    assert not ExplicitGame(conjoin_viewpoints(whole)).is_realizable()
    assert ExplicitGame(
        conjoin_viewpoints(merge_viewpoints(powered=POWERED, shines=SHINES))
    ).is_realizable()


def test_viewpoints_with_equal_assumptions_are_one_contract():
    whole = merge_viewpoints(powered=POWERED, again=POWERED)
    assert conjoin_viewpoints(whole) is whole


def test_what_recurs_for_one_viewpoint_recurs_in_the_conjunction():
    whole = merge_viewpoints(
        powered=f"{POWERED}\nassume recurs door\npromise recurs lit", shines=SHINES
    )
    conjunction = conjoin_viewpoints(whole)
    assert [assumption.text for assumption in conjunction.assumptions] == ["door"]
    assert [variable.name for variable in conjunction.variables][-1] == "broken"


def test_different_recurrences_are_outside_gr1():
    whole = merge_viewpoints(
        powered="assume recurs power\npromise recurs lit",
        shines="assume recurs door\npromise recurs !lit",
    )
    with pytest.raises(OutsideGr1Error, match="more than GR"):
        conjoin_viewpoints(whole)
