"""Every allocation is in some diagram: as a line, as the title of a lane, or as a row."""

import re

import pytest
from diagrams import draw_without_style, emit

from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text

MODEL = """\
Package p "Plant"
  Class robot "Robot" role="block"
    Property robot.arm "arm" role="part" aggregation="composite"
      -> typed-by arm
    Property robot.eye "eye" role="part" aggregation="composite"
      -> typed-by arm
    Operation robot.op "grasp"
  Class arm "Arm" role="block"
    Property arm.grip "grip" role="value"
  Class far "Far" role="block" external=true
    Property far.part "part" role="part" external=true
  Activity job "Job"
    Action pick "pick" subkind="opaque" body="x"
"""


def allocate(client: str, supplier: str) -> Graph:
    """Return the graph of the model with an allocation."""
    return parse_text(
        f'{MODEL}  Dependency d "" role="allocate" subkind="abstraction"\n'
        f"    -> client {client}\n    -> supplier {supplier}\n"
    )


@pytest.mark.parametrize(
    ("client", "supplier", "file", "text"),
    [
        ("robot", "arm", "bdd.puml", "robot_1 ..> arm_1 : <size:10>«allocate»</size>"),
        (
            "robot.arm",
            "robot.eye",
            "Robot.ibd.puml",
            "arm_1 ..> eye_1 : <size:10>«allocate»</size>",
        ),
        ("robot.arm", "arm.grip", "bdd.puml", "arm → Arm.grip"),
        ("pick", "robot.arm", "Job.act.puml", "allocated to Robot.arm"),
        ("pick", "robot", "bdd.puml", "← Job.pick"),
        ("far.part", "robot.arm", "bdd.puml", "arm ← Far.part"),
        ("robot", "robot.arm", "bdd.puml", "→ Robot.arm"),
        ("robot.op", "robot.arm", "bdd.puml", "grasp → Robot.arm"),
    ],
)
def test_an_allocation_is_drawn(client, supplier, file, text):
    graph = allocate(client, supplier)
    assert text in draw_without_style(graph)[f"Plant.{file}"]
    assert emit(graph)[1] == []


def test_an_allocation_to_a_feature_is_drawn_once():
    texts = draw_without_style(allocate("robot.arm", "arm.grip")).values()
    assert len(re.findall("Arm.grip|← Robot.arm", "".join(texts))) == 1


def test_an_allocate_partition_has_its_stereotype_in_the_title():
    text = MODEL.replace(
        "    Action pick",
        '    Partition lane "lane" role="allocate partition"\n      -> represents robot.arm\n'
        "    Action pick",
    )
    files, _ = emit(parse_text(text + "      -> in-partition lane\n"))
    act = next(file.text for file in files if file.path.endswith(".act.puml"))
    assert "(«allocate» lane: arm : Arm)" in act
