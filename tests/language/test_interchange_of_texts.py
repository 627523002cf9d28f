"""Texts of the corpus, resolved, written as interchange files and read again: the same trees."""

import re
from functools import partial

import pytest

from long_runs import quick_first
from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import InterchangeFiles, interchange_path, link, read, write
from sysmlc.language.library import find_library
from sysmlc.language.names import resolve
from sysmlc.language.names.implied_relations import implied_redefinitions
from sysmlc.language.text import parse
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def library(corpus):
    return find_library(corpus / "sysml2/omg-release/sysml.library", {})


def written(folder, library):
    """Documents of the texts of a folder, and their interchange files."""
    sink = Sink()
    paths = sorted(path for path in folder.rglob("*.*ml") if path.suffix in (".sysml", ".kerml"))
    documents = [
        parse(
            path.read_bytes().decode(), path.relative_to(folder).as_posix(), path.suffix[1:], sink
        )
        for path in paths
    ]
    model = resolve(documents, library, sink)
    redefined, told = partial(implied_redefinitions, model), Sink()
    known = InterchangeFiles([*documents, *library.loaded_documents()], redefined=redefined)
    files = {interchange_path(one): write(one, known, told) for one in documents}
    return documents, files, [found.rule.code for found in told]


def read_again(files):
    sink = Sink()
    documents = [read(Source(path, data), sink) for path, data in files.items()]
    link(documents, sink)
    assert [found.message for found in sink] == []
    return documents


def shape(documents):
    """Trees as values: references into the documents by what they lead to, others not at all."""
    roots = {document.root for document in documents}
    return [[_node(node, roots) for node in document.root.walk()] for document in documents]


def _node(node, roots):
    facts = {name: fact for name, fact in node.attributes.items() if name != "isPrefix"}
    role = "default" if node.role == "default =" else node.role
    relations = [(one.kind, _targets(one.reference, roots)) for one in node.relations]
    said = (node.kind, node.name, node.short_name, node.membership, role, node.visibility)
    return (*said, len(node.members), facts, relations)


def _targets(reference, roots):
    targets = reference.targets or []
    is_own = targets and all(_root(one) in roots for one in targets)
    return [(one.kind, one.name) for one in targets] if is_own else len(reference.chain)


def _root(node):
    while node.owner is not None:
        node = node.owner
    return node


@pytest.mark.parametrize("folder", quick_first(["omg-release/examples/Simple Tests", "showcase"]))
def test_texts_come_back_as_they_were(folder, corpus, library):
    documents, files, codes = written(corpus / "sysml2" / folder, library)
    assert codes == []
    again = read_again(files)
    for before, after in zip(shape(documents), shape(again), strict=True):
        assert before == after


@pytest.mark.long
def test_what_leads_nowhere_in_the_ice_laboratory_is_told(corpus, library):
    documents, files, codes = written(corpus / "sysml2/ice-lab", library)
    assert (len(files), set(codes)) == (18, {"SM758"})
    again = read_again(files)
    assert [len(list(one.root.walk())) for one in again[:3]] == [
        len(list(one.root.walk())) for one in documents[:3]
    ]


def test_ids_of_the_library_text_are_those_of_its_releases(corpus, library):
    """Also of elements that are named by what they implicitly redefine."""
    folder = corpus / "sysml2/omg-release/sysml.library/Systems Library"
    released = corpus / "sysml2/interchange/xmi/Systems Library"
    same = other = 0
    for path, data in written(folder, library)[1].items():
        ours, theirs = (
            set(re.findall(rb'xmi:id="([^"]+)"', text))
            for text in (data, (released / path).read_bytes())
        )
        same, other = same + len(ours & theirs), other + len(ours - theirs)
    assert (same, other) == (6_419, 0)


@pytest.mark.long
def test_models_of_the_pilot_come_back_as_they_were(corpus, library):
    """Small models of every construct; those with faults that are meant are left out."""
    paths = sorted((corpus / "sysml2/pilot-xpect").rglob("*.xt"))
    compared = 0
    for path in paths:
        language, sink = "kerml" if ".kerml" in path.name else "sysml", Sink()
        text = path.read_bytes().decode("utf-8", "replace")
        one = parse(text, path.name.removesuffix(".xt"), language, sink)
        resolve([one], library, sink)
        if not sink.has_errors():
            data = write(one, [one, *library.loaded_documents()], sink)
            again = read_again({interchange_path(one): data})
            assert shape([one]) == shape(again), path
            compared += 1
    assert (len(paths), compared > 200) == (428, True)


def loaded(files, folder, corpus):
    """How many elements pyecore finds in each file with the metamodel, and how many it has."""
    from pyecore.resources import URI, ResourceSet

    resources = ResourceSet()
    metamodel = corpus / "sysml2/interchange/metamodel/SysML.ecore"
    package = resources.get_resource(URI(str(metamodel))).contents[0]
    resources.metamodel_registry[package.nsURI] = package
    found, there = [], []
    for path, data in files.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
        (root,) = resources.get_resource(URI(str(file))).contents
        found.append(1 + sum(1 for _ in root.eAllContents()))
        there.append(data.count(b"xmi:id="))
    return found, there


@pytest.mark.parametrize(
    "folder", quick_first(["omg-release/examples/Simple Tests", "omg-release/training", "showcase"])
)
def test_texts_as_we_write_them_are_valid_for_the_metamodel(folder, corpus, library, tmp_path):
    _, files, codes = written(corpus / "sysml2" / folder, library)
    found, there = loaded(files, tmp_path, corpus)
    assert codes == []
    assert found == there


def test_kerml_as_we_write_it_is_valid_for_the_metamodel(corpus, library, tmp_path):
    files = {}
    for path in sorted((corpus / "sysml2/pilot-xpect/kerml").rglob("*.xt"))[::4]:
        sink = Sink()
        one = parse(path.read_text("utf-8"), path.name[:-3], "kerml", sink)
        resolve([one], library, sink)
        if not sink.has_errors():
            files[interchange_path(one)] = write(one, [one, *library.loaded_documents()], sink)
    found, there = loaded(files, tmp_path, corpus)
    assert len(files) > 20
    assert found == there
