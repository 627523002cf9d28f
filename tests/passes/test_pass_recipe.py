"""The pass ``recipe``: levels, tasks, machines, materials, graphs, and every rule of recipes."""

import pytest

import recipe_samples as samples
from sysmlc.diagnostics import Severity, Sink
from sysmlc.driver import load_full_catalogue
from sysmlc.ir import Graph, parse_text, verify
from sysmlc.ir.text import print_text
from sysmlc.logic.expressions.expression import Binary, Literal, Unary
from sysmlc.passes.recipe import Recipe
from sysmlc.recipe.expression import make_variable
from sysmlc.recipe.model import MaterialUse, Mode, Model, Range

RULES = [
    rule
    for rule in load_full_catalogue().values()
    if "SM601" <= rule.code <= "SM622" and rule.code != "SM621"
]


def run(text: str, **options: object) -> tuple[Graph, list[str], Sink]:
    """The graph after the pass, the codes found, and the sink."""
    graph, sink = parse_text(text), Sink()
    Recipe(**options).run(graph, sink)
    return graph, [diagnostic.rule.code for diagnostic in sink], sink


def model(text: str, **options: object) -> Model:
    """The only recipe of a text."""
    (found,) = run(text, **options)[0].derived(Model)
    return found


def profiled(of: str, stereotype: str, tags: str = "") -> str:
    """Application of the shipped profile, for the place of an element's child."""
    return (
        f'Application {of}.{stereotype} stereotype="{stereotype}"'
        f' namespace="urn:sysmlc:profile:1" {tags}\n          -> subject {of}'
    )


# -- rules -------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: f"{rule.code}-{rule.name}")
def test_a_rule_reports_its_wrong_model_and_not_its_right_one(rule):
    assert rule.code in run(rule.read_page().wrong)[1]
    assert run(rule.read_page().right)[1] == []


def test_all_rules_are_there():
    numbers = {int(rule.code[2:]) for rule in RULES}
    assert numbers == {*range(601, 621), 622}


def test_a_finding_names_the_element_and_both_numbers():
    _, _, sink = run(samples.task(mount="500"))
    (found,) = sink
    assert found.message == (
        "task 'Plant::Build::mount' takes 600 ms by its services, but 500 ms on 'Plant::Robot'"
    )
    assert found.subject.id == "r.a"
    assert found.severity is Severity.WARNING


# -- the pass as a pass ------------------------------------------------------------------------


def test_the_graph_stays_as_it_is_and_twice_equals_once():
    graph = parse_text(samples.task())
    before = print_text(graph)
    Recipe().run(graph, Sink())
    once = graph.derived(Model)
    Recipe().run(graph, Sink())
    assert graph.derived(Model) == once
    assert print_text(graph) == before
    assert verify(graph) == []


def test_order_of_the_model_does_not_matter():
    lines = samples.NODES.split("    ")
    nodes = "    ".join(lines[:1] + lines[-1:] + lines[-2:0:-1])
    with_pin = samples.NODES.split("    Control d")[0]
    turned = samples.NODES.replace(with_pin, "") + with_pin
    assert nodes != samples.NODES
    assert model(samples.task(nodes=turned)) == model(samples.task())
    flows = tuple(reversed(samples.STEPS))
    found, expected = model(samples.task(steps=flows)), model(samples.task())
    assert found.recipe == expected.recipe
    ids = [[node.id for node in one.service_graphs[0].nodes] for one in (found, expected)]
    assert ids[0] == ids[1]


# -- levels ------------------------------------------------------------------------------------


def test_levels_of_the_options_win():
    text = samples.recipe().replace(' level="machine"', "")
    assert "SM601" in run(text)[1]
    assert run(text, levels={"Plant::Robot": "machine"})[1] == []


def test_a_stereotype_that_specialises_the_profile_counts_and_a_namesake_does_not():
    def with_machine(application: str) -> str:
        return samples.recipe().replace(
            'Class robot "Robot" level="machine"', f'Class robot "Robot"\n    {application}'
        )

    ours = 'Application x stereotype="Arm" namespace="urn:own" lineage=["Arm", "Machine"]'
    foreign = 'Application x stereotype="Machine" namespace="urn:own"'
    edge = "\n      -> subject robot"
    assert run(with_machine(ours + edge))[1] == []
    assert "SM601" in run(with_machine(foreign + edge))[1]


