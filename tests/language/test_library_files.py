"""Where the library is found, that it is read lazily, and what the cache keeps of it."""

import importlib.metadata
import sys
import zipfile

import pytest

from sysmlc.cache import Cache
from sysmlc.diagnostics import Sink
from sysmlc.language.library import Library, core, find
from sysmlc.language.names import resolve
from sysmlc.language.stored import StoredNode, pack, unpack
from sysmlc.language.text import parse
from sysmlc.sources import Source, SourceError


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "lib" / "deep").mkdir(parents=True)
    (tmp_path / "lib" / "Doors.sysml").write_text("package Doors { part def Gate; }")
    (tmp_path / "lib" / "deep" / "other.sysml").write_text("package Halls { part def Hall; }")
    (tmp_path / "lib" / "notes.txt").write_text("no model")
    return tmp_path / "lib"


def names(found):
    return [(node.kind, node.name) for node in found]


def test_a_folder_is_searched_with_all_below_it(folder):
    library = find(folder)
    assert library.paths() == ["Doors.sysml", "deep/other.sysml"]
    assert names(library.roots("Doors")) == [("Package", "Doors")]
    assert names(library.roots("Halls")) == [("Package", "Halls")]
    assert library.roots("Gate") == []


def test_only_the_file_named_like_the_package_is_read(folder):
    library = find(folder)
    library.roots("Doors")
    assert [document.path for document in library.loaded()] == ["Doors.sysml"]


def test_an_archive_is_a_library_and_so_is_a_folder_of_them(folder, tmp_path):
    path = tmp_path / "kpars" / "doors.kpar"
    path.parent.mkdir()
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(folder / "Doors.sysml", "Doors.sysml")
        archive.writestr(".project.json", "{}")
    assert find(path).paths() == ["doors.kpar!Doors.sysml"]
    assert find(path.parent).paths() == ["doors.kpar!Doors.sysml"]
    assert names(find(path).roots("Doors")) == [("Package", "Doors")]


def test_the_option_comes_before_the_environment(folder, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "Roofs.kerml").write_text("package Roofs;")
    environment = {"SYSML_LIBRARY_PATH": str(other)}
    assert find(folder, environment).paths() == ["Doors.sysml", "deep/other.sysml"]
    assert find(None, environment).paths() == ["Roofs.kerml"]


def test_a_library_that_is_not_there_or_empty_is_an_error(tmp_path):
    with pytest.raises(SourceError, match="No such file"):
        find(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(SourceError, match=r"has no .sysml or .kerml files"):
        find(tmp_path / "empty")


def test_the_installed_distribution_is_read_as_data_and_not_imported(tmp_path, monkeypatch):
    models = tmp_path / "sysml" / "stdlib"
    models.mkdir(parents=True)
    (tmp_path / "sysml" / "__init__.py").write_text("raise RuntimeError('imported')")
    (models / "Parts.sysml").write_text("package Parts { part def Part; }")
    monkeypatch.delitem(sys.modules, "sysml", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    library = find(None, {})
    assert library.paths() == ["Parts.sysml"]
    assert "sysml" not in sys.modules
    assert not library.is_core


def codes_without_library(text):
    sink = Sink()
    resolve([parse(text, "a.sysml", "sysml", sink)], find(None, {}), sink)
    return [diagnostic.rule.code for diagnostic in sink]


@pytest.fixture
def wheel_without_models(tmp_path, monkeypatch):
    """The distribution as it is on platforms for which it has no library files."""
    (tmp_path / "sysml").mkdir()
    (tmp_path / "sysml" / "__init__.py").touch()
    monkeypatch.delitem(sys.modules, "sysml", raising=False)
    monkeypatch.syspath_prepend(tmp_path)


def test_the_core_replaces_a_distribution_without_models_which_is_reported_once(
    wheel_without_models,
):
    assert find(None, {}).is_core
    text = "attribute a : ScalarValues::Real; attribute b : ScalarValues::String;"
    assert codes_without_library(text) == ["SM207"]
    assert codes_without_library("attribute a;") == []


def test_labels_of_libraries(folder, wheel_without_models):
    assert find(folder).label == f"{folder} (--library)"
    environment = {"SYSML_LIBRARY_PATH": str(folder)}
    assert find(None, environment).label == f"{folder} (SYSML_LIBRARY_PATH)"
    assert find(None, {}).label == "core of sysmlc (bundled)"


def test_the_label_of_the_installed_library_has_the_version():
    version = importlib.metadata.version("sysml")
    assert find(None, {}).label == f"sysml {version} (installed)"


def test_a_lost_type_is_looked_for_in_library_files_that_nobody_read():
    tools = Source("Tools.sysml", b"library package Tools { part def Drill; }")
    sink = Sink()
    resolve([parse("part d : Drill;", "a.sysml", "sysml", sink)], Library([tools]), sink)
    assert [found.help for found in sink] == ["'Drill' is in 'Tools', which is not imported here"]


def test_every_name_of_the_core_is_known_in_it():
    library = core()
    sink = Sink()
    documents = [library.document(path) for path in library.paths()]
    resolve(documents, core(), sink)
    assert [found.message for found in sink if found.rule.code != "SM207"] == []
    assert sum(1 for document in documents for _ in document.root.walk()) > 500


def test_a_second_run_takes_trees_from_the_cache(folder, tmp_path, monkeypatch):
    cache = Cache(tmp_path / "cache")
    first = find(folder, cache=cache)
    assert first.roots("Nobody") == []
    monkeypatch.setattr("sysmlc.language.text.parse", None)
    second = find(folder, cache=cache)
    gate = second.roots("Doors")[0].members[0]
    assert isinstance(gate, StoredNode)
    assert (gate.kind, gate.name, gate.owner.name) == ("PartDefinition", "Gate", "Doors")
    assert names(second.roots("Halls")) == [("Package", "Halls")]
    assert second.roots("Nobody") == []


def test_another_text_is_read_anew(folder, tmp_path):
    cache = Cache(tmp_path / "cache")
    find(folder, cache=cache).roots("Doors")
    (folder / "Doors.sysml").write_text("package Doors { part def Flap; }")
    members = find(folder, cache=cache).roots("Doors")[0].members
    assert [member.name for member in members] == ["Flap"]


def described(node):
    relations = [(r.kind, str(r.reference), r.reference.start) for r in node.relations]
    own = [getattr(node, name) for name in ("kind", "name", "short", "membership", "role")]
    return [*own, node.visibility, node.facts, relations, node.start, node.end, node.name_start]


def test_a_stored_tree_is_the_tree():
    text = """
        package Doors {
            private import ScalarValues::*;
            abstract part def <G> Gate :> Door { attribute width : Real[1] = 2 * (3 + x.y); }
            alias Flap for Gate;
        }
    """
    root = parse(text, "a.sysml", "sysml", Sink()).root
    again = unpack(pack(root))
    assert [described(n) for n in again.walk()] == [described(n) for n in root.walk()]


def test_damaged_entries_are_not_used():
    assert unpack(b"") is None
    assert unpack(b"no tree") is None
    assert unpack(pack(parse("part a;", "a.sysml", "sysml", Sink()).root)[:-4]) is None


def test_names_with_line_ends_and_tabs_are_kept_in_the_index(folder, tmp_path):
    (folder / "odd.sysml").write_text(r"package 'Halls\nand\tdoors' { part def Both; }")
    cache = Cache(tmp_path / "cache")
    for _ in range(2):
        library = find(folder, cache=cache)
        assert names(library.roots("Halls\nand\tdoors")) == [("Package", "Halls\nand\tdoors")]
        assert library.roots("Halls\nand") == []
