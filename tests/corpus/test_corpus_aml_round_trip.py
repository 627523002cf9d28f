"""Real plants are saved as valid CAEX 3.0 and read back; every difference has a reason.

Validity is checked with the published schema.
"""

from collections import Counter

import pytest
from lxml import etree
from plants import list_baygate, list_units, load_unit, refine

from graph_differences import diff
from sysmlc.backends.aml import write_files
from sysmlc.diagnostics import Sink
from sysmlc.sources import Source, SourceError, load

pytestmark = pytest.mark.corpus

IGNORED = {"id", "source", "trace"}
NEW_VERSION = "the file is CAEX 3.0 now"
WRITER = "CAEX 3.0 requires the writer of the file (SM746)"
REASONS = {
    ("attribute", "version: '2.15' -> '3.0'"): NEW_VERSION,
    ("attribute", "version: None -> '3.0'"): NEW_VERSION,
    ("added", "Metadata SourceDocumentInformation"): WRITER,
}


def save(graph):
    sink = Sink()
    return write_files(graph, "plant", sink), Counter(diagnostic.rule.code for diagnostic in sink)


def read_back(texts):
    paths = {path: path.removeprefix("aml/") for path in texts}
    return refine([Source(paths[path], text.encode()) for path, text in texts.items()])


@pytest.fixture(scope="module")
def schema(corpus):
    return etree.XMLSchema(etree.parse(corpus / "aml" / "schema" / "CAEX_ClassModel_V.3.0.xsd"))


@pytest.mark.long
def test_every_difference_after_reading_back_has_a_reason(corpus, schema, golden):
    lines = []
    for name, paths in sorted(list_units(corpus).items()):
        graph = refine(load_unit(corpus, paths))
        texts, counts = save(graph)
        for text in texts.values():
            assert schema.validate(etree.fromstring(text.encode())), (name, schema.error_log)
        changes = diff(graph, read_back(texts), IGNORED)
        reasons = Counter(find_reason(change) for change in changes)
        codes = "".join(f", {count} {code}" for code, count in sorted(counts.items()))
        lines.append(f"{name}: {len(graph)} elements, {len(changes)} differences{codes}")
        lines += [f"  {count} {reason}" for reason, count in sorted(reasons.items())]
    assert len([line for line in lines if not line.startswith(" ")]) == 34
    assert [line for line in lines if "without a reason" in line] == []
    golden.check("aml", {"corpus.txt": "\n".join(lines) + "\n"})


def find_reason(change):
    name = change.element.rpartition("::")[2]
    detail = f"{change.detail} {name}" if change.what == "added" else change.detail
    return REASONS.get((change.what, detail), f"without a reason: {change}")


@pytest.mark.parametrize("name", ["BayGate.aml", "BayGate.amlx", "BayGate_extlibs.aml"])
def test_baygate_is_read_back_without_differences(name, corpus):
    graph = refine(load_unit(corpus, list_baygate(corpus)[name]))
    texts, counts = save(graph)
    assert counts == Counter()
    assert diff(graph, read_back(texts), IGNORED) == []


@pytest.mark.long
def test_saving_twice_gives_the_same_bytes(corpus):
    for name, paths in sorted(list_units(corpus).items()):
        texts, _ = save(refine(load_unit(corpus, paths)))
        assert save(read_back(texts))[0] == texts, name


def test_ids_of_elements_links_and_interfaces_are_preserved(corpus):
    """The IDs in these files are unique, and no element repeats the parts of its class."""
    for name in ("amlsec_casestudy_a.aml", "vera_plant.aml", "eplan_arapc_example.aml"):
        path = corpus / "aml" / "dev" / name
        texts, _ = save(refine(load(path, name)))
        before = Counter(iter_ids(path.read_bytes()))
        after = Counter(id for text in texts.values() for id in iter_ids(text.encode()))
        assert before - after == Counter(), name
        assert before, name


def iter_ids(data):
    """Yield the IDs of internal elements and interfaces."""
    root = etree.fromstring(data)
    for node in root.iter("{*}InternalElement", "{*}ExternalInterface"):
        if node.get("ID"):
            yield node.get("ID")


def test_models_of_other_languages_are_valid_plants(corpus, schema):
    from examples.compiling import compile_example

    paths = [path for folder in ("papyrus", "ea") for path in (corpus / "xmi" / folder).iterdir()]
    count = 0
    for path in sorted(paths):
        if not path.is_file() or path.stat().st_size >= 1_000_000:
            continue
        try:
            graph = compile_example(path, "reqtable").graph
        except SourceError:
            continue
        texts, _ = save(graph)
        for text in texts.values():
            assert schema.validate(etree.fromstring(text.encode())), (path.name, schema.error_log)
        read_back(texts)
        count += 1
    assert count > 15
