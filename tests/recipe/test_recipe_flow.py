"""Times, loops and order of flow graphs, against results worked out by hand and by playing them."""

from random import Random

import pytest

from sysmlc.recipe.durations import compute_duration
from sysmlc.recipe.expression import make_variable
from sysmlc.recipe.flow import find_cycles, list_forward_edges, sort_nodes
from sysmlc.recipe.loops import add_loop_nodes
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node, Range

TIMES = {"a": (10, 20), "b": (5, 5), "c": (1, 100), "d": (7, 9)}


def graph(text: str, **bounds: int) -> FlowGraph:
    """Graph of ``a>b`` edges; the first letter of a node tells its kind."""
    kinds = {"i": "initial", "f": "final", "D": "decision", "M": "merge", "F": "fork", "J": "join"}
    edges = [pair.split(">") for pair in text.split()]
    names = dict.fromkeys(name for edge in edges for name in edge)
    nodes = tuple(Node(name, kinds.get(name[0], "service")) for name in sorted(names))
    flows = tuple(FlowEdge(a, b, guard=make_variable(f"{a}{b}")) for a, b in edges)
    return add_loop_nodes(FlowGraph("g", nodes=nodes, edges=flows), bounds)


def time(text: str, **bounds: int) -> tuple[float, float | None] | None:
    """Shortest and longest time of a graph."""
    found = compute_duration(graph(text, **bounds), lambda node: Range(*TIMES[node.id[0]]))
    return None if found is None else (found.min, found.max)


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
def test_times_are_those_worked_out_by_hand(text, bounds, expected):
    assert time(text, **bounds) == expected


def test_a_step_without_a_time_leaves_the_whole_without():
    assert compute_duration(graph("i>a a>f"), lambda node: None) is None


def played(found: FlowGraph, limits: dict[str, int]) -> set[int]:
    """Every time that playing a graph without forks can take, with fixed times."""
    done: set[int] = set()
    stack: list[tuple[str, int, tuple[tuple[str, int], ...]]] = [("i", 0, ())]
    following: dict[str, list[str]] = {}
    for edge in found.edges:
        following.setdefault(edge.source, []).append(edge.target)
    while stack:
        node, clock, taken = stack.pop()
        clock += TIMES[node[0]][1] if node[0] in TIMES else 0
        if node[0] == "f":
            done.add(clock)
        for target in following.get(node, ()):
            rounds = dict(taken)
            if target == limits_head(node):
                rounds[node] = rounds.get(node, 0) + 1
                if rounds[node] > limits[node] - 1:
                    continue
            stack.append((target, clock, tuple(sorted(rounds.items()))))
    return done


def limits_head(decision: str) -> str:
    """The merge that the random loops go back to."""
    return "M" + decision[1:] if decision[0] == "D" else ""


@pytest.mark.parametrize("seed", range(30))
def test_longest_times_are_those_of_playing_every_way(seed):
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
    expected = max(played(graph(text), limits))
    assert time(text, **limits)[1] == expected


# -- loops -------------------------------------------------------------------------------------


def kinds(found: FlowGraph) -> dict[str, str]:
    """Kind of each decision or loop."""
    return {node.id: node.kind for node in found.nodes if node.id[0] == "D"}


def test_only_decisions_that_close_a_cycle_become_loops():
    found = graph("i>D1 D1>M D1>f M>a a>D2 D2>M D2>f")
    assert kinds(found) == {"D1": "decision", "D2": "loop"}


def test_a_cycle_that_nothing_leaves_stays():
    found = graph("i>M M>a a>M")
    assert find_cycles([node.id for node in found.nodes], [("M", "a"), ("a", "M")]) == [["M", "a"]]
    assert not any(edge.role for edge in found.edges)


def test_every_way_round_passes_a_loop_node():
    random = Random(7)
    for _ in range(200):
        names = ["i", "f", *"abc", "D1", "D2", "D3"]
        edges = {("i", "a"), *(("D" + str(n), "f") for n in (1, 2, 3))}
        edges |= {(random.choice(names[2:]), random.choice(names[2:])) for _ in range(8)}
        found = graph(" ".join(f"{a}>{b}" for a, b in sorted(edges)))
        plain = {node.id for node in found.nodes if node.kind not in ("loop", "decision")}
        rest = [(e.source, e.target) for e in found.edges if e.role != "body"]
        left = find_cycles([node.id for node in found.nodes], rest)
        assert all(set(part) <= plain for part in left)


@pytest.mark.parametrize("text", ["i>M M>a a>D D>M D>f", "i>a a>b b>a", "i>M M>D D>a a>M D>b b>f"])
def test_forward_edges_hold_no_cycle_and_reach_the_same(text):
    found = graph(text)
    forward = list_forward_edges(found)
    names = [node.id for node in found.nodes]
    assert find_cycles(names, forward) == []
    rank = {id: number for number, id in enumerate(sort_nodes(found))}
    assert all(rank[a] < rank[b] for a, b in forward)


def test_order_of_nodes_and_edges_does_not_change_times():
    text = "i>F F>a F>D D>b D>c b>M c>M a>J M>J J>d d>f"
    edges = text.split()
    for turn in range(len(edges)):
        assert time(" ".join(edges[turn:] + edges[:turn])) == (17, 109)
