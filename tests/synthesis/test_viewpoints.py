"""Conjunction of viewpoints: each is owed its promises where its own assumptions hold."""

import pytest
from contracts_in_lines import contract
from explicit import Explicit
from msgspec.structs import replace

from sysmlc.logic.contract import Contract
from sysmlc.synthesis import Manager, OutsideGr1Error
from sysmlc.synthesis.algebra.composition import conjoin_viewpoints, list_viewpoints
from sysmlc.synthesis.algebra.refinement import find_refinement_failures

VARIABLES = "env power: bool\nenv door: bool\nsys lit: bool\n"
POWERED = "assume always power'\nassume at first power\npromise always lit' -> power'"
SHINES = "promise always door' -> lit'"


def together(**sides):
    """One contract of several viewpoints."""
    made = {name: contract(VARIABLES + text) for name, text in sides.items()}

    def said(name, side):
        return [replace(one, viewpoint=name) for one in getattr(made[name], side)]

    return Contract(
        "Lamp",
        "",
        next(iter(made.values())).variables,
        tuple(one for name in made for one in said(name, "assumptions")),
        tuple(one for name in made for one in said(name, "guarantees")),
    )


def alone(whole, name):
    """The contract of one viewpoint."""
    view = next(one for one in list_viewpoints(whole) if one.name == name)
    return replace(whole, assumptions=view.assumptions, guarantees=view.guarantees)


def test_a_conjunction_refines_every_viewpoint():
    whole = together(powered=POWERED, shines=SHINES)
    made = conjoin_viewpoints(whole)
    for name in ("powered", "shines"):
        assert list(find_refinement_failures(made, alone(whole, name), Manager())) == []


def test_all_together_need_not_keep_one_alone():
    whole = together(powered=POWERED, shines=SHINES)
    failures = list(find_refinement_failures(whole, alone(whole, "shines"), Manager()))
    assert {one.is_assumption for one in failures} == {True}


def test_what_only_holds_with_the_assumptions_of_another_cannot_be_kept_in_conjunction():
    strict = f"promise always lit' -> power'\n{SHINES}"
    whole = together(powered=POWERED, shines=strict)
    assert Explicit(whole).is_realizable()
    assert not Explicit(conjoin_viewpoints(whole)).is_realizable()
    assert Explicit(conjoin_viewpoints(together(powered=POWERED, shines=SHINES))).is_realizable()


def test_viewpoints_that_assume_the_same_are_one_contract():
    whole = together(powered=POWERED, again=POWERED)
    assert conjoin_viewpoints(whole) is whole


def test_what_recurs_for_one_viewpoint_recurs_in_the_conjunction():
    whole = together(powered=f"{POWERED}\nassume recurs door\npromise recurs lit", shines=SHINES)
    made = conjoin_viewpoints(whole)
    assert [one.text for one in made.assumptions] == ["door"]
    assert [one.name for one in made.variables][-1] == "broken"


def test_different_recurrences_are_more_than_gr1():
    whole = together(
        powered="assume recurs power\npromise recurs lit",
        shines="assume recurs door\npromise recurs !lit",
    )
    with pytest.raises(OutsideGr1Error, match="more than GR"):
        conjoin_viewpoints(whole)
