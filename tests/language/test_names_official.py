"""Every name of the official models is resolved, to the target in the interchange files."""

from functools import cache
from pathlib import Path

import pytest
from official_models import (
    FOLDER,
    LIBRARY_FOLDER,
    XMI_FILES,
    load_standard_library,
    parse_folder,
    read_xmi_library,
)

from sysmlc.diagnostics import Severity, Sink
from sysmlc.language.library import Library
from sysmlc.language.names import Model, resolve

pytestmark = pytest.mark.corpus


def list_unknown_names(documents, library):
    """Return path, line and name of each name that is unknown."""
    sink = Sink()
    resolve(documents, library, sink)
    texts = {document.path: document.text.encode() for document in documents}
    unknown = []
    for diagnostic in sink:
        if diagnostic.severity is Severity.ERROR:
            place = diagnostic.subject.place
            line = texts[place.file].count(b"\n", 0, place.offset) + 1
            unknown.append((place.file, line, diagnostic.message.split("'")[1]))
    return sorted(unknown)


@pytest.mark.parametrize(("folder", "count"), [("training", 100), ("examples", 95)])
def test_no_name_of_the_official_models_is_unknown(folder, count):
    documents = parse_folder(FOLDER / "omg-release" / folder)
    assert len(documents) == count
    assert list_unknown_names(documents, load_standard_library()) == []


@pytest.mark.long
def test_no_name_of_the_library_itself_is_unknown():
    documents = parse_folder(LIBRARY_FOLDER)
    assert len(documents) == 94
    assert list_unknown_names(documents, Library([])) == []


def test_the_unknown_names_of_the_ice_laboratory_are_those_in_its_readme():
    folder = FOLDER / "ice-lab"
    unknown = list_unknown_names(parse_folder(folder), load_standard_library())
    assert [path for path, _, name in unknown if name == "OpcUaConnection"] == [
        "plant/ice_lab.sysml"
    ] * 9
    cell = "equipment/state_machines/robotic_cell.sysml"
    port_uses = [
        number
        for number, line in enumerate((folder / cell).read_text("utf-8").splitlines(), 1)
        if any(port in line for port in ("CmdPort;", "StatePort;", ".cmdPort", ".statePort"))
    ]
    assert [line for path, line, _ in unknown if path == cell] == port_uses
    assert len(port_uses) == 15
    assert len(unknown) == 24


def test_the_showcase_has_no_unknown_name():
    assert list_unknown_names(parse_folder(FOLDER / "showcase"), load_standard_library()) == []


@cache
def load_xmi_model():
    return Model(read_xmi_library(), Library([]))


@cache
def load_text_model():
    return resolve(parse_folder(LIBRARY_FOLDER), Library([]), Sink())


def list_names_from_root(model, node):
    """Return the names from the root to *node*; a nameless element counts by its position."""
    steps = []
    while node.owner is not None:
        name = model.name(node)
        steps.append(name if name is not None else node.owner.members.index(node))
        node = node.owner
    return steps


def iter_pairs(left, right):
    """Yield the nodes at the same positions of two trees."""
    yield left, right
    for left_member, right_member in zip(left.members, right.members, strict=True):
        yield from iter_pairs(left_member, right_member)


def list_targets(model, relation):
    return [list_names_from_root(model, target) for target in relation.reference.targets]


@pytest.mark.parametrize("name", XMI_FILES)
def test_each_name_has_the_target_of_the_interchange_file(name):
    text_model, xmi_model = load_text_model(), load_xmi_model()
    xmi = next(document for document in xmi_model.documents if document.path == name)
    text = next(
        document for document in text_model.documents if Path(document.path).stem == Path(name).stem
    )
    wrong, count = [], 0
    for text_node, xmi_node in iter_pairs(text.root, xmi.root):
        for relation, expected in zip(text_node.relations, xmi_node.relations, strict=True):
            if expected.reference.target is None:
                continue
            count += 1
            targets = list_targets(text_model, relation)
            expected_targets = list_targets(xmi_model, expected)
            if targets != expected_targets:
                wrong.append((str(relation.reference), targets, expected_targets))
    assert wrong == []
    assert count or name.endswith("StandardViewDefinitions.sysmlx")


def test_2829_targets_are_compared_and_288_are_in_files_that_are_not_there():
    relations = [
        relation
        for document in load_xmi_model().documents
        for node in document.root.walk()
        for relation in node.relations
    ]
    resolved = sum(relation.reference.target is not None for relation in relations)
    assert (resolved, len(relations) - resolved) == (2829, 288)
