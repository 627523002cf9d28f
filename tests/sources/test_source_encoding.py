"""Encodings: the declared one is used; data that expat cannot decode is converted to UTF-8."""

import hashlib

import pytest

from sysmlc.sources import Source, SourceError, load
from sysmlc.sources.xml import convert_to_utf8, find_codec, make_parser, parse

TEXT = '<?xml version="1.0" encoding="%s"?>\n<a name="%s"/>'


def read_names(data):
    """Return the names in a file with these bytes."""
    names = []
    parser = make_parser()
    parser.StartElementHandler = lambda _tag, values: names.append(values["name"])
    parse(convert_to_utf8(Source("m.uml", data)), parser)
    return names


def read_refusal(data):
    with pytest.raises(SourceError) as raised:
        read_names(data)
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
    assert read_names((TEXT % (declared, "設備")).encode(encoding)) == ["設備"]


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
    assert read_names((TEXT % (declared, name)).encode(declared)) == [name]


def test_the_digest_is_computed_from_the_original_bytes(tmp_path):
    data = (TEXT % ("Shift_JIS", "設備")).encode("shift_jis")
    (tmp_path / "m.uml").write_bytes(data)
    (source,) = load(tmp_path / "m.uml", "m.uml")
    assert source.data == (TEXT % ("UTF-8", "設備")).encode()
    assert source.sha256 == hashlib.sha256(data).hexdigest()


def test_bytes_in_another_encoding_are_reported_as_such():
    data = (TEXT % ("UTF-8", "Förderer")).encode("latin-1")
    reason = "it is not encoded in UTF-8: invalid start byte"
    assert read_refusal(data) == (reason, data.index(b"\xf6"))


def test_invalid_multibyte_characters_are_located():
    data = (
        (TEXT % ("Shift_JIS", "設備"))
        .encode("shift_jis")
        .replace("備".encode("shift_jis"), b"\x81")
    )
    message, offset = read_refusal(data)
    assert message == "it is not encoded in Shift_JIS: illegal multibyte sequence"
    assert offset == data.index(b"\x81")


@pytest.mark.parametrize("name", ["klingon", "base64", "idna", "rot13", "utf-7", "unicode_escape"])
def test_an_unknown_encoding_is_named(name):
    data = (TEXT % (name, "x")).encode()
    assert read_refusal(data) == (f"its encoding '{name}' is unknown", data.index(name.encode()))


def test_a_wrong_declaration_of_utf_16_is_refused():
    message, offset = read_refusal((TEXT % ("UTF-16", "x")).encode())
    assert message == "not well-formed XML: encoding specified in XML declaration is incorrect"
    assert offset == 30


def test_a_byte_order_mark_takes_precedence_over_the_declaration():
    assert find_codec((TEXT % ("windows-1252", "é")).encode("utf-8-sig")) == (3, "utf-8")
    assert find_codec("<a/>".encode("utf-16-le")) == (0, "utf-16-le")
    assert find_codec("<a/>".encode("utf-32")) == (4, "utf-32-le")
