"""Every case of the security table about archives: refused for the right reason, unpacked never."""

import io
import struct
import zipfile
from contextlib import suppress
from random import Random

import pytest

from fuzz.answers import model
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError, read_entries

ENTRY = "com.nomagic.magicdraw.uml_model.model"
MODEL = model().encode()
MEGABYTE = 1 << 20
CENTRAL, END = b"PK\x01\x02", b"PK\x05\x06"


def archive(*files, method=zipfile.ZIP_DEFLATED):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", method) as opened:
        for name, data in files or [(ENTRY, MODEL)]:
            info = name if isinstance(name, zipfile.ZipInfo) else zipfile.ZipInfo(name)
            opened.writestr(info, data, method)
    return made.getvalue()


def bomb(megabytes):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as opened, opened.open(ENTRY, "w") as out:
        for _ in range(megabytes):
            out.write(b" " * MEGABYTE)
    return made.getvalue()


def sizes_changed(data, old, new):
    """Both headers say that the entry has another size when unpacked."""
    size = struct.pack("<I", old)
    assert data.count(size) >= 1
    return data.replace(size, struct.pack("<I", new))


def named(name):
    info = zipfile.ZipInfo("x")
    info.filename = name
    return archive((info, MODEL))


def encrypted():
    data = bytearray(archive())
    for start, flags in ((0, 6), (data.index(CENTRAL), 8)):
        data[start + flags] |= 1
    return bytes(data)


def other_checksum():
    data = bytearray(archive())
    for start, sum_ in ((0, 14), (data.index(CENTRAL), 16)):
        data[start + sum_] ^= 1
    return bytes(data)


def overlapping(count):
    """Many entries of the table stand for one piece of packed data."""
    whole = archive((f"{0:04}.uml", b" " * MEGABYTE))
    start, end = whole.index(CENTRAL), whole.index(END)
    record = whole[start:end]
    table = b"".join(record.replace(b"0000.uml", f"{n:04}.uml".encode()) for n in range(count))
    sizes = struct.pack("<HHII", count, count, len(table), start)
    return whole[:start] + table + whole[end : end + 8] + sizes + whole[end + 20 :]


def dense(megabytes):
    """Content that packs to less than the ratio of one entry, but more than that of all."""
    random = Random(1)
    return b"".join(random.randbytes(4) + b" " * 1020 for _ in range(megabytes * 1024))


def test_the_archive_that_the_others_are_made_of_is_read(asked):
    assert asked.about(archive(), "m.mdzip").ended.code == 0


TOO_LARGE = {
    "ratio": lambda: bomb(100),
    "many entries of a megabyte": lambda: archive(
        *((f"{n}.uml", b" " * MEGABYTE) for n in range(70))
    ),
    "all together": lambda: archive((ENTRY, dense(80))),
    "header says four gigabytes": lambda: sizes_changed(archive(), len(MODEL), 0xFFFFFFF0),
    "number of entries": lambda: archive(*((str(n), b"") for n in range(10_001))),
}


@pytest.mark.parametrize("how", TOO_LARGE)
def test_too_much_is_refused_before_it_is_unpacked(asked, how):
    answer = asked.about(TOO_LARGE[how](), "m.mdzip")
    assert (answer.ended.code, answer.only.code) == (2, "SM178")
    assert answer.only.file.startswith("m.mdzip")
    assert answer.ended.megabytes < 150


DAMAGED = {
    "header says a thousand bytes": (
        lambda: sizes_changed(bomb(100), 100 * MEGABYTE, 1000),
        "Bad CRC-32",
    ),
    "header says less": (lambda: sizes_changed(archive(), len(MODEL), 20), "Bad CRC-32"),
    "other checksum": (other_checksum, "Bad CRC-32"),
    "two entries of one name": (
        lambda: _twice(),
        f"two entries are named '{ENTRY}'",
    ),
    "overlap": (lambda: overlapping(50), "damaged archive"),
    "archive in an archive": (lambda: archive(("x.mdzip", archive())), "holds no model"),
    "only a folder": (lambda: archive((f"{ENTRY}/", b"")), "holds no model"),
    "empty": (lambda: END + bytes(18), "holds no model"),
}


def _twice():
    with pytest.warns(UserWarning, match="Duplicate name"):
        return archive((ENTRY, MODEL), (ENTRY, MODEL))


@pytest.mark.parametrize("how", DAMAGED)
def test_damage_is_told_with_its_reason(asked, how):
    make, reason = DAMAGED[how]
    answer = asked.about(make(), "m.mdzip")
    assert (answer.ended.code, answer.only.code, answer.only.file) == (1, "SM172", "m.mdzip")
    assert reason in answer.only.message


REFUSED = {
    **{
        f"name {name}": (lambda name=name: named(name), "leads out of the archive")
        for name in (f"../{ENTRY}", f"/{ENTRY}", f"C:/{ENTRY}", f"..\\{ENTRY}", f"a/../../{ENTRY}")
    },
    "encrypted": (encrypted, "is encrypted"),
    "lzma": (lambda: archive(method=zipfile.ZIP_LZMA), "neither stored nor deflated"),
    "bzip2": (lambda: archive(method=zipfile.ZIP_BZIP2), "neither stored nor deflated"),
}


@pytest.mark.parametrize("how", REFUSED)
def test_what_no_tool_writes_is_refused(asked, how):
    make, reason = REFUSED[how]
    answer = asked.about(make(), "m.mdzip")
    assert (answer.ended.code, answer.only.code, answer.only.file) == (1, "SM177", "m.mdzip")
    assert reason in answer.only.message
    assert [path.name for path in asked.folder.iterdir() if path.is_file()] == ["m.mdzip"]


def test_an_archive_as_an_entry_and_a_link_as_an_entry_are_no_models(asked):
    link = zipfile.ZipInfo(ENTRY)
    link.external_attr = 0o120777 << 16
    for data in (archive((ENTRY, archive())), archive((link, b"/etc/passwd"))):
        answer = asked.about(data, "m.mdzip")
        assert (answer.ended.code, answer.codes) == (1, ["SM171"])


def test_faults_of_xml_inside_are_located_inside(asked):
    found = asked.about(archive((ENTRY, b"<!DOCTYPE a>" + MODEL.partition(b"\n")[2])), "m.mdzip")
    assert (found.only.code, found.only.file) == ("SM100", f"m.mdzip!{ENTRY}")
    assert (found.only.line, found.only.column) == (1, 12)


def test_an_archive_is_damaged_wherever_it_is_cut():
    whole = archive((ENTRY, MODEL), ("BINARY-1", b"x" * 100))
    for length in range(4, len(whole)):
        with pytest.raises(SourceError, match="its table of contents is missing") as raised:
            read_entries(Source("m.mdzip", whole[:length]), lambda _: True, DEFAULT_LIMITS)
        assert raised.value.exit_code == 1


def test_a_byte_of_the_table_that_lies_is_no_exception_of_zipfile():
    whole = archive((ENTRY, MODEL), ("BINARY-1", b"x" * 100))
    for at in range(len(whole)):
        for value in (0, 1, 0xFF):
            lying = whole[:at] + bytes([value]) + whole[at + 1 :]
            with suppress(SourceError):
                read_entries(Source("m.mdzip", lying), lambda _: True, DEFAULT_LIMITS)


def test_the_table_may_be_followed_by_a_comment(asked):
    comment = b"x" * 65_535
    assert asked.about(archive()[:-2] + b"\xff\xff" + comment, "m.mdzip").ended.code == 0