def test_an_equal_name_only_suggests():
    rule = load_full_catalogue()["SM619"]
    found = model(rule.read_page().wrong)
    assert {task.implementation for task in found.recipe.tasks} == {""}


# -- tasks -------------------------------------------------------------------------------------

THESIS = """
Package p "P"
  Class Robot "Robot" level="machine"
  Class Press "Press" level="machine"
  Class Piece "Piece" level="material"
  Class Assemble "Assemble" level="task"
  Class Store "Store" level="task"
  Activity r "Build" level="recipe"
    ObjectNode a "assemble"
      -> typed-by Assemble
    ObjectNode s "store"
      -> typed-by Store
    ObjectNode m "robot"
      -> typed-by Robot
    ObjectNode m2 "press"
      -> typed-by Press
    ObjectNode x "pieces"
      -> typed-by Piece
    ObjectNode y "stack"
      -> typed-by Piece
    ObjectFlow f1
      {capability}
      -> flow-source m
      -> flow-target a
    ObjectFlow f2
      {second}
      -> flow-source m2
      -> flow-target a
    ObjectFlow f3 weight="3"
      -> flow-source x
      -> flow-target a
    ObjectFlow f4
      -> flow-source a
      -> flow-target y
    ObjectFlow f5
      -> flow-source y
      -> flow-target s
    ObjectFlow f6
      -> flow-source m
      -> flow-target s
"""


def thesis(first: str = "", second: str = "") -> Model:
    """The recipe with capability tags on the flows from the two machines."""
    return model(
        THESIS.format(
            capability=profiled("f1", "Capability", first),
            second=profiled("f2", "Capability", second),
        )
    )


def test_tasks_machines_and_materials_are_object_nodes_as_in_the_thesis():
    found = thesis('tag.duration="900" tag.minPower="60" tag.maxPower="200"', 'tag.duration="800"')
    assemble, store = found.recipe.tasks
    assert assemble.id == "P::Build::assemble"
    assert assemble.equipment == (
        Mode(("P::Press",), 800),
        Mode(("P::Robot",), 900, Range(60, 200)),
    )
    assert store.equipment == (Mode(("P::Robot",)),)


def test_precedence_follows_material_but_not_machines():
    assert thesis().recipe.precedence == (("P::Build::assemble", "P::Build::store"),)


def test_a_material_that_goes_in_and_out_is_carried():
    assemble, store = thesis().recipe.tasks
    assert assemble.materials == (MaterialUse("P::Piece", 3, "carried"),)
    assert store.materials == (MaterialUse("P::Piece", 1, "consumed"),)


def test_relations_of_one_mode_are_needed_at_the_same_time():
    found = thesis(
        'tag.mode="both" tag.duration="900" tag.minPower="60" tag.maxPower="200"',
        'tag.mode="both" tag.duration="700" tag.minPower="40" tag.maxPower="100"',
    )
    together = Mode(("P::Press", "P::Robot"), 900, Range(100, 300))
    assert found.recipe.tasks[0].equipment == (together,)


def test_a_dependency_on_several_machines_needs_them_all():
    text = samples.recipe(supplier="robot press").replace(
        '  Activity r "Build"', '  Class press "Press" level="machine"\n  Activity r "Build"'
    )
    mill = next(task for task in model(text).recipe.tasks if task.name == "mill")
    assert [mode.machines for mode in mill.equipment] == [("Plant::Press", "Plant::Robot")]


def test_an_association_with_capability_relates_a_task_to_a_machine():
    text = samples.recipe().replace(
        '  Dependency drill.on role="allocate"\n    -> client drill\n    -> supplier robot\n',
        "  Association a\n    "
        + profiled("a", "Capability", 'tag.duration="70"')
        + "\n    -> end a.t a.m\n    Property a.t\n      -> typed-by drill\n"
        "    Property a.m\n      -> typed-by robot\n",
    )
    drill = next(task for task in model(text).recipe.tasks if task.name == "drill")
    assert drill.equipment == (Mode(("Plant::Robot",), 70),)


