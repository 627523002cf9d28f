"""Plants that the benchmarks generate: the same bytes for a seed, of the size asked for, sound."""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from lxml import etree

from sysmlc.driver.compilation import Request, compile_model
from sysmlc.ir import Kind

GENERATOR = Path(__file__).parents[2] / "benchmarks" / "aml_model.py"
ELEMENTS_OF_50_MB = 686_000


def generated(path, megabytes, *, seed=1):
    options = ["--megabytes", str(megabytes), "--seed", str(seed)]
    subprocess.run([sys.executable, GENERATOR, *options, path], check=True, capture_output=True)
    return path.read_bytes()


def test_a_seed_gives_the_same_plant_and_another_seed_another(tmp_path):
    one = generated(tmp_path / "a", 0.2, seed=4)
    assert one == generated(tmp_path / "b", 0.2, seed=4)
    assert one != generated(tmp_path / "c", 0.2, seed=5)


def test_the_plant_has_about_the_size_and_every_id_once(tmp_path):
    data = generated(tmp_path / "plant.aml", 1)
    ids = [id for node in etree.fromstring(data).iter() if (id := node.get("ID"))]
    assert 0.9e6 < len(data) < 1.1e6
    assert len(set(ids)) == len(ids)


def test_elements_are_as_dense_as_in_real_plants(tmp_path):
    data = generated(tmp_path / "plant.aml", 1)
    tags = Counter(etree.QName(node).localname for node in etree.fromstring(data).iter())
    expected = len(data) * ELEMENTS_OF_50_MB / 50e6
    assert tags.total() == pytest.approx(expected, rel=0.05)
    shares = {tag: round(100 * number / tags.total()) for tag, number in tags.items()}
    assert shares["Attribute"] == pytest.approx(33, abs=5)
    assert shares["InternalElement"] == pytest.approx(8, abs=3)


def test_the_plant_is_sound_and_all_of_it_is_read(tmp_path):
    path = tmp_path / "plant.aml"
    data = generated(path, 0.1)
    found = compile_model(Request(inputs=(path,)))
    graph, total = found.graph, found.coverage.as_json()["total"]
    tree = etree.fromstring(data)
    lines = tree.findall("{*}InstanceHierarchy/{*}InternalElement")
    assert [one.message for one in found.diagnostics] == []
    assert total["mapped"] == total["elements"] == sum(1 for _ in tree.iter())
    assert len(graph.of_kind(Kind.GROUP)) == len(lines) > 1
    owners = {line.get("ID") for line in lines}
    between = [e for e in graph.of_kind(Kind.CONNECTOR) if e.owner in owners]
    assert sum(e.name[0] in "mfb" for e in between) == 3 * 6 * len(lines)


@pytest.mark.corpus
def test_the_plant_follows_the_schema_of_caex(corpus, tmp_path):
    data = generated(tmp_path / "plant.aml", 0.1)
    schema = etree.XMLSchema(file=str(corpus / "aml/schema/CAEX_ClassModel_V.3.0.xsd"))
    assert schema.validate(etree.fromstring(data)), schema.error_log
