"""The back end as a whole: file names, splitting, templates of users, and diagnostics."""

import re

import pytest
from diagrams import draw, emit

from rule_examples import read_graphs
from sysmlc.backends.plantuml import BAD_TEMPLATE, partitioning
from sysmlc.backends.plantuml.partitioning import split_view
from sysmlc.backends.plantuml.undrawn import NOT_DRAWN, OVERTAKEN
from sysmlc.backends.plantuml.views import GraphView, Line, Node
from sysmlc.ir.text import parse_text

BLOCK = 'Package p "Plant"\n  Class b "Gate" role="block"\n'


def test_a_package_of_95_blocks_is_split_without_losses():
    blocks = "".join(f'  Class b{n} "Block{n}" role="block"\n' for n in range(95))
    texts = draw(parse_text(f'Package p "Plant"\n{blocks}'))
    names = [f"Plant.{n}-of-3.bdd.puml" for n in (1, 2, 3)]
    assert sorted(texts) == names
    assert all(text.count('\nclass "') <= partitioning.MAX_BOXES for text in texts.values())
    assert all(f"part {n} of 3 of Plant" in texts[name] for n, name in enumerate(names, 1))
    assert all(any(f"**Block{n}**" in text for text in texts.values()) for n in range(95))


def test_connected_blocks_are_in_one_part():
    neighbours = {"a": ["c"], "b": ["d"], "c": ["a"], "d": ["b"]}
    assert partitioning.partition(["a", "b", "c", "d"], neighbours, limit=2) == [
        ["a", "c"],
        ["b", "d"],
    ]


def test_a_block_with_too_many_neighbours_is_a_part_of_its_own():
    assert partitioning.partition(["a", "b"], {"a": ["x", "y", "z"]}, limit=3) == [["a"], ["b"]]


def test_the_parts_of_a_split_view_have_every_node_and_every_line():
    nodes = tuple(Node(f"n{n}", f"n{n}", "action", shows=(f"n{n}",)) for n in range(100))
    lines = tuple(Line(f"n{n}", "-->", f"n{n + 1}") for n in range(99))
    parts = split_view(GraphView(nodes, lines), limit=40)
    assert len(parts) == 3
    assert {line for part in parts for line in part.lines} == set(lines)
    assert {id for part in parts for node in part.nodes for id in node.shows} == {
        node.alias for node in nodes
    }


def test_the_children_of_a_large_node_are_in_a_part_of_their_own():
    inner = tuple(Node(f"i{n}", f"i{n}", "state") for n in range(30))
    nodes = (Node("big", "big", "state", children=inner), Node("out", "out", "state"))
    view = GraphView(nodes, (Line("big", "-->", "out"), Line("i3", "-->", "i4")))
    first, second = split_view(view, limit=30)
    assert [node.alias for node in first.nodes] == ["big", "out"]
    assert first.nodes[0].children == ()
    assert {node.alias for node in second.nodes} == {node.alias for node in inner}


def test_equal_names_get_numbers_in_file_names():
    twice = '  Activity a{0} "run"\n    Action x{0} "go" subkind="opaque"\n'
    texts = draw(parse_text('Package p "P"\n' + twice.format(1) + twice.format(2)))
    assert sorted(texts) == ["P.run-2.act.puml", "P.run.act.puml"]


def test_a_template_of_the_user_replaces_the_shipped_one_of_the_same_name(tmp_path):
    (tmp_path / "plantuml").mkdir()
    (tmp_path / "plantuml" / "_style.j2").write_text("skinparam monochrome true\n")
    files, diagnostics = emit(parse_text(BLOCK), tmp_path)
    assert "skinparam monochrome true\nmainframe" in files[0].text
    assert diagnostics == []


@pytest.mark.parametrize("text", ["{{ view.boxs }}", "{% for %}", "{% include 'none.j2' %}"])
def test_a_faulty_template_is_reported(tmp_path, text):
    (tmp_path / "bdd.puml.j2").write_text(text)
    files, diagnostics = emit(parse_text(BLOCK), tmp_path)
    assert files == []
    assert [diagnostic.rule for diagnostic in diagnostics] == [BAD_TEMPLATE]


def test_an_element_in_no_diagram_is_reported():
    _, diagnostics = emit(parse_text('Package p "Plant"\n  Unit u "second"\n'))
    assert [diagnostic.message for diagnostic in diagnostics] == [
        "1 unit of 'Plant' in no diagram: second"
    ]