def test_a_machine_may_be_an_object_node_only():
    text = THESIS.replace('Class Press "Press" level="machine"', 'Class Press "Press"').replace(
        'ObjectNode m2 "press"', 'ObjectNode m2 "press" level="machine"'
    )
    found = model(text.format(capability="", second=""))
    assert ("P::Build::press",) in [m.machines for m in found.recipe.tasks[0].equipment]


def test_a_partition_that_represents_a_machine_equips_the_task():
    text = samples.recipe().replace(
        "      -> calls drill\n",
        "      -> calls drill\n      -> in-partition lane\n"
        '    Partition lane "lane"\n      -> represents lathe\n',
    )
    text += '  Class lathe "Lathe" level="machine"\n'
    drill = next(task for task in model(text).recipe.tasks if task.name == "drill")
    assert drill.equipment == (Mode(("Plant::Lathe",)),)


def test_precedence_goes_through_forks_and_joins():
    text = samples.recipe("r.i r.k", "r.k r.a", "r.k r.b", "r.a r.j", "r.b r.j", "r.j r.f")
    text = text.replace(
        '    Control r.f "end" subkind="final"\n',
        '    Control r.f "end" subkind="final"\n    Control r.k subkind="fork"\n'
        '    Control r.j subkind="join"\n',
    )
    assert model(text).recipe.precedence == ()


# -- graphs ------------------------------------------------------------------------------------


def graph_of(*steps: str, nodes: str = samples.NODES, **parts: str):
    """Nodes by their short ids and the service graph, for the sample with these flows."""
    found = model(samples.task(nodes=nodes, steps=steps or samples.STEPS, **parts))
    graph = found.service_graphs[0]
    return {node.id.rpartition("::")[2]: node for node in graph.nodes}, graph


def test_results_are_variables_and_guards_are_trees():
    nodes, graph = graph_of()
    assert nodes["look"].assign == (("ok", "ok"),)
    guards = {edge.text: edge.guard for edge in graph.edges if edge.text}
    assert guards == {"ok": make_variable("ok"), "else": None}
    assert {edge.text for edge in graph.edges if edge.is_else} == {"else"}


def test_a_decision_that_goes_back_is_a_loop_with_body_and_exit():
    nodes, graph = graph_of("s m", "m l", "l d", "d m ok", "d g else", "g a", "a b", "b e")
    loop = nodes["good?"]
    assert (loop.kind, loop.expression, loop.max_iterations) == ("loop", make_variable("ok"), None)
    roles = {e.target.rpartition("::")[2]: e.role for e in graph.edges if e.source == loop.id}
    assert roles == {"after": "body", "grip": "exit"}


def test_the_guard_of_the_way_out_says_when_a_loop_goes_on():
    nodes, _ = graph_of("s m", "m l", "l d", "d m else", "d g ok", "g a", "a b", "b e")
    assert nodes["good?"].expression == Unary("not", make_variable("ok"))


def test_a_bound_stands_on_the_decision():
    bounded = '"good?" subkind="decision"\n      ' + profiled("d", "Loop", 'tag.maxIterations="4"')
    nodes, _ = graph_of(
        "s m",
        "m l",
        "l d",
        "d m ok",
        "d g else",
        "g a",
        "a b",
        "b e",
        nodes=samples.NODES.replace('"good?" subkind="decision"', bounded),
    )
    assert nodes["good?"].max_iterations == 4


def test_several_assignments_are_a_chain():
    nodes, graph = graph_of(
        "s g",
        "g x",
        "x l",
        "l a",
        "a e",
        nodes=samples.NODES
        + '    Action x "count" subkind="opaque" body="n := n + 1; ok := true"\n',
    )
    assert nodes["count"].variable == "n"
    assert nodes["count"].expression == Binary("+", make_variable("n"), Literal(1))
    assert nodes["count#2"].variable == "ok"
    ends = {(e.source.rpartition("::")[2], e.target.rpartition("::")[2]) for e in graph.edges}
    assert {("grip", "count"), ("count", "count#2"), ("count#2", "look")} <= ends


