"""The models that the benchmarks generate: reproducible, valid, of the requested size."""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from lxml import etree

from sysmlc.driver.compilation import Request, compile_model
from sysmlc.ir import Kind
from sysmlc.logic.activities.token_graph import TokenGraph

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
MODEL_GENERATOR = BENCHMARKS / "xmi_model.py"
PLANT_GENERATOR = BENCHMARKS / "aml_model.py"
ELEMENTS_OF_50_MB = 686_000
"""Elements in a plant of AutomationML of 50 MB, as measured in real files."""
XMI_ID = "{http://www.omg.org/spec/XMI/20131001}id"


def generate_model(path, megabytes, *, seed=1, dialect="papyrus"):
    options = ["--megabytes", str(megabytes), "--seed", str(seed), "--dialect", dialect]
    subprocess.run(
        [sys.executable, MODEL_GENERATOR, *options, path], check=True, capture_output=True
    )
    return path.read_bytes()


def compile_file(path):
    return compile_model(Request(inputs=(path,)))


@pytest.mark.parametrize("dialect", ["papyrus", "magicdraw"])
def test_a_seed_determines_the_bytes_of_a_model(dialect, tmp_path):
    first = generate_model(tmp_path / "a", 0.3, seed=4, dialect=dialect)
    assert first == generate_model(tmp_path / "b", 0.3, seed=4, dialect=dialect)
    assert first != generate_model(tmp_path / "c", 0.3, seed=5, dialect=dialect)


@pytest.mark.parametrize("dialect", ["papyrus", "magicdraw"])
def test_a_model_has_the_requested_size_and_unique_ids(dialect, tmp_path):
    data = generate_model(tmp_path / "plant", 1, dialect=dialect)
    ids = [id for element in etree.fromstring(data).iter() if (id := element.get(XMI_ID))]
    assert 0.8e6 < len(data) < 1.2e6
    assert len(set(ids)) == len(ids)


def test_elements_are_as_dense_as_in_real_papyrus_files(tmp_path):
    data = generate_model(tmp_path / "plant.uml", 1)
    elements = sum(1 for _ in etree.fromstring(data).iter())
    assert 126 < len(data) / elements < 180


def test_most_elements_of_a_magicdraw_file_are_notation(tmp_path):
    path = tmp_path / "plant.xml"
    generate_model(path, 1, dialect="magicdraw")
    totals = compile_file(path).coverage.as_json()["total"]
    assert 0.7 < totals["ignored_notation"] / totals["elements"] < 0.9


def test_a_model_has_no_errors_and_is_read_completely(tmp_path):
    path = tmp_path / "plant.uml"
    generate_model(path, 0.2)
    compilation = compile_file(path)
    machines = 6 * 2
    graph, total = compilation.graph, compilation.coverage.as_json()["total"]
    assert [diagnostic.message for diagnostic in compilation.diagnostics] == []
    assert total["unsupported"] == total["approximated"] == 0
    assert len(graph.derived(TokenGraph)) == machines
    assert len(graph.of_kind(Kind.STATE_MACHINE)) == machines
    assert len(graph.of_kind(Kind.ITEM_FLOW)) == 5 * 2
    assert [block.role for block in graph.of_kind(Kind.CLASS)].count("requirement") == 4 * 2


def describe_elements(graph):
    """Return kind, name and role of all elements except stereotype applications."""
    return sorted(
        (element.kind, graph.qualified_name(element), element.role)
        for element in graph
        if element.kind is not Kind.APPLICATION
    )


def test_both_dialects_describe_the_same_model(tmp_path):
    for dialect, name in (("papyrus", "a.uml"), ("magicdraw", "a.xml")):
        generate_model(tmp_path / name, 0.01, dialect=dialect)
    papyrus, magicdraw = (
        describe_elements(compile_file(tmp_path / name).graph) for name in ("a.uml", "a.xml")
    )
    assert papyrus == magicdraw


# -- plants in AutomationML ------------------------------------------------------------------------


def generate_plant(path, megabytes, *, seed=1):
    options = ["--megabytes", str(megabytes), "--seed", str(seed)]
    subprocess.run(
        [sys.executable, PLANT_GENERATOR, *options, path], check=True, capture_output=True
    )
    return path.read_bytes()


def test_a_seed_determines_the_bytes_of_a_plant(tmp_path):
    first = generate_plant(tmp_path / "a", 0.2, seed=4)
    assert first == generate_plant(tmp_path / "b", 0.2, seed=4)
    assert first != generate_plant(tmp_path / "c", 0.2, seed=5)


def test_a_plant_has_the_requested_size_and_unique_ids(tmp_path):
    data = generate_plant(tmp_path / "plant.aml", 1)
    ids = [id for node in etree.fromstring(data).iter() if (id := node.get("ID"))]
    assert 0.9e6 < len(data) < 1.1e6
    assert len(set(ids)) == len(ids)


def test_elements_are_as_dense_as_in_real_plants(tmp_path):
    data = generate_plant(tmp_path / "plant.aml", 1)
    tags = Counter(etree.QName(node).localname for node in etree.fromstring(data).iter())
    expected = len(data) * ELEMENTS_OF_50_MB / 50e6
    assert tags.total() == pytest.approx(expected, rel=0.05)
    shares = {tag: round(100 * number / tags.total()) for tag, number in tags.items()}
    assert shares["Attribute"] == pytest.approx(33, abs=5)
    assert shares["InternalElement"] == pytest.approx(8, abs=3)


def test_a_plant_has_no_errors_and_is_read_completely(tmp_path):
    path = tmp_path / "plant.aml"
    data = generate_plant(path, 0.1)
    compilation = compile_file(path)
    graph, total = compilation.graph, compilation.coverage.as_json()["total"]
    tree = etree.fromstring(data)
    lines = tree.findall("{*}InstanceHierarchy/{*}InternalElement")
    assert [diagnostic.message for diagnostic in compilation.diagnostics] == []
    assert total["mapped"] == total["elements"] == sum(1 for _ in tree.iter())
    assert len(graph.of_kind(Kind.GROUP)) == len(lines) > 1
    owners = {line.get("ID") for line in lines}
    connectors = [
        connector for connector in graph.of_kind(Kind.CONNECTOR) if connector.owner in owners
    ]
    assert sum(connector.name[0] in "mfb" for connector in connectors) == 3 * 6 * len(lines)


@pytest.mark.corpus
def test_a_plant_follows_the_schema_of_caex(corpus, tmp_path):
    data = generate_plant(tmp_path / "plant.aml", 0.1)
    schema = etree.XMLSchema(file=str(corpus / "aml/schema/CAEX_ClassModel_V.3.0.xsd"))
    assert schema.validate(etree.fromstring(data)), schema.error_log