def test_an_element_in_a_diagram_is_not_reported():
    files, diagnostics = emit(parse_text('Package p "Plant"\n  Class b "Line" role="block"\n'))
    assert len(files) == 1
    assert diagnostics == []


def test_a_connector_without_second_end_is_reported():
    text = BLOCK + '    Connector c "loose"\n'
    _, diagnostics = emit(parse_text(text))
    assert [diagnostic.message for diagnostic in diagnostics] == [
        "1 connector of 'Plant::Gate' in no diagram: loose"
    ]


def test_the_name_of_a_partition_is_on_its_nodes():
    text = """
Activity a "run"
  Partition left "Left"
  Partition right "Right"
  Partition spare "Spare"
  Action x "go" subkind="opaque"
    -> in-partition left
  Action y "stop" subkind="opaque"
    -> in-partition right
"""
    diagram = draw(parse_text(text))["run.act.puml"]
    assert '(Left)</size>\\n<size:10>«opaque»</size>\\ngo" as go_1 <<action>> <<lane1>>' in diagram
    assert 'stop" as stop_1 <<action>> <<lane2>>' in diagram
    assert 'state "Spare" as spare_1 <<lane>>' in diagram


TEMPLATE = """
Package p "Plant"
  Class stack "Stack"
    TemplateParameter t "T" subkind="classifier"
      -> references item
      DataType item "T"
    TemplateParameter n "size"
    Property top "top"
      -> typed-by item
  Class bound "Pallets"
    TemplateBinding b
      -> binds stack
      TemplateSubstitution s1
        -> instance-of t
        -> references pallet
      TemplateSubstitution s2 value=3
        -> instance-of n
  Class pallet "Pallet"
  Class feeding "Feeding" subkind="collaboration"
    Property role "feeder"
  Class cell "Cell"
    Property gate "gate"
    CollaborationUse use "feeding"
      -> typed-by feeding
      Dependency rb subkind="role-binding"
        -> client role
        -> supplier gate
"""


def test_a_template_has_its_parameters_and_a_binding_its_substitutions():
    files, diagnostics = emit(parse_text(TEMPLATE))
    (diagram,) = [file.text for file in files if file.path == "diagrams/Plant.bdd.puml"]
    assert 'class "**Stack<U+003C>T, size<U+003E>**" as stack_1' in diagram
    assert "pallets_1 ..> stack_1 : <size:10>«bind» T → Pallet, size → 3</size>" in diagram
    assert 'class "T"' not in diagram
    assert diagnostics == []


def test_a_collaboration_use_has_its_role_bindings():
    (diagram,) = draw(parse_text(TEMPLATE)).values()
    assert ".. collaborations ..\n{field} feeding : Feeding (feeder = gate)" in diagram


def test_an_actor_is_drawn_with_use_cases_unless_another_diagram_needs_it():
    model = parse_text("""
Package p "Plant"
  Actor a "Operator"
  Actor b "Owner"
  UseCase u "Run"
  Class k "Line"
  Dependency d subkind="dependency"
    -> client b
    -> supplier k
""")
    texts = draw(model)
    assert "Operator" in texts["Plant.uc.puml"]
    assert "Operator" not in texts["Plant.bdd.puml"]
    assert "Owner" in texts["Plant.bdd.puml"]


def test_a_use_case_in_another_has_a_figure_beside_it_because_a_figure_is_no_frame():
    model = parse_text("""
Package p "Plant"
  UseCase u "Run"
    UseCase v "Refill"
""")
    lines = draw(model)["Plant.uc.puml"].splitlines()
    assert [line for line in lines if "Run" in line] == ['usecase "Run" as run_1']
    assert 'usecase "Refill" as refill_1' in lines


def test_a_submachine_has_its_name_its_entry_points_and_protocol_conditions():
    diagram = draw(
        parse_text("""
StateMachine inner "Inner"
  Pseudostate go "go in" subkind="entry-point"
StateMachine outer "Outer"
  Region r
    Pseudostate i subkind="initial"
    State s "Nested"
      -> calls inner
      Pseudostate at "at" subkind="connection-point"
        -> references go
    Transition t guard="ready" subkind="protocol"
      -> flow-source i
      -> flow-target at
      Constraint t.p body="done" subkind="postcondition"
""")
    )["Outer.stm.puml"]
    assert 'state "Nested : Inner" as nested_1 <<state>> {' in diagram
    assert 'state "at" as at_1 <<entryPoint>>' in diagram
    assert "initial_1 --> at_1 : [ready] / [done]" in diagram


