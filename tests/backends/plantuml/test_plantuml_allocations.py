"""Every allocation is in some diagram: as a line, as a lane's title, or as a row."""

import re

import pytest
from diagrams import emitted

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


def drawn(client: str, supplier: str) -> tuple[dict[str, str], list[str]]:
    allocation = (
        '  Dependency d "" role="allocate" subkind="abstraction"\n'
        f"    -> client {client}\n    -> supplier {supplier}\n"
    )
    files, sink = emitted(parse_text(MODEL + allocation))
    shown = {one.path.removeprefix("diagrams/Plant."): one.text for one in files}
    return {name: text.partition("</style>")[2] for name, text in shown.items()}, [
        found.message for found in sink
    ]


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
    shown, findings = drawn(client, supplier)
    assert text in shown[file]
    assert findings == []


def test_a_feature_and_its_own_block_are_told_once():
    shown, _ = drawn("robot.arm", "arm.grip")
    assert len(re.findall("Arm.grip|← Robot.arm", "".join(shown.values()))) == 1


def test_an_allocate_partition_says_so():
    text = MODEL.replace(
        "    Action pick",
        '    Partition lane "lane" role="allocate partition"\n      -> represents robot.arm\n'
        "    Action pick",
    )
    files, _ = emitted(parse_text(text + "      -> in-partition lane\n"))
    act = next(one.text for one in files if one.path.endswith(".act.puml"))
    assert "(«allocate» lane: arm : Arm)" in act
