"""Outputs reach the disk whole."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.support.atomic_files import write
from sysmlc.support.output import Output, append_members, encode_json, encode_row

_JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


def test_a_failing_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    target = tmp_path / "a.txt"
    write(target, b"old")
    monkeypatch.setattr("os.replace", lambda *_: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(OSError, match="full"):
        write(target, b"new")
    assert target.read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


@pytest.mark.parametrize("text", ["\ud800", b"bytes"])
def test_a_text_that_cannot_be_written_is_refused_when_it_is_added(text):
    with pytest.raises((UnicodeEncodeError, AttributeError)):
        Output().add("a.txt", text)


def test_artefacts_come_sorted_and_their_traces_without_repetition():
    output = Output()
    output.add("b.txt", "", trace=["x", "y", "x"])
    output.add("a.txt", "")
    assert [a.path for a in output.artefacts()] == ["a.txt", "b.txt"]
    assert output.artefacts()[1].trace == ("x", "y")


@pytest.mark.parametrize("path", ["/etc/passwd", "../a", "a/../../b"])
def test_no_artefact_leaves_the_output_folder(path):
    with pytest.raises(ValueError, match="leaves the output folder"):
        Output().add(path, "")


def test_two_artefacts_never_share_a_path():
    output = Output()
    output.add("a", "")
    with pytest.raises(ValueError, match="written twice"):
        output.add("a", "")


def test_a_json_file_is_indented_and_keeps_characters_beyond_ascii():
    assert encode_json({"één": [1, None]}) == '{\n "één": [\n  1,\n  null\n ]\n}\n'


@given(st.dictionaries(st.text(), _JSON, min_size=1), _JSON)
def test_members_on_one_line_follow_the_indented_ones(head, row):
    text = append_members(head, [f'"new row": {encode_row(row)}'])
    assert json.loads(text) == head | {"new row": row}
    assert text.endswith("\n}\n")
