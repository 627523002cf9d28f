"""Derived times of small task graphs, compared with answers calculated by hand."""

import pytest
from task_graphs import build_task_graph, derive_times

from sysmlc.recipe.durations import find_unbounded_loops
from sysmlc.recipe.model import Range

ARM = {"a": "arm:1000", "b": "arm:2000", "c": "arm:300"}
TWO_ARMS = {"a": "left:1000", "b": "right:2000", "c": "left:300"}
NO_MACHINE = {"a": ":1000", "b": ":2000", "c": ":300"}
ANY_ARM = {"a": "left:1000 right:1000", "b": "left:1000 right:1000", "c": "left:1000 right:1000"}

SEQUENCE = """
    i > a
    a > b
    b > f
"""
PARALLEL = """
    i > F
    F > a
    F > b
    a > J
    b > J
    J > f
"""
THREE_PARALLEL = """
    i > F
    F > a
    F > b
    F > c
    a > J
    b > J
    c > J
    J > f
"""
DECISION = """
    i > D
    D > a [ok]
    D > b [else]
    a > M
    b > M
    M > f
"""
COUNTED_LOOP = """
    i > M
    M > a
    a > A
    A = n := n + 1
    A > D
    D > M [n < 4]
    D > f [else]
"""
TESTED_FIRST = """
    i > M
    M > D
    D > a [n < 4]
    D > f [else]
    a > A
    A = n := n + 1
    A > M
"""
FOR_EACH = """
    i > E
    E = parts
    E > a
    a > E
    E > f
"""
WAITING_LOOP = """
    i > M
    M > a
    a -> ok
    a > D
    D > f [ok]
    D > M [else]
"""


def derive_range(text, machines, variables=None, **bounds) -> tuple[float, float | None]:
    """Return the derived minimum and maximum."""
    duration = derive_times(build_task_graph(text, variables, **bounds), machines).duration
    assert duration is not None
    return duration.min, duration.max


@pytest.mark.parametrize(
    ("text", "machines", "variables", "expected"),
    [
        (SEQUENCE, ARM, {}, (3000, 3000)),
        # One arm does one service after the other; two arms work at the same time.
        (PARALLEL, ARM, {}, (3000, 3000)),
        (PARALLEL, TWO_ARMS, {}, (2000, 2000)),
        (PARALLEL, NO_MACHINE, {}, (2000, 2000)),
        # Two of three services share the left arm.
        (THREE_PARALLEL, TWO_ARMS, {}, (2000, 2000)),
        # Three seconds of work on two arms take more than one second each.
        (THREE_PARALLEL, ANY_ARM, {}, (1500, 3000)),
        (DECISION, ARM, {"ok": None}, (1000, 2000)),
        (DECISION, ARM, {"ok": True}, (1000, 1000)),
        (DECISION, ARM, {"ok": False}, (2000, 2000)),
        (COUNTED_LOOP, ARM, {"n": 0}, (4000, 4000)),
        (COUNTED_LOOP, ARM, {"n": 9}, (1000, 1000)),
        (TESTED_FIRST, ARM, {"n": 0}, (4000, 4000)),
        (TESTED_FIRST, ARM, {"n": 4}, (0, 0)),
        (FOR_EACH, ARM, {"parts": (7, 8, 9)}, (3000, 3000)),
        (FOR_EACH, ARM, {"parts": ()}, (0, 0)),
    ],
)
def test_times_equal_those_calculated_by_hand(text, machines, variables, expected):
    assert derive_range(text, machines, variables) == expected


def test_a_loop_that_waits_for_a_sensor_has_no_maximum_for_a_reason():
    derived = derive_times(build_task_graph(WAITING_LOOP, {"ok": False}), ARM)
    assert derived.duration == Range(1000, None)
    assert derived.because == "the loop at 'D' has no bound"


def test_a_bound_of_the_model_gives_this_loop_a_maximum():
    assert derive_range(WAITING_LOOP, ARM, {"ok": False}, D=3) == (1000, 3000)


def test_a_bound_that_the_guards_contradict_does_not_shorten_the_loop():
    assert derive_range(COUNTED_LOOP, ARM, {"n": 0}, D=2) == (4000, 4000)


def test_only_loops_whose_rounds_nothing_limits_are_unbounded():
    waiting = build_task_graph(WAITING_LOOP, {"ok": False})
    assert [node.id for node in find_unbounded_loops(waiting)] == ["D"]
    assert find_unbounded_loops(build_task_graph(COUNTED_LOOP, {"n": 0})) == []


def test_a_list_of_unknown_length_may_be_empty_and_has_no_maximum():
    derived = derive_times(build_task_graph(FOR_EACH), ARM)
    assert derived.duration == Range(0, None)
    assert derived.because == "the loop at 'E' has no bound"


