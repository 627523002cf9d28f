"""Archives: which entries are read, and which archives are refused."""

import io
import zipfile

import pytest

from sysmlc.sources import Fault, Limits, Source, SourceError, is_model_entry, read_entries


def pack_archive(*files, method=zipfile.ZIP_DEFLATED):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, data in files:
            archive.writestr(name, data)
    return Source("plant.mdzip", buffer.getvalue())


def accept_all(_name):
    return True


def read_refused(source, limits=None):
    """Read an archive that is refused; return the error."""
    with pytest.raises(SourceError) as raised:
        read_entries(source, accept_all, limits or Limits())
    return raised.value


def test_entries_are_sorted_and_named_after_their_archive():
    entries = read_entries(pack_archive(("b", b"2"), ("a", b"1")), accept_all)
    assert [(entry.name, entry.data) for entry in entries] == [
        ("plant.mdzip!a", b"1"),
        ("plant.mdzip!b", b"2"),
    ]


def test_only_some_entries_of_magicdraw_are_models():
    project = "com.nomagic.magicdraw.uml_model"
    assert is_model_entry(f"{project}.model")
    assert is_model_entry(f"{project}.shared_model")
    assert not is_model_entry(f"{project}____sharepoints.shared_model")
    assert not is_model_entry("BINARY-004d58df-51cf-4b9f-bdd8-b12336862a99")
    assert not is_model_entry("element.versions.properties.shared_model")


@pytest.mark.parametrize("name", ["/etc/passwd", "a/../../b", "C:/x", "..\\x", "\\x"])
def test_entries_with_paths_out_of_the_archive_are_refused(name):
    info = zipfile.ZipInfo("x")
    info.filename = name
    error = read_refused(pack_archive((info, b"")))
    assert error.fault is Fault.REFUSED
    assert "leads out of the archive" in error.message
    assert error.exit_code == 1


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_two_entries_with_one_name_are_refused():
    error = read_refused(pack_archive(("a", b"1"), ("a", b"2")))
    assert "two entries are named 'a'" in error.message


def test_other_compression_methods_are_refused():
    error = read_refused(pack_archive(("a", b"x" * 100), method=zipfile.ZIP_LZMA))
    assert "neither stored nor deflated" in error.message


def test_a_zip_bomb_is_stopped_while_it_is_unpacked():
    error = read_refused(pack_archive(("bomb", bytes(30 << 20))))
    assert error.fault is Fault.LIMIT
    assert error.exit_code == 2
    assert error.file == "plant.mdzip!bomb"


def test_a_zip_bomb_with_a_forged_size_is_stopped_too():
    source = pack_archive(("bomb", bytes(30 << 20)))
    size = (30 << 20).to_bytes(4, "little")
    forged = Source(source.name, source.data.replace(size, (1000).to_bytes(4, "little")))
    assert forged.data != source.data
    assert read_refused(forged).fault in (Fault.LIMIT, Fault.MALFORMED)


def test_the_total_size_of_entries_is_limited():
    archive = pack_archive(("a", b"x" * 3000), ("b", b"y" * 3000))
    assert read_refused(archive, Limits(total_size=4000)).fault is Fault.LIMIT
    assert len(read_entries(archive, accept_all, Limits(total_size=6000))) == 2


def test_the_number_of_entries_is_limited():
    archive = pack_archive(*((str(number), b"") for number in range(11)))
    assert read_refused(archive, Limits(entries=10)).fault is Fault.LIMIT
    assert len(read_entries(archive, accept_all, Limits(entries=11))) == 11


def test_damage_is_reported_instead_of_an_exception_of_zipfile():
    intact = pack_archive(("a", bytes(range(256)) * 64))
    assert read_refused(Source("a.zip", intact.data[:-40])).fault is Fault.MALFORMED
    start = 60
    damaged = bytearray(intact.data)
    damaged[start : start + 20] = bytes(20)
    assert read_refused(Source("a.zip", bytes(damaged))).fault is Fault.MALFORMED


def test_an_encrypted_entry_is_refused():
    data = bytearray(pack_archive(("a", b"1")).data)
    data[data.index(b"PK\x01\x02") + 8] |= 1
    assert "encrypted" in read_refused(Source("a.zip", bytes(data))).message
