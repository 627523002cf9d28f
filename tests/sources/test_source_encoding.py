"""Encodings: what a file declares is believed, put into UTF-8 where expat does not read it."""

import hashlib

import pytest

from sysmlc.sources import Source, SourceError, load
from sysmlc.sources.encoding import convert_to_utf8, find_codec
from sysmlc.sources.xml import make_parser, parse

TEXT = '<?xml version="1.0" encoding="%s"?>\n<a name="%s"/>'


def names(data):
    """Names in the file as it is read from disk."""
    seen = []
    parser = make_parser()
    parser.StartElementHandler = lambda _tag, values: seen.append(values["name"])
    parse(convert_to_utf8(Source("m.uml", data)), parser)
    return seen


def refusal(data):
    with pytest.raises(SourceError) as raised:
        names(data)
    return raised.value.message, raised.value.offset


@pytest.mark.parametrize(
    ("declared", "encoding"),
    [
        ("UTF-8", "utf-8"),
        ("utf-8", "utf-8-sig"),
        ("UTF-16", "utf-16"),
        ("UTF-16LE", "utf-16-le"),
        ("UTF-16BE", "utf-16-be"),
        ("UTF-32", "utf-32"),
        ("Shift_JIS", "shift_jis"),
        ("Windows-31J", "cp932"),
        ("EUC-JP", "euc_jp"),
        ("ISO-2022-JP", "iso2022_jp"),
        ("GB18030", "gb18030"),
    ],
)
def test_japanese_names_are_read_in_every_encoding(declared, encoding):
    assert names((TEXT % (declared, "設備")).encode(encoding)) == ["設備"]


@pytest.mark.parametrize(
    ("declared", "name"),
    [
        ("EUC-KR", "설비"),
        ("Big5", "設備"),
        ("GBK", "设备"),
        ("windows-1252", "Förderer €"),
        ("ISO-8859-15", "Förderer €"),
        ("windows-1251", "Станок"),
        ("KOI8-R", "Станок"),
        ("ISO-8859-1", "Förderer"),
    ],
)
def test_names_of_other_languages_are_read(declared, name):
    assert names((TEXT % (declared, name)).encode(declared)) == [name]


def test_the_digest_is_that_of_the_file(tmp_path):
    data = (TEXT % ("Shift_JIS", "設備")).encode("shift_jis")
    (tmp_path / "m.uml").write_bytes(data)
    (source,) = load(tmp_path / "m.uml", "m.uml")
    assert source.data == (TEXT % ("UTF-8", "設備")).encode()
    assert source.sha256 == hashlib.sha256(data).hexdigest()


def test_bytes_of_another_encoding_are_not_reported_as_bad_markup():
    data = (TEXT % ("UTF-8", "Förderer")).encode("latin-1")
    reason = "it is not encoded in UTF-8: invalid start byte"
    assert refusal(data) == (reason, data.index(b"\xf6"))


def test_broken_characters_of_several_bytes_are_located():
    data = (
        (TEXT % ("Shift_JIS", "設備"))
        .encode("shift_jis")
        .replace("備".encode("shift_jis"), b"\x81")
    )
    message, offset = refusal(data)
    assert message == "it is not encoded in Shift_JIS: illegal multibyte sequence"
    assert offset == data.index(b"\x81")


@pytest.mark.parametrize("name", ["klingon", "base64", "idna", "rot13", "utf-7", "unicode_escape"])
def test_an_encoding_that_is_not_known_is_named(name):
    data = (TEXT % (name, "x")).encode()
    assert refusal(data) == (f"its encoding '{name}' is unknown", data.index(name.encode()))


def test_utf_16_that_is_declared_but_not_there_is_refused():
    message, offset = refusal((TEXT % ("UTF-16", "x")).encode())
    assert message == "not well-formed XML: encoding specified in XML declaration is incorrect"
    assert offset == 30


def test_a_mark_says_more_than_a_wrong_declaration():
    assert find_codec((TEXT % ("windows-1252", "é")).encode("utf-8-sig")) == (3, "utf-8")
    assert find_codec("<a/>".encode("utf-16-le")) == (0, "utf-16-le")
    assert find_codec("<a/>".encode("utf-32")) == (4, "utf-32-le")
