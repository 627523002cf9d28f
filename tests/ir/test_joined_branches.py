"""Whether all branches of an activity are joined before its final node."""

import random

import pytest

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query.activities import is_joined
from sysmlc.ir.text import parse_text

SUBKINDS = {"s": "initial", "f": "fork", "j": "join", "d": "decision", "m": "merge", "e": "final"}


def draw_activity(flows):
    """Return an activity of flows ``a b``; SUBKINDS maps first letters to control nodes."""
    names = dict.fromkeys(name for flow in flows for name in flow.split())
    lines = ['Activity a "a"']
    for name in names:
        subkind = SUBKINDS.get(name[0])
        kind = f'Control n.{name} "" subkind="{subkind}"' if subkind else f"Action n.{name}"
        lines.append(f"  {kind}")
    for number, flow in enumerate(flows):
        source, target = flow.split()
        lines += [f"  ControlFlow w{number}", f"    -> flow-source n.{source}"]
        lines.append(f"    -> flow-target n.{target}")
    return parse_text("\n".join(lines) + "\n")


def joins_all_branches(*flows):
    graph = draw_activity(flows)
    return is_joined(graph, graph["n.e"])


@pytest.mark.parametrize(
    "flows",
    [
        ("s x", "x e"),
        ("s f", "f x", "f y", "x j", "y j", "j e"),
        ("s f", "f x", "f y", "x f2", "f2 u", "f2 v", "u j", "v j", "y j", "j e"),
        ("s d", "d x", "d f", "x e", "f u", "f v", "u j", "v j", "j e"),
        ("s x", "x u", "x v", "u j", "v j", "j e"),
        ("s m", "m f", "f x", "f y", "x j", "y j", "j d", "d m", "d e"),
        ("s x", "x e", "f u", "f v"),
    ],
)
def test_an_activity_that_joins_its_branches_is_joined_at_the_end(flows):
    assert joins_all_branches(*flows)


@pytest.mark.parametrize(
    "flows",
    [
        ("s f", "f x", "f y", "x e"),
        ("s f", "f x", "f y", "x e", "y e"),
        ("s f", "f x", "f y", "f z", "x j", "y j", "j e"),
        ("s f", "f x", "f y", "x m", "y m", "m e"),
        ("s f", "f x", "f y", "f z", "x j", "y j", "j e", "z m", "m z"),
        ("s x", "x u", "x v", "u e"),
        ("s f", "f d", "f y", "d j", "d e", "y j", "j e"),
    ],
)
def test_an_activity_with_a_branch_that_is_not_joined_is_not_joined_at_the_end(flows):
    assert not joins_all_branches(*flows)


def test_a_flow_to_an_element_that_is_no_node_is_ignored():
    graph = draw_activity(["s f", "f x", "f y", "x e"])
    for flow in graph.sources(graph["n.y"], Edge.FLOW_TARGET):
        graph.disconnect(Edge.FLOW_TARGET, flow, graph["n.y"])
        graph.connect(Edge.FLOW_TARGET, flow, graph["a"])
    assert is_joined(graph, graph["n.e"])


def is_joined_by_definition(graph):
    """Whether each fork that reaches the end has a join that all its branches must pass.

    This is the definition, without the algorithm of the compiler: no path from the fork that stops
    at the join may end elsewhere, and from each of its nodes a path leads to an end.
    """
    nodes = [element for element in graph if element.kind in (Kind.ACTION, Kind.CONTROL)]
    successors = {
        node.id: [
            graph.target(flow, Edge.FLOW_TARGET).id
            for flow in graph.sources(node, Edge.FLOW_SOURCE)
        ]
        for node in nodes
    }
    joins = [
        node.id
        for node in nodes
        if node.subkind not in ("decision", "merge", "final")
        and len(graph.sources(node, Edge.FLOW_TARGET)) > 1
    ]

    def reach(start, stop=None):
        reached, stack = set(), [start]
        while stack:
            new = [id for id in successors[stack.pop()] if id not in reached]
            reached.update(new)
            stack.extend(id for id in new if id != stop)
        return reached

    def closes(fork, join):
        region = reach(fork, join) | {fork}
        has_other_end = any(not successors[id] for id in region - {join})
        can_end = all(any(not successors[end] for end in reach(id) | {id}) for id in region)
        return join in region - {fork} and not has_other_end and can_end

    forks = [
        node.id
        for node in nodes
        if len(successors[node.id]) > 1 and node.subkind not in ("decision", "merge")
    ]
    return all(any(closes(fork, join) for join in joins) for fork in forks if "n.e" in reach(fork))


@pytest.mark.parametrize("seed", range(150))
def test_random_activities_agree_with_the_definition(seed):
    dice = random.Random(seed)
    names = ["s", "f", "f2", "j", "j2", "d", "m", "x", "y", "z", "e"]
    inner_names = dice.sample(names[1:-1], dice.randint(2, 8))
    flows = {f"s {inner_names[0]}", f"{inner_names[-1]} e"}
    flows |= {
        f"{source} {target}"
        for source in inner_names
        for target in dice.sample([*inner_names, "e"], dice.choice([1, 1, 2]))
        if source != target
    }
    graph = draw_activity(sorted(flows))
    assert is_joined(graph, graph["n.e"]) == is_joined_by_definition(graph)
