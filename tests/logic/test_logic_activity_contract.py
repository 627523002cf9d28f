"""Contracts of small activities, as texts, and their meaning according to Spot."""

import pytest
from random_block_activities import build_tokens, draw_activity

from activity_sketch import sketch
from spot_formulas import conjoin, print_for_spot
from sysmlc.ir.text import parse_text
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.printing import print_formula

spot = pytest.importorskip("spot")

STRAIGHT = sketch("initial i\naction work\nfinal f\ni -> work\nwork -> f")


def derive(text: str) -> Contract:
    """Return the contract of the activity in a text of the IR."""
    return derive_contract(build_tokens(parse_text(text)))


def print_conjunct(conjunct: Conjunct) -> str:
    """Return the formula behind the temporal operators of its class; a prime means "next"."""
    prefix = {Class.INIT: "", Class.SAFETY: "G ", Class.LIVENESS: "G F "}[conjunct.class_]
    return f"{prefix}({print_formula(conjunct.formula)})"


def test_one_action_has_an_assumption_about_its_end_and_guarantees_about_its_tokens():
    contract = derive(STRAIGHT)
    assert [f"{variable.owner} {variable.name}" for variable in contract.variables] == [
        "env done_work",
        "sys run_work",
    ]
    assert [*map(print_conjunct, contract.assumptions)] == ["G F (!run_work | done_work)"]
    assert [*map(print_conjunct, contract.guarantees)] == [
        "(run_work)",
        "G (run_work' <-> run_work & !done_work & !(run_work & done_work) | run_work & done_work)",
        "G F (run_work & done_work)",
    ]


def test_the_next_action_runs_in_the_step_after_the_end_of_the_one_before():
    contract = derive(sketch("initial i\naction x\nmerge m\naction y\ni -> x\nx -> m\nm -> y"))
    assert "G (run_y' <-> run_x & done_x | run_y & !done_y)" in map(
        print_conjunct, contract.guarantees
    )


def test_a_token_that_waits_for_another_has_a_variable():
    contract = derive(
        sketch(
            "initial i\nfork k\naction x\naction y\njoin j\naction z\ni -> k\nk -> x\nk -> y\n"
            "x -> j\ny -> j\nj -> z"
        )
    )
    assert [v.name for v in contract.variables if v.name.startswith("at_")] == [
        "at_x_to_join_1",
        "at_y_to_join_1",
    ]


def test_every_conjunct_has_a_sentence_and_an_origin():
    contract = derive(STRAIGHT)
    conjuncts = [*contract.assumptions, *contract.guarantees]
    assert [conjunct.text for conjunct in conjuncts] == [
        "Whenever action 'work' runs, the environment ends it sooner or later.",
        "At the start action 'work' is running.",
        "Action 'work' runs from when all its flows have brought a token until it is done.",
        "Activity 'a' finishes again and again.",
    ]
    graph = parse_text(STRAIGHT)
    assert all(conjunct.origin in graph for conjunct in conjuncts)


def test_a_loop_with_an_exit_guard_has_one_exit_assumption_with_an_origin():
    contract = derive(
        sketch(
            "initial i\nmerge m\naction work\ndecision d\nfinal f\ni -> m\nm -> work\n"
            "work -> d\nd -> m [else]\nd -> f [ok]"
        )
    )
    (assumption,) = [
        conjunct for conjunct in contract.assumptions if conjunct.text.startswith("The loop")
    ]
    assert assumption.origin == "d"
    assert assumption.text == (
        "The loop through decision 1 is left sooner or later: whenever it goes on, ok holds there "
        "eventually."
    )
    assert print_conjunct(assumption).endswith("| at_work_to_decision_1 & ok)")


# -- the meaning -------------------------------------------------------------------------------

MODELS = {
    "one action": STRAIGHT,
    "decision": sketch(
        "initial i\ndecision d\naction x\naction y\nmerge m\nfinal f\ni -> d\nd -> x [ok]\n"
        "d -> y [else]\nx -> m\ny -> m\nm -> f"
    ),
    "missing branch": sketch(
        "initial i\ndecision d\naction x\nfinal f\ni -> d\nd -> x [ok]\nx -> f"
    ),
    "loop": sketch(
        "initial i\nmerge m\naction x\ndecision d\nfinal f\ni -> m\nm -> x\nx -> d\n"
        "d -> m [else]\nd -> f [ok]"
    ),
    "parallel": sketch(
        "initial i\nfork k\naction x\naction y\njoin j\nfinal f\ni -> k\nk -> x\nk -> y\n"
        "x -> j\ny -> j\nj -> f"
    ),
    "no final node": sketch("initial i\naction x\naction y\ni -> x\nx -> y"),
    "structured": sketch(
        "initial i\nstructured s\n  action x\n  action y\nfinal f\ni -> s\nx -> y\ns -> f"
    ),
    "started by events": sketch("initial i\naccept go\n  on-pallet t\nfinal f\ni -> go\ngo -> f"),
    "interrupted": """
Activity a "a"
  Control i "" subkind="initial"
  Control k "" subkind="fork"
  Structured r "busy" subkind="interruptible"
  Action x "x" subkind="opaque"
    -> in-partition r
  Action stop "stop" subkind="accept"
    -> in-partition r
  Control m "" subkind="merge"
  Control f "" subkind="final"
  ControlFlow f1
    -> flow-source i
    -> flow-target k
  ControlFlow f2
    -> flow-source k
    -> flow-target x
  ControlFlow f3
    -> flow-source k
    -> flow-target stop
  ControlFlow f4 interrupts="r"
    -> flow-source x
    -> flow-target m
  ControlFlow f5 interrupts="r"
    -> flow-source stop
    -> flow-target m
  ControlFlow f6
    -> flow-source m
    -> flow-target f
""",
}


