"""Real plants that are written as CAEX 3.0 and read back: valid, and what is not the same.

The schema is the published one of the corpus; nothing of our own judges what is written.
"""

from collections import Counter

import pytest
from lxml import etree
from plants import baygate, refined, sources, units

from graph_differences import diff
from sysmlc.backends.aml.backend import write_files
from sysmlc.diagnostics import Sink
from sysmlc.sources import Source, SourceError, load

pytestmark = pytest.mark.corpus

IGNORED = {"id", "source", "trace"}
NEWER = "the file is CAEX 3.0 now"
WRITER = "CAEX 3.0 wants to know who wrote it (SM746)"
REASONS = {
    ("attribute", "version: '2.15' -> '3.0'"): NEWER,
    ("attribute", "version: None -> '3.0'"): NEWER,
    ("added", "Metadata SourceDocumentInformation"): WRITER,
}


def written(graph):
    sink = Sink()
    return write_files(graph, "plant", sink), Counter(found.rule.code for found in sink)


def read_back(texts):
    named = ((path.removeprefix("aml/"), text) for path, text in texts.items())
    return refined([Source(path, text.encode()) for path, text in named])


@pytest.fixture(scope="module")
def schema(corpus):
    return etree.XMLSchema(etree.parse(corpus / "aml" / "schema" / "CAEX_ClassModel_V.3.0.xsd"))


@pytest.mark.long
def test_every_difference_has_a_reason(corpus, schema, golden):
    lines = []
    for name, paths in sorted(units(corpus).items()):
        graph = refined(sources(corpus, paths))
        texts, told = written(graph)
        for text in texts.values():
            assert schema.validate(etree.fromstring(text.encode())), (name, schema.error_log)
        changes = diff(graph, read_back(texts), IGNORED)
        found = Counter(reason(change) for change in changes)
        codes = "".join(f", {count} {code}" for code, count in sorted(told.items()))
        lines.append(f"{name}: {len(graph)} elements, {len(changes)} differences{codes}")
        lines += [f"  {count} {why}" for why, count in sorted(found.items())]
    assert len([line for line in lines if not line.startswith(" ")]) == 34
    assert [line for line in lines if "without a reason" in line] == []
    golden.check("aml", {"corpus.txt": "\n".join(lines) + "\n"})


def reason(change):
    name = change.element.rpartition("::")[2]
    detail = f"{change.detail} {name}" if change.what == "added" else change.detail
    return REASONS.get((change.what, detail), f"without a reason: {change}")


@pytest.mark.parametrize("name", ["BayGate.aml", "BayGate.amlx", "BayGate_extlibs.aml"])
def test_baygate_comes_back_without_any_difference(name, corpus):
    graph = refined(sources(corpus, baygate(corpus)[name]))
    texts, told = written(graph)
    assert told == Counter()
    assert diff(graph, read_back(texts), IGNORED) == []


@pytest.mark.long
def test_what_is_written_again_is_the_same(corpus):
    for name, paths in sorted(units(corpus).items()):
        texts, _ = written(refined(sources(corpus, paths)))
        assert written(read_back(texts))[0] == texts, name


def test_ids_of_elements_links_and_interfaces_are_those_of_the_source(corpus):
    """Of files whose IDs are unique, and whose elements repeat none of their classes."""
    for name in ("amlsec_casestudy_a.aml", "vera_plant.aml", "eplan_arapc_example.aml"):
        path = corpus / "aml" / "dev" / name
        texts, _ = written(refined(load(path, name)))
        before = Counter(ids(path.read_bytes()))
        after = Counter(id for text in texts.values() for id in ids(text.encode()))
        assert before - after == Counter(), name
        assert before, name


def ids(data):
    """IDs of internal elements and their interfaces, as they are written."""
    root = etree.fromstring(data)
    for one in root.iter("{*}InternalElement", "{*}ExternalInterface"):
        if one.get("ID"):
            yield one.get("ID")


def test_models_of_other_languages_are_valid_plants(corpus, schema):
    from examples.compiling import compile_example

    found = [p for folder in ("papyrus", "ea") for p in (corpus / "xmi" / folder).iterdir()]
    count = 0
    for path in sorted(p for p in found if p.is_file() and p.stat().st_size < 1_000_000):
        try:
            graph = compile_example(path, "reqtable").graph
        except SourceError:
            continue
        texts, _ = written(graph)
        for text in texts.values():
            assert schema.validate(etree.fromstring(text.encode())), (path.name, schema.error_log)
        read_back(texts)
        count += 1
    assert count > 15
