"""Columns that are kept: the graph is the same, and only what changed is parsed."""

import pytest

from sysmlc.cache import Cache
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND, parsing, remembered
from sysmlc.ir import Graph
from sysmlc.ir.text import print_text
from sysmlc.sources import Source

HEAD = (
    '<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" '
    'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">'
)


def model(name: str, classes: int = 400) -> Source:
    """A file that is large enough to be kept, with text, repeated ids and drawings."""
    rows = "".join(
        f'<packagedElement xmi:type="uml:Class" xmi:id="{name}{i}" name="C{i}">'
        f"<ownedComment xmi:id='{name}k{i}'><body>note {i}</body></ownedComment></packagedElement>"
        for i in range(classes)
    )
    again = f'<packagedElement xmi:type="uml:Class" xmi:id="{name}0" name="again"/>'
    shapes = "<diagramRepresentation><a/><b/></diagramRepresentation>"
    drawn = f"<xmi:Extension><x>{shapes}</x></xmi:Extension>"
    head = f'{HEAD}<uml:Model xmi:id="{name}" name="{name}">'
    text = f"{head}{rows}{again}{drawn}</uml:Model></xmi:XMI>"
    return Source(f"{name}.uml", text.encode())


def compiled(cache, *sources):
    graph, sink, coverage = Graph(), Sink(), Coverage()
    FRONTEND.with_cache(cache).read(sources, graph, sink, coverage)
    return print_text(graph), [found.message for found in sink], coverage.as_json()


@pytest.fixture
def parsed(monkeypatch):
    """Names of the files that were really parsed."""
    names = []
    real = parsing.read

    def read(source):
        names.append(source.name)
        return real(source)

    monkeypatch.setattr(parsing, "read", read)
    return names


def test_a_file_that_is_kept_gives_the_same_graph_findings_and_coverage(tmp_path, parsed):
    cache = Cache(tmp_path)
    first = compiled(cache, model("plant"))
    assert compiled(cache, model("plant")) == first
    assert parsed == ["plant.uml"]


def test_of_two_files_only_the_changed_one_is_parsed_again(tmp_path, parsed):
    cache = Cache(tmp_path)
    compiled(cache, model("plant"), model("line"))
    compiled(cache, model("plant"), model("line", classes=401))
    assert parsed == ["line.uml", "plant.uml", "line.uml"]


def test_the_same_content_under_another_name_keeps_its_own_name(tmp_path, parsed):
    cache = Cache(tmp_path)
    compiled(cache, model("plant"))
    graph, _, _ = compiled(cache, Source("copy.uml", model("plant").data))
    assert "@copy.uml:1" in graph
    assert "@plant.uml" not in graph
    assert parsed == ["plant.uml"]


@pytest.mark.parametrize("entry", [b"no marshal", b"", b"\xe9\x00\x00\x00\x00"])
def test_an_entry_that_cannot_be_read_is_not_there(tmp_path, parsed, entry):
    cache = Cache(tmp_path)
    first = compiled(cache, model("plant"))
    for path in tmp_path.rglob("*.entry"):
        cache.put(path.stem, entry)
    assert compiled(cache, model("plant")) == first
    assert len(parsed) == 2


def test_small_files_are_not_kept(tmp_path, parsed):
    cache = Cache(tmp_path)
    compiled(cache, model("plant", classes=2))
    assert not list(tmp_path.rglob("*.entry"))


def test_other_code_does_not_see_old_entries(tmp_path, parsed, monkeypatch):
    cache = Cache(tmp_path)
    compiled(cache, model("plant"))
    monkeypatch.setattr(remembered, "__version__", "99")
    compiled(cache, model("plant"))
    assert len(parsed) == 2
