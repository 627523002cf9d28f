"""Archives: what is read, and the tricks that are refused."""

import io
import zipfile

import pytest

from sysmlc.sources import Fault, Limits, Source, SourceError, is_model_entry, read_entries


def archive(*files, method=zipfile.ZIP_DEFLATED):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as opened:
        for name, data in files:
            opened.writestr(name, data)
    return Source("plant.mdzip", buffer.getvalue())


def everything(_name):
    return True


def refusal(source, limits=None):
    with pytest.raises(SourceError) as raised:
        read_entries(source, everything, limits or Limits())
    return raised.value


def test_entries_come_sorted_and_are_named_after_their_archive():
    entries = read_entries(archive(("b", b"2"), ("a", b"1")), everything)
    assert [(entry.name, entry.data) for entry in entries] == [
        ("plant.mdzip!a", b"1"),
        ("plant.mdzip!b", b"2"),
    ]


def test_only_the_model_entries_of_magicdraw_are_wanted():
    project = "com.nomagic.magicdraw.uml_model"
    assert is_model_entry(f"{project}.model")
    assert is_model_entry(f"{project}.shared_model")
    assert not is_model_entry(f"{project}____sharepoints.shared_model")
    assert not is_model_entry("BINARY-004d58df-51cf-4b9f-bdd8-b12336862a99")
    assert not is_model_entry("element.versions.properties.shared_model")


@pytest.mark.parametrize("name", ["/etc/passwd", "a/../../b", "C:/x", "..\\x", "\\x"])
def test_names_that_lead_out_are_refused(name):
    info = zipfile.ZipInfo("x")
    info.filename = name
    error = refusal(archive((info, b"")))
    assert error.fault is Fault.REFUSED
    assert "leads out of the archive" in error.message
    assert error.exit_code == 1


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_two_entries_with_one_name_are_refused():
    assert "two entries are named 'a'" in refusal(archive(("a", b"1"), ("a", b"2"))).message


def test_other_methods_are_refused():
    error = refusal(archive(("a", b"x" * 100), method=zipfile.ZIP_LZMA))
    assert "neither stored nor deflated" in error.message


def test_a_bomb_is_stopped_while_it_unpacks():
    error = refusal(archive(("bomb", bytes(30 << 20))))
    assert error.fault is Fault.LIMIT
    assert error.exit_code == 2
    assert error.file == "plant.mdzip!bomb"


def test_a_bomb_that_lies_about_its_size_is_stopped_too():
    source = archive(("bomb", bytes(30 << 20)))
    size = (30 << 20).to_bytes(4, "little")
    lying = Source(source.name, source.data.replace(size, (1000).to_bytes(4, "little")))
    assert lying.data != source.data
    assert refusal(lying).fault in (Fault.LIMIT, Fault.MALFORMED)


def test_all_entries_together_are_limited():
    two = archive(("a", b"x" * 3000), ("b", b"y" * 3000))
    assert refusal(two, Limits(total_size=4000)).fault is Fault.LIMIT
    assert len(read_entries(two, everything, Limits(total_size=6000))) == 2


def test_too_many_entries_are_refused():
    many = archive(*((str(number), b"") for number in range(11)))
    assert refusal(many, Limits(entries=10)).fault is Fault.LIMIT
    assert len(read_entries(many, everything, Limits(entries=11))) == 11


def test_damage_is_an_error_and_not_an_exception_of_zipfile():
    whole = archive(("a", bytes(range(256)) * 64))
    assert refusal(Source("a.zip", whole.data[:-40])).fault is Fault.MALFORMED
    middle = 60
    broken = bytearray(whole.data)
    broken[middle : middle + 20] = bytes(20)
    assert refusal(Source("a.zip", bytes(broken))).fault is Fault.MALFORMED


def test_an_encrypted_entry_is_refused():
    data = bytearray(archive(("a", b"1")).data)
    data[data.index(b"PK\x01\x02") + 8] |= 1
    assert "encrypted" in refusal(Source("a.zip", bytes(data))).message
