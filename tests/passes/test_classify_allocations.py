"""Allocations of actions, of definitions, and of partitions that represent a part."""

import pytest
from pass_runs import print_after_second_run, run_until

from sysmlc.ir import Edge
from sysmlc.ir.query import allocated_from, allocated_to
from sysmlc.ir.text import print_text

SYSML = 'namespace="http://www.omg.org/spec/SysML/20150709/SysML"'
LANES = f"""\
Class robot "Robot"
Class cell "Cell"
  Property arm "arm" aggregation="composite"
    -> typed-by robot
Activity job "Job"
  Partition lane "lane"
    -> represents arm
    Application s stereotype="AllocateActivityPartition" {SYSML}
      -> subject lane
    Partition inner "inner"
  Partition plain "plain"
    -> represents cell
  Action pick "pick" subkind="opaque"
    -> in-partition lane
  Action place "place" subkind="call-behavior"
    -> in-partition inner
    -> calls move
  Action look "look" subkind="opaque"
    -> in-partition plain
  Control start subkind="initial"
    -> in-partition lane
Activity move "Move"
"""
DEFINITION = f"""\
Dependency d subkind="abstraction"
  -> client move
  -> supplier robot
  Application a stereotype="Allocate" {SYSML}
    -> subject d
"""


@pytest.mark.parametrize(
    ("node", "expected"), [("pick", ["arm"]), ("place", ["arm"]), ("look", []), ("start", [])]
)
def test_actions_in_an_allocate_partition_are_allocated_to_the_part_it_represents(node, expected):
    graph, _ = run_until(LANES, "classify")
    assert [target.id for target in graph.targets(graph[node], Edge.ALLOCATED_TO)] == expected


def test_the_pass_is_idempotent():
    graph, _ = run_until(LANES, "classify")
    once = print_text(graph)
    assert print_after_second_run(graph, "classify") == once


def test_an_allocation_of_a_definition_holds_for_its_usages():
    graph, _ = run_until(LANES + DEFINITION, "classify")
    assert [target.id for target in allocated_to(graph, graph["place"])] == ["arm", "robot"]
    assert [target.id for target in allocated_to(graph, graph["move"])] == ["robot"]
    assert [target.id for target in allocated_to(graph, graph["look"])] == []
    sources = allocated_from(graph, graph["arm"])
    assert [source.id for source in sources] == ["pick", "place", "move"]


@pytest.mark.parametrize("tag", ["allocatedTo", "allocatedFrom"])
def test_the_tags_of_sysml_1_2_allocate_like_a_partition(tag):
    subject, value = ("pick", "arm") if tag == "allocatedTo" else ("arm", "pick")
    tags = f'  Application b stereotype="Allocated" {SYSML} tag.{tag}="{value}"\n'
    text = (
        LANES.replace("AllocateActivityPartition", "Other") + tags + f"    -> subject {subject}\n"
    )
    graph, _ = run_until(text, "classify")
    assert graph.targets(graph["pick"], Edge.ALLOCATED_TO) == [graph["arm"]]
