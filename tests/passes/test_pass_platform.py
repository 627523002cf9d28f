"""The pass ``platform``: bind the machines and services of recipes to elements of a plant."""

import pytest
from pass_runs import list_diagnostics

from sysmlc.analyses import analysis
from sysmlc.analyses.recipe import Recipe
from sysmlc.diagnostics import Sink
from sysmlc.ir import parse_text
from sysmlc.ir.text import print_text
from sysmlc.recipe.plant import Platform

PASS = analysis.load("platform")


def run(text):
    """Return the platform or None, and the diagnostics of the pass."""
    graph, sink = parse_text(text), Sink()
    Recipe().run(graph, Sink())
    PASS.run(graph, sink)
    platforms = graph.derived(Platform)
    return (platforms[0] if platforms else None), sink


PLANT = """\
Package plant "Plant" subkind="instance-hierarchy"
  Instance line "Line"
    -> instance-of line-class
    Instance gate "Gate1" subkind="part"
      -> instance-of gate-class
      -> represents gate-part
      Instance st "st" subkind="part"
        -> instance-of stopper
        -> represents st-part
    Instance oven "Oven" subkind="part"
      -> instance-of oven-class
      -> represents oven-part
      Instance fan "fan" subkind="part"
        -> instance-of fan-class
        -> represents fan-part
  Class line-class "Line" subkind="internal-element"
    Property gate-part "Gate1" role="part"
      -> typed-by gate-class
    Property oven-part "Oven" role="part"
      -> typed-by oven-class
Package roles "Roles" subkind="role-class-lib"
  Class transport "Transport" subkind="role-class"
    Operation carry "Carry"
Package lib "Lib" subkind="system-unit-class-lib"
  Class base "BaseGate"
    -> realizes transport
    Operation read "ReadId"
      Parameter read.tag "tag"
        -> typed-by tag
      Parameter read.id "id" direction="return"
  Class gate-class "Gate"
    -> specializes base
    Property st-part "st" role="part"
      -> typed-by stopper
  Class stopper "Stopper"
    Operation stop "Stop"
      -> method halt
  Class oven-class "Oven"
    Property fan-part "fan" role="part"
      -> typed-by fan-class
  Class fan-class "Fan"
Class tag "Tag"
Activity halt "Halt"
"""
RECIPE = """\
Package p "Recipes"
  Class arm "GateMachine" level="machine"
    Application arm.m stereotype="Machine" namespace="urn:sysmlc:profile:1" {tags}
      -> subject arm
  Activity build "Build" level="recipe"
    Action build.a "work" subkind="call-behavior"
      -> calls work
  Activity work "Work" level="task"
    Action a1 "one" subkind="call-behavior"
      -> calls service
  Activity service "{service}" level="{level}"
{parameters}  Dependency offer role="allocate"
    -> client service
    -> supplier arm
"""
READ = """\
    Parameter service.t "tag"
      -> typed-by tag
    Parameter service.o "number" direction="out"
"""


def build_model(
    service="ReadId",
    tags='tag.amlId="gate"',
    parameters=READ,
    elements="",
    level="machine service",
):
    """Return a plant, a recipe with one service of one machine, and further elements."""
    build_model = RECIPE.format(service=service, tags=tags, parameters=parameters, level=level)
    return PLANT + build_model + elements


def allocate(source, target, file=""):
    location = f" @{file}:1" if file else ""
    ends = f"  -> client {source}\n  -> supplier {target}\n"
    return f'Dependency more role="allocate"{location}\n{ends}'


def list_offers(text):
    """Return the machine, element, operation and reason of each offer; there are no diagnostics."""
    platform, sink = run(text)
    assert list_diagnostics(sink) == []
    return [(o.machine, o.plant, o.operation, o.how) for o in platform.offers]


def list_bindings(platform):
    return [(binding.machine, binding.plant, binding.how) for binding in platform.bindings]


# -- machines ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tags", "elements", "how"),
    [
        ('tag.amlId="gate"', "", "id"),
        ('tag.amlId="{GATE}"', "", "id"),
        ('tag.plantElement="gate"', "", "tag"),
        ("", allocate("arm", "gate"), "allocation"),
        ("", allocate("arm", "gate-part"), "allocation"),
        ("", allocate("arm", "gate-class"), "allocation"),
        ("", allocate("arm", "base"), "allocation"),
        ("", allocate("arm", "gate", file="plant.overlay.yaml"), "overlay"),
    ],
)
def test_a_machine_is_bound_by_tags_by_an_allocation_or_by_the_overlay(tags, elements, how):
    platform, sink = run(build_model(tags=tags, elements=elements))
    assert list_bindings(platform) == [("Recipes::GateMachine", "gate", how)]
    assert list(sink) == []


def test_an_element_of_the_same_name_is_suggested_but_not_bound():
    text = build_model(tags="").replace('"GateMachine"', '"Gate1"')
    platform, (diagnostic,) = run(text)
    assert platform.bindings == ()
    assert diagnostic.rule.code == "SM624"
    assert diagnostic.help == "did you mean 'Plant::Line::Gate1' (id gate)?"


def test_a_machine_that_is_an_element_of_the_plant_is_bound_to_itself():
    text = (
        build_model(tags="")
        .replace("-> supplier arm", "-> supplier gate")
        .replace('Instance gate "Gate1"', 'Instance gate "Gate1" level="machine"')
    )
    platform, sink = run(text)
    assert list_bindings(platform) == [("Plant::Line::Gate1", "gate", "itself")]
    assert list(sink) == []


