"""The same model from three tools gives the same graph and the same outputs."""

import os
import subprocess
import sys
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dialects.comparison import WRITERS, common_outputs, compile_both, graph_changes
from dialects.enterprise_architect import write_xmi
from dialects.magicdraw import write_xml
from dialects.random_models import random_model
from examples.compiling import EXAMPLES, compile_text, outputs
from long_runs import examples, quick_first
from sysmlc.driver import Request, compile_model, select_backends

DEFAULT = ("contracts", "recipe", "plantuml", "reqtable")


@pytest.mark.parametrize("dialect", WRITERS)
@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_is_the_same_in_every_dialect(model, dialect, tmp_path):
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


@pytest.mark.parametrize("dialect", ["xml", "xmi"])
@pytest.mark.parametrize("seed", quick_first(range(25), 4))
def test_a_random_model_is_the_same_in_every_dialect(seed, dialect, tmp_path):
    papyrus = random_model(Random(seed))
    one, other = compile_both(tmp_path, papyrus, dialect, *DEFAULT)
    assert codes(one) == codes(other)
    assert len(one.graph) > 10
    assert graph_changes(one, other) == []
    here, there = common_outputs(papyrus, one, other)
    assert here == there


@pytest.mark.long
@settings(
    max_examples=examples(15),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.randoms(use_true_random=False), st.integers(1, 3), st.sampled_from(["xml", "xmi"]))
def test_any_random_model_has_one_graph(tmp_path, random, size, dialect):
    one, other = compile_both(tmp_path, random_model(random, size), dialect, "ir")
    assert graph_changes(one, other) == []


def codes(compilation):
    return [(found.rule.code, found.message) for found in compilation.diagnostics]


def write_three(folder):
    """Three random models, each in the dialect of another tool."""
    papyrus = [random_model(Random(seed)) for seed in (3, 5, 10)]
    files = {"a.uml": papyrus[0], "b.xml": write_xml(papyrus[1]), "c.xmi": write_xmi(papyrus[2])}
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return [folder / name for name in files]


def test_the_order_of_the_files_does_not_matter(tmp_path):
    files = write_three(tmp_path)
    texts = {ir_of(order) for order in (files, files[::-1], [files[1], files[0], files[2]])}
    assert len(texts) == 1


def ir_of(files):
    request = Request(tuple(files), backends=tuple(select_backends(("ir",))))
    return "".join(outputs(compile_model(request)).values())


def test_the_seed_of_hashes_does_not_matter(tmp_path):
    names = [str(path) for path in write_three(tmp_path)]
    command = [sys.executable, "-m", "sysmlc", "build", *names, "--emit", "ir,graph"]
    for seed in ("0", "1", "2"):
        folder = tmp_path / f"out{seed}"
        environment = os.environ | {"PYTHONHASHSEED": seed}
        arguments = [*command, "--no-cache", "-o", str(folder)]
        subprocess.run(arguments, env=environment, capture_output=True, check=False)
    made = [texts_in(tmp_path / f"out{seed}") for seed in ("0", "1", "2")]
    assert len(made[0]) > 3
    assert made[0] == made[1] == made[2]


def texts_in(folder):
    found = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder): path.read_bytes() for path in found}


def test_random_models_hold_what_they_promise():
    """A generator that makes nothing would make the tests above pass."""
    text = b"".join(random_model(Random(seed)) for seed in range(25)).decode()
    wanted = """uml:Port isConjugated PortsAndFlows:FlowProperty Blocks:NestedConnectorEnd
        uml:InformationFlow uml:StateMachine uml:TimeEvent uml:DecisionNode uml:ForkNode
        uml:InputPin Requirements:Requirement Allocations:Allocate Plant:Robot uml:Stereotype
        uml:Enumeration uml:Generalization uml:Operation uml:ActivityPartition uml:Interaction
        uml:CombinedFragment uml:ConsiderIgnoreFragment uml:InteractionUse uml:StateInvariant
        uml:BehaviorExecutionSpecification uml:DurationConstraint uml:Gate uml:Extend
        uml:CollaborationUse uml:TemplateBinding uml:ConnectionPointReference
        Blocks:BoundReference DeprecatedElements:FlowPort Requirements:Copy unit= quantityKind=
        Allocations:AllocateActivityPartition Activities:Probability ModelElements:Problem"""
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


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b' upper="1"', b' upper="-1"'),
        (b' lower="1"', b' lower="0"'),
        (b'isConjugated="true"', b'isConjugated="false"'),
        (b"<SysML1.4:proxyPort", b"<SysML1.4:fullPort"),
        (b'<type xmi:idref="EAID_', b'<type xmi:idref="EAPK_'),
        (b'documentation="The', b'documentation="A'),
    ],
)
def test_the_comparison_sees_a_difference_in_enterprise_architects_dialect(old, new, tmp_path):
    papyrus = EXAMPLES[0].read_bytes()
    other = write_xmi(papyrus)
    one = compile_text(tmp_path, "model.uml", papyrus, "ir")
    assert old in other
    changed = compile_text(tmp_path, "model.xmi", other.replace(old, new, 1), "ir")
    assert graph_changes(one, changed) != []