def translate(*conjuncts: Conjunct) -> str:
    """Return the conjunction as a formula for Spot."""
    return print_for_spot(conjoin(conjuncts))


def is_satisfiable(formula: str) -> bool:
    return not spot.translate(formula, "small", "low").is_empty()


def split_guarantees(contract: Contract) -> tuple[str, str]:
    """Return the guarantees about steps, and that the activity finishes, both for Spot."""
    steps = [part for part in contract.guarantees if part.class_ is not Class.LIVENESS]
    (finish,) = [part for part in contract.guarantees if part.class_ is Class.LIVENESS]
    return translate(*steps), translate(finish)


@pytest.mark.parametrize("name", MODELS)
def test_assumptions_and_guarantees_can_hold_together(name):
    contract = derive(MODELS[name])
    assert is_satisfiable(translate(*contract.assumptions, *contract.guarantees))


@pytest.mark.parametrize("name", MODELS)
def test_the_assumptions_imply_that_the_activity_finishes(name):
    """No assumption is missing: with the guarantees about steps, the tokens reach the end."""
    contract = derive(MODELS[name])
    steps, finish = split_guarantees(contract)
    assert not is_satisfiable(f"{translate(*contract.assumptions)} & {steps} & !{finish}")


@pytest.mark.parametrize("name", MODELS)
def test_without_an_assumption_the_activity_may_never_finish(name):
    """Except where another assumption implies the omitted one.

    The exit of a loop requires that the actions in it end, and one of two actions is enough to
    end an interrupted region, so that both assumptions are omitted together.
    """
    contract = derive(MODELS[name])
    steps, finish = split_guarantees(contract)
    omissions = [[part] for part in contract.assumptions]
    if name == "loop":
        omissions = [[part] for [part] in omissions if not part.text.startswith("Whenever a")]
    elif name == "interrupted":
        omissions = [list(contract.assumptions)]
    assert omissions
    for omitted in omissions:
        assumptions = [part for part in contract.assumptions if part not in omitted]
        assert is_satisfiable(f"{translate(*assumptions)} & {steps} & !{finish}")


def test_an_exit_guard_that_holds_again_and_again_is_not_enough_to_leave_a_loop():
    """It may hold only while the token is elsewhere (decision 11)."""
    contract = derive(MODELS["loop"])
    steps, finish = split_guarantees(contract)
    ends = [part for part in contract.assumptions if part.text.startswith("Whenever")]
    assert is_satisfiable(f"{translate(*ends)} & (G F ok) & {steps} & !{finish}")


def test_both_branches_of_a_choice_with_overlapping_guards_stay_possible():
    contract = derive_contract(build_tokens(draw_activity(("choose", ("act",), ("act",)))))
    first, second = (
        variable.name for variable in contract.variables if variable.name.startswith("run_")
    )
    guarantees = translate(*contract.guarantees)
    assert is_satisfiable(f"{guarantees} & (F {first}) & G !{second}")
    assert is_satisfiable(f"{guarantees} & (F {second}) & G !{first}")


@pytest.mark.parametrize(
    ("x", "y", "is_allowed"), [(0, 0, False), (1, 0, True), (0, 1, True), (1, 1, False)]
)
def test_one_token_goes_to_one_of_several_open_branches(x, y, is_allowed):
    contract = derive(
        sketch("initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [ok]\nd -> y [fine]")
    )
    names = [variable.name for variable in contract.variables]
    (start,) = [name for name in names if name.startswith("at_start")]
    to_x, to_y = (next(name for name in names if name.endswith(f"_to_{end}")) for end in "xy")
    before = dict.fromkeys(names, False) | {start: True, "ok": True, "fine": True}
    after = dict.fromkeys(names, False) | {to_x: bool(x), to_y: bool(y)}
    steps = [part.formula for part in contract.guarantees if part.class_ is Class.SAFETY]
    assert all(is_true(formula, before, after) for formula in steps) is is_allowed


def list_fillers(contract: Contract) -> list[str]:
    """Return the conjuncts that contain a constant."""
    texts = [print_formula(c.formula) for c in (*contract.assumptions, *contract.guarantees)]
    return [text for text in texts if {"true", "false"} & set(text.replace("(", " ").split())]


def test_a_flow_that_never_gets_a_second_token_has_a_guarantee_without_a_constant():
    loop = "d -> m\nm -> work\nwork -> m"
    contract = derive(sketch(f"initial i\ndecision d\nmerge m\naction work\ni -> d\n{loop}"))
    assert "G (!at_start_to_decision_1')" in map(print_conjunct, contract.guarantees)
    assert list_fillers(contract) == []


def test_a_free_choice_has_no_guarantee_that_is_just_true():
    contract = derive(
        sketch(
            "initial i\ndecision d\naction x\naction y\nfinal f\n"
            "i -> d\nd -> x\nd -> y\nx -> f\ny -> f"
        )
    )
    assert list_fillers(contract) == []
    choice = [c for c in contract.guarantees if c.text.startswith("The token that decision")]
    assert len(choice) == 1
