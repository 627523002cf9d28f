"""Levels of recipes that follow from others: machines, OPC UA bindings, pauses (SM483)."""

import pytest

import recipe_samples as samples
from sysmlc.diagnostics import Sink
from sysmlc.driver import load_full_catalogue
from sysmlc.ir import Graph, parse_text
from sysmlc.logic.expressions.expression import Literal
from sysmlc.passes.recipe import Recipe
from sysmlc.recipe.model import Model


def run(text: str, **options: object) -> tuple[Graph, list[str]]:
    graph, sink = parse_text(text), Sink()
    Recipe(**options).run(graph, sink)
    return graph, [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in sink]


def model(text: str) -> Model:
    (found,) = run(text)[0].derived(Model)
    return found


def test_a_block_that_owns_a_machine_function_is_a_machine_and_it_is_told():
    assert [one.id for one in model(samples.OWNED_FUNCTION).machines] == ["Plant::Robot"]
    assert run(samples.OWNED_FUNCTION)[1] == [
        "SM483: 'Plant::Robot' is treated as a machine: it owns the machine function 'Close'"
    ]


def test_the_rule_reports_its_wrong_model_and_not_its_right_one():
    rule = load_full_catalogue()["SM483"]
    assert [one[:5] for one in run(rule.read_page().wrong)[1]] == ["SM483"]
    assert run(rule.read_page().right)[1] == []


def test_where_a_machine_is_said_no_other_block_is_derived_to_be_one():
    cell = 'Class c "Cell" level="machine"'
    text = samples.OWNED_FUNCTION.replace('Class camera "Camera"', cell)
    assert not any(one.startswith("SM483") for one in run(text)[1])
    assert model(text).machines == ()


def test_an_option_says_more_than_what_is_derived():
    found = run(samples.OWNED_FUNCTION, levels={"Plant::Robot": "machine"})[1]
    assert found == []


BOUND = samples.OWNED_FUNCTION.replace(
    '  Class camera "Camera"\n',
    """\
  Stereotype node "Node"
""",
).replace(
    "      -> subject close\n",
    """\
      -> subject close
    Application close.n stereotype="Node" tag.nodeId="{id}" tag.parentNodeId="ns=4;i=7"
      -> subject close
      -> instance-of node
""",
    1,
)


@pytest.mark.parametrize(
    "id",
    [
        "ns=3;s=Close",
        "nsu=urn:robot;i=12",
        "i=85",
        "ns=7;g=09087e75-8e5e-499b-954f-f2a9603db28a",
        "b=M/RbKBsRVkePCePcx24oRA==",
    ],
)
def test_a_stereotype_with_node_ids_as_opc_ua_writes_them_binds(id):
    (close,) = [one for one in model(BOUND.format(id=id)).functions if one.opcua is not None]
    assert close.opcua is not None
    assert (close.id, close.opcua.object, close.opcua.method) == (
        "Plant::Robot::Close",
        "ns=4;i=7",
        id,
    )


@pytest.mark.parametrize("id", ["Close", "ns=x", "i=door", "g=12", "42"])
def test_a_tag_that_is_only_called_so_binds_nothing(id):
    assert all(one.opcua is None for one in model(BOUND.format(id=id)).functions)


PAUSE = samples.OWNED_FUNCTION.replace(
    '  Class camera "Camera"\n',
    """\
  Activity pause "Pause"
    Parameter pause.for "for" direction="in"{more}
      -> typed-by time
  DataType time "DurationValue" external=true qualified_name="{of}"
""",
).replace(
    '    Action l "look" subkind="call-behavior"\n      -> calls look\n',
    """\
    Action l "wait" subkind="call-behavior"
      -> calls pause
      Pin l.for "for" direction="in" value=2 value_unit="s"
""",
)


def _waiting(**parts: str) -> str:
    return PAUSE.format(**{"of": "ISQBase::DurationValue", "more": "", **parts})


def test_a_behaviour_that_is_only_given_a_duration_is_a_pause():
    (graph,) = [one for one in model(_waiting()).service_graphs if one.id == "Plant::Mount"]
    (pause,) = [one for one in graph.nodes if one.kind == "delay"]
    assert pause.expression == Literal(2000)


def test_a_behaviour_that_is_given_something_else_is_none():
    text = _waiting(of="Plant::Height")
    assert not any(one.kind == "delay" for one in model(text).service_graphs[0].nodes)


def test_what_only_says_what_recipes_are_is_no_recipe():
    text = samples.recipe().replace(
        '  Activity r "Build" level="recipe"\n',
        '  Activity kind "Recipe" level="recipe"\n'
        '  Activity r "Build" level="recipe"\n    -> specializes kind\n',
    )
    assert model(text).recipe.id == "Plant::Build"
