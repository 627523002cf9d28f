"""Recipes in SysML v2: loops over lists, blocks, helpers, values between tasks and machines."""

from reading_v2 import Reading

from sysmlc.ir.expressions import Literal
from sysmlc.recipe.expression import make_variable
from sysmlc.recipe.model import Model

PASSES = ("resolve", "inherit", "classify", "ports", "behaviours", "recipe")
_AROUND = """
package P {{
    private import RecipeLevels::*;
    private import ScalarValues::*;
    enum def Slot :> Integer {{ left = 1; right = 2; }}
    part def Belt :> Machine {{
        attribute places : Integer[4];
        attribute busy : Boolean {{ @OpcUaCall {{ kind = "read"; node = "ns=2;s=Busy"; }} }}
    }}
    action def Move :> MachineFunction {{ in to : Integer; }}
    {}
    action def Serve :> MachineService {{
        in ref belt : Belt;
        {}
    }}
    action def Work :> Task {{
        in ref belt : Belt;
        out last : Integer = serve.at;
        action serve : Serve {{ in ref :>> belt = Work::belt; {} }}
    }}
    action def All :> Recipe {{
        in ref belt : Belt;
        action work : Work {{ in ref :>> belt = All::belt; }}
    }}
}}"""


def recipe(serving, *, helper="", given="out :>> at;"):
    text = _AROUND.format(helper, f"out at : Integer; {serving}", given)
    reading = Reading(text, passes=PASSES)
    (model,) = reading.graph.derived(Model)
    return model, [diagnostic.rule.code for diagnostic in reading.sink]


def list_edges(graph):
    nodes = {node.id: node.id.rpartition("::")[2] for node in graph.nodes}
    return [
        f"{nodes[e.source]} -> {nodes[e.target]}" + (f" {e.role}" if e.role else "")
        for e in graph.edges
    ]


def test_a_for_loop_is_a_node_with_a_body_and_an_exit():
    model, _ = recipe("""
        first start;
        then for p in belt.places {
            action go : Move { in :>> to = p; }
            then action settle;
        }
        then done;""")
    (graph,) = model.function_graphs
    assert list_edges(graph) == [
        "start -> expansion",
        "expansion -> done exit",
        "expansion -> go body",
        "go -> settle",
        "settle -> expansion",
    ]
    (loop,) = [node for node in graph.nodes if node.kind == "forEach"]
    assert (loop.variable, loop.expression, loop.max_iterations) == (
        "p",
        make_variable("belt.places"),
        4,
    )


def test_a_for_loop_takes_as_long_as_its_list_is_long():
    model, _ = recipe("""
        first start;
        then for p in belt.places { accept after 2 [SI::s]; }
        then done;""")
    (task,) = model.recipe.tasks
    assert (task.derived.duration.min, task.derived.duration.max) == (8000, 8000)


def test_a_loop_inside_a_for_loop_is_a_loop():
    model, codes = recipe("""
        first start;
        then for p in belt.places {
            merge again;
            then action go : Move { in :>> to = p; }
            then decide;
                if belt.busy then again;
                else settle;
            action settle;
        }
        then done;""")
    (graph,) = model.function_graphs
    kinds = {node.id.rpartition("::")[2]: node.kind for node in graph.nodes}
    assert (kinds["expansion"], kinds["decision"]) == ("forEach", "loop")
    assert "settle -> expansion" in list_edges(graph)
    assert "SM604" not in codes


def test_steps_of_a_block_are_steps_of_the_service():
    model, codes = recipe("""
        first start;
        then action both { first start; then action go : Move { in :>> to = 1; } then done; }
        then done;""")
    (graph,) = model.function_graphs
    assert list_edges(graph) == ["start -> both", "both -> go", "go -> end", "end -> done"]
    assert "SM615" not in codes


def test_a_block_with_branches_at_once_stays_one_step():
    _, codes = recipe("""
        first start;
        then action both {
            first start; then fork f;
            then a; then b;
            action a : Move { in :>> to = 1; } action b : Move { in :>> to = 2; }
        }
        then done;""")
    assert "SM615" in codes


def test_several_successions_of_the_start_begin_together():
    """In UML, they compete for one token; the steps of SysML v2 all follow the start."""
    model, codes = recipe("""
        first start then go;
        first start then come;
        action go : Move; then both;
        action come : Move; then both;
        join both; then done;""")
    (graph,) = model.function_graphs
    assert list_edges(graph)[:3] == ["start -> fork", "fork -> come", "fork -> go"]
    assert "SM604" not in codes


