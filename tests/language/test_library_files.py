"""Where the library is found, that it is read lazily, and what a process reuses of it."""

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


def names(found):
    return [(node.kind, node.name) for node in found]


def test_a_folder_is_searched_with_all_below_it(folder):
    library = find_library(folder)
    assert library.paths() == ["Doors.sysml", "deep/other.sysml"]
    assert names(library.roots("Doors")) == [("Package", "Doors")]
    assert names(library.roots("Halls")) == [("Package", "Halls")]
    assert library.roots("Gate") == []


def test_only_the_file_named_like_the_package_is_read(folder):
    library = find_library(folder)
    library.roots("Doors")
    assert [document.path for document in library.loaded_documents()] == ["Doors.sysml"]


def test_an_archive_is_a_library_and_so_is_a_folder_of_them(folder, tmp_path):
    path = tmp_path / "kpars" / "doors.kpar"
    path.parent.mkdir()
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(folder / "Doors.sysml", "Doors.sysml")
        archive.writestr(".project.json", "{}")
    assert find_library(path).paths() == ["doors.kpar!Doors.sysml"]
    assert find_library(path.parent).paths() == ["doors.kpar!Doors.sysml"]
    assert names(find_library(path).roots("Doors")) == [("Package", "Doors")]


def test_the_option_comes_before_the_environment(folder, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "Roofs.kerml").write_text("package Roofs;")
    environment = {"SYSML_LIBRARY_PATH": str(other)}
    assert find_library(folder, environment).paths() == ["Doors.sysml", "deep/other.sysml"]
    assert find_library(None, environment).paths() == ["Roofs.kerml"]


def test_a_library_that_is_not_there_or_empty_is_an_error(tmp_path):
    with pytest.raises(SourceError, match="No such file"):
        find_library(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(SourceError, match=r"has no .sysml or .kerml files"):
        find_library(tmp_path / "empty")


def test_the_installed_distribution_is_read_as_data_and_not_imported(tmp_path, monkeypatch):
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


def codes_without_library(text):
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
    assert codes_without_library(text) == ["SM207"]
    assert codes_without_library("attribute a;") == []


def test_labels_of_libraries(folder, wheel_without_models):
    assert find_library(folder).label == f"{folder} (--library)"
    environment = {"SYSML_LIBRARY_PATH": str(folder)}
    assert find_library(None, environment).label == f"{folder} (SYSML_LIBRARY_PATH)"
    assert find_library(None, {}).label == "core of sysmlc (bundled)"


def test_the_label_of_the_installed_library_has_the_version():
    version = importlib.metadata.version("sysml")
    assert find_library(None, {}).label == f"sysml {version} (installed)"


def test_a_lost_type_is_looked_for_in_library_files_that_nobody_read():
    tools = Source("Tools.sysml", b"library package Tools { part def Drill; }")
    sink = Sink()
    resolve([parse("part d : Drill;", "a.sysml", "sysml", sink)], Library([tools]), sink)
    assert [found.help for found in sink] == ["'Drill' is in 'Tools', which is not imported here"]


def test_every_name_of_the_core_is_known_in_it():
    library = load_core()
    sink = Sink()
    documents = [library.document(path) for path in library.paths()]
    resolve(documents, load_core(), sink)
    assert [found.message for found in sink if found.rule.code != "SM207"] == []
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


def test_a_second_model_of_a_process_uses_the_parsed_library(folder, monkeypatch):
    first = find_library(folder)
    first.roots("Doors")
    monkeypatch.setattr("sysmlc.language.library.parse", None)
    assert names(find_library(folder).roots("Doors")) == [("Package", "Doors")]


def test_a_changed_library_file_is_parsed_again(folder):
    find_library(folder).roots("Doors")
    (folder / "Doors.sysml").write_text("package Doors { part def Flap; }")
    members = find_library(folder).roots("Doors")[0].members
    assert [member.name for member in members] == ["Flap"]


def test_a_package_of_one_model_is_not_seen_by_the_next_model(folder):
    """The library's ``Halls`` is the model's own in the first model, and the library's again."""
    (folder / "Doors.sysml").write_text("package Doors { part hall : Halls::Hall; }")
    text = "package Cell { part p :> Doors::hall; }"
    own = "package Halls { part def Hall { part lamp; } }"
    first = resolve([parse(text + own, "a.sysml", "sysml", Sink())], find_library(folder), Sink())
    assert [node.owner.owner.members[0].name for node in hall_types(first)] == ["Cell"]
    second = resolve([parse(text, "a.sysml", "sysml", Sink())], find_library(folder), Sink())
    assert [node.owner.members[0].name for node in hall_types(second)] == ["Hall"]
    assert [len(node.members) for node in hall_types(second)] == [0]


def hall_types(model):
    return model.types(model.find("Doors::hall"))
