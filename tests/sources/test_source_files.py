"""Files: how they are read completely, and which files references can reach."""

import os
import zipfile
from pathlib import Path

import pytest

from sysmlc.sources import DEFAULT_LIMITS, Fault, Limits, Roots, SourceError, files, load
from sysmlc.sources.files import read_whole
from sysmlc.sources.source import DOCUMENT_LIMITS

DOCS = Path(__file__).parents[2] / "docs"


def test_a_plain_file_is_one_source(tmp_path):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    (source,) = load(path, "models/plant.uml")
    assert (source.name, source.data) == ("models/plant.uml", b"<a/>")


def test_an_archive_is_recognised_by_its_content(tmp_path):
    path = tmp_path / "plant.uml"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("com.nomagic.magicdraw.uml_model.model", "<a/>")
        archive.writestr("BINARY-1", "drawing")
    (source,) = load(path, "plant.uml")
    assert source.name == "plant.uml!com.nomagic.magicdraw.uml_model.model"


def test_an_archive_without_a_model_is_an_error(tmp_path):
    path = tmp_path / "plant.mdzip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("readme", "nothing")
    with pytest.raises(SourceError, match="holds no model"):
        load(path, "plant.mdzip")


def test_a_missing_file_and_a_file_over_the_limit_are_exit_code_2(tmp_path):
    with pytest.raises(SourceError) as missing:
        load(tmp_path / "no.uml", "no.uml")
    assert (missing.value.fault, missing.value.exit_code) == (Fault.MISSING, 2)
    (tmp_path / "big.uml").write_bytes(b"x" * 11)
    with pytest.raises(SourceError) as large:
        load(tmp_path / "big.uml", "big.uml", limits=Limits(file_size=10))
    assert (large.value.fault, large.value.exit_code) == (Fault.LIMIT, 2)


@pytest.mark.parametrize(
    ("limits", "size"), [(DEFAULT_LIMITS, 2 << 30), (DOCUMENT_LIMITS, 16 << 20)]
)
def test_models_and_documents_have_a_greatest_size(tmp_path, limits, size):
    """The file has a hole of this size, so that it takes no space on the disk."""
    path = tmp_path / "big.uml"
    with path.open("wb") as file:
        file.truncate(size + 1)
    with pytest.raises(SourceError, match=f"^larger than {size} bytes$"):
        read_whole(path, "big.uml", limits)


def test_the_limits_are_those_of_the_documentation():
    text = " ".join((DOCS / "untrusted-repositories.md").read_text().split())
    limits = Limits()
    assert (
        f"A model may have at most {limits.file_size >> 30} GiB, an XML file at most "
        f"{limits.depth} levels, and an archive at most {limits.entries:,} entries. An archive "
        f"that unpacks to more than {limits.free_size >> 20} MiB may have a compression ratio of "
        f"at most {limits.total_ratio}."
    ) in text
    assert limits.total_size == limits.file_size


def test_references_are_resolved_inside_the_roots_only(tmp_path):
    inside = tmp_path / "unit"
    (inside / "sub").mkdir(parents=True)
    for path in (inside / "a b.uml", inside / "sub" / "c.uml", tmp_path / "secret.uml"):
        path.write_text("<a/>")
    (inside / "link.uml").symlink_to(tmp_path / "secret.uml")
    roots = Roots((inside,))
    base = inside / "sub" / "c.uml"
    assert roots.resolve(base, "../a%20b.uml#id") == inside / "a b.uml"
    assert roots.resolve(base, "../../secret.uml") is None
    assert roots.resolve(base, "../link.uml") is None
    assert roots.resolve(base, str(tmp_path / "secret.uml")) is None
    assert roots.resolve(base, "http://localhost/a.uml") is None
    assert roots.resolve(base, "file:///etc/passwd") is None
    assert roots.resolve(base, "#local") is None


# -- files that change while they are read --------------------------------------------------------


def set_states(monkeypatch, *pairs):
    """Set the size and time that a file seems to have before and after each attempt to read it."""
    states = list(pairs)
    monkeypatch.setattr(files, "_make_state", lambda _: states.pop(0))
    monkeypatch.setattr(files, "_PAUSE", 0)


def test_a_file_that_changes_once_while_it_is_read_is_read_again(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    set_states(monkeypatch, (4, 1), (4, 2), (4, 2), (4, 2))
    assert files.read_whole(path, "plant.uml", Limits()) == b"<a/>"


def test_a_file_that_keeps_changing_is_reported_and_not_used(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    set_states(monkeypatch, (4, 1), (4, 2), (4, 3), (4, 4))
    with pytest.raises(SourceError, match="changes while it is read") as raised:
        files.read_whole(path, "plant.uml", Limits())
    assert (raised.value.fault, raised.value.exit_code) == (Fault.CHANGING, 2)


def test_a_file_with_more_bytes_than_its_size_is_read_again(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    set_states(monkeypatch, (2, 1), (2, 1), (4, 1), (4, 1))
    assert files.read_whole(path, "plant.uml", Limits()) == b"<a/>"


def test_a_file_that_is_replaced_while_open_has_its_old_content(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<old/>")

    def replace_after_opening(name, flags):
        handle = os.open(name, flags)
        (tmp_path / "new").write_bytes(b"<newer/>")
        (tmp_path / "new").replace(path)
        return handle

    monkeypatch.setattr(files, "_open_nonblocking", replace_after_opening)
    assert files.read_whole(path, "plant.uml", Limits()) == b"<old/>"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this platform has no named pipes")
def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    path = tmp_path / "plant.uml"
    os.mkfifo(path)
    with pytest.raises(SourceError, match="is not a regular file") as raised:
        files.read_whole(path, "plant.uml", Limits())
    assert raised.value.exit_code == 2