def test_a_merge_with_several_successions_is_followed_by_a_fork():
    """Only 'decide' chooses in SysML v2; UML takes such a merge as a merge and a decision."""
    model, codes = recipe("""
        first start; then merge again;
        first again then go;
        first again then come;
        action go : Move; then both;
        action come : Move; then both;
        join both; then done;""")
    (graph,) = model.function_graphs
    assert [(node.id.rpartition("::")[2], node.kind) for node in graph.nodes][1:3] == [
        ("again", "merge"),
        ("fork", "fork"),
    ]
    assert list_edges(graph)[1:4] == ["again -> fork", "fork -> come", "fork -> go"]
    assert "SM604" not in codes


def test_a_helper_has_a_graph_of_its_own():
    helper = """
    action def Wait {
        in ref belt : Belt;
        first start;
        then merge again;
        then decide;
            if belt.busy == false then gone;
            else again;
        action gone;
        then done;
    }"""
    serving = "first start; then action w : Wait { in ref :>> belt = Serve::belt; } then done;"
    model, codes = recipe(serving, helper=helper)
    names = [graph.id for graph in model.function_graphs]
    assert names == ["P::Serve", "P::Wait"]
    (call,) = [node for node in model.function_graphs[0].nodes if node.kind == "call"]
    assert (call.ref, dict(call.bind)) == ("P::Wait", {"belt": make_variable("belt")})
    assert model.functions == ()
    assert "SM614" not in codes


def test_a_helper_that_calls_itself_ends():
    helper = "action def Wait { first start; then action w : Wait; then done; }"
    model, _ = recipe("first start; then action w : Wait; then done;", helper=helper)
    assert [graph.id for graph in model.function_graphs] == ["P::Serve", "P::Wait"]


def test_variables_of_a_machine_are_those_that_are_spoken_of():
    model, _ = recipe("""
        first start;
        then merge again;
        then decide;
            if belt.busy then again;
            else gone;
        action gone;
        then done;""")
    (machine,) = model.machines
    (busy,) = machine.variables
    assert (busy.name, busy.type, busy.node) == ("busy", "boolean", "ns=2;s=Busy")


def test_literals_of_numbers_are_numbers_where_numbers_are_meant():
    model, _ = recipe("first start; then action go : Move { in :>> to = Slot::right; } then done;")
    (go,) = [node for node in model.function_graphs[0].nodes if node.kind == "function"]
    assert dict(go.bind) == {"to": Literal(2)}


def test_an_output_that_is_an_expression_is_assigned_before_the_end():
    text = """
        attribute found : Integer[*] := (1, 2);
        first start; then action go : Move { in :>> to = 1; } then done;
        bind at = found;"""
    model, _ = recipe(text)
    graph = model.function_graphs[0]
    assigned = [(node.variable, node.expression) for node in graph.nodes if node.kind == "assign"]
    assert assigned == [("at", make_variable("found"))]
    assert list_edges(graph) == ["start -> go", "go -> at", "at -> done"]
    assert [variable.value for variable in graph.variables] == [(1, 2)]


def test_the_first_value_of_an_output_is_no_result():
    serving = "first start; then action go : Move { in :>> to = 1; } then done;"
    text = f"out list : Integer[*] := (); {serving}"
    model, _ = recipe(text)
    graph = model.function_graphs[0]
    assert "assign" not in {node.kind for node in graph.nodes}
    assert {output.name: output.value for output in graph.outputs} == {"at": None, "list": ()}


# -- levels that are missing -------------------------------------------------------------------

_WITHOUT_LEVELS = """
package P {
    action def Task;
    action def MachineService;
    action def Pick :> MachineService;
    action def Assemble :> Task { action pick : Pick; }
    action def Build { action assemble : Assemble; }
}"""


def test_definitions_named_like_levels_are_reported_with_the_lines_to_add():
    (diagnostic,) = Reading(_WITHOUT_LEVELS, passes=PASSES).sink
    assert diagnostic.rule.code == "SM640"
    assert diagnostic.notes == (
        "[recipe.levels]",
        'task = "P::Task"',
        'machine-service = "P::MachineService"',
    )


def test_a_model_with_tasks_but_without_services_needs_no_levels():
    without_services = _WITHOUT_LEVELS.replace("MachineService", "Skill")
    assert list(Reading(without_services, passes=PASSES).sink) == []