@pytest.mark.parametrize(
    "kind",
    [
        *("Unit", "QuantityKind", "View", "GeneralOrdering", "GeneralizationSet", "ParameterSet"),
        *("Stereotype", "Document"),
    ],
)
def test_an_element_that_no_diagram_shows_is_reported(kind):
    _, diagnostics = emit(parse_text(f'Package p "Plant"\n  {kind} x "extra"\n'))
    (message,) = [found.message for found in diagnostics if found.rule == NOT_DRAWN]
    words = re.sub(r"\B[A-Z]", r" \g<0>", kind).lower()
    assert words in message
    assert "extra" in message


def test_a_message_that_another_overtakes_is_reported():
    _, diagnostics = emit(parse_text(read_graphs(OVERTAKEN).wrong))
    assert [diagnostic.message for diagnostic in diagnostics] == [
        "message 'slow' of 'Feed' is drawn where it is sent, though 'quick' comes first on "
        "lifeline 'belt'"
    ]
    _, diagnostics = emit(parse_text(read_graphs(OVERTAKEN).right))
    assert diagnostics == []


def write_services(count: int) -> str:
    """Return a package with a robot, and one with activities that depend on the robot."""
    text = 'Package m "Machines"\n  Class robot "Robot" role="block"\nPackage s "Services"\n'
    for number in range(count):
        text += f'  Activity a{number} "Do {number}"\n    Action n{number} "n"\n'
        text += f'  Dependency d{number} "able {number}" subkind="dependency"\n'
        text += f"    -> client a{number}\n    -> supplier robot\n"
    return text


def test_three_clients_of_another_package_are_boxes_and_four_are_rows():
    few = draw(parse_text(write_services(3)))["Machines.bdd.puml"]
    many = draw(parse_text(write_services(4)))["Machines.bdd.puml"]
    assert few.count("..>") == 3
    assert "depended on by" not in few
    assert many.count("..>") == 0
    assert ".. depended on by ..\n{field} Do 0 able 0\n{field} Do 1 able 1\n" in many


def test_dependencies_in_rows_are_in_the_trace():
    files, diagnostics = emit(parse_text(write_services(5)))
    bdd = next(file for file in files if file.path.endswith("Machines.bdd.puml"))
    assert {f"d{number}" for number in range(5)} <= set(bdd.trace)
    assert diagnostics == []


def test_an_execution_that_ends_in_one_operand_is_active_in_the_other():
    diagram = draw(
        parse_text("""
Interaction sd "Serve"
  Lifeline a "a"
  Lifeline b "b"
  Occurrence s1
    -> covers a
  Occurrence r1
    -> covers b
  Execution x
    -> covers b
    -> start r1
    -> finish s2
  Fragment f subkind="alt"
    Operand f1 guard="good"
      Occurrence s2
        -> covers b
      Occurrence r2
        -> covers a
    Operand f2 guard="else"
      Occurrence s3
        -> covers b
      Occurrence r3
        -> covers a
  Message m1 "ask"
    -> send-event s1
    -> receive-event r1
    -> flow-source a
    -> flow-target b
  Message m2 "yes" subkind="reply"
    -> send-event s2
    -> receive-event r2
    -> flow-source b
    -> flow-target a
  Message m3 "no" subkind="reply"
    -> send-event s3
    -> receive-event r3
    -> flow-source b
    -> flow-target a
""")
    )["Serve.sd.puml"]
    assert (
        diagram[diagram.index("a_1 ->") :]
        == """\
a_1 -> b_1 : ask
activate b_1
alt good
b_1 -->> a_1 : yes
deactivate b_1
else else
b_1 -->> a_1 : no
activate b_1
end
deactivate b_1
@enduml
"""
    )


def test_an_operand_without_a_guard_has_its_name():
    diagram = draw(
        parse_text("""
Interaction sd "Serve"
  Lifeline a "a"
  Fragment f subkind="alt"
    Operand f1 "in time"
    Operand f2 "InteractionOperand2"
    Operand f3 "late" guard="[t > 5]"
""")
    )["Serve.sd.puml"]
    assert "\nalt in time\nelse\nelse t <U+003E> 5\nend\n" in diagram


def test_states_are_drawn_at_any_depth():
    rows = ['StateMachine m "Gate"']
    for level in range(400):
        rows.append(f"{'  ' * (2 * level + 1)}Region r{level}")
        rows.append(f'{"  " * (2 * level + 2)}State s{level} "S{level}"')
    (diagram,) = draw(parse_text("\n".join(rows) + "\n")).values()
    assert 'state "S399" as s399_1 <<state>>' in diagram
