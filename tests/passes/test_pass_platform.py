"""The pass ``platform``: machines and services of recipes on the elements of a plant."""

import pytest

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir import parse_text
from sysmlc.ir.text import print_text
from sysmlc.passes.platform import Platform
from sysmlc.passes.platform import rules as _rules
from sysmlc.passes.recipe import Recipe
from sysmlc.recipe.plant import Platform as Found

RULES = [rule for rule in catalogue().values() if "SM623" <= rule.code <= "SM630"]
assert _rules


def run(text):
    """The platform, if there is one, and what was found."""
    graph, sink, late = parse_text(text), Sink(), Sink()
    Recipe().run(graph, sink)
    Platform().run(graph, late)
    found = graph.derived(Found)
    return (found[0] if found else None), late


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: f"{rule.code}-{rule.name}")
def test_a_rule_reports_its_wrong_model_and_not_its_right_one(rule):
    assert [diagnostic.rule.code for diagnostic in run(rule.read_page().wrong)[1]] == [rule.code]
    assert list(run(rule.read_page().right)[1]) == []


def test_all_rules_are_there():
    assert sorted(rule.code for rule in RULES) == [f"SM{n}" for n in range(623, 631)]


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


def recipe(service="ReadId", tags='tag.amlId="gate"', parameters=READ, more="", **other):
    given = {"level": "machine service", **other}
    return PLANT + RECIPE.format(service=service, tags=tags, parameters=parameters, **given) + more


def allocation(source, target, name="more", file=""):
    place = f" @{file}:1" if file else ""
    return (
        f'Dependency {name} role="allocate"{place}\n  -> client {source}\n  -> supplier {target}\n'
    )


def offers(text):
    found, sink = run(text)
    assert [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in sink] == []
    return [(one.machine, one.plant, one.operation, one.how) for one in found.offers]


# -- machines ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tags", "more", "how"),
    [
        ('tag.amlId="gate"', "", "id"),
        ('tag.amlId="{GATE}"', "", "id"),
        ('tag.plantElement="gate"', "", "tag"),
        ("", allocation("arm", "gate"), "allocation"),
        ("", allocation("arm", "gate-part"), "allocation"),
        ("", allocation("arm", "gate-class"), "allocation"),
        ("", allocation("arm", "base"), "allocation"),
        ("", allocation("arm", "gate", file="plant.overlay.yaml"), "overlay"),
    ],
)
def test_a_machine_is_bound_by_its_tags_by_an_allocation_or_by_the_overlay(tags, more, how):
    found, sink = run(recipe(tags=tags, more=more))
    assert [(one.machine, one.plant, one.how) for one in found.bindings] == [
        ("Recipes::GateMachine", "gate", how)
    ]
    assert list(sink) == []


def test_an_equal_name_binds_nothing_but_is_suggested():
    text = recipe(tags="").replace('"GateMachine"', '"Gate1"')
    found, sink = run(text)
    assert found.bindings == ()
    (one,) = sink
    assert (one.rule.code, one.help) == ("SM624", "did you mean 'Plant::Line::Gate1' (id gate)?")


def test_a_machine_that_is_an_element_of_the_plant_needs_no_binding():
    text = (
        recipe(tags="")
        .replace("-> supplier arm", "-> supplier gate")
        .replace('Instance gate "Gate1"', 'Instance gate "Gate1" level="machine"')
    )
    found, sink = run(text)
    assert [(one.machine, one.plant, one.how) for one in found.bindings] == [
        ("Plant::Line::Gate1", "gate", "itself")
    ]
    assert list(sink) == []


def test_several_ways_to_say_the_same_are_no_fault():
    assert offers(recipe(more=allocation("arm", "gate")))
    assert run(recipe(more=allocation("arm", "gate")))[0].bindings[0].how == "id"


# -- services ------------------------------------------------------------------------------------


def test_an_operation_that_the_block_inherits_offers_the_service():
    assert offers(recipe()) == [("Recipes::GateMachine", "gate", "read", "name")]


