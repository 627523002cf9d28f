"""Branches of an activity are joined before its end, or they are not."""

import random

import pytest

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query.activities import is_joined
from sysmlc.ir.text import parse_text

SUBKINDS = {"s": "initial", "f": "fork", "j": "join", "d": "decision", "m": "merge", "e": "final"}


def drawn(flows):
    """An activity of flows ``a b``; a first letter of SUBKINDS makes a node a control node."""
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


def ends(*flows):
    graph = drawn(flows)
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
def test_what_is_joined_is_over_at_the_end(flows):
    assert ends(*flows)


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
def test_a_branch_that_is_not_joined_goes_on(flows):
    assert not ends(*flows)


def test_ways_to_what_is_no_step_lead_nowhere():
    graph = drawn(["s f", "f x", "f y", "x e"])
    for flow in graph.sources(graph["n.y"], Edge.FLOW_TARGET):
        graph.disconnect(Edge.FLOW_TARGET, flow, graph["n.y"])
        graph.connect(Edge.FLOW_TARGET, flow, graph["a"])
    assert is_joined(graph, graph["n.e"])


def over_by_its_meaning(graph):
    """The same from the definition: for each fork a join without which no way gets anywhere."""
    steps = [one for one in graph if one.kind in (Kind.ACTION, Kind.CONTROL)]
    ways = {
        one.id: [
            graph.target(flow, Edge.FLOW_TARGET).id for flow in graph.sources(one, Edge.FLOW_SOURCE)
        ]
        for one in steps
    }
    waiting = [
        one.id
        for one in steps
        if one.subkind not in ("decision", "merge", "final")
        and len(graph.sources(one, Edge.FLOW_TARGET)) > 1
    ]

    def reached(start, stop=None):
        found, open_ones = set(), [start]
        while open_ones:
            new = [one for one in ways[open_ones.pop()] if one not in found]
            found.update(new)
            open_ones.extend(one for one in new if one != stop)
        return found

    def closes(fork, join):
        before = reached(fork, join) | {fork}
        gone = {one for one in before if one != join and not ways[one]}
        stuck = {one for one in before if not any(not ways[to] for to in reached(one) | {one})}
        return join in before - {fork} and not gone and not stuck

    forks = [one.id for one in steps if len(ways[one.id]) > 1]
    forks = [one for one in forks if graph[one].subkind not in ("decision", "merge")]
    return all(
        any(closes(fork, join) for join in waiting) for fork in forks if "n.e" in reached(fork)
    )


@pytest.mark.parametrize("seed", range(150))
def test_random_activities_agree_with_the_definition(seed):
    chance = random.Random(seed)
    names = ["s", "f", "f2", "j", "j2", "d", "m", "x", "y", "z", "e"]
    some = chance.sample(names[1:-1], chance.randint(2, 8))
    flows = {f"s {some[0]}", f"{some[-1]} e"}
    flows |= {
        f"{one} {other}"
        for one in some
        for other in chance.sample([*some, "e"], chance.choice([1, 1, 2]))
        if one != other
    }
    graph = drawn(sorted(flows))
    assert is_joined(graph, graph["n.e"]) == over_by_its_meaning(graph)
