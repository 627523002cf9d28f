"""The text of a model, read again, gives the facts of the model."""

import pytest
from sysml_texts import PASSES, refine, write

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Edge, Graph
from sysmlc.passes import pipeline
from sysmlc.sources import Source


def read_back(text):
    """Return the lines of the text of a model, the graph of this text, and the losses.

    Fails if reading the text gives a diagnostic.
    """
    files, losses = write(refine(text))
    sources = [Source(name, content.encode()) for name, content in files.items()]
    graph, sink = Graph(), Sink()
    FRONTEND.read(sources, graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    assert [diagnostic.message for diagnostic in sink] == []
    lines = [line.strip() for line in files["model.sysml"].splitlines() if line.strip()]
    return lines, graph, losses


def list_names(graph, kind):
    return [element.name for element in graph if element.kind == kind]


def list_target_names(graph, name, edge):
    (element,) = [element for element in graph if element.name == name]
    return [target.name for target in graph.targets(element, edge)]


# -- conditions ------------------------------------------------------------------------------------

GUARD = """
Package p "Plant"
  Activity run "Run"
    Control run.i "" subkind="initial"
    Control run.d "" subkind="decision"
    Action run.a "door free" subkind="opaque"
    Action run.b "b" subkind="opaque"
    ControlFlow run.f0 ""
      -> flow-source run.i
      -> flow-target run.d
    ControlFlow run.f1 "" guard="{guard}"
      -> flow-source run.d
      -> flow-target run.a
    ControlFlow run.f2 "" guard="{guard}"
      -> flow-source run.d
      -> flow-target run.b
"""


@pytest.mark.parametrize(
    ("guard", "declaration"),
    [
        ("door shut", "#inWords attribute 'door shut' : Boolean;"),
        ("door free", "#inWords attribute 'door free_2' : Boolean { @Named { name = {guard}; } }"),
        ("door  shut", "#inWords attribute 'door shut' : Boolean { @Named { name = {guard}; } }"),
    ],
)
def test_a_condition_in_words_is_read_with_its_own_words(guard, declaration):
    """Two flows share one attribute, which is no element of the model."""
    lines, graph, _ = read_back(GUARD.replace("{guard}", guard))
    declarations = [line for line in lines if "inWords" in line]
    assert declarations == [declaration.replace("{guard}", f'"{guard}"')]
    guards = [element.attrs["guard"] for element in graph if "guard" in element.attrs]
    assert guards == [guard, guard]
    assert list_names(graph, "Property") == []


# -- nodes of activities ---------------------------------------------------------------------------

NODES = """
Package p "Plant"
  Activity run "Run"
    Parameter run.p "speed" direction="in"
    ActivityParameter run.n "speed" direction="in"
      -> references run.p
    Action run.a "a" subkind="opaque"
    Control run.i "" subkind="initial"
"""


@pytest.mark.parametrize(
    "flow",
    [
        "",
        'ObjectFlow run.f ""\n      -> flow-source run.n',
        'Control run.k "k" subkind="fork"\n    '
        'ObjectFlow run.f ""\n      -> flow-source run.k\n      -> flow-target run.n',
    ],
    ids=["no flow", "flow without target", "flow from a fork without objects"],
)
def test_a_parameter_node_is_read_although_no_flow_needs_it(flow):
    _, graph, _ = read_back(NODES + f"    {flow}\n")
    assert list_names(graph, "ActivityParameter") == ["speed"]


@pytest.mark.parametrize(
    ("ends", "is_written"),
    [
        (("flow-source run.i",), False),
        (("flow-target run.a",), False),
        (("flow-source run.i", "flow-target run.a"), True),
    ],
)
def test_a_control_flow_without_an_end_is_reported_as_lost(ends, is_written):
    edges = "".join(f"\n      -> {end}" for end in ends)
    lines, _, losses = read_back(f'{NODES}    ControlFlow run.f ""{edges}\n')
    assert ("first start then a;" in lines) is is_written
    assert any(loss.startswith("SM736") for loss in losses) is not is_written


# -- interactions ----------------------------------------------------------------------------------

SCENARIO = """
Package p "Plant"
  Class gate "Gate" role="block"
  Class plant "Line" role="block"
    Property plant.g "left" role="part" aggregation="composite"
      -> typed-by gate
    Property plant.h "right" role="part" aggregation="composite"
      -> typed-by gate
{scenario}
"""
INSIDE = """
    Interaction i "Scenario"{role}
      Lifeline i.l "a"
        -> represents plant.h
"""
OUTSIDE = """
  Class c "Context" role="block"
    Interaction i "Scenario"
      Lifeline i.l "a"
        -> represents plant.h
"""


def test_a_lifeline_subsets_a_part_of_the_block_around_it():
    lines, graph, losses = read_back(SCENARIO.replace("{scenario}", INSIDE.replace("{role}", "")))
    assert "ref part a : Gate :> right;" in lines
    assert list_target_names(graph, "a", Edge.REPRESENTS) == ["right"]
    assert losses == []


def test_metadata_states_which_part_of_another_block_a_lifeline_represents():
    lines, graph, _ = read_back(SCENARIO.replace("{scenario}", OUTSIDE))
    fact = '@Kept { attributes = ("represents->Plant::Line::right"); }'
    assert f"ref part a : Gate {{ {fact} }}" in lines
    assert list_target_names(graph, "a", Edge.REPRESENTS) == ["right"]


@pytest.mark.parametrize("role", ["", ' role="test case"'])
def test_an_interaction_stays_an_interaction_if_it_is_a_test_case(role):
    _, graph, _ = read_back(SCENARIO.replace("{scenario}", INSIDE.replace("{role}", role)))
    (interaction,) = [element for element in graph if element.name == "Scenario"]
    assert (interaction.kind, interaction.role) == ("Interaction", "test case" if role else "")
    assert list_names(graph, "Lifeline") == ["a"]


# -- regions and properties ------------------------------------------------------------------------

REGIONS = """
Package p "Plant"
  Class gate "Gate" role="block"
    StateMachine sm "Life"
      Region sm.r ""
        State s "Work"
          Region s.r1 ""
{state}
"""


def list_regions(lines_of_state):
    """Return the number of vertices of each region of a state."""
    _, graph, losses = read_back(REGIONS.replace("{state}", lines_of_state))
    assert losses == []
    (state,) = [element for element in graph if element.name == "Work"]
    return [len(graph.owned(region)) for region in graph.owned(state)]


def test_the_regions_of_a_state_are_read_again_if_they_are_empty():
    inner = '            State s.a "A"'
    assert list_regions("") == [0]
    assert list_regions(inner) == [1]
    assert list_regions(f'{inner}\n          Region s.r2 ""') == [1, 0]


BEHAVIOUR_AS_TYPE = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.p "run"{aggregation}
      -> typed-by b
    {behaviour} b "Behaviour"
"""


@pytest.mark.parametrize("behaviour", ["Activity", "StateMachine"])
@pytest.mark.parametrize("aggregation", ["", ' aggregation="composite"'])
def test_a_property_typed_by_a_behaviour_of_its_class_is_no_behaviour(behaviour, aggregation):
    model = BEHAVIOUR_AS_TYPE.replace("{aggregation}", aggregation)
    _, graph, _ = read_back(model.replace("{behaviour}", behaviour))
    assert list_names(graph, "Property") == ["run"]
    assert list_names(graph, behaviour) == ["Behaviour"]
    assert list_target_names(graph, "run", Edge.TYPED_BY) == ["Behaviour"]


def test_an_activity_without_steps_in_the_text_stays_an_activity():
    model = REGIONS.partition("    StateMachine")[0]
    _, graph, _ = read_back(
        f'{model}    Activity a "Read"\n      Control a.i "" subkind="initial"\n'
    )
    assert list_names(graph, "Activity") == ["Read"]


def test_a_view_that_is_a_package_stays_a_package():
    model = 'Package p "Plant"\n  {kind} v "Overview" role="view"\n'
    for kind in ("Package", "Class"):
        _, graph, _ = read_back(model.replace("{kind}", kind))
        (view,) = [element for element in graph if element.name == "Overview"]
        assert (view.kind, view.role) == (kind, "view")


def test_the_result_of_a_test_case_that_is_an_interaction_is_a_parameter():
    scenario = INSIDE.replace("{role}", ' role="test case"')
    scenario += '      Parameter i.v "verdict" direction="return"\n'
    _, graph, _ = read_back(SCENARIO.replace("{scenario}", scenario))
    assert list_names(graph, "Parameter") == ["verdict"]


# -- approximations --------------------------------------------------------------------------------


def list_approximations(text):
    _, _, losses = read_back(text)
    return [loss for loss in losses if loss.startswith("SM734")]


@pytest.mark.parametrize(("trigger", "count"), [('subkind="any"', 0), ("", 1)])
def test_a_trigger_without_an_event_is_an_approximation(trigger, count):
    state = f"""
        Transition sm.t ""
          -> flow-source s
          -> flow-target s
          -> trigger sm.g
          Trigger sm.g "" {trigger}"""
    found = list_approximations(REGIONS.replace('          Region s.r1 ""\n{state}', state[1:]))
    assert len([loss for loss in found if "a trigger without an event" in loss]) == count


# -- associations ----------------------------------------------------------------------------------

ASSOCIATION = """
Package p "Plant"
  Class gate "Gate" role="block"
    Activity run "Run"
    Association a ""
      -> end gate.p a.e
      Property a.e ""
        -> typed-by gate
    Property gate.p "do"
      -> typed-by {type}
  Class motor "Motor" role="block"
"""


@pytest.mark.parametrize("type_", ["run", "motor"])
def test_an_end_of_an_association_is_the_property_of_the_class_whatever_its_type(type_):
    _, graph, _ = read_back(ASSOCIATION.replace("{type}", type_))
    (association,) = [element for element in graph if element.kind == "Association"]
    ends = graph.targets(association, Edge.END)
    assert [(end.name, graph.owner(end).name) for end in ends] == [("do", "Gate"), ("", "")]
    assert sorted(list_names(graph, "Property")) == ["", "do"]


# -- ports ---------------------------------------------------------------------------------------


def test_the_port_of_a_part_is_written_with_the_path_to_it():
    lines, graph, _ = read_back("""
Package p "Plant"
  Signal go "Go"
  Class belt "Belt" role="block"
    Port belt.p "inlet" role="proxy port" direction="inout"
  Class cell "Cell" role="block"
    Property cell.l "left" aggregation="composite"
      -> typed-by belt
    Activity cell.a "work"
      Action wait "wait" subkind="accept"
        -> trigger wait.t
        Trigger wait.t "" subkind="signal" port="belt.p"
          -> typed-by go
          -> path cell.l
      Action tell "tell" subkind="send" on_port="belt.p"
        -> calls go
        -> path cell.l
""")
    assert any("accept Go via left.inlet" in line for line in lines)
    assert any("send new Go() via left.inlet" in line for line in lines)
    assert list_target_names(graph, "tell", Edge.PATH) == ["left"]
