"""The same model from Papyrus and from MagicDraw gives the same graph and the same outputs."""

from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dialects.comparing import common_outputs, compile_both, graph_changes
from dialects.magicdraw import write_xml
from dialects.random_models import random_model
from examples.compiling import EXAMPLES, compile_text

DEFAULT = ("contracts", "recipe", "plantuml")


@pytest.mark.parametrize("dialect", ["xml", "mdzip"])
@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_is_the_same_in_both_dialects(model, dialect, tmp_path):
    papyrus = model.read_bytes()
    one, other = compile_both(tmp_path, papyrus, dialect, *DEFAULT)
    assert graph_changes(one, other) == []
    here, there = common_outputs(papyrus, one, other)
    assert here == there
    assert here


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_what_magicdraw_adds_to_sysml_changes_no_output(model, tmp_path):
    papyrus = model.read_bytes()
    adorned = write_xml(papyrus, customised=True)
    assert b"PartProperty" in adorned
    one = compile_text(tmp_path, "model.uml", papyrus, *DEFAULT)
    other = compile_text(tmp_path, "model.xml", adorned, *DEFAULT)
    here, there = common_outputs(papyrus, one, other)
    assert here == there


@pytest.mark.parametrize("seed", range(25))
def test_a_random_model_is_the_same_in_both_dialects(seed, tmp_path):
    papyrus = random_model(Random(seed))
    one, other = compile_both(tmp_path, papyrus, "xml", *DEFAULT)
    assert len(one.graph) > 10
    assert graph_changes(one, other) == []
    here, there = common_outputs(papyrus, one, other)
    assert here == there


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.randoms(use_true_random=False), st.integers(1, 3))
def test_any_random_model_has_one_graph(tmp_path, random, size):
    one, other = compile_both(tmp_path, random_model(random, size), "xml", "ir")
    assert graph_changes(one, other) == []


def test_random_models_hold_what_they_promise():
    """A generator that makes nothing would make the tests above pass."""
    text = b"".join(random_model(Random(seed)) for seed in range(25)).decode()
    wanted = """uml:Port isConjugated PortsAndFlows:FlowProperty Blocks:NestedConnectorEnd
        uml:InformationFlow uml:StateMachine uml:TimeEvent uml:DecisionNode uml:ForkNode
        uml:InputPin Requirements:Requirement Allocations:Allocate Plant:Robot uml:Stereotype
        uml:Enumeration uml:Generalization uml:Operation uml:ActivityPartition"""
    assert [word for word in wanted.split() if word not in text] == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b' isConjugated="true"', b""),
        (b"palletId = expectedId", b"palletId = palletA"),
        (b' Id="BG-1"', b' Id="BG-9"'),
        (b' direction="inout"', b' direction="in"'),
        (b"<sysml:ProxyPort", b"<sysml:Port"),
        (b"<sysml:ItemFlow", b"<sysml:Trace"),
        (b' isRelative="true"', b""),
        (b'value="0.3"', b'value="0.4"'),
        (b'name="Released"', b'name="Freed"'),
        (b" partWithPort=", b" ignored="),
        (b'"uml:MergeNode"', b'"uml:JoinNode"'),
    ],
)
def test_the_comparison_sees_a_difference(old, new, tmp_path):
    """Each is a difference that the readers could make between the dialects."""
    papyrus = EXAMPLES[0].read_bytes()
    other = write_xml(papyrus)
    assert old in other
    one = compile_text(tmp_path, "model.uml", papyrus, "ir")
    changed = compile_text(tmp_path, "model.xml", other.replace(old, new, 1), "ir")
    assert graph_changes(one, changed) != []
