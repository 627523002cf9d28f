"""A state machine with missing or wrong elements has a diagnostic or a contract."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_state_machines import machines

from long_runs import examples
from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Kind
from sysmlc.logic.contract import Contract

_EDGES = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET, Edge.TRIGGER, Edge.TYPED_BY, Edge.EFFECT, Edge.ENTRY)
_TEXTS = ("", "(", "x := ", "else", "nothing", "x", "x > 99", "1 / 0 == 0", "mode", "x.y.z")


def damage(draw, graph):
    """Remove an element or its edges, or change a target, a text or a subkind."""
    elements = list(graph)
    element = draw(st.sampled_from(elements))
    match draw(st.sampled_from(["remove", "disconnect", "redirect", "text", "subkind"])):
        case "remove" if element.owner is not None:
            graph.remove(element)
        case "disconnect":
            edge = draw(st.sampled_from(_EDGES))
            for target in graph.targets(element, edge):
                graph.disconnect(edge, element, target)
        case "redirect" if element.kind is Kind.TRANSITION:
            edge = draw(st.sampled_from([Edge.FLOW_SOURCE, Edge.FLOW_TARGET]))
            graph.replace_targets(edge, element, [draw(st.sampled_from(elements))])
        case "text":
            key = draw(st.sampled_from(["guard", "body", "when", "condition", "default"]))
            graph.set(element, **{key: draw(st.sampled_from(_TEXTS))})
        case "subkind":
            graph.set(
                element, subkind=draw(st.sampled_from(["initial", "choice", "join", "time", "any"]))
            )


@given(machines(), st.data())
@settings(
    max_examples=examples(50),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
def test_a_damaged_state_machine_has_a_diagnostic_or_a_contract(model, data):
    graph, machine = model
    for _ in range(data.draw(st.integers(1, 3))):
        damage(data.draw, graph)
    sink = Sink()
    analysis.load("contracts").run(graph, sink)
    has_region = machine.id in graph and any(
        element.kind is Kind.REGION for element in graph.owned(graph[machine.id])
    )
    assert graph.derived(Contract) or not has_region or len(sink)
