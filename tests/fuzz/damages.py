"""Damage to bytes that only a fuzzer does: to markup, to encodings, to archives."""

import io
import re
import zipfile
from collections.abc import Callable
from random import Random

from dialects.mutations import Damage, damage

Spoil = Callable[[bytes, Random], tuple[str, bytes]]
"""Changes a document; says what was done."""
_NAMESPACE = re.compile(rb"""xmlns:?\w*=["']([^"']+)["']""")
_DATE = (2021, 3, 31, 9, 38, 0)


def _unbalance(data: bytes, random: Random) -> bytes:
    """One tag's end is gone, or there is one too many."""
    closing = [found.start() for found in re.finditer(rb"</", data)] or [0]
    at = random.choice(closing)
    end = data.find(b">", at) + 1
    return data[:at] + random.choice([b"", 2 * data[at:end], data[at : end - 1]]) + data[end:]


def _cut_pieces(data: bytes, random: Random) -> bytes:
    """Some ranges are missing, as after a bad merge."""
    for _ in range(random.randint(1, 4)):
        at = random.randrange(len(data) + 1)
        data = data[:at] + data[at + random.choice([1, 100, 4096]) :]
    return data


def _double_a_line(data: bytes, random: Random) -> bytes:
    lines = data.split(b"\n")
    at = random.randrange(len(lines))
    return b"\n".join([*lines[: at + 1], lines[at], *lines[at + 1 :]])


def _merge_conflict(data: bytes, random: Random) -> bytes:
    """Marks of a merge, as version control leaves them."""
    lines = data.split(b"\n")
    at = random.randrange(len(lines))
    return b"\n".join([*lines[:at], b"<<<<<<< HEAD", lines[at], b"=======", *lines[at:]])


def _other_namespace(data: bytes, random: Random) -> bytes:
    found = _NAMESPACE.findall(data[:8192])
    if not found:
        return data
    other = random.choice([b"", b"urn:x", b"http://www.omg.org/spec/UML/20990101", *found])
    return data.replace(random.choice(found), other)


def _mixed_encodings(data: bytes, random: Random) -> bytes:
    """Part of the file is in another encoding than the rest."""
    at = random.randrange(len(data) + 1)
    rest = data[at:].decode("utf-8", "replace") + "äöü€"
    other = random.choice(["latin-1", "cp1252", "utf-16", "shift_jis", "utf-7"])
    return data[:at] + rest.encode(other, "replace")


def _declared(data: bytes, random: Random) -> bytes:
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
    head = f'<?xml version="{random.choice(["1.0", "1.1", "2"])}" encoding="{random.choice(names)}"'
    return re.sub(rb"^<\?xml[^?]*", head.encode(), data, count=1)


TEXT_DAMAGES: tuple[Damage, ...] = (
    _cut_pieces,
    _double_a_line,
    _merge_conflict,
    _mixed_encodings,
    _mixed_encodings,
)
"""Of files that are no XML."""

DAMAGES: tuple[Damage, ...] = (
    _unbalance,
    _cut_pieces,
    _double_a_line,
    _merge_conflict,
    _other_namespace,
    _mixed_encodings,
    _declared,
)


# -- archives ------------------------------------------------------------------------------------


def mutate_archive(data: bytes, random: Random, spoil: Spoil) -> tuple[str, bytes]:
    """Change a model inside an archive by ``spoil``, the archive's table, or its bytes."""
    if random.random() < 0.25:
        return damage(data, random, (_cut_at_border, _lie))
    entries = _unpacked(data)
    models = [name for name in entries if _is_model(name, entries[name])]
    done = "entries"
    if models and random.random() < 0.8:
        name = random.choice(models)
        done, entries[name] = spoil(entries[name], random)
    else:
        names = list(entries)
        one, other = random.choice(names), random.choice(names)
        if random.random() < 0.5:
            entries[one], entries[other] = entries[other], entries[one]
        else:
            del entries[one]
    return f"in the archive: {done}", _packed(entries)


def _is_model(name: str, data: bytes) -> bool:
    if name.endswith((".sysml", ".kerml", ".json")):
        return True
    return data.lstrip()[:1] == b"<" and "BINARY" not in name


def _unpacked(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as opened:
        return {info.filename: opened.read(info) for info in opened.infolist()}


def _packed(entries: dict[str, bytes]) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as opened:
        for name, data in entries.items():
            opened.writestr(zipfile.ZipInfo(name, _DATE), data, zipfile.ZIP_DEFLATED)
    return made.getvalue()


def _cut_at_border(data: bytes, random: Random) -> bytes:
    """Cut before or after a header of the archive."""
    borders = [found.start() for found in re.finditer(rb"PK[\x01\x03\x05]", data)]
    return data[: random.choice(borders) + random.choice([0, 1, 4, 30])]


def _lie(data: bytes, random: Random) -> bytes:
    """A byte of the table of contents says something else."""
    start = data.find(b"PK\x01\x02")
    at = random.randrange(start, len(data))
    return data[:at] + bytes([random.randrange(256)]) + data[at + 1 :]
