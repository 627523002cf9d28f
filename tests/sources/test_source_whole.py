"""Files are read whole: never half of one being saved, never a pipe or a device."""

import os

import pytest

from sysmlc.sources import Fault, Limits, SourceError, files

LIMITS = Limits()


def set_states(monkeypatch, *pairs):
    """Set size and time of the file before and after each reading."""
    states = list(pairs)
    monkeypatch.setattr(files, "_make_state", lambda _: states.pop(0))
    monkeypatch.setattr(files, "_PAUSE", 0)


def test_a_file_that_changes_once_while_it_is_read_is_read_again(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    set_states(monkeypatch, (4, 1), (4, 2), (4, 2), (4, 2))
    assert files.read_whole(path, "plant.uml", LIMITS) == b"<a/>"


def test_a_file_that_keeps_changing_is_reported_and_not_used(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    set_states(monkeypatch, (4, 1), (4, 2), (4, 3), (4, 4))
    with pytest.raises(SourceError, match="changes while it is read") as raised:
        files.read_whole(path, "plant.uml", LIMITS)
    assert (raised.value.fault, raised.value.exit_code) == (Fault.CHANGING, 2)


def test_a_file_that_grows_after_it_was_looked_at_is_read_again(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<a/>")
    set_states(monkeypatch, (2, 1), (2, 1), (4, 1), (4, 1))
    assert files.read_whole(path, "plant.uml", LIMITS) == b"<a/>"


def test_the_old_content_is_whole_when_the_file_is_replaced_while_open(tmp_path, monkeypatch):
    path = tmp_path / "plant.uml"
    path.write_bytes(b"<old/>")

    def opener(name, flags):
        handle = os.open(name, flags)
        (tmp_path / "new").write_bytes(b"<newer/>")
        (tmp_path / "new").replace(path)
        return handle

    monkeypatch.setattr(files, "_open_nonblocking", opener)
    assert files.read_whole(path, "plant.uml", LIMITS) == b"<old/>"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_a_pipe_is_not_waited_for(tmp_path):
    path = tmp_path / "plant.uml"
    os.mkfifo(path)
    with pytest.raises(SourceError, match="is not a regular file") as raised:
        files.read_whole(path, "plant.uml", LIMITS)
    assert raised.value.exit_code == 2