def test_an_object_flow_orders_what_no_control_flow_orders():
    flow = "    ObjectFlow o1\n      -> flow-source l.ok\n      -> flow-target a.in\n"
    nodes = samples.NODES.replace(
        '"place" subkind="call-behavior"\n      -> calls place\n',
        '"place" subkind="call-behavior"\n      -> calls place\n'
        '      Pin a.in "ok" direction="in"\n        -> typed-by Boolean\n',
        1,
    )
    found, graph = graph_of("s g", "g l", "a e", nodes=nodes + flow)
    assert found["place"].bind == (("ok", make_variable("ok")),)
    items = {
        (e.source.rpartition("::")[2], e.target.rpartition("::")[2], e.item) for e in graph.edges
    }
    assert ("look", "place", "Plant::Boolean") in items


def test_an_activity_without_initial_and_final_begins_and_ends_as_uml_says():
    drawn = '    Control e "end" subkind="final"\n'
    nodes = samples.NODES.replace('    Control s "start" subkind="initial"\n', "")
    _, graph = graph_of(
        "g l", "l d", "d a ok", "d b else", "a m", "b m", nodes=nodes.replace(drawn, "")
    )
    ends = {(e.source.rpartition("::")[2], e.target.rpartition("::")[2]) for e in graph.edges}
    assert {("initial", "grip"), ("after", "final")} <= ends


def without_a_line() -> list[str]:
    """The sample with one line missing, wherever that leaves a graph."""
    lines = samples.task().splitlines(keepends=True)
    texts = ["".join(lines[:n] + lines[n + 1 :]) for n in range(1, len(lines))]
    return [text for text in texts if is_graph(text)]


def is_graph(text: str) -> bool:
    """Whether the text can be read."""
    try:
        return bool(parse_text(text))
    except ValueError:
        return False


@pytest.mark.parametrize("text", without_a_line(), ids=lambda text: f"{len(text)}")
def test_a_model_with_a_line_missing_is_no_crash(text):
    run(text)


def test_a_tag_that_cannot_be_read_is_told_and_left_out():
    found = model(samples.task(close="-3"))
    assert next(one for one in found.functions if one.id == "Plant::Close").duration is None


def test_a_missing_flow_is_told_once_at_each_of_its_ends():
    steps = tuple(step for step in samples.STEPS if step != "g l")
    found = [
        diagnostic
        for diagnostic in run(samples.task(steps=steps))[2]
        if diagnostic.rule.code == "SM603"
    ]
    assert [one.message for one in found] == [
        "in 'Plant::Mount', no path leads from the initial node to 'look'",
        "in 'Plant::Mount', no path leads from 'grip' to a final node",
    ]


def test_an_unnamed_attribute_and_pin_show_their_kind():
    text = samples.task().replace('Property mount.n "n"', "Property mount.n")
    text = text.replace('Pin l.ok "ok"', "Pin l.ok")
    graph = model(text).service_graphs[0]
    assert [one.name for one in graph.variables] == ["ok", "pin", "property"]
    look = next(node for node in graph.nodes if node.id == "Plant::Mount::look")
    assert look.assign == (("pin", "pin"),)


def test_a_condition_of_a_service_that_cannot_be_read_is_told():
    place = '  Activity place "Place" level="machine service"\n'
    tagged = place + "    " + profiled("place", "MachineService", 'tag.pre="piece in hand"') + "\n"
    _, codes, sink = run(samples.task().replace(place, tagged))
    assert codes == ["SM616"]
    assert "'piece in hand' at 'Plant::Place'" in next(iter(sink)).message


def test_properties_of_a_material_that_have_no_names_may_have_values_of_several_types():
    plate = '  Class plate "Plate" level="material"\n'
    values = '    Property plate.size default=2.5\n    Property plate.colour default="red"\n'
    (material,) = model(samples.task().replace(plate, plate + values)).materials
    assert [value for _, value in material.properties] == [2.5, "red"]
