"""The smallest bound of timers that a contract can promise."""

import json
import os
from pathlib import Path

import pytest
from contracts_in_lines import parse_contract

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


def find_bound(contract, *timers, options=Options()):  # noqa: B008 - a value
    sink = Sink()
    return find_deadline(contract, timers, lambda origin: Subject(origin), sink, options), list(
        sink
    )


def parse_cart(last: int, speed: int, more: str = ""):
    return parse_contract(f"{CART.format(last=last, speed=speed)}\n{more}")


@pytest.mark.parametrize(("last", "speed", "bound"), [(3, 1, 3), (3, 2, 2), (5, 1, 5), (5, 4, 2)])
def test_the_bound_of_a_cart_is_the_time_from_end_to_end(last, speed, bound):
    deadline, diagnostics = find_bound(parse_cart(last, speed), "timer")
    assert [deadline.bound, deadline.exit_code, diagnostics] == [bound, 0, []]
    assert deadline.text() == f"c: timer <= {bound} can be guaranteed, no smaller bound"


def test_verdicts_change_at_the_bound():
    deadline, _ = find_bound(parse_cart(5, 1), "timer")
    assert all(verdict.is_realizable == (bound >= 5) for bound, verdict in deadline.tried.items())
    assert {4, 5} <= set(deadline.tried)


def test_an_existing_bound_is_replaced():
    deadline, _ = find_bound(parse_cart(5, 1, "promise always timer <= 2"), "timer")
    assert deadline.bound == 5
    other_deadline, _ = find_bound(parse_cart(5, 1, "promise always timer <= 2 | cart=1"), "timer")
    assert other_deadline.bound is None


def test_a_new_bound_replaces_all_existing_bounds():
    contract = set_bound(
        parse_cart(3, 1, "promise always timer < 9\npromise always 7 >= timer"), ["timer"], 4
    )
    formulas = [print_formula(guarantee.formula) for guarantee in contract.guarantees]
    assert [formula for formula in formulas if "timer" in formula] == ["timer<=4"]


def test_there_is_no_bound_if_the_environment_can_always_delay():
    deadline, diagnostics = find_bound(
        parse_cart(3, 1, "env wind: bool\npromise always wind -> cart'=cart"), "timer"
    )
    assert [deadline.bound, deadline.exit_code] == [None, 1]
    assert [(diagnostic.rule.code, diagnostic.message) for diagnostic in diagnostics] == [
        ("SM576", "'c' can guarantee no bound for timer: even 8 is too small")
    ]


@pytest.mark.parametrize("name", ["clock", "far"])
def test_a_timer_that_is_no_number_of_the_contract_is_reported(name):
    deadline, diagnostics = find_bound(parse_cart(3, 1, "sys far: bool"), name)
    assert [deadline.bound, deadline.exit_code] == [None, 2]
    assert [diagnostic.rule.code for diagnostic in diagnostics] == ["SM575"]
    assert diagnostics[0].help == "name one of its numeric variables: target, timer, cart"


def test_an_undecided_bound_is_reported_once():
    deadline, diagnostics = find_bound(
        parse_cart(3, 1), "timer", options=Options(limits=Limits(nodes=2))
    )
    assert [deadline.exit_code, [diagnostic.rule.code for diagnostic in diagnostics]] == [
        2,
        ["SM531"],
    ]


@pytest.mark.parametrize("rule", [rules.NO_TIMER, rules.NO_DEADLINE], ids=lambda rule: rule.code)
def test_the_examples_of_the_rules(rule):
    timer = "late" if rule is rules.NO_DEADLINE else "later"
    wrong, right = (
        find_bound(formats.read(text, "x.gr1.json", Sink())[0], name)
        for text, name in ((rule.read_page().wrong, timer), (rule.read_page().right, "late"))
    )
    assert [[diagnostic.rule.code for diagnostic in wrong[1]], right[1]] == [[rule.code], []]


@pytest.mark.corpus
@pytest.mark.parametrize(
    ("name", "bound"), [("hol_9x2_move_T4", 4), ("hol_16x2_move_T5", 5), ("hol_16x1_smart", 7)]
)
def test_smallest_deadlines_of_robots(name, bound):
    text = Path(CORPUS or "", "gr1", "robots", f"{name}.json").read_text(encoding="utf-8")
    data = json.loads(text)
    if "tm0" not in data["variables"]:
        add_timer(data, 15)
    (contract,) = formats.read(json.dumps(data), f"{name}.gr1.json", Sink())
    timers = [variable.name for variable in contract.variables if variable.name.startswith("tm")]
    assert find_bound(contract, *timers)[0].bound == bound


def add_timer(data, last: int) -> None:
    """Count the steps to the target, as the contracts of the corpus with deadlines do."""
    data["variables"]["tm0"] = {"owner": "env", "type": [0, last]}
    data["assumptions"]["init"].append("tm0=0")
    data["assumptions"]["safety"] += [
        "pos0=tgt0 -> tm0'=0",
        f"pos0!=tgt0 & tm0!={last} -> tm0'=tm0+1",
        f"pos0!=tgt0 & tm0={last} -> tm0'={last}",
    ]
