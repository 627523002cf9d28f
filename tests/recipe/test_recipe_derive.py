"""What follows from a model: same-machine groups, sub-tasks, and that a stale file is noticed."""

from itertools import pairwise

from msgspec.structs import replace

from sysmlc.diagnostics import Sink, Subject
from sysmlc.recipe import validate
from sysmlc.recipe.derivation import derive
from sysmlc.recipe.model import (
    FlowEdge,
    FlowGraph,
    Function,
    Mode,
    Model,
    Node,
    OpcUa,
    Provider,
    Range,
    Recipe,
    Resource,
    Service,
    Task,
)


def made(order: str, does: dict[str, str], machines: dict[str, str], equipment: str) -> Model:
    """A task of services in a row; each does something with ``hand`` and runs on some machines."""
    names = order.split()
    nodes = [Node(name, "service", ref=name.upper()) for name in names]
    chain = ["start", *names, "end"]
    edges = tuple(FlowEdge(a, b) for a, b in pairwise(chain))
    graph = FlowGraph(
        "T", nodes=(Node("start", "initial"), *nodes, Node("end", "final")), edges=edges
    )
    services, functions, graphs = [], [], []
    for name in sorted(set(names)):
        offers = tuple(Provider(m, 100) for m in machines[name].split())
        kind = "machine" if offers else "infrastructure"
        refined = name.upper() if name in does else ""
        services.append(
            Service(name.upper(), kind, providers=offers, duration=50, implementation=refined)
        )
        uses = tuple(Resource("hand", mode) for mode in does.get(name, "").split())
        functions.append(Function(f"f{name}", duration=Range(100, 100), resources=uses))
        inner = (Node("s", "initial"), Node("c", "function", ref=f"f{name}"), Node("e", "final"))
        ways = (FlowEdge("s", "c"), FlowEdge("c", "e"))
        graphs.append(FlowGraph(name.upper(), nodes=inner, edges=ways))
    modes = tuple(Mode((machine,), 1000) for machine in equipment.split())
    recipe = Recipe("R", (Task("t", equipment=modes, implementation="T"),))
    return derive(
        Model(
            recipe,
            services=tuple(services),
            functions=tuple(functions),
            service_graphs=(graph,),
            function_graphs=tuple(graphs),
        )
    )


def groups(model: Model) -> list[tuple[str, ...]]:
    """Same-machine groups of the task."""
    return [group.nodes for group in model.recipe.tasks[0].derived.same_machine]


def findings(model: Model, code: str) -> list[str]:
    """Messages of one rule."""
    sink = Sink()
    validate(model, sink, Subject)
    return [one.message for one in sink if one.rule.code == code]


ARMS = {"pick": "A B", "look": "", "turn": "A B", "place": "A B", "wash": "A B"}
HAND = {"pick": "acquire", "turn": "hold", "place": "release"}


def test_what_touches_the_resource_between_taking_and_giving_back_is_a_group():
    model = made("wash pick look turn place", HAND, ARMS, "A B")
    assert groups(model) == [("pick", "turn", "place")]
    (group,) = model.recipe.tasks[0].derived.same_machine
    assert group.because == ("fpick acquires hand", "fturn holds hand", "fplace releases hand")


def test_two_takings_are_two_groups():
    does = {"pick": "acquire", "place": "release", "grab": "acquire", "drop": "release"}
    arms = dict.fromkeys(does, "A B")
    assert groups(made("pick place grab drop", does, arms, "A B")) == [
        ("pick", "place"),
        ("grab", "drop"),
    ]


def test_a_service_that_takes_and_gives_back_itself_binds_nobody():
    assert groups(made("wash turn", {"wash": "acquire release"}, ARMS, "A B")) == []


def test_what_is_never_given_back_is_no_group_but_told():
    model = made("pick turn", {"pick": "acquire", "turn": "hold"}, ARMS, "A B")
    assert groups(model) == []
    assert len(findings(model, "SM618")) == 1


def test_sub_tasks_use_only_the_machines_of_the_task():
    sub_tasks = made("pick look place", HAND, ARMS, "B").recipe.tasks[0].derived.sub_tasks
    assert [(one.node, [m.machines for m in one.alternatives], one.after) for one in sub_tasks] == [
        ("pick", [("B",)], ()),
        ("look", [], ("pick",)),
        ("place", [("B",)], ("look",)),
    ]


def test_the_duration_of_an_infrastructure_service_counts():
    assert made("pick look place", HAND, ARMS, "A").recipe.tasks[0].derived.duration == Range(
        250, 250
    )


def test_a_group_needs_one_machine_of_the_task():
    assert findings(made("pick place", HAND, ARMS, "A"), "SM610") == []
    apart = {**ARMS, "place": "C"}
    assert len(findings(made("pick place", HAND, apart, "A C"), "SM610")) == 1
    outside = {**ARMS, "pick": "A B", "place": "B C"}
    assert len(findings(made("pick place", HAND, outside, "A C"), "SM610")) == 1


def test_groups_that_were_changed_by_hand_are_noticed():
    model = made("pick place", HAND, ARMS, "A B")
    task = model.recipe.tasks[0]
    stale = replace(task, derived=replace(task.derived, same_machine=()))
    changed = replace(model, recipe=replace(model.recipe, tasks=(stale,)))
    (message,) = findings(changed, "SM610")
    assert "not those that follow" in message
    assert derive(changed) == model


def test_a_malformed_node_id_is_reported():
    call = OpcUa("call", "Robot.Grip", "ns=2;s=Grip", namespace_uri="urn:robot")
    model = Model(Recipe("R", ()), services=(Service("S", "machine", opcua=call),))
    sink = Sink()
    validate(model, sink, Subject)
    assert "the OPC UA call on 'S' has 'Robot.Grip', which is not a node id" in [
        diagnostic.message for diagnostic in sink
    ]
