"""A graph that is saved as UML is read back as the same graph."""

from collections import Counter
from random import Random

import pytest
from lxml import etree
from uml_files import read, refine, round_trip, save

from dialects.comparison import DIALECT_ATTRIBUTES, is_dialect_difference
from dialects.enterprise_architect import write_xmi
from dialects.magicdraw import write_xml
from dialects.papyrus import XMI
from dialects.random_models import random_model
from examples.compiling import EXAMPLES, compile_text, outputs
from graph_differences import diff
from long_runs import quick_first
from rule_examples import parse_rule_examples
from sysmlc.ir import Kind

_NAMES = """type source target client supplier behavior operation signal event guard covered
    sendEvent receiveEvent memberEnd role constrainedElement annotatedElement general classifier
    definingFeature represents inPartition association signature formal actual"""
REFERENCES = _NAMES.split()


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_is_read_back(model):
    text, back, changes = round_trip(read(model.read_bytes()))
    assert changes == []
    assert len(back) > 200
    assert find_faults(text) == []


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_the_refined_graph_of_an_example_is_read_back_with_its_diagrams(model, tmp_path):
    first = compile_text(tmp_path, "model.uml", model.read_bytes(), "uml", "plantuml")
    texts = outputs(first)
    second = compile_text(tmp_path, "model.uml", texts["uml/model.uml"].encode(), "uml", "plantuml")
    assert diff(first.graph, second.graph, {"id", "source", "trace"}) == []
    diagrams = [path for path in texts if path.endswith(".puml")]
    assert len(diagrams) > 3
    assert {path: strip_digest(text, first) for path, text in texts.items()} == {
        path: strip_digest(text, second) for path, text in outputs(second).items()
    }


def strip_digest(text, compilation):
    """Return the text without the digest of the input."""
    return text.replace(compilation.inputs[0].sha256, "")


@pytest.mark.parametrize("seed", quick_first(range(100), 20))
def test_a_random_model_is_read_back(seed):
    text, back, changes = round_trip(read(random_model(Random(seed))))
    assert changes == []
    assert len(back) > 10
    assert find_faults(text) == []


@pytest.mark.parametrize("write", [write_xml, write_xmi], ids=["magicdraw", "ea"])
@pytest.mark.parametrize("seed", quick_first(range(10), 3))
def test_a_model_of_another_tool_is_saved_as_papyrus_would(seed, write):
    name = "model.xml" if write is write_xml else "model.xmi"
    graph = read(write(random_model(Random(seed))), name)
    _, back, _ = round_trip(graph)
    changes = diff(graph, back, {"id", "source", "trace", *DIALECT_ATTRIBUTES})
    assert [change for change in changes if not is_dialect_difference(change)] == []


def test_saving_twice_gives_the_same_bytes():
    for model in EXAMPLES:
        text, _ = save(read(model.read_bytes()))
        assert save(read(text.encode()))[0] == text


def test_the_comparison_sees_a_difference():
    graph = read(EXAMPLES[0].read_bytes())
    text, _ = save(graph)
    for old, new in ((' name="Stopper"', ' name="Gate"'), (' isConjugated="true"', "")):
        assert old in text
        back = read(text.replace(old, new, 1).encode())
        assert diff(graph, back, {"id", "source", "trace"}) != []


def find_faults(text):
    """Return the ids that are not unique, and the references without target; only lxml is used."""
    root = etree.fromstring(text.encode())
    ids = Counter(node.get(f"{{{XMI}}}id") for node in root.iter("*"))
    ids.pop(None, None)
    faults = [f"{id} occurs {count} times" for id, count in ids.items() if count > 1]
    for node in root.iter("*"):
        if node.tag == "eAnnotations":
            continue
        values = [node.get(f"{{{XMI}}}idref", "")]
        values += [node.get(name, "") for name in REFERENCES]
        values += [value for name, value in node.attrib.items() if str(name).startswith("base_")]
        targets = (id for value in values for id in value.split())
        faults += [f"{id} does not exist" for id in targets if id not in ids]
    return faults


def test_the_search_for_faults_finds_a_dangling_reference():
    text, _ = save(read(EXAMPLES[0].read_bytes()))
    assert find_faults(text.replace(' source="_', ' source="x_', 1)) != []


UNNAMED = (Kind.COMMENT, Kind.SLOT, Kind.IMPORT, Kind.CONNECTOR_END, Kind.APPLICATION)


def test_the_example_of_every_rule_keeps_its_names_or_has_a_loss():
    for graph in parse_rule_examples(refine):
        text, messages = save(graph)
        names = {element.name for element in read(text.encode())}
        if any(message.startswith(("SM720", "SM725")) for message in messages):
            continue
        for element in graph:
            is_named = element.kind not in UNNAMED and not element.attrs.get("external")
            if is_named and "origin" not in element.attrs:
                assert element.name in names, (element, text)
