"""Random damage to bytes: to markup, to encodings, to archives."""

import io
import re
import zipfile
from collections.abc import Callable
from random import Random

from dialects.mutations import Damage, damage

DocumentChange = Callable[[bytes, Random], tuple[str, bytes]]
"""A function that changes a document and returns a description and the result."""
_NAMESPACE = re.compile(rb"""xmlns:?\w*=["']([^"']+)["']""")
_DATE = (2021, 3, 31, 9, 38, 0)


def _unbalance_tags(data: bytes, random: Random) -> bytes:
    """Remove, duplicate or cut an end tag."""
    starts = [match.start() for match in re.finditer(rb"</", data)] or [0]
    start = random.choice(starts)
    end = data.find(b">", start) + 1
    return (
        data[:start] + random.choice([b"", 2 * data[start:end], data[start : end - 1]]) + data[end:]
    )


def _cut_ranges(data: bytes, random: Random) -> bytes:
    """Remove some ranges, as a bad merge does."""
    for _ in range(random.randint(1, 4)):
        start = random.randrange(len(data) + 1)
        data = data[:start] + data[start + random.choice([1, 100, 4096]) :]
    return data


def _duplicate_line(data: bytes, random: Random) -> bytes:
    lines = data.split(b"\n")
    index = random.randrange(len(lines))
    return b"\n".join([*lines[: index + 1], lines[index], *lines[index + 1 :]])


def _add_conflict_markers(data: bytes, random: Random) -> bytes:
    """Insert the conflict markers of version control."""
    lines = data.split(b"\n")
    index = random.randrange(len(lines))
    return b"\n".join([*lines[:index], b"<<<<<<< HEAD", lines[index], b"=======", *lines[index:]])


def _change_namespace(data: bytes, random: Random) -> bytes:
    namespaces = _NAMESPACE.findall(data[:8192])
    if not namespaces:
        return data
    namespace = random.choice([b"", b"urn:x", b"http://www.omg.org/spec/UML/20990101", *namespaces])
    return data.replace(random.choice(namespaces), namespace)


def _mix_encodings(data: bytes, random: Random) -> bytes:
    """Encode the end of the file in another encoding than its start."""
    start = random.randrange(len(data) + 1)
    end = data[start:].decode("utf-8", "replace") + "äöü€"
    encoding = random.choice(["latin-1", "cp1252", "utf-16", "shift_jis", "utf-7"])
    return data[:start] + end.encode(encoding, "replace")


def _change_declaration(data: bytes, random: Random) -> bytes:
    names = [
        "Shift_JIS",
        "GB18030",
        "EUC-KR",
        "UTF-7",
        "ISO-2022-JP",
        "cp037",
        "x",
        "base64",
        "idna",
    ]
    declaration = (
        f'<?xml version="{random.choice(["1.0", "1.1", "2"])}" encoding="{random.choice(names)}"'
    )
    return re.sub(rb"^<\?xml[^?]*", declaration.encode(), data, count=1)


TEXT_DAMAGES: tuple[Damage, ...] = (
    _cut_ranges,
    _duplicate_line,
    _add_conflict_markers,
    _mix_encodings,
    _mix_encodings,
)
"""Damage to files that are not XML."""

DAMAGES: tuple[Damage, ...] = (
    _unbalance_tags,
    _cut_ranges,
    _duplicate_line,
    _add_conflict_markers,
    _change_namespace,
    _mix_encodings,
    _change_declaration,
)


# -- archives ------------------------------------------------------------------------------------


def mutate_archive(data: bytes, random: Random, change: DocumentChange) -> tuple[str, bytes]:
    """Change a model in an archive by *change*, or the entries or bytes of the archive."""
    if random.random() < 0.25:
        return damage(data, random, (_cut_at_header, _change_table))
    entries = _unpack(data)
    models = [name for name in entries if _is_model(name, entries[name])]
    description = "entries"
    if models and random.random() < 0.8:
        name = random.choice(models)
        description, entries[name] = change(entries[name], random)
    else:
        names = list(entries)
        first, second = random.choice(names), random.choice(names)
        if random.random() < 0.5:
            entries[first], entries[second] = entries[second], entries[first]
        else:
            del entries[first]
    return f"in the archive: {description}", _pack(entries)


def _is_model(name: str, data: bytes) -> bool:
    if name.endswith((".sysml", ".kerml", ".json")):
        return True
    return data.lstrip()[:1] == b"<" and "BINARY" not in name


def _unpack(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {info.filename: archive.read(info) for info in archive.infolist()}


def _pack(entries: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(zipfile.ZipInfo(name, _DATE), data, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _cut_at_header(data: bytes, random: Random) -> bytes:
    """Cut the archive before or after a header."""
    headers = [match.start() for match in re.finditer(rb"PK[\x01\x03\x05]", data)]
    return data[: random.choice(headers) + random.choice([0, 1, 4, 30])]


def _change_table(data: bytes, random: Random) -> bytes:
    """Replace a byte of the table of contents."""
    start = data.find(b"PK\x01\x02")
    index = random.randrange(start, len(data))
    return data[:index] + bytes([random.randrange(256)]) + data[index + 1 :]
