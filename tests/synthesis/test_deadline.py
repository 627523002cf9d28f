"""The smallest bound of timers that a contract can promise."""

import json
import os
from pathlib import Path

import pytest
from contracts_in_lines import contract

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import Limits, rules
from sysmlc.synthesis.decision import Options, find_deadline, set_bound

CORPUS = os.environ.get("SYSMLC_CORPUS")
CART = """
    env target: 0..{last}
    env timer: 0..9
    sys cart: 0..{last}
    promise at first cart=0
    promise always cart' <= cart + {speed}
    promise always cart' >= cart - {speed}
    promise recurs cart=target
    assume at first timer=0
    assume always cart!=target -> target'=target
    assume always cart=target -> timer'=0
    assume always cart!=target & timer!=9 -> timer'=timer + 1
    assume always cart!=target & timer=9 -> timer'=9
"""


def found(made, *timers, options=Options()):  # noqa: B008 - a value
    sink = Sink()
    return find_deadline(made, timers, lambda origin: Subject(origin), sink, options), list(sink)


def cart(last: int, speed: int, more: str = ""):
    return contract(f"{CART.format(last=last, speed=speed)}\n{more}")


@pytest.mark.parametrize(("last", "speed", "bound"), [(3, 1, 3), (3, 2, 2), (5, 1, 5), (5, 4, 2)])
def test_a_cart_needs_the_way_from_end_to_end(last, speed, bound):
    made, told = found(cart(last, speed), "timer")
    assert [made.bound, made.exit_code, told] == [bound, 0, []]
    assert made.text() == f"c: timer <= {bound} can be guaranteed, no smaller bound"


def test_a_bound_is_the_one_where_decisions_change():
    made, _ = found(cart(5, 1), "timer")
    assert all(one.is_realizable == (bound >= 5) for bound, one in made.tried.items())
    assert {4, 5} <= set(made.tried)


def test_bounds_that_are_promised_already_are_what_is_looked_for():
    made, _ = found(cart(5, 1, "promise always timer <= 2"), "timer")
    assert made.bound == 5
    other, _ = found(cart(5, 1, "promise always timer <= 2 | cart=1"), "timer")
    assert other.bound is None


def test_a_bounded_contract_says_so_once():
    made = set_bound(
        cart(3, 1, "promise always timer < 9\npromise always 7 >= timer"), ["timer"], 4
    )
    said = [print_formula(one.formula) for one in made.guarantees]
    assert [one for one in said if "timer" in one] == ["timer<=4"]


def test_where_the_environment_can_always_delay_there_is_none():
    made, told = found(cart(3, 1, "env wind: bool\npromise always wind -> cart'=cart"), "timer")
    assert [made.bound, made.exit_code] == [None, 1]
    assert [(one.rule.code, one.message) for one in told] == [
        ("SM576", "'c' can guarantee no bound for timer: even 8 is too small")
    ]


@pytest.mark.parametrize("name", ["clock", "far"])
def test_what_is_no_number_of_the_contract_is_told(name):
    made, told = found(cart(3, 1, "sys far: bool"), name)
    assert [made.bound, made.exit_code] == [None, 2]
    assert [one.rule.code for one in told] == ["SM575"]
    assert told[0].help == "name one of its numeric variables: target, timer, cart"


def test_what_is_not_decided_is_told_once():
    made, told = found(cart(3, 1), "timer", options=Options(limits=Limits(nodes=2)))
    assert [made.exit_code, [one.rule.code for one in told]] == [2, ["SM531"]]


@pytest.mark.parametrize("rule", [rules.NO_TIMER, rules.NO_DEADLINE], ids=lambda rule: rule.code)
def test_the_examples_of_the_rules(rule):
    timer = "late" if rule is rules.NO_DEADLINE else "later"
    wrong, right = (
        found(formats.read(text, "x.gr1.json", Sink())[0], name)
        for text, name in ((rule.read_page().wrong, timer), (rule.read_page().right, "late"))
    )
    assert [[one.rule.code for one in wrong[1]], right[1]] == [[rule.code], []]


@pytest.mark.corpus
@pytest.mark.skipif(not CORPUS, reason="SYSMLC_CORPUS names no folder")
@pytest.mark.parametrize(
    ("name", "bound"), [("hol_9x2_move_T4", 4), ("hol_16x2_move_T5", 5), ("hol_16x1_smart", 7)]
)
def test_smallest_deadlines_of_robots(name, bound):
    text = Path(CORPUS or "", "gr1", "robots", f"{name}.json").read_text(encoding="utf-8")
    data = json.loads(text)
    if "tm0" not in data["variables"]:
        with_timer(data, 15)
    (made,) = formats.read(json.dumps(data), f"{name}.gr1.json", Sink())
    timers = [one.name for one in made.variables if one.name.startswith("tm")]
    assert found(made, *timers)[0].bound == bound


def with_timer(data, last: int) -> None:
    """Count the steps to the target, as the contracts of the corpus with deadlines do."""
    data["variables"]["tm0"] = {"owner": "env", "type": [0, last]}
    data["assumptions"]["init"].append("tm0=0")
    data["assumptions"]["safety"] += [
        "pos0=tgt0 -> tm0'=0",
        f"pos0!=tgt0 & tm0!={last} -> tm0'=tm0+1",
        f"pos0!=tgt0 & tm0={last} -> tm0'={last}",
    ]
