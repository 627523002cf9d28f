"""Damaged state machines: whatever is missing or misdirected, there is a finding or a contract."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from machines import machines

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Kind
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline

_EDGES = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET, Edge.TRIGGER, Edge.TYPED_BY, Edge.EFFECT, Edge.ENTRY)
_TEXTS = ("", "(", "x := ", "else", "nothing", "x", "x > 99", "1 / 0 == 0", "mode", "x.y.z")


def _damage(draw, graph):
    elements = list(graph)
    one = draw(st.sampled_from(elements))
    match draw(st.sampled_from(["remove", "cut", "turn", "text", "subkind"])):
        case "remove" if one.owner is not None:
            graph.remove(one)
        case "cut":
            edge = draw(st.sampled_from(_EDGES))
            for target in graph.targets(one, edge):
                graph.disconnect(edge, one, target)
        case "turn" if one.kind is Kind.TRANSITION:
            edge = draw(st.sampled_from([Edge.FLOW_SOURCE, Edge.FLOW_TARGET]))
            graph.replace_targets(edge, one, [draw(st.sampled_from(elements))])
        case "text":
            key = draw(st.sampled_from(["guard", "body", "when", "condition", "default"]))
            graph.set(one, **{key: draw(st.sampled_from(_TEXTS))})
        case "subkind":
            graph.set(
                one, subkind=draw(st.sampled_from(["initial", "choice", "join", "time", "any"]))
            )


@given(machines(), st.data())
@settings(
    max_examples=examples(50),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
def test_damage_is_no_crash_and_is_not_silent(model, data):
    graph, machine = model
    for _ in range(data.draw(st.integers(1, 3))):
        _damage(data.draw, graph)
    sink = Sink()
    pipeline.load("contracts").run(graph, sink)
    is_drawn = machine.id in graph and any(
        one.kind is Kind.REGION for one in graph.owned(graph[machine.id])
    )
    assert graph.derived(Contract) or not is_drawn or len(sink)
