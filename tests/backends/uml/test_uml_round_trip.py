"""What is saved as UML is read back as the same graph."""

import os
import subprocess
import sys
from collections import Counter
from random import Random

import pytest
from lxml import etree
from saving import read, round_trip, saved

from dialects.comparing import OF_THE_DIALECT, of_dialect
from dialects.enterprise_architect import write_xmi
from dialects.magicdraw import write_xml
from dialects.papyrus import XMI
from dialects.random_models import random_model
from examples.compiling import EXAMPLES, compile_text, outputs
from graph_differences import diff
from long_runs import quick_first

_NAMES = """type source target client supplier behavior operation signal event guard covered
    sendEvent receiveEvent memberEnd role constrainedElement annotatedElement general classifier
    definingFeature represents inPartition association signature formal actual"""
REFERENCES = _NAMES.split()


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_comes_back(model):
    text, back, changes = round_trip(read(model.read_bytes()))
    assert changes == []
    assert len(back) > 200
    assert complaints(text) == []


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_the_refined_graph_of_an_example_and_its_diagrams_come_back(model, tmp_path):
    one = compile_text(tmp_path, "model.uml", model.read_bytes(), "uml", "plantuml")
    made = outputs(one)
    two = compile_text(tmp_path, "model.uml", made["uml/model.uml"].encode(), "uml", "plantuml")
    assert diff(one.graph, two.graph, {"id", "source", "trace"}) == []
    again = outputs(two)
    drawn = [path for path in made if path.endswith(".puml")]
    assert len(drawn) > 3
    assert {path: plain(made[path], one) for path in made} == {
        path: plain(again[path], two) for path in again
    }


def plain(text, compilation):
    """The text without the digest of the input."""
    return text.replace(compilation.inputs[0].sha256, "")


@pytest.mark.parametrize("seed", quick_first(range(100), 20))
def test_a_random_model_comes_back(seed):
    text, back, changes = round_trip(read(random_model(Random(seed))))
    assert changes == []
    assert len(back) > 10
    assert complaints(text) == []


@pytest.mark.parametrize("write", [write_xml, write_xmi], ids=["magicdraw", "ea"])
@pytest.mark.parametrize("seed", quick_first(range(10), 3))
def test_a_model_of_another_tool_is_saved_as_papyrus_would(seed, write):
    name = "model.xml" if write is write_xml else "model.xmi"
    graph = read(write(random_model(Random(seed))), name)
    _, back, _ = round_trip(graph)
    changes = diff(graph, back, {"id", "source", "trace", *OF_THE_DIALECT})
    assert [change for change in changes if not of_dialect(change)] == []


def test_saving_twice_gives_the_same_bytes():
    for model in EXAMPLES:
        text, _ = saved(read(model.read_bytes()))
        assert saved(read(text.encode()))[0] == text


def test_the_comparison_sees_a_difference():
    graph = read(EXAMPLES[0].read_bytes())
    text, _ = saved(graph)
    for old, new in ((' name="Stopper"', ' name="Gate"'), (' isConjugated="true"', "")):
        assert old in text
        back = read(text.replace(old, new, 1).encode())
        assert diff(graph, back, {"id", "source", "trace"}) != []


def complaints(text):
    """Ids that are there twice, and references that lead nowhere: counted with lxml alone."""
    root = etree.fromstring(text.encode())
    ids = Counter(one.get(f"{{{XMI}}}id") for one in root.iter("*"))
    ids.pop(None, None)
    found = [f"{id} is there {count} times" for id, count in ids.items() if count > 1]
    for one in root.iter("*"):
        if one.tag == "eAnnotations":
            continue
        named = [one.get(f"{{{XMI}}}idref", "")]
        named += [one.get(name, "") for name in REFERENCES]
        named += [value for name, value in one.attrib.items() if str(name).startswith("base_")]
        found += [f"{id} leads nowhere" for value in named for id in value.split() if id not in ids]
    return found


def test_the_count_of_complaints_can_fail():
    text, _ = saved(read(EXAMPLES[0].read_bytes()))
    assert complaints(text.replace(' source="_', ' source="x_', 1)) != []


def test_order_of_hashes_is_not_in_the_file(tmp_path):
    command = [sys.executable, "-m", "sysmlc", "build", str(EXAMPLES[0]), "--emit", "uml"]
    for seed in ("0", "7"):
        environment = os.environ | {"PYTHONHASHSEED": seed}
        arguments = [*command, "--no-cache", "-o", str(tmp_path / seed)]
        subprocess.run(arguments, env=environment, capture_output=True, check=False)
    made = [next((tmp_path / seed).rglob("*.uml")).read_bytes() for seed in ("0", "7")]
    assert made[0] == made[1]