def test_an_operation_of_a_role_that_the_block_realises_offers_it_too():
    assert offers(recipe("Carry", parameters="")) == [
        ("Recipes::GateMachine", "gate", "carry", "name")
    ]


def test_the_method_of_an_operation_is_offered_whatever_it_is_called():
    text = recipe("Anything", tags='tag.amlId="st"', parameters="").replace(
        "-> method halt", "-> method service"
    )
    assert offers(text) == [("Recipes::GateMachine", "st", "stop", "method")]


def test_an_operation_may_be_allocated():
    text = recipe("Anything", parameters="", more=allocation("service", "read"))
    assert offers(text) == [("Recipes::GateMachine", "gate", "read", "allocation")]


def test_the_element_may_be_allocated_to_the_service_itself():
    text = recipe(
        "Carry", parameters="", tags='tag.amlId="oven"', more=allocation("service", "gate")
    )
    found, _ = run(text)
    assert [(one.machine, one.plant, one.operation) for one in found.offers] == [
        ("", "gate", "carry")
    ]


def test_a_service_of_no_machine_is_looked_for_in_the_whole_plant():
    text = recipe("ReadId", level="infrastructure service").replace(
        "-> client service", "-> client work"
    )
    assert offers(text) == [("", "gate", "read", "name")]


def test_an_infrastructure_service_that_the_plant_does_not_know_is_no_fault():
    text = recipe("AskDatabase", level="infrastructure service", parameters="").replace(
        "-> client service", "-> client work"
    )
    assert offers(text) == []


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
def test_parameters_must_fit(parameters, problem):
    found, sink = run(recipe(parameters=parameters))
    assert found.offers == ()
    (one,) = sink
    assert one.rule.code == "SM627"
    assert one.message.endswith(f"'Recipes::ReadId': {problem}")


@pytest.mark.parametrize(
    "more",
    [
        '    Parameter service.x "spare" multiplicity="0..1"\n',
        '    Parameter service.x "on"\n      -> typed-by arm\n',
    ],
)
def test_what_may_be_absent_and_machines_are_not_compared(more):
    assert offers(recipe(parameters=READ + more))


def test_a_near_name_of_an_operation_is_suggested():
    (one,) = run(recipe("ReadID_"))[1]
    assert (one.rule.code, one.help) == ("SM623", "did you mean 'ReadId'?")


# -- the platform as a whole ---------------------------------------------------------------------


def test_what_no_recipe_uses_is_listed_by_its_topmost_element():
    found, _ = run(recipe())
    assert [(one.id, one.contents) for one in found.unused] == [("oven", 1)]
    assert [(one.id, one.name, one.type) for one in found.used] == [
        ("gate", "Plant::Line::Gate1", "Lib::Gate")
    ]


def test_without_recipe_or_without_plant_there_is_nothing():
    assert run(PLANT)[0] is None
    alone = 'Class tag "Tag"\n' + recipe(tags='tag.amlId="gate"')[len(PLANT) :]
    found, sink = run(alone)
    assert found is None
    assert list(sink) == []


def test_a_plant_in_sysml_is_what_machines_are_allocated_to():
    alone = (
        'Class tag "Tag"\nPackage q "Plant"\n  Class belt "Belt"\n    Operation o "Run"\n'
        + recipe("Run", tags="", parameters="", more=allocation("arm", "belt"))[len(PLANT) :]
    )
    assert offers(alone) == [("Recipes::GateMachine", "belt", "o", "name")]


def test_the_graph_stays_as_it_is_and_twice_equals_once():
    graph = parse_text(recipe())
    Recipe().run(graph, Sink())
    before = print_text(graph)
    Platform().run(graph, Sink())
    once = graph.derived(Found)
    Platform().run(graph, Sink())
    assert graph.derived(Found) == once
    assert print_text(graph) == before


def test_the_order_of_the_model_does_not_matter():
    blocks = recipe().split("\nPackage ")
    turned = "\nPackage ".join([blocks[0], *reversed(blocks[1:])])
    assert run(turned + "\n")[0] == run(recipe())[0]
