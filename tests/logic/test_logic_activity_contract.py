"""Contracts of small activities: read as texts, and asked about their meaning with Spot."""

import pytest
from activity_models import activity, tokens_of

from activity_sketch import sketch
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.passes.activities import Activities

spot = pytest.importorskip("spot")

STRAIGHT = sketch("initial i\naction work\nfinal f\ni -> work\nwork -> f")


def contract(text: str) -> Contract:
    graph = parse_text(text)
    Activities().run(graph, Sink())
    (tokens,) = graph.derived(TokenGraph)
    return derive_contract(tokens)


# -- reading -----------------------------------------------------------------------------------


def shown(formula: Formula) -> str:
    match formula:
        case Const(value):
            return str(value).lower()
        case Var(name, primed):
            return f"X {name}" if primed else name
        case Apply(Op.NOT, (inner,)):
            return f"!({shown(inner)})"
        case Apply(op, args):
            return "(" + f" {op} ".join(map(shown, args)) + ")"


def temporal(conjunct) -> str:
    prefix = {Class.INIT: "", Class.SAFETY: "G", Class.LIVENESS: "G F"}[conjunct.class_]
    return f"{prefix} {shown(conjunct.formula)}".strip()


def test_the_contract_of_one_action():
    found = contract(STRAIGHT)
    assert [f"{v.owner} {v.name}" for v in found.variables] == [
        "env done_work",
        "sys run_work",
        "sys at_start_to_work",
        "sys at_work_to_end",
    ]
    assert [temporal(c) for c in found.assumptions] == ["G F (!(run_work) | done_work)"]
    assert [temporal(c) for c in found.guarantees] == [
        "at_start_to_work",
        "!(at_work_to_end)",
        "!(run_work)",
        "G (X at_start_to_work <-> at_work_to_end)",
        "G (X at_work_to_end <-> (run_work & done_work & !(at_work_to_end)))",
        "G (X run_work <-> ((at_start_to_work | (run_work & !(done_work))) & !(at_work_to_end)))",
        "G F at_work_to_end",
    ]


def test_every_conjunct_says_in_words_where_it_comes_from():
    found = contract(STRAIGHT)
    assert [c.text for c in (*found.assumptions, *found.guarantees)] == [
        "Whenever action 'work' runs, the environment ends it sooner or later.",
        "The flow from initial node 1 to action 'work' starts with a token.",
        "The flow from action 'work' to activity final node 1 has no token at the start.",
        "At the start action 'work' is not running.",
        "The flow from initial node 1 to action 'work' gets a token when the activity starts, and "
        "keeps it until action 'work' takes it.",
        "The flow from action 'work' to activity final node 1 gets a token when action 'work' "
        "gives one, and keeps it until activity final node 1 takes it.",
        "Action 'work' runs from when all its flows have brought a token until it is done.",
        "Activity 'a' finishes again and again.",
    ]
    graph = parse_text(STRAIGHT)
    assert all(c.origin in graph for c in (*found.assumptions, *found.guarantees))


def test_a_loop_that_the_environment_decides_has_one_traced_exit_assumption():
    found = contract(
        sketch(
            "initial i\nmerge m\naction work\ndecision d\nfinal f\ni -> m\nm -> work\n"
            "work -> d\nd -> m [else]\nd -> f [ok]"
        )
    )
    (exit_,) = [c for c in found.assumptions if c.text.startswith("The loop")]
    assert exit_.origin == "d"
    assert exit_.text == (
        "The loop through decision 1 is left sooner or later: whenever it goes on, ok holds there "
        "eventually."
    )
    assert temporal(exit_).endswith("| (at_work_to_decision_1 & ok))")


# -- asking Spot -------------------------------------------------------------------------------

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


def joined(parts) -> str:
    return " & ".join(f"({temporal(part)})" for part in parts) or "1"


def holds_somewhere(formula: str) -> bool:
    return not spot.translate(formula, "small", "low").is_empty()


@pytest.mark.parametrize("name", MODELS)
def test_assumptions_and_guarantees_can_hold_together(name):
    found = contract(MODELS[name])
    assert holds_somewhere(f"{joined(found.assumptions)} & {joined(found.guarantees)}")


@pytest.mark.parametrize("name", MODELS)
def test_the_activity_finishes_because_the_environment_plays_along(name):
    """The safety guarantees and the assumptions imply the liveness guarantee.

    So no assumption is missing, and the tokens alone bring the activity to its end.
    """
    found = contract(MODELS[name])
    moves = [c for c in found.guarantees if c.class_ is not Class.LIVENESS]
    (finish,) = [c for c in found.guarantees if c.class_ is Class.LIVENESS]
    assert not holds_somewhere(
        f"{joined(found.assumptions)} & {joined(moves)} & !({temporal(finish)})"
    )


@pytest.mark.parametrize("name", MODELS)
def test_without_an_assumption_the_activity_may_hang(name):
    """Except where another assumption says the same: the exit of a loop asks for the end of
    the actions in it, and one of two actions is enough to end an interrupted region.
    """
    found = contract(MODELS[name])
    moves = [c for c in found.guarantees if c.class_ is not Class.LIVENESS]
    (finish,) = [c for c in found.guarantees if c.class_ is Class.LIVENESS]
    for left_out in found.assumptions:
        if left_out.text.startswith("Whenever a") and name in ("loop", "interrupted"):
            continue
        others = [c for c in found.assumptions if c is not left_out]
        assert holds_somewhere(f"{joined(others)} & {joined(moves)} & !({temporal(finish)})")


def test_an_exit_guard_that_holds_again_and_again_is_not_enough_to_leave_a_loop():
    """It may hold only while the token is elsewhere (decision 11)."""
    found = contract(MODELS["loop"])
    moves = [c for c in found.guarantees if c.class_ is not Class.LIVENESS]
    (finish,) = [c for c in found.guarantees if c.class_ is Class.LIVENESS]
    ended = [c for c in found.assumptions if c.text.startswith("Whenever")]
    plain = f"{joined(ended)} & (G F ok) & {joined(moves)}"
    assert holds_somewhere(f"{plain} & !({temporal(finish)})")


def test_a_choice_that_the_diagram_leaves_open_stays_open():
    found = derive_contract(tokens_of(activity(("choose", ("act",), ("act",)))))
    first, second = (v.name for v in found.variables if v.name.startswith("run_"))
    both = f"{joined(found.guarantees)} & (F {{}}) & G !{{}}"
    assert holds_somewhere(both.format(first, second))
    assert holds_somewhere(both.format(second, first))


@pytest.mark.parametrize(
    ("x", "y", "is_kept"), [(0, 0, False), (1, 0, True), (0, 1, True), (1, 1, False)]
)
def test_one_token_goes_to_one_of_several_open_branches(x, y, is_kept):
    drawn = "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [ok]\nd -> y [fine]"
    found = contract(sketch(drawn))
    names = [one.name for one in found.variables]
    (before,) = [one for one in names if one.startswith("at_start")]
    to_x, to_y = (next(one for one in names if one.endswith(f"_to_{to}")) for to in "xy")
    now = dict.fromkeys(names, False) | {before: True, "ok": True, "fine": True}
    then = dict.fromkeys(names, False) | {to_x: bool(x), to_y: bool(y)}
    safe = [one.formula for one in found.guarantees if one.class_ is Class.SAFETY]
    assert all(is_true(one, now, then) for one in safe) is is_kept
