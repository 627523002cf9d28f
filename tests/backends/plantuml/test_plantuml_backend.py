"""The back end as a whole: file names, splitting, templates of users, what it reports."""

import pytest
from diagrams import emitted, texts

from sysmlc.backends.plantuml import partitioning
from sysmlc.backends.plantuml.backend import BAD_TEMPLATE
from sysmlc.backends.plantuml.partitioning import split_view
from sysmlc.backends.plantuml.undrawn import OVERTAKEN
from sysmlc.backends.plantuml.views import GraphView, Line, Node
from sysmlc.ir.text import parse_text

BLOCK = 'Package p "Plant"\n  Class b "Gate" role="block"\n'


def test_a_package_of_95_blocks_is_split_and_loses_none():
    blocks = "".join(f'  Class b{n} "Block{n}" role="block"\n' for n in range(95))
    made = texts(parse_text(f'Package p "Plant"\n{blocks}'))
    names = [f"Plant.{n}-of-3.bdd.puml" for n in (1, 2, 3)]
    assert sorted(made) == names
    assert all(text.count('\nclass "') <= partitioning.MAX_BOXES for text in made.values())
    assert all(f"part {n} of 3 of Plant" in made[name] for n, name in enumerate(names, 1))
    assert all(any(f"**Block{n}**" in text for text in made.values()) for n in range(95))


def test_connected_blocks_stay_together():
    near = {"a": ["c"], "b": ["d"], "c": ["a"], "d": ["b"]}
    assert partitioning.partition(["a", "b", "c", "d"], near, limit=2) == [["a", "c"], ["b", "d"]]


def test_an_item_with_too_many_neighbours_is_a_part_of_its_own():
    assert partitioning.partition(["a", "b"], {"a": ["x", "y", "z"]}, limit=3) == [["a"], ["b"]]


def test_a_cut_graph_shows_every_node_and_every_line():
    nodes = tuple(Node(f"n{n}", f"n{n}", "action", shows=(f"n{n}",)) for n in range(100))
    lines = tuple(Line(f"n{n}", "-->", f"n{n + 1}") for n in range(99))
    parts = split_view(GraphView(nodes, lines), limit=40)
    assert len(parts) == 3
    assert {line for part in parts for line in part.lines} == set(lines)
    assert {id for part in parts for node in part.nodes for id in node.shows} == {
        node.alias for node in nodes
    }


def test_a_large_node_is_closed_and_opened_in_its_own_part():
    inner = tuple(Node(f"i{n}", f"i{n}", "state") for n in range(30))
    nodes = (Node("big", "big", "state", children=inner), Node("out", "out", "state"))
    view = GraphView(nodes, (Line("big", "-->", "out"), Line("i3", "-->", "i4")))
    first, second = split_view(view, limit=30)
    assert [node.alias for node in first.nodes] == ["big", "out"]
    assert first.nodes[0].children == ()
    assert {node.alias for node in second.nodes} == {node.alias for node in inner}


def test_equal_names_get_numbers_in_file_names():
    twice = '  Activity a{0} "run"\n    Action x{0} "go" subkind="opaque"\n'
    made = texts(parse_text('Package p "P"\n' + twice.format(1) + twice.format(2)))
    assert sorted(made) == ["P.run-2.act.puml", "P.run.act.puml"]


def test_a_template_of_the_user_replaces_ours_by_name(tmp_path):
    (tmp_path / "plantuml").mkdir()
    (tmp_path / "plantuml" / "_style.j2").write_text("skinparam monochrome true\n")
    files, sink = emitted(parse_text(BLOCK), tmp_path)
    assert "skinparam monochrome true\nmainframe" in files[0].text
    assert list(sink) == []


@pytest.mark.parametrize("text", ["{{ view.boxs }}", "{% for %}", "{% include 'none.j2' %}"])
def test_a_wrong_template_is_reported(tmp_path, text):
    (tmp_path / "bdd.puml.j2").write_text(text)
    files, sink = emitted(parse_text(BLOCK), tmp_path)
    assert files == []
    assert [found.rule for found in sink] == [BAD_TEMPLATE]


def test_what_no_diagram_shows_is_reported():
    _, sink = emitted(parse_text('Package p "Plant"\n  Unit u "second"\n'))
    assert [found.message for found in sink] == ["1 Unit of 'Plant' in no diagram: second"]


def test_what_a_diagram_shows_is_not_reported():
    files, sink = emitted(parse_text('Package p "Plant"\n  Class b "Line" role="block"\n'))
    assert len(files) == 1
    assert list(sink) == []


