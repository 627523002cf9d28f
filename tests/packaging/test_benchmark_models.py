"""Models that the benchmarks generate: the same bytes for a seed, sound, of the size asked for."""

import subprocess
import sys
from pathlib import Path

import pytest
from lxml import etree

from sysmlc.driver.compilation import Request, compile_model
from sysmlc.ir import Kind
from sysmlc.logic.activities.token_graph import TokenGraph

GENERATOR = Path(__file__).parents[2] / "benchmarks" / "xmi_model.py"
XMI_ID = "{http://www.omg.org/spec/XMI/20131001}id"


def generated(path, megabytes, *, seed=1, dialect="papyrus"):
    options = ["--megabytes", str(megabytes), "--seed", str(seed), "--dialect", dialect]
    subprocess.run([sys.executable, GENERATOR, *options, path], check=True, capture_output=True)
    return path.read_bytes()


def compiled(path):
    return compile_model(Request(inputs=(path,)))


@pytest.mark.parametrize("dialect", ["papyrus", "magicdraw"])
def test_a_seed_gives_the_same_bytes_and_another_seed_others(dialect, tmp_path):
    one = generated(tmp_path / "a", 0.3, seed=4, dialect=dialect)
    assert one == generated(tmp_path / "b", 0.3, seed=4, dialect=dialect)
    assert one != generated(tmp_path / "c", 0.3, seed=5, dialect=dialect)


@pytest.mark.parametrize("dialect", ["papyrus", "magicdraw"])
def test_the_file_has_about_the_size_and_every_id_once(dialect, tmp_path):
    data = generated(tmp_path / "plant", 1, dialect=dialect)
    ids = [id for element in etree.fromstring(data).iter() if (id := element.get(XMI_ID))]
    assert 0.8e6 < len(data) < 1.2e6
    assert len(set(ids)) == len(ids)


def test_density_is_that_of_real_papyrus_files(tmp_path):
    data = generated(tmp_path / "plant.uml", 1)
    elements = sum(1 for _ in etree.fromstring(data).iter())
    assert 126 < len(data) / elements < 180


def test_most_elements_of_a_magicdraw_file_are_drawings(tmp_path):
    path = tmp_path / "plant.xml"
    generated(path, 1, dialect="magicdraw")
    totals = compiled(path).coverage.as_json()["total"]
    assert 0.7 < totals["ignored_notation"] / totals["elements"] < 0.9


def test_the_model_is_sound_and_all_of_it_is_read(tmp_path):
    path = tmp_path / "plant.uml"
    generated(path, 0.2)
    found = compiled(path)
    machines = 6 * 2
    graph, total = found.graph, found.coverage.as_json()["total"]
    assert [one.message for one in found.diagnostics] == []
    assert total["unsupported"] == total["approximated"] == 0
    assert len(graph.derived(TokenGraph)) == machines
    assert len(graph.of_kind(Kind.STATE_MACHINE)) == machines
    assert len(graph.of_kind(Kind.ITEM_FLOW)) == 5 * 2
    assert [r.role for r in graph.of_kind(Kind.CLASS)].count("requirement") == 4 * 2


def normalised(graph):
    return sorted((element.kind, graph.qualified_name(element), element.role) for element in graph)


def test_both_dialects_say_the_same(tmp_path):
    for dialect, name in (("papyrus", "a.uml"), ("magicdraw", "a.xml")):
        generated(tmp_path / name, 0.01, dialect=dialect)
    one, other = (compiled(tmp_path / name).graph for name in ("a.uml", "a.xml"))
    kinds = set(Kind) - {Kind.APPLICATION}
    left, right = ([row for row in normalised(graph) if row[0] in kinds] for graph in (one, other))
    assert left == right
