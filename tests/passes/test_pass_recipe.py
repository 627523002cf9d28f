"""The pass ``recipe``: its rules, and the tasks, machines and materials of recipes."""

import pytest
from pass_runs import list_codes, list_messages
from recipe_runs import derive_model, print_application, run_recipe

import recipe_samples as samples
from rule_examples import has_graphs, read_graphs
from sysmlc.analyses.recipe import Recipe
from sysmlc.diagnostics import Severity, Sink
from sysmlc.driver import load_full_catalogue
from sysmlc.ir import parse_text, verify
from sysmlc.ir.text import print_text
from sysmlc.recipe.model import MaterialUse, Mode, Model, Range, Task

RULES = [
    rule
    for rule in load_full_catalogue().values()
    if "SM601" <= rule.code <= "SM622" and rule.code != "SM621"
]
IN_TEXT_FORM = [rule for rule in RULES if has_graphs(rule)]
"""Rules whose examples are graphs; ``test_driver_rule_pages`` compiles those in SysML v2."""


def list_recipe_codes(text: str, **options: object) -> list[str]:
    """Return the codes of the diagnostics of the pass."""
    return list_codes(run_recipe(text, **options)[1])


def find_task(text: str, name: str) -> Task:
    return next(task for task in derive_model(text).recipe.tasks if task.name == name)


# -- rules -------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", IN_TEXT_FORM, ids=lambda rule: f"{rule.code}-{rule.name}")
def test_rule_reports_its_wrong_example_and_not_its_right_one(rule):
    assert rule.code in list_recipe_codes(read_graphs(rule).wrong)
    assert list_recipe_codes(read_graphs(rule).right) == []


def test_every_code_has_a_rule():
    numbers = {int(rule.code[-3:]) for rule in RULES}
    assert numbers == {*range(601, 621), 622}


def test_a_contradictory_duration_is_reported_with_both_durations():
    _, (diagnostic,) = run_recipe(samples.task(mount="500"))
    assert diagnostic.message == (
        "task 'Plant::Build::mount' takes 600 ms by its services, but 500 ms on 'Plant::Robot'"
    )
    assert diagnostic.subject.id == "r.a"
    assert diagnostic.severity is Severity.WARNING


# -- the pass as a whole -----------------------------------------------------------------------


def test_the_pass_leaves_the_elements_unchanged_and_is_idempotent():
    graph = parse_text(samples.task())
    before = print_text(graph)
    Recipe().run(graph, Sink())
    once = graph.derived(Model)
    Recipe().run(graph, Sink())
    assert graph.derived(Model) == once
    assert print_text(graph) == before
    assert verify(graph) == []


def test_the_order_of_nodes_and_flows_does_not_matter():
    lines = samples.NODES.split("    ")
    nodes = "    ".join(lines[:1] + lines[-1:] + lines[-2:0:-1])
    with_pin = samples.NODES.split("    Control d")[0]
    reordered_nodes = samples.NODES.replace(with_pin, "") + with_pin
    assert nodes != samples.NODES
    expected = derive_model(samples.task())
    assert derive_model(samples.task(nodes=reordered_nodes)) == expected
    model = derive_model(samples.task(steps=tuple(reversed(samples.STEPS))))
    assert model.recipe == expected.recipe
    graph, expected_graph = model.service_graphs[0], expected.service_graphs[0]
    assert [node.id for node in graph.nodes] == [node.id for node in expected_graph.nodes]


# -- levels ------------------------------------------------------------------------------------


def test_an_option_gives_an_element_its_level():
    text = samples.recipe().replace(' level="machine"', "")
    assert "SM601" in list_recipe_codes(text)
    assert list_recipe_codes(text, levels={"Plant::Robot": "machine"}) == []


