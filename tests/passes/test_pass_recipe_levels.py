"""The pass ``recipe``: machines, OPC UA bindings and pauses that follow from other elements."""

import pytest
from pass_runs import list_codes, list_messages
from recipe_runs import derive_model, run_recipe

import recipe_samples as samples
from rule_examples import read_graphs
from sysmlc.driver import load_full_catalogue
from sysmlc.ir.expressions import Literal


def test_a_block_that_owns_a_machine_function_is_treated_as_a_machine_and_reported():
    machines = derive_model(samples.OWNED_FUNCTION).machines
    assert [machine.id for machine in machines] == ["Plant::Robot"]
    _, sink = run_recipe(samples.OWNED_FUNCTION)
    assert list_codes(sink) == ["SM483"]
    assert list_messages(sink, "SM483") == [
        "'Plant::Robot' is treated as a machine: it owns the machine function 'Close'"
    ]


def test_rule_reports_its_wrong_example_and_not_its_right_one():
    page = read_graphs(load_full_catalogue()["SM483"])
    assert list_codes(run_recipe(page.wrong)[1]) == ["SM483"]
    assert list_codes(run_recipe(page.right)[1]) == []


def test_in_a_model_with_a_machine_no_other_block_is_treated_as_a_machine():
    cell = 'Class c "Cell" level="machine"'
    text = samples.OWNED_FUNCTION.replace('Class camera "Camera"', cell)
    assert "SM483" not in list_codes(run_recipe(text)[1])
    assert derive_model(text).machines == ()


def test_a_machine_that_an_option_names_is_not_reported():
    _, sink = run_recipe(samples.OWNED_FUNCTION, levels={"Plant::Robot": "machine"})
    assert list(sink) == []


WITH_NODE_ID = samples.OWNED_FUNCTION.replace(
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
def test_tags_with_valid_node_ids_bind_a_function_to_opc_ua(id):
    functions = derive_model(WITH_NODE_ID.format(id=id)).functions
    (close,) = [function for function in functions if function.opcua is not None]
    assert close.id == "Plant::Robot::Close"
    assert (close.opcua.object, close.opcua.method) == ("ns=4;i=7", id)


@pytest.mark.parametrize("id", ["Close", "ns=x", "i=door", "g=12", "42"])
def test_tags_with_invalid_node_ids_bind_nothing(id):
    functions = derive_model(WITH_NODE_ID.format(id=id)).functions
    assert all(function.opcua is None for function in functions)


PAUSE = samples.OWNED_FUNCTION.replace(
    '  Class camera "Camera"\n',
    """\
  Activity pause "Pause"
    Parameter pause.for "for" direction="in"
      -> typed-by time
  DataType time "DurationValue" external=true qualified_name="{type}"
""",
).replace(
    '    Action l "look" subkind="call-behavior"\n      -> calls look\n',
    """\
    Action l "wait" subkind="call-behavior"
      -> calls pause
      Pin l.for "for" direction="in" value=2 value_unit="s"
""",
)


def test_a_behaviour_whose_only_parameter_is_a_duration_is_a_pause():
    model = derive_model(PAUSE.format(type="ISQBase::DurationValue"))
    (graph,) = [graph for graph in model.service_graphs if graph.id == "Plant::Mount"]
    (pause,) = [node for node in graph.nodes if node.kind == "delay"]
    assert pause.expression == Literal(2000)


def test_a_behaviour_with_a_parameter_of_another_type_is_no_pause():
    model = derive_model(PAUSE.format(type="Plant::Height"))
    assert not any(node.kind == "delay" for node in model.service_graphs[0].nodes)


def test_a_general_definition_of_recipes_is_no_recipe():
    text = samples.recipe().replace(
        '  Activity r "Build" level="recipe"\n',
        '  Activity kind "Recipe" level="recipe"\n'
        '  Activity r "Build" level="recipe"\n    -> specializes kind\n',
    )
    assert derive_model(text).recipe.id == "Plant::Build"
