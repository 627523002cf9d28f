"""Hostile archives are refused with the right reason, and never unpacked completely."""

import io
import struct
import zipfile
from contextlib import suppress
from random import Random

import pytest

from fuzz.checker import change_size, make_model
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError, read_entries

ENTRY = "com.nomagic.magicdraw.uml_model.model"
MODEL = make_model().encode()
MEGABYTE = 1 << 20
CENTRAL, END = b"PK\x01\x02", b"PK\x05\x06"


def make_archive(*files, method=zipfile.ZIP_DEFLATED):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, data in files or [(ENTRY, MODEL)]:
            info = name if isinstance(name, zipfile.ZipInfo) else zipfile.ZipInfo(name)
            archive.writestr(info, data, method)
    return buffer.getvalue()


def make_bomb(megabytes):
    buffer = io.BytesIO()
    with (
        zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open(ENTRY, "w") as out,
    ):
        for _ in range(megabytes):
            out.write(b" " * MEGABYTE)
    return buffer.getvalue()


def make_archive_with_entry(name):
    info = zipfile.ZipInfo("x")
    info.filename = name
    return make_archive((info, MODEL))


def make_encrypted_archive():
    data = bytearray(make_archive())
    for start, flags in ((0, 6), (data.index(CENTRAL), 8)):
        data[start + flags] |= 1
    return bytes(data)


def make_archive_with_wrong_checksum():
    data = bytearray(make_archive())
    for start, sum_ in ((0, 14), (data.index(CENTRAL), 16)):
        data[start + sum_] ^= 1
    return bytes(data)


def make_overlapping_archive(count):
    """Return an archive whose table has many entries for the same packed data."""
    archive = make_archive((f"{0:04}.uml", b" " * MEGABYTE))
    start, end = archive.index(CENTRAL), archive.index(END)
    record = archive[start:end]
    table = b"".join(record.replace(b"0000.uml", f"{n:04}.uml".encode()) for n in range(count))
    sizes = struct.pack("<HHII", count, count, len(table), start)
    return archive[:start] + table + archive[end : end + 8] + sizes + archive[end + 20 :]


def make_dense_content(megabytes):
    """Return content within the packing ratio of one entry, but beyond that of all together."""
    random = Random(1)
    return b"".join(random.randbytes(4) + b" " * 1020 for _ in range(megabytes * 1024))


def test_the_archive_without_faults_is_read(checker):
    assert checker.check_content(make_archive(), "m.mdzip").exit_code == 0


TOO_LARGE = {
    "ratio": lambda: make_bomb(100),
    "many entries of a megabyte": lambda: make_archive(
        *((f"{n}.uml", b" " * MEGABYTE) for n in range(70))
    ),
    "all together": lambda: make_archive((ENTRY, make_dense_content(80))),
    "header says four gigabytes": lambda: change_size(make_archive(), len(MODEL), 0xFFFFFFF0),
    "number of entries": lambda: make_archive(*((str(n), b"") for n in range(10_001))),
}


@pytest.mark.parametrize("size", TOO_LARGE)
def test_a_large_archive_is_refused_before_it_is_unpacked(checker, size):
    result = checker.check_content(TOO_LARGE[size](), "m.mdzip")
    assert (result.exit_code, result.diagnostic.code) == (2, "SM178")
    assert result.diagnostic.file.startswith("m.mdzip")
    assert result.command.megabytes < 150


DAMAGES = {
    "header says a thousand bytes": (
        lambda: change_size(make_bomb(100), 100 * MEGABYTE, 1000),
        "Bad CRC-32",
    ),
    "header says less": (lambda: change_size(make_archive(), len(MODEL), 20), "Bad CRC-32"),
    "other checksum": (make_archive_with_wrong_checksum, "Bad CRC-32"),
    "two entries of one name": (
        lambda: make_archive_with_duplicate(),
        f"two entries are named '{ENTRY}'",
    ),
    "overlap": (lambda: make_overlapping_archive(50), "damaged archive"),
    "archive in an archive": (lambda: make_archive(("x.mdzip", make_archive())), "holds no model"),
    "only a folder": (lambda: make_archive((f"{ENTRY}/", b"")), "holds no model"),
    "empty": (lambda: END + bytes(18), "holds no model"),
}