def test_a_counter_that_grows_forever_is_no_situation_of_its_own():
    text = WAITING_LOOP.replace("a > D", "a > A\nA = n := n + 1\nA > D")
    assert derive_range(text, ARM, {"ok": False, "n": 0}, D=3) == (1000, 3000)


def test_too_many_situations_are_a_reason_for_no_maximum():
    text = COUNTED_LOOP.replace("4", "1000000")
    derived = derive_times(build_task_graph(text, {"n": 0}), ARM)
    assert derived.duration == Range(1000, None)
    assert derived.because == "the executions reach more than 10000 situations"


def test_the_same_condition_has_the_same_value_at_two_decisions():
    text = """
        i > D1
        D1 > a [ok]
        D1 > b [else]
        a > M1
        b > M1
        M1 > D2
        D2 > c [ok]
        D2 > M2 [else]
        c > M2
        M2 > f
    """
    assert derive_range(text, ARM, {"ok": None}) == (1300, 2000)


def test_a_variable_that_a_parallel_branch_assigns_may_have_any_value():
    text = """
        i > F
        F > A
        A = n := 1
        A > J
        F > D
        D > a [n > 0]
        D > b [else]
        a > M
        b > M
        M > J
        J > f
    """
    assert derive_range(text, ARM, {"n": 0}) == (1000, 2000)
    alone = text.replace("A = n := 1", "A = k := 1")
    assert derive_range(alone, ARM, {"n": 0, "k": 0}) == (2000, 2000)


def test_sub_tasks_state_how_often_and_on_which_branch_they_run():
    text = COUNTED_LOOP.replace("D > f [else]", "D > D2 [else]\nD2 > b [ok]\nD2 > M2 [else]\n")
    graph = build_task_graph(text + "b > M2\nM2 > f", {"n": 0, "ok": None})
    sub_tasks = {sub_task.node: sub_task for sub_task in derive_times(graph, ARM).sub_tasks}
    assert sub_tasks["a"].runs == Range(4, 4)
    assert sub_tasks["a"].when == ()
    assert sub_tasks["b"].runs == Range(0, 1)
    assert [(c.decision, c.text) for c in sub_tasks["b"].when] == [("D2", "ok")]


def test_a_search_that_succeeds_early_counts():
    text = """
        i > M
        M > a
        a -> ok
        a > D1
        D1 > f1 [ok]
        D1 > A [else]
        A = n := n + 1
        A > D2
        D2 > M [n < 3]
        D2 > f2 [else]
    """
    derived = derive_times(build_task_graph(text, {"n": 0, "ok": False}), ARM)
    assert derived.duration == Range(1000, 3000)
    assert [(end.node, end.duration, end.is_early) for end in derived.ends] == [
        ("f1", Range(1000, 3000), False),
        ("f2", Range(3000, 3000), False),
    ]


def test_an_inner_loop_that_gives_up_ends_the_task_early():
    text = """
        i > M1
        M1 > M2
        M2 > a
        a -> ok
        a > A2
        A2 = tries := tries + 1
        A2 > D2
        D2 > A1 [ok]
        D2 > M2 [not ok and tries < 2]
        D2 > f2 [else]
        A1 = n := n + 1
        A1 > D1
        D1 > M1 [n < 3]
        D1 > f1 [else]
    """
    derived = derive_times(build_task_graph(text, {"n": 0, "tries": 0, "ok": False}), ARM)
    # Only the first piece may be tried twice, because nothing resets 'tries'.
    assert derived.duration == Range(3000, 4000)
    assert [(end.node, end.duration, end.is_early) for end in derived.ends] == [
        ("f1", Range(3000, 4000), False),
        ("f2", Range(2000, 4000), True),
    ]


# -- expected times ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("i > D\nD > a 75%\nD > b 25%\na > M\nb > M\nM > f", 1250),
        # Half of the rounds are repeated: 1 + 1/2 + 1/4 + ... = 2 rounds.
        ("i > M\nM > a\na > D\nD > M 50%\nD > f 50%", 2000),
        ("i > D\nD > a\nD > b\na > M\nb > M\nM > f", None),
        ("i > D\nD > a 75%\nD > b 75%\na > M\nb > M\nM > f", None),
    ],
)
def test_expected_times_follow_from_probabilities(text, expected):
    assert derive_times(build_task_graph(text), ARM).expected == pytest.approx(expected)


def test_a_branch_that_leads_back_to_its_fork_has_no_time():
    """Each round would start another one beside itself; SM604 reports the cycle."""
    graph = build_task_graph("""
        i > M1
        M1 > F1
        F1 > a
        F1 > b
        a > M1
        b > f
    """)
    assert derive_times(graph, {"a": "robot:10", "b": "robot:20"}).duration is None