def test_only_a_stereotype_that_specialises_the_profile_gives_a_level():
    def with_machine(application: str) -> str:
        return samples.recipe().replace(
            'Class robot "Robot" level="machine"', f'Class robot "Robot"\n    {application}'
        )

    own_profile = """
Profile own "Own" uri="urn:own"
  Stereotype arm "Arm"
    -> specializes machine
  Stereotype foreign "Machine"
    -> specializes resource
  Stereotype resource "Resource"
Stereotype machine "Machine" external=true href="pathmap://SYSMLC_PROFILES/sysmlc.profile.uml#m"
"""

    def list_codes_with(stereotype):
        application = f'Application x stereotype="{stereotype}" namespace="urn:own"'
        return list_recipe_codes(
            with_machine(f"{application}\n      -> subject robot") + own_profile
        )

    assert list_codes_with("Arm") == []
    assert "SM601" in list_codes_with("Machine")


def test_an_activity_with_the_name_of_a_task_does_not_implement_the_task():
    rule = load_full_catalogue()["SM619"]
    model = derive_model(read_graphs(rule).wrong)
    assert {task.implementation for task in model.recipe.tasks} == {""}


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


def derive_thesis_model(first: str = "", second: str = "") -> Model:
    """Return the recipe with capability tags on the flows from the two machines."""
    return derive_model(
        THESIS.format(
            capability=print_application("f1", "Capability", first),
            second=print_application("f2", "Capability", second),
        )
    )


def test_tasks_machines_and_materials_are_object_nodes_as_in_the_thesis():
    model = derive_thesis_model(
        'tag.duration="900" tag.minPower="60" tag.maxPower="200"', 'tag.duration="800"'
    )
    assemble, store = model.recipe.tasks
    assert assemble.id == "P::Build::assemble"
    assert assemble.equipment == (
        Mode(("P::Press",), 800),
        Mode(("P::Robot",), 900, Range(60, 200)),
    )
    assert store.equipment == (Mode(("P::Robot",)),)


def test_precedence_follows_material_but_not_machines():
    assert derive_thesis_model().recipe.precedence == (("P::Build::assemble", "P::Build::store"),)


def test_a_material_that_flows_in_and_out_is_carried():
    assemble, store = derive_thesis_model().recipe.tasks
    assert assemble.materials == (MaterialUse("P::Piece", 3, "carried"),)
    assert store.materials == (MaterialUse("P::Piece", 1, "consumed"),)


def test_capabilities_of_the_same_mode_are_needed_together():
    model = derive_thesis_model(
        'tag.mode="both" tag.duration="900" tag.minPower="60" tag.maxPower="200"',
        'tag.mode="both" tag.duration="700" tag.minPower="40" tag.maxPower="100"',
    )
    both = Mode(("P::Press", "P::Robot"), 900, Range(100, 300))
    assert model.recipe.tasks[0].equipment == (both,)


def test_tagged_values_may_have_units():
    model = derive_thesis_model(
        'tag.duration="9 s" tag.minPower="1 kW" tag.maxPower="1500"', 'tag.duration="1.5 min"'
    )
    assert [(mode.duration, mode.power) for mode in model.recipe.tasks[0].equipment] == [
        (90_000, None),
        (9000, Range(1000, 1500)),
    ]


def test_the_value_type_of_a_tag_may_state_its_unit():
    application = (
        'Application f1.c stereotype="Capability" tag.duration="{}"\n'
        "          -> subject f1\n          -> instance-of timed"
    )
    own_stereotype = (
        'Stereotype timed "Capability"\n    Property timed.d "duration"\n'
        '      -> typed-by seconds\n  DataType seconds "Seconds"\n    -> references sec\n'
        '  Unit sec "second" symbol="s"\n  Class Robot'
    )
    text = THESIS.replace("Class Robot", own_stereotype, 1)
    for value, milliseconds in (("9", 9000), ("250 ms", 250)):
        model = derive_model(text.format(capability=application.format(value), second=""))
        assert model.recipe.tasks[0].equipment[1].duration == milliseconds


def test_a_dependency_on_several_machines_needs_all_of_them():
    text = samples.recipe(supplier="robot press").replace(
        '  Activity r "Build"', '  Class press "Press" level="machine"\n  Activity r "Build"'
    )
    equipment = find_task(text, "mill").equipment
    assert [mode.machines for mode in equipment] == [("Plant::Press", "Plant::Robot")]


