"""A model has the same graph and the same outputs in the dialects of three tools."""

import os
import subprocess
import sys
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dialects.comparison import WRITERS, compile_both, find_graph_changes, normalize_outputs
from dialects.enterprise_architect import write_xmi
from dialects.magicdraw import write_xml
from dialects.random_models import random_model
from examples.compiling import EXAMPLES, compile_text, outputs
from long_runs import examples, quick_first
from sysmlc.driver import Request, compile_model, select_backends

DEFAULT_BACKENDS = ("contracts", "recipe", "plantuml", "reqtable")


@pytest.mark.parametrize("dialect", WRITERS)
@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_has_equal_graphs_and_outputs_in_every_dialect(model, dialect, tmp_path):
    papyrus = model.read_bytes()
    original, translated = compile_both(tmp_path, papyrus, dialect, *DEFAULT_BACKENDS)
    assert find_graph_changes(original, translated) == []
    expected, texts = normalize_outputs(papyrus, original, translated)
    assert expected == texts
    assert expected


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_magicdraws_additions_to_sysml_change_no_output(model, tmp_path):
    papyrus = model.read_bytes()
    adorned = write_xml(papyrus, customised=True)
    assert b"PartProperty" in adorned
    original = compile_text(tmp_path, "model.uml", papyrus, *DEFAULT_BACKENDS)
    translated = compile_text(tmp_path, "model.xml", adorned, *DEFAULT_BACKENDS)
    expected, texts = normalize_outputs(papyrus, original, translated)
    assert expected == texts


@pytest.mark.parametrize("dialect", ["xml", "xmi"])
@pytest.mark.parametrize("seed", quick_first(range(25), 4))
def test_a_random_model_has_equal_graphs_and_outputs_in_every_dialect(seed, dialect, tmp_path):
    papyrus = random_model(Random(seed))
    original, translated = compile_both(tmp_path, papyrus, dialect, *DEFAULT_BACKENDS)
    assert list_messages(original) == list_messages(translated)
    assert len(original.graph) > 10
    assert find_graph_changes(original, translated) == []
    expected, texts = normalize_outputs(papyrus, original, translated)
    assert expected == texts


@pytest.mark.long
@settings(
    max_examples=examples(15),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.randoms(use_true_random=False), st.integers(1, 3), st.sampled_from(["xml", "xmi"]))
def test_any_random_model_has_equal_graphs_in_every_dialect(tmp_path, random, size, dialect):
    original, translated = compile_both(tmp_path, random_model(random, size), dialect, "ir")
    assert find_graph_changes(original, translated) == []


def list_messages(compilation):
    return [(diagnostic.rule.code, diagnostic.message) for diagnostic in compilation.diagnostics]


def write_models(folder):
    """Write three random models, each in the dialect of another tool, and return their paths."""
    papyrus = [random_model(Random(seed)) for seed in (3, 5, 10)]
    files = {"a.uml": papyrus[0], "b.xml": write_xml(papyrus[1]), "c.xmi": write_xmi(papyrus[2])}
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return [folder / name for name in files]


def test_the_output_does_not_depend_on_the_order_of_the_files(tmp_path):
    files = write_models(tmp_path)
    texts = {print_ir(order) for order in (files, files[::-1], [files[1], files[0], files[2]])}
    assert len(texts) == 1


def print_ir(files):
    request = Request(tuple(files), backends=tuple(select_backends(("ir",))))
    return "".join(outputs(compile_model(request)).values())


def test_the_output_does_not_depend_on_the_hash_seed(tmp_path):
    names = [str(path) for path in write_models(tmp_path)]
    command = [sys.executable, "-m", "sysmlc", "build", *names, "--emit", "ir,graph"]
    for seed in ("0", "1"):
        folder = tmp_path / f"out{seed}"
        environment = os.environ | {"PYTHONHASHSEED": seed}
        arguments = [*command, "--no-cache", "-o", str(folder)]
        subprocess.run(arguments, env=environment, capture_output=True, check=False)
    outputs_by_seed = [read_texts(tmp_path / f"out{seed}") for seed in ("0", "1")]
    assert len(outputs_by_seed[0]) > 3
    assert outputs_by_seed[0] == outputs_by_seed[1]


def read_texts(folder):
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder): path.read_bytes() for path in paths}


def test_random_models_contain_all_constructs_that_the_tests_rely_on():
    """The tests above would pass too if the generator left these constructs out."""
    text = b"".join(random_model(Random(seed)) for seed in range(25)).decode()
    expected = """uml:Port isConjugated PortsAndFlows:FlowProperty Blocks:NestedConnectorEnd
        uml:InformationFlow uml:StateMachine uml:TimeEvent uml:DecisionNode uml:ForkNode
        uml:InputPin Requirements:Requirement Allocations:Allocate Plant:Robot uml:Stereotype
        uml:Enumeration uml:Generalization uml:Operation uml:ActivityPartition uml:Interaction
        uml:CombinedFragment uml:ConsiderIgnoreFragment uml:InteractionUse uml:StateInvariant
        uml:BehaviorExecutionSpecification uml:DurationConstraint uml:Gate uml:Extend
        uml:CollaborationUse uml:TemplateBinding uml:ConnectionPointReference
        Blocks:BoundReference DeprecatedElements:FlowPort Requirements:Copy unit= quantityKind=
        Allocations:AllocateActivityPartition Activities:Probability ModelElements:Problem"""
    assert [word for word in expected.split() if word not in text] == []


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
def test_the_comparison_detects_a_difference(old, new, tmp_path):
    """Each difference could result from a fault in the reader of one dialect."""
    papyrus = EXAMPLES[0].read_bytes()
    translated = write_xml(papyrus)
    assert old in translated
    original = compile_text(tmp_path, "model.uml", papyrus, "ir")
    changed = compile_text(tmp_path, "model.xml", translated.replace(old, new, 1), "ir")
    assert find_graph_changes(original, changed) != []


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
def test_the_comparison_detects_a_difference_in_enterprise_architects_dialect(old, new, tmp_path):
    papyrus = EXAMPLES[0].read_bytes()
    translated = write_xmi(papyrus)
    original = compile_text(tmp_path, "model.uml", papyrus, "ir")
    assert old in translated
    changed = compile_text(tmp_path, "model.xmi", translated.replace(old, new, 1), "ir")
    assert find_graph_changes(original, changed) != []