def test_the_id_takes_precedence_over_an_allocation_to_the_same_element():
    platform, sink = run(build_model(elements=allocate("arm", "gate")))
    assert platform.offers
    assert platform.bindings[0].how == "id"
    assert list(sink) == []


# -- services ------------------------------------------------------------------------------------


def test_an_operation_that_the_block_inherits_offers_the_service():
    assert list_offers(build_model()) == [("Recipes::GateMachine", "gate", "read", "name")]


def test_an_operation_of_a_role_that_the_block_realises_offers_the_service():
    assert list_offers(build_model("Carry", parameters="")) == [
        ("Recipes::GateMachine", "gate", "carry", "name")
    ]


def test_the_method_of_an_operation_is_offered_under_any_name():
    text = build_model("Anything", tags='tag.amlId="st"', parameters="").replace(
        "-> method halt", "-> method service"
    )
    assert list_offers(text) == [("Recipes::GateMachine", "st", "stop", "method")]


def test_a_service_may_be_allocated_to_an_operation():
    text = build_model("Anything", parameters="", elements=allocate("service", "read"))
    assert list_offers(text) == [("Recipes::GateMachine", "gate", "read", "allocation")]


def test_a_service_may_be_allocated_to_an_element():
    text = build_model(
        "Carry", parameters="", tags='tag.amlId="oven"', elements=allocate("service", "gate")
    )
    platform, _ = run(text)
    assert [(o.machine, o.plant, o.operation) for o in platform.offers] == [("", "gate", "carry")]


def test_a_service_without_a_machine_is_searched_in_the_whole_plant():
    text = build_model("ReadId", level="infrastructure service").replace(
        "-> client service", "-> client work"
    )
    assert list_offers(text) == [("", "gate", "read", "name")]


def test_an_infrastructure_service_outside_the_plant_is_not_reported():
    text = build_model("AskDatabase", level="infrastructure service", parameters="").replace(
        "-> client service", "-> client work"
    )
    assert list_offers(text) == []


@pytest.mark.parametrize(
    ("parameters", "problem"),
    [
        ("", "the service has no parameter 'tag', the service has no parameter 'id'"),
        (
            READ + '    Parameter service.x "depth"\n',
            "the operation has no parameter 'depth'",
        ),
        (
            READ.replace('"tag"', '"tag" direction="inout"'),
            "'tag' is inout of the service, in of the operation",
        ),
        (
            READ.replace("typed-by tag", "typed-by stopper"),
            "'tag' is a Stopper of the service, a Tag of the operation",
        ),
    ],
)
def test_an_operation_with_different_parameters_is_reported_and_not_offered(parameters, problem):
    platform, (diagnostic,) = run(build_model(parameters=parameters))
    assert platform.offers == ()
    assert diagnostic.rule.code == "SM627"
    assert diagnostic.message.endswith(f"'Recipes::ReadId': {problem}")


@pytest.mark.parametrize(
    "parameter",
    [
        '    Parameter service.x "spare" multiplicity="0..1"\n',
        '    Parameter service.x "on"\n      -> typed-by arm\n',
    ],
)
def test_optional_parameters_and_machines_as_parameters_are_not_compared(parameter):
    assert list_offers(build_model(parameters=READ + parameter))


def test_the_nearest_name_of_an_operation_is_suggested():
    _, (diagnostic,) = run(build_model("ReadID_"))
    assert (diagnostic.rule.code, diagnostic.help) == ("SM623", "did you mean 'ReadId'?")


# -- the platform as a whole ---------------------------------------------------------------------


def test_unused_elements_are_listed_by_their_topmost_element():
    platform, _ = run(build_model())
    assert [(element.id, element.contents) for element in platform.unused] == [("oven", 1)]
    (used,) = platform.used
    assert (used.id, used.name, used.type) == ("gate", "Plant::Line::Gate1", "Lib::Gate")


def test_a_unit_without_recipe_or_without_plant_has_no_platform():
    assert run(PLANT)[0] is None
    without_plant = 'Class tag "Tag"\n' + build_model(tags='tag.amlId="gate"')[len(PLANT) :]
    platform, sink = run(without_plant)
    assert platform is None
    assert list(sink) == []


def test_a_plant_in_sysml_consists_of_the_elements_that_machines_are_allocated_to():
    recipe = build_model("Run", tags="", parameters="", elements=allocate("arm", "belt"))
    plant = 'Class tag "Tag"\nPackage q "Plant"\n  Class belt "Belt"\n    Operation o "Run"\n'
    offers = list_offers(plant + recipe[len(PLANT) :])
    assert offers == [("Recipes::GateMachine", "belt", "o", "name")]


def test_the_pass_leaves_the_elements_unchanged_and_is_idempotent():
    graph = parse_text(build_model())
    Recipe().run(graph, Sink())
    before = print_text(graph)
    PASS.run(graph, Sink())
    once = graph.derived(Platform)
    PASS.run(graph, Sink())
    assert graph.derived(Platform) == once
    assert print_text(graph) == before


def test_the_order_of_packages_does_not_matter():
    first, *packages = build_model().split("\nPackage ")
    reordered = "\nPackage ".join([first, *reversed(packages)])
    assert run(reordered + "\n")[0] == run(build_model())[0]