def test_an_association_with_a_capability_relates_a_task_to_a_machine():
    text = samples.recipe().replace(
        '  Dependency drill.on role="allocate"\n    -> client drill\n    -> supplier robot\n',
        "  Association a\n    "
        + print_application("a", "Capability", 'tag.duration="70"')
        + "\n    -> end a.t a.m\n    Property a.t\n      -> typed-by drill\n"
        "    Property a.m\n      -> typed-by robot\n",
    )
    assert find_task(text, "drill").equipment == (Mode(("Plant::Robot",), 70),)


def test_a_machine_may_be_an_object_node_without_a_machine_class():
    text = THESIS.replace('Class Press "Press" level="machine"', 'Class Press "Press"').replace(
        'ObjectNode m2 "press"', 'ObjectNode m2 "press" level="machine"'
    )
    model = derive_model(text.format(capability="", second=""))
    assert ("P::Build::press",) in [m.machines for m in model.recipe.tasks[0].equipment]


def test_a_partition_that_represents_a_machine_equips_the_task():
    text = samples.recipe().replace(
        "      -> calls drill\n",
        "      -> calls drill\n      -> in-partition lane\n"
        '    Partition lane "lane"\n      -> represents lathe\n',
    )
    text += '  Class lathe "Lathe" level="machine"\n'
    assert find_task(text, "drill").equipment == (Mode(("Plant::Lathe",)),)


def test_tasks_on_parallel_branches_have_no_precedence():
    text = samples.recipe("r.i r.k", "r.k r.a", "r.k r.b", "r.a r.j", "r.b r.j", "r.j r.f")
    text = text.replace(
        '    Control r.f "end" subkind="final"\n',
        '    Control r.f "end" subkind="final"\n    Control r.k subkind="fork"\n'
        '    Control r.j subkind="join"\n',
    )
    assert derive_model(text).recipe.precedence == ()


# -- faulty models -----------------------------------------------------------------------------


def list_texts_without_a_line() -> list[str]:
    """Return the sample without one of its lines, for each line whose removal leaves a graph."""
    lines = samples.task().splitlines(keepends=True)
    texts = ["".join(lines[:n] + lines[n + 1 :]) for n in range(1, len(lines))]
    return [text for text in texts if is_graph(text)]


def is_graph(text: str) -> bool:
    """Whether the text is valid IR text."""
    try:
        return bool(parse_text(text))
    except ValueError:
        return False


@pytest.mark.parametrize("text", list_texts_without_a_line(), ids=lambda text: f"{len(text)}")
def test_the_pass_accepts_a_model_with_a_missing_line(text):
    run_recipe(text)


def test_an_invalid_duration_is_omitted():
    model = derive_model(samples.task(close="-3"))
    (close,) = [function for function in model.functions if function.id == "Plant::Close"]
    assert close.duration is None


def test_a_missing_flow_is_reported_once_at_each_of_its_ends():
    steps = tuple(step for step in samples.STEPS if step != "g l")
    _, sink = run_recipe(samples.task(steps=steps))
    assert list_messages(sink, "SM603") == [
        "in 'Plant::Mount', no path leads from the initial node to 'look'",
        "in 'Plant::Mount', no path leads from 'grip' to a final node",
    ]


def test_a_condition_of_a_service_with_a_syntax_error_is_reported():
    place = '  Activity place "Place" level="machine service"\n'
    tagged = (
        place
        + "    "
        + print_application("place", "MachineService", 'tag.pre="piece in hand"')
        + "\n"
    )
    _, (diagnostic,) = run_recipe(samples.task().replace(place, tagged))
    assert diagnostic.rule.code == "SM616"
    assert "'piece in hand' at 'Plant::Place'" in diagnostic.message


def test_unnamed_properties_of_a_material_may_have_values_of_different_types():
    plate = '  Class plate "Plate" level="material"\n'
    values = '    Property plate.size default=2.5\n    Property plate.colour default="red"\n'
    (material,) = derive_model(samples.task().replace(plate, plate + values)).materials
    assert [value for _, value in material.properties] == [2.5, "red"]
