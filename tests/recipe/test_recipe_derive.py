"""Derived content of a recipe: same-machine groups, sub-tasks, and the check of stale content."""

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


def derive_row(
    order: str, hand_modes: dict[str, str], machines: dict[str, str], equipment: str
) -> Model:
    """Return a recipe with one task, whose services run in *order*.

    *hand_modes* states how services use the resource ``hand``, *machines* on which machines they
    run, and *equipment* on which machines the task runs.
    """
    names = order.split()
    nodes = [Node(name, "service", ref=name.upper()) for name in names]
    chain = ["start", *names, "end"]
    edges = tuple(FlowEdge(a, b) for a, b in pairwise(chain))
    service_graph = FlowGraph(
        "T", nodes=(Node("start", "initial"), *nodes, Node("end", "final")), edges=edges
    )
    services, functions, graphs = [], [], []
    for name in sorted(set(names)):
        providers = tuple(Provider(m, 100) for m in machines[name].split())
        kind = "machine" if providers else "infrastructure"
        implementation = name.upper() if name in hand_modes else ""
        services.append(
            Service(
                name.upper(), kind, providers=providers, duration=50, implementation=implementation
            )
        )
        uses = tuple(Resource("hand", mode) for mode in hand_modes.get(name, "").split())
        functions.append(Function(f"f{name}", duration=Range(100, 100), resources=uses))
        function_nodes = (
            Node("s", "initial"),
            Node("c", "function", ref=f"f{name}"),
            Node("e", "final"),
        )
        function_edges = (FlowEdge("s", "c"), FlowEdge("c", "e"))
        graphs.append(FlowGraph(name.upper(), nodes=function_nodes, edges=function_edges))
    modes = tuple(Mode((machine,), 1000) for machine in equipment.split())
    recipe = Recipe("R", (Task("t", equipment=modes, implementation="T"),))
    return derive(
        Model(
            recipe,
            services=tuple(services),
            functions=tuple(functions),
            service_graphs=(service_graph,),
            function_graphs=tuple(graphs),
        )
    )


def list_groups(model: Model) -> list[tuple[str, ...]]:
    """Return the same-machine groups of the task."""
    return [group.nodes for group in model.recipe.tasks[0].derived.same_machine]


def list_messages(model: Model, code: str) -> list[str]:
    """Return the messages of one rule."""
    sink = Sink()
    validate(model, sink, Subject)
    return [diagnostic.message for diagnostic in sink if diagnostic.rule.code == code]


ARMS = {"pick": "A B", "look": "", "turn": "A B", "place": "A B", "wash": "A B"}
HAND_MODES = {"pick": "acquire", "turn": "hold", "place": "release"}


def test_services_from_acquiring_to_releasing_a_resource_are_a_group():
    model = derive_row("wash pick look turn place", HAND_MODES, ARMS, "A B")
    assert list_groups(model) == [("pick", "turn", "place")]
    (group,) = model.recipe.tasks[0].derived.same_machine
    assert group.because == ("fpick acquires hand", "fturn holds hand", "fplace releases hand")


def test_acquiring_a_resource_twice_makes_two_groups():
    modes = {"pick": "acquire", "place": "release", "grab": "acquire", "drop": "release"}
    arms = dict.fromkeys(modes, "A B")
    assert list_groups(derive_row("pick place grab drop", modes, arms, "A B")) == [
        ("pick", "place"),
        ("grab", "drop"),
    ]


def test_a_service_that_acquires_and_releases_a_resource_makes_no_group():
    assert list_groups(derive_row("wash turn", {"wash": "acquire release"}, ARMS, "A B")) == []


def test_a_resource_that_is_never_released_is_reported_and_makes_no_group():
    model = derive_row("pick turn", {"pick": "acquire", "turn": "hold"}, ARMS, "A B")
    assert list_groups(model) == []
    assert len(list_messages(model, "SM618")) == 1


def test_sub_tasks_use_only_the_machines_of_the_task():
    sub_tasks = (
        derive_row("pick look place", HAND_MODES, ARMS, "B").recipe.tasks[0].derived.sub_tasks
    )
    assert [
        (sub_task.node, [m.machines for m in sub_task.alternatives], sub_task.after)
        for sub_task in sub_tasks
    ] == [
        ("pick", [("B",)], ()),
        ("look", [], ("pick",)),
        ("place", [("B",)], ("look",)),
    ]


def test_the_duration_of_a_task_includes_infrastructure_services():
    assert derive_row("pick look place", HAND_MODES, ARMS, "A").recipe.tasks[
        0
    ].derived.duration == Range(250, 250)


def test_a_group_that_no_machine_of_the_task_can_perform_is_reported():
    assert list_messages(derive_row("pick place", HAND_MODES, ARMS, "A"), "SM610") == []
    apart = {**ARMS, "place": "C"}
    assert len(list_messages(derive_row("pick place", HAND_MODES, apart, "A C"), "SM610")) == 1
    outside = {**ARMS, "pick": "A B", "place": "B C"}
    assert len(list_messages(derive_row("pick place", HAND_MODES, outside, "A C"), "SM610")) == 1


def test_groups_that_were_edited_by_hand_are_reported():
    model = derive_row("pick place", HAND_MODES, ARMS, "A B")
    task = model.recipe.tasks[0]
    stale = replace(task, derived=replace(task.derived, same_machine=()))
    changed = replace(model, recipe=replace(model.recipe, tasks=(stale,)))
    (message,) = list_messages(changed, "SM610")
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
