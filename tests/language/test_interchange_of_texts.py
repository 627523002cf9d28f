"""Texts of the corpus, written as interchange files and read again, have the same trees."""

import re
from functools import partial

import pytest
from official_models import (
    FOLDER,
    LIBRARY_FOLDER,
    load_standard_library,
    parse_folder,
)

from long_runs import quick_first
from sysml_metamodel import count_ids, count_with_metamodel
from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import link, read
from sysmlc.language.interchange.writer import InterchangeFiles, interchange_path, write
from sysmlc.language.names import resolve
from sysmlc.language.names.implied_relations import implied_redefinitions
from sysmlc.language.text import parse
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus


def write_folder(folder):
    """Return the documents of a folder, their interchange files, and the codes of diagnostics."""
    library, sink = load_standard_library(), Sink()
    documents = parse_folder(folder)
    model = resolve(documents, library, Sink())
    all_files = InterchangeFiles(
        [*documents, *library.loaded_documents()],
        redefined=partial(implied_redefinitions, model),
    )
    files = {interchange_path(document): write(document, all_files, sink) for document in documents}
    return documents, files, [diagnostic.rule.code for diagnostic in sink]


def read_files(files):
    sink = Sink()
    documents = [read(Source(path, data), sink) for path, data in files.items()]
    link(documents, sink)
    assert [diagnostic.message for diagnostic in sink] == []
    return documents


def list_values(documents):
    """Return the trees as values.

    A reference counts by its targets within the documents, and else by the length of its chain.
    """
    roots = {document.root for document in documents}
    return [[_describe(node, roots) for node in document.root.walk()] for document in documents]


def _describe(node, roots):
    attributes = {name: value for name, value in node.attributes.items() if name != "isPrefix"}
    role = "default" if node.role == "default =" else node.role
    relations = [
        (relation.kind, _describe_targets(relation.reference, roots)) for relation in node.relations
    ]
    names = (node.kind, node.name, node.short_name)
    membership = (node.membership, role, node.visibility)
    return (*names, *membership, len(node.members), attributes, relations)


def _describe_targets(reference, roots):
    targets = reference.targets or []
    is_inside = targets and all(_find_root(target) in roots for target in targets)
    return [(node.kind, node.name) for node in targets] if is_inside else len(reference.chain)


def _find_root(node):
    while node.owner is not None:
        node = node.owner
    return node


@pytest.mark.parametrize("folder", quick_first(["omg-release/examples/Simple Tests", "showcase"]))
def test_texts_have_the_same_trees_after_writing_and_reading(folder):
    documents, files, codes = write_folder(FOLDER / folder)
    assert codes == []
    for before, after in zip(list_values(documents), list_values(read_files(files)), strict=True):
        assert before == after


@pytest.mark.long
def test_unresolved_references_of_the_ice_laboratory_are_reported_as_losses():
    documents, files, codes = write_folder(FOLDER / "ice-lab")
    assert (len(files), set(codes)) == (18, {"SM758"})
    counts_before, counts_after = (
        [len(list(document.root.walk())) for document in version[:3]]
        for version in (documents, read_files(files))
    )
    assert counts_after == counts_before


def test_ids_of_the_written_library_are_those_of_the_release():
    """Also ids of elements whose name is that of the feature they implicitly redefine."""
    released_folder = FOLDER / "interchange/xmi/Systems Library"
    same = different = 0
    for path, data in write_folder(LIBRARY_FOLDER / "Systems Library")[1].items():
        ids, released_ids = (
            set(re.findall(rb'xmi:id="([^"]+)"', text))
            for text in (data, (released_folder / path).read_bytes())
        )
        same, different = same + len(ids & released_ids), different + len(ids - released_ids)
    assert (same, different) == (6_419, 0)


def iter_valid_pilot_models(folder, step=1):
    """Yield path, document and interchange file of the pilot's models without errors."""
    library = load_standard_library()
    for path in sorted(folder.rglob("*.xt"))[::step]:
        language, sink = "kerml" if ".kerml" in path.name else "sysml", Sink()
        text = path.read_bytes().decode("utf-8", "replace")
        document = parse(text, path.name.removesuffix(".xt"), language, sink)
        resolve([document], library, sink)
        # Interchange files state the visibility that an import in an older text omits (SM197).
        is_older = any(diagnostic.rule.code == "SM197" for diagnostic in sink)
        if not sink.has_errors() and not is_older:
            yield path, document, write(document, [document, *library.loaded_documents()], sink)


@pytest.mark.long
def test_models_of_the_pilot_have_the_same_trees_after_writing_and_reading():
    """Small models of every construct; those with intended errors are skipped."""
    count = 0
    for path, document, data in iter_valid_pilot_models(FOLDER / "pilot-xpect"):
        documents = read_files({interchange_path(document): data})
        assert list_values([document]) == list_values(documents), path
        count += 1
    assert count > 200


@pytest.mark.parametrize(
    "folder", quick_first(["omg-release/examples/Simple Tests", "omg-release/training", "showcase"])
)
def test_written_texts_are_valid_for_the_metamodel(folder, tmp_path, corpus):
    _, files, codes = write_folder(FOLDER / folder)
    assert codes == []
    texts = {path: data.decode() for path, data in files.items()}
    assert count_with_metamodel(texts, tmp_path, corpus) == count_ids(texts)


def test_written_kerml_is_valid_for_the_metamodel(tmp_path, corpus):
    files = {
        interchange_path(document): data
        for _, document, data in iter_valid_pilot_models(FOLDER / "pilot-xpect/kerml", step=4)
    }
    assert len(files) > 20
    texts = {path: data.decode() for path, data in files.items()}
    assert count_with_metamodel(texts, tmp_path, corpus) == count_ids(texts)