def make_archive_with_duplicate():
    with pytest.warns(UserWarning, match="Duplicate name"):
        return make_archive((ENTRY, MODEL), (ENTRY, MODEL))


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_archive_is_reported_with_the_reason(checker, damage):
    make, reason = DAMAGES[damage]
    result = checker.check_content(make(), "m.mdzip")
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.file) == (
        1,
        "SM172",
        "m.mdzip",
    )
    assert reason in result.diagnostic.message


REFUSED = {
    **{
        f"name {name}": (
            lambda name=name: make_archive_with_entry(name),
            "leads out of the archive",
        )
        for name in (f"../{ENTRY}", f"/{ENTRY}", f"C:/{ENTRY}", f"..\\{ENTRY}", f"a/../../{ENTRY}")
    },
    "encrypted": (make_encrypted_archive, "is encrypted"),
    "lzma": (lambda: make_archive(method=zipfile.ZIP_LZMA), "neither stored nor deflated"),
    "bzip2": (lambda: make_archive(method=zipfile.ZIP_BZIP2), "neither stored nor deflated"),
}


@pytest.mark.parametrize("feature", REFUSED)
def test_an_archive_that_no_tool_writes_is_refused(checker, feature):
    make, reason = REFUSED[feature]
    result = checker.check_content(make(), "m.mdzip")
    assert (result.exit_code, result.diagnostic.code, result.diagnostic.file) == (
        1,
        "SM177",
        "m.mdzip",
    )
    assert reason in result.diagnostic.message
    assert [path.name for path in checker.folder.iterdir() if path.is_file()] == ["m.mdzip"]


def test_an_entry_that_is_an_archive_or_a_link_is_not_a_model(checker):
    link = zipfile.ZipInfo(ENTRY)
    link.external_attr = 0o120777 << 16
    for data in (make_archive((ENTRY, make_archive())), make_archive((link, b"/etc/passwd"))):
        result = checker.check_content(data, "m.mdzip")
        assert (result.exit_code, result.codes) == (1, ["SM171"])


def test_a_fault_in_an_entry_is_located_in_the_entry(checker):
    result = checker.check_content(
        make_archive((ENTRY, b"<!DOCTYPE a>" + MODEL.partition(b"\n")[2])), "m.mdzip"
    )
    assert (result.diagnostic.code, result.diagnostic.file) == ("SM100", f"m.mdzip!{ENTRY}")
    assert (result.diagnostic.line, result.diagnostic.column) == (1, 12)


def test_an_archive_cut_at_any_byte_is_reported_as_damaged():
    archive = make_archive((ENTRY, MODEL), ("BINARY-1", b"x" * 100))
    for length in range(4, len(archive)):
        with pytest.raises(SourceError, match="its table of contents is missing") as raised:
            read_entries(Source("m.mdzip", archive[:length]), lambda _: True, DEFAULT_LIMITS)
        assert raised.value.exit_code == 1


def test_a_changed_byte_of_the_archive_raises_no_exception_of_zipfile():
    archive = make_archive((ENTRY, MODEL), ("BINARY-1", b"x" * 100))
    for index in range(len(archive)):
        for value in (0, 1, 0xFF):
            changed = archive[:index] + bytes([value]) + archive[index + 1 :]
            with suppress(SourceError):
                read_entries(Source("m.mdzip", changed), lambda _: True, DEFAULT_LIMITS)


def test_a_comment_after_the_table_is_accepted(checker):
    archive = make_archive()[:-2] + b"\xff\xff" + b"x" * 65_535
    assert checker.check_content(archive, "m.mdzip").exit_code == 0
