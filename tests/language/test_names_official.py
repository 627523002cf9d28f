"""Every name of the official models leads somewhere, and where the interchange files say."""

import os
from functools import cache
from pathlib import Path

import pytest

from sysmlc.diagnostics import Severity, Sink
from sysmlc.language.interchange import link
from sysmlc.language.interchange import read as read_interchange
from sysmlc.language.library import Library, find_library
from sysmlc.language.names import Model, resolve
from sysmlc.language.text import parse
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

_FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
_LIBRARY = _FOLDER / "omg-release" / "sysml.library"
_XMI = _FOLDER / "interchange" / "xmi"
XMI_FILES = sorted(path.relative_to(_XMI).as_posix() for path in _XMI.rglob("*.*mlx"))


@cache
def library():
    return find_library(_LIBRARY)


def documents(folder):
    paths = sorted(path for path in folder.rglob("*") if path.suffix in (".sysml", ".kerml"))
    names = [path.relative_to(folder).as_posix() for path in paths]
    sources = [Source(name, path.read_bytes()) for name, path in zip(names, paths, strict=True)]
    return [
        parse(s.data.decode("utf-8-sig"), s.name, Path(s.name).suffix[1:], Sink(), s)
        for s in sources
    ]


def unresolved(folder, beside):
    """Path, line and name of each use that leads nowhere."""
    sink = Sink()
    made = documents(folder)
    resolve(made, beside, sink)
    texts = {document.path: document.text.encode() for document in made}
    found = [f for f in sink if f.severity is Severity.ERROR]
    places = [f.subject.place for f in found]
    lines = [texts[p.file].count(b"\n", 0, p.offset) + 1 for p in places]
    words = [f.message.split("'")[1] for f in found]
    return sorted(zip((p.file for p in places), lines, words, strict=True))


@pytest.mark.parametrize(("folder", "count"), [("training", 100), ("examples", 95)])
def test_no_name_of_the_official_models_is_unknown(folder, count):
    made = _FOLDER / "omg-release" / folder
    assert len(documents(made)) == count
    assert unresolved(made, library()) == []


@pytest.mark.long
def test_no_name_of_the_library_itself_is_unknown():
    assert len(documents(_LIBRARY)) == 94
    assert unresolved(_LIBRARY, Library([])) == []


def test_the_unknown_names_of_the_ice_laboratory_are_those_that_its_readme_tells():
    found = unresolved(_FOLDER / "ice-lab", library())
    plant = [line for file, line, name in found if name == "OpcUaConnection"]
    assert len(plant) == 9
    assert {file for file, _, name in found if name == "OpcUaConnection"} == {"plant/ice_lab.sysml"}
    cell = "equipment/state_machines/robotic_cell.sysml"
    text = (_FOLDER / "ice-lab" / cell).read_text("utf-8").splitlines()
    ports = [
        number
        for number, line in enumerate(text, 1)
        if any(f in line for f in ("CmdPort;", "StatePort;", ".cmdPort", ".statePort"))
    ]
    assert [line for file, line, _ in found if file == cell] == ports
    assert len(ports) == 15
    assert len(found) == 24


def test_the_showcase_has_no_unknown_name():
    assert unresolved(_FOLDER / "showcase", library()) == []


@cache
def interchanged():
    sink = Sink()
    made = [read_interchange(Source(n, (_XMI / n).read_bytes()), sink) for n in XMI_FILES]
    link(made, sink)
    return Model(made, Library([]))


@cache
def written():
    return resolve(documents(_LIBRARY), Library([]), Sink())


def described(model, node):
    """Names from the root to an element; a nameless one is its number among its siblings."""
    steps = []
    while node.owner is not None:
        name = model.name(node)
        steps.append(name if name is not None else node.owner.members.index(node))
        node = node.owner
    return steps


def pairs(left, right):
    yield left, right
    for one, other in zip(left.members, right.members, strict=True):
        yield from pairs(one, other)


@pytest.mark.parametrize("name", XMI_FILES)
def test_each_name_leads_where_the_interchange_file_says(name):
    theirs = next(d for d in interchanged().documents if d.path == name)
    stem = Path(name).stem
    ours = next(d for d in written().documents if Path(d.path).stem == stem)
    wrong, count = [], 0
    for mine, other in pairs(ours.root, theirs.root):
        said = mine.relations
        for relation, expected in zip(said, other.relations, strict=True):
            if expected.reference.target is None:
                continue
            count += 1
            found = [described(written(), n) for n in relation.reference.targets]
            wanted = [described(interchanged(), n) for n in expected.reference.targets]
            if found != wanted:
                wrong.append((str(relation.reference), found, wanted))
    assert wrong == []
    assert count or name.endswith("StandardViewDefinitions.sysmlx")


def test_targets_in_other_files_are_the_only_ones_that_are_not_compared():
    relations = [
        relation
        for document in interchanged().documents
        for node in document.root.walk()
        for relation in node.relations
    ]
    known = sum(relation.reference.target is not None for relation in relations)
    assert (known, len(relations) - known) == (2829, 288)
