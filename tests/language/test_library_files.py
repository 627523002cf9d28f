"""The library: where it is searched, lazy reading, and reuse within a process."""

import importlib.metadata
import sys
import zipfile

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.language.library import Library, find_library, load_core
from sysmlc.language.names import resolve
from sysmlc.language.text import parse
from sysmlc.sources import Source, SourceError


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "lib" / "deep").mkdir(parents=True)
    (tmp_path / "lib" / "Doors.sysml").write_text("package Doors { part def Gate; }")
    (tmp_path / "lib" / "deep" / "other.sysml").write_text("package Halls { part def Hall; }")
    (tmp_path / "lib" / "notes.txt").write_text("no model")
    return tmp_path / "lib"


def list_roots(library, name):
    """Return metaclass and name of the root elements called *name*."""
    return [(node.kind, node.name) for node in library.roots(name)]


def test_a_folder_is_searched_recursively(folder):
    library = find_library(folder)
    assert library.paths() == ["Doors.sysml", "deep/other.sysml"]
    assert list_roots(library, "Doors") == [("Package", "Doors")]
    assert list_roots(library, "Halls") == [("Package", "Halls")]
    assert list_roots(library, "Gate") == []


def test_only_the_file_named_like_the_package_is_read(folder):
    library = find_library(folder)
    library.roots("Doors")
    assert [document.path for document in library.loaded_documents()] == ["Doors.sysml"]


def test_an_archive_or_a_folder_of_archives_is_a_library(folder, tmp_path):
    path = tmp_path / "kpars" / "doors.kpar"
    path.parent.mkdir()
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(folder / "Doors.sysml", "Doors.sysml")
        archive.writestr(".project.json", "{}")
    assert find_library(path).paths() == ["doors.kpar!Doors.sysml"]
    assert find_library(path.parent).paths() == ["doors.kpar!Doors.sysml"]
    assert list_roots(find_library(path), "Doors") == [("Package", "Doors")]


def test_the_option_takes_precedence_over_the_environment(folder, tmp_path):
    environment_folder = tmp_path / "environment"
    environment_folder.mkdir()
    (environment_folder / "Roofs.kerml").write_text("package Roofs;")
    environment = {"SYSML_LIBRARY_PATH": str(environment_folder)}
    assert find_library(folder, environment).paths() == ["Doors.sysml", "deep/other.sysml"]
    assert find_library(None, environment).paths() == ["Roofs.kerml"]


def test_a_missing_or_empty_library_is_an_error(tmp_path):
    with pytest.raises(SourceError, match="No such file"):
        find_library(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(SourceError, match=r"has no .sysml or .kerml files"):
        find_library(tmp_path / "empty")


def test_the_installed_distribution_is_read_without_being_imported(tmp_path, monkeypatch):
    models = tmp_path / "sysml" / "stdlib"
    models.mkdir(parents=True)
    (tmp_path / "sysml" / "__init__.py").write_text("raise RuntimeError('imported')")
    (models / "Parts.sysml").write_text("package Parts { part def Part; }")
    monkeypatch.delitem(sys.modules, "sysml", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    library = find_library(None, {})
    assert library.paths() == ["Parts.sysml"]
    assert "sysml" not in sys.modules
    assert not library.is_core


def list_codes_without_library(text):
    sink = Sink()
    resolve([parse(text, "a.sysml", "sysml", sink)], find_library(None, {}), sink)
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
    assert find_library(None, {}).is_core
    text = "attribute a : ScalarValues::Real; attribute b : ScalarValues::String;"
    assert list_codes_without_library(text) == ["SM207"]
    assert list_codes_without_library("attribute a;") == []


def test_the_label_of_a_library_says_where_it_was_found(folder, wheel_without_models):
    assert find_library(folder).label == f"{folder} (--library)"
    environment = {"SYSML_LIBRARY_PATH": str(folder)}
    assert find_library(None, environment).label == f"{folder} (SYSML_LIBRARY_PATH)"
    assert find_library(None, {}).label == "core of sysmlc (bundled)"


def test_the_label_of_the_installed_library_has_the_version():
    version = importlib.metadata.version("sysml")
    assert find_library(None, {}).label == f"sysml {version} (installed)"


def test_an_unknown_type_is_searched_in_unread_library_files():
    tools = Source("Tools.sysml", b"library package Tools { part def Drill; }")
    sink = Sink()
    resolve([parse("part d : Drill;", "a.sysml", "sysml", sink)], Library([tools]), sink)
    assert [diagnostic.help for diagnostic in sink] == [
        "'Drill' is in 'Tools', which is not imported here"
    ]


def test_every_name_in_the_core_is_resolved_within_the_core():
    library = load_core()
    sink = Sink()
    documents = [library.document(path) for path in library.paths()]
    resolve(documents, load_core(), sink)
    assert [diagnostic.message for diagnostic in sink if diagnostic.rule.code != "SM207"] == []
    assert sum(1 for document in documents for _ in document.root.walk()) > 500


def test_a_file_that_does_not_mention_a_name_is_not_parsed(folder):
    (folder / "broken.sysml").write_text("package Roofs { part def Tile; }")
    library = find_library(folder)
    library.roots("Halls")
    assert sorted(library._parsed) == ["deep/other.sysml"]


@pytest.mark.parametrize("text", ["package 'Doors \\'n\\' gates';", "package 'A\\tB';"])
def test_a_name_with_escapes_is_found(tmp_path, text):
    (tmp_path / "any.sysml").write_text(text)
    library = find_library(tmp_path)
    (name,) = library.names()
    assert [node.name for node in library.roots(name)] == [name]


def test_a_second_model_reuses_the_parsed_library(folder, monkeypatch):
    first = find_library(folder)
    first.roots("Doors")
    monkeypatch.setattr("sysmlc.language.library.parse", None)
    assert list_roots(find_library(folder), "Doors") == [("Package", "Doors")]


def test_a_changed_library_file_is_parsed_again(folder):
    find_library(folder).roots("Doors")
    (folder / "Doors.sysml").write_text("package Doors { part def Flap; }")
    members = find_library(folder).roots("Doors")[0].members
    assert [member.name for member in members] == ["Flap"]


def test_a_package_of_one_model_is_invisible_to_the_next_model(folder):
    """The package ``Halls`` of the first model replaces the library's ``Halls`` for it alone."""
    (folder / "Doors.sysml").write_text("package Doors { part hall : Halls::Hall; }")
    text = "package Cell { part p :> Doors::hall; }"
    halls = "package Halls { part def Hall { part lamp; } }"
    first = resolve([parse(text + halls, "a.sysml", "sysml", Sink())], find_library(folder), Sink())
    assert [node.owner.owner.members[0].name for node in list_hall_types(first)] == ["Cell"]
    second = resolve([parse(text, "a.sysml", "sysml", Sink())], find_library(folder), Sink())
    assert [node.owner.members[0].name for node in list_hall_types(second)] == ["Hall"]
    assert [len(node.members) for node in list_hall_types(second)] == [0]


def list_hall_types(model):
    return model.types(model.find("Doors::hall"))
