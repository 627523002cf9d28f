"""Durations, loops and order of flow graphs, compared with a calculation by hand and with runs."""

from random import Random

import pytest

from sysmlc.recipe.costs import NodeCost
from sysmlc.recipe.durations import compute_timing
from sysmlc.recipe.expression import make_variable
from sysmlc.recipe.flow import add_loop_nodes, find_cycles, list_forward_edges, sort_nodes
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node, Range

TIMES = {"a": (10, 20), "b": (5, 5), "c": (1, 100), "d": (7, 9)}


def build_graph(text: str, **bounds: int) -> FlowGraph:
    """Return a graph of edges written ``a>b``; the first letter of a node gives its kind."""
    list_decision_kinds = {
        "i": "initial",
        "f": "final",
        "D": "decision",
        "M": "merge",
        "F": "fork",
        "J": "join",
    }
    edges = [pair.split(">") for pair in text.split()]
    names = dict.fromkeys(name for edge in edges for name in edge)
    nodes = tuple(Node(name, list_decision_kinds.get(name[0], "service")) for name in sorted(names))
    flows = tuple(FlowEdge(a, b, guard=make_variable(f"{a}{b}")) for a, b in edges)
    return add_loop_nodes(FlowGraph("g", nodes=nodes, edges=flows), bounds)


def compute_range(text: str, **bounds: int) -> tuple[float, float | None] | None:
    """Return the shortest and the longest time of a graph."""
    graph = build_graph(text, **bounds)
    timing = compute_timing(graph, lambda node: NodeCost(Range(*TIMES[node.id[0]])))
    return None if timing is None else (timing.duration.min, timing.duration.max)


@pytest.mark.parametrize(
    ("text", "bounds", "expected"),
    [
        ("i>a a>b b>f", {}, (15, 25)),
        ("i>D D>a D>b a>M b>M M>f", {}, (5, 20)),
        ("i>F F>a F>b a>J b>J J>f", {}, (10, 20)),
        ("i>F F>a F>D D>b D>c b>M c>M a>J M>J J>d d>f", {}, (17, 109)),
        ("i>M M>a a>D D>M D>f", {"D": 3}, (10, 60)),
        ("i>M M>a a>D D>b b>M D>f", {"D": 3}, (10, 70)),
        ("i>M M>D D>a a>M D>f", {"D": 3}, (0, 60)),
        ("i>M M>D D>a a>M D>f", {"M": 2}, (0, 40)),
        ("i>M M>a a>D D>M D>f", {}, (10, None)),
        ("i>M M>M2 M2>a a>D2 D2>M2 D2>b b>D D>M D>f", {"D": 2, "D2": 3}, (15, 130)),
        ("i>D D>a D>f a>f2", {}, (0, 20)),
    ],
)
def test_durations_equal_those_calculated_by_hand(text, bounds, expected):
    assert compute_range(text, **bounds) == expected


def test_a_graph_with_a_step_of_unknown_duration_has_no_duration():
    assert compute_timing(build_graph("i>a a>f"), lambda node: None) is None


def list_run_times(graph: FlowGraph, limits: dict[str, int]) -> set[int]:
    """Return the times of all runs of a graph without forks, in which each step takes longest."""
    times: set[int] = set()
    stack: list[tuple[str, int, tuple[tuple[str, int], ...]]] = [("i", 0, ())]
    targets: dict[str, list[str]] = {}
    for edge in graph.edges:
        targets.setdefault(edge.source, []).append(edge.target)
    while stack:
        node, clock, counts = stack.pop()
        clock += TIMES[node[0]][1] if node[0] in TIMES else 0
        if node[0] == "f":
            times.add(clock)
        for target in targets.get(node, ()):
            rounds = dict(counts)
            if target == name_merge(node):
                rounds[node] = rounds.get(node, 0) + 1
                if rounds[node] > limits[node] - 1:
                    continue
            stack.append((target, clock, tuple(sorted(rounds.items()))))
    return times


def name_merge(decision: str) -> str:
    """Return the merge at the start of the loop that *decision* repeats."""
    return "M" + decision[1:] if decision[0] == "D" else ""


@pytest.mark.parametrize("seed", range(30))
def test_the_longest_duration_is_that_of_the_longest_run(seed):
    random = Random(seed)
    edges, last, limits = [], "i", {}
    for number in range(random.randint(1, 4)):
        step = f"{random.choice('abcd')}{number}"
        if random.random() < 0.5:
            limits[f"D{number}"] = random.randint(1, 3)
            edges += [f"{last}>M{number}", f"M{number}>{step}", f"{step}>D{number}"]
            edges += [f"D{number}>M{number}"]
            last = f"D{number}"
        else:
            edges += [f"{last}>{step}"]
            last = step
    text = " ".join([*edges, f"{last}>f"])
    expected = max(list_run_times(build_graph(text), limits))
    assert compute_range(text, **limits)[1] == expected


# -- loops -------------------------------------------------------------------------------------


def list_decision_kinds(graph: FlowGraph) -> dict[str, str]:
    """Return the kind of each decision or loop."""
    return {node.id: node.kind for node in graph.nodes if node.id[0] == "D"}


def test_only_decisions_that_close_a_cycle_become_loops():
    graph = build_graph("i>D1 D1>M D1>f M>a a>D2 D2>M D2>f")
    assert list_decision_kinds(graph) == {"D1": "decision", "D2": "loop"}


def test_a_cycle_without_an_exit_is_no_loop():
    graph = build_graph("i>M M>a a>M")
    assert find_cycles([node.id for node in graph.nodes], [("M", "a"), ("a", "M")]) == [["M", "a"]]
    assert not any(edge.role for edge in graph.edges)


def test_every_cycle_contains_a_loop_node():
    random = Random(7)
    for _ in range(200):
        names = ["i", "f", *"abc", "D1", "D2", "D3"]
        edges = {("i", "a"), *(("D" + str(n), "f") for n in (1, 2, 3))}
        edges |= {(random.choice(names[2:]), random.choice(names[2:])) for _ in range(8)}
        graph = build_graph(" ".join(f"{a}>{b}" for a, b in sorted(edges)))
        plain_nodes = {node.id for node in graph.nodes if node.kind not in ("loop", "decision")}
        edges_outside_bodies = [(e.source, e.target) for e in graph.edges if e.role != "body"]
        cycles = find_cycles([node.id for node in graph.nodes], edges_outside_bodies)
        assert all(set(cycle) <= plain_nodes for cycle in cycles)


@pytest.mark.parametrize("text", ["i>M M>a a>D D>M D>f", "i>a a>b b>a", "i>M M>D D>a a>M D>b b>f"])
def test_forward_edges_have_no_cycle_and_follow_the_order_of_nodes(text):
    graph = build_graph(text)
    forward = list_forward_edges(graph)
    names = [node.id for node in graph.nodes]
    assert find_cycles(names, forward) == []
    rank = {id: number for number, id in enumerate(sort_nodes(graph))}
    assert all(rank[a] < rank[b] for a, b in forward)


def test_the_order_of_edges_does_not_change_durations():
    text = "i>F F>a F>D D>b D>c b>M c>M a>J M>J J>d d>f"
    edges = text.split()
    for start in range(len(edges)):
        assert compute_range(" ".join(edges[start:] + edges[:start])) == (17, 109)