def test_a_connector_without_second_end_is_reported():
    text = BLOCK + '    Connector c "loose"\n'
    _, sink = emitted(parse_text(text))
    assert [found.message for found in sink] == [
        "1 Connector of 'Plant::Gate' in no diagram: loose"
    ]


def test_partitions_are_written_on_their_nodes():
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
    made = texts(parse_text(text))["run.act.puml"]
    assert '(Left)</size>\\n<size:10>«opaque»</size>\\ngo" as go_1 <<action>> <<lane1>>' in made
    assert 'stop" as stop_1 <<action>> <<lane2>>' in made
    assert 'state "Spare" as spare_1 <<lane>>' in made


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


def test_templates_and_what_is_made_of_them():
    files, sink = emitted(parse_text(TEMPLATE))
    (made,) = [file for file in files if file.path == "diagrams/Plant.bdd.puml"]
    assert 'class "**Stack<U+003C>T, size<U+003E>**" as stack_1' in made.text
    assert "pallets_1 ..> stack_1 : <size:10>«bind» T → Pallet, size → 3</size>" in made.text
    assert 'class "T"' not in made.text
    assert list(sink) == []


def test_a_collaboration_use_says_who_plays_which_role():
    (made,) = texts(parse_text(TEMPLATE)).values()
    assert ".. collaborations ..\n{field} feeding : Feeding (feeder = gate)" in made


def test_an_actor_of_use_cases_is_in_their_diagram_only():
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
    made = texts(model)
    assert "Operator" in made["Plant.uc.puml"]
    assert "Operator" not in made["Plant.bdd.puml"]
    assert "Owner" in made["Plant.bdd.puml"]


def test_submachines_their_points_and_protocols():
    made = texts(
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
    assert 'state "Nested : Inner" as nested_1 <<state>> {' in made
    assert 'state "at" as at_1 <<entryPoint>>' in made
    assert "initial_1 --> at_1 : [ready] / [done]" in made


def test_a_message_that_another_overtakes_is_reported():
    _, sink = emitted(parse_text(OVERTAKEN.read_page().wrong))
    assert [found.message for found in sink] == [
        "message 'slow' of 'Feed' is drawn where it is sent, though 'quick' comes first on "
        "lifeline 'belt'"
    ]
    _, sink = emitted(parse_text(OVERTAKEN.read_page().right))
    assert list(sink) == []


def _with_services(count: int) -> str:
    text = 'Package m "Machines"\n  Class robot "Robot" role="block"\nPackage s "Services"\n'
    for number in range(count):
        text += f'  Activity a{number} "Do {number}"\n    Action n{number} "n"\n'
        text += f'  Dependency d{number} "able {number}" subkind="dependency"\n'
        text += f"    -> client a{number}\n    -> supplier robot\n"
    return text


def test_few_foreign_clients_are_boxes_and_many_are_rows():
    few = texts(parse_text(_with_services(3)))["Machines.bdd.puml"]
    many = texts(parse_text(_with_services(4)))["Machines.bdd.puml"]
    assert few.count("..>") == 3
    assert "depended on by" not in few
    assert many.count("..>") == 0
    assert ".. depended on by ..\n{field} Do 0 able 0\n{field} Do 1 able 1\n" in many


def test_dependencies_in_rows_are_in_the_trace():
    files, sink = emitted(parse_text(_with_services(5)))
    bdd = next(one for one in files if one.path.endswith("Machines.bdd.puml"))
    assert {f"d{number}" for number in range(5)} <= set(bdd.trace)
    assert list(sink) == []


def test_a_bar_that_ends_in_one_operand_stands_in_the_other():
    made = texts(
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
        made[made.index("a_1 ->") :]
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


def test_the_name_of_an_operand_stands_for_a_guard_that_is_not_there():
    made = texts(
        parse_text("""
Interaction sd "Serve"
  Lifeline a "a"
  Fragment f subkind="alt"
    Operand f1 "in time"
    Operand f2 "InteractionOperand2"
    Operand f3 "late" guard="[t > 5]"
""")
    )["Serve.sd.puml"]
    assert "\nalt in time\nelse\nelse t <U+003E> 5\nend\n" in made


def test_states_are_drawn_however_deep_they_are_in_one_another():
    rows = ['StateMachine m "Gate"']
    for level in range(400):
        rows.append(f"{'  ' * (2 * level + 1)}Region r{level}")
        rows.append(f'{"  " * (2 * level + 2)}State s{level} "S{level}"')
    (drawn,) = texts(parse_text("\n".join(rows) + "\n")).values()
    assert 'state "S399" as s399_1 <<state>>' in drawn
