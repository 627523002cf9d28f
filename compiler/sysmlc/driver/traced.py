"""Elements and their places as ``trace.json`` shows them.

A process that stays remembers them from one compilation to the next: what an element says
follows from its id, name and ordinal and from the bytes of its file. Where these are equal it is
used again.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from json.encoder import encode_basestring

from sysmlc.diagnostics.locate import positions
from sysmlc.sources import Source
from sysmlc.values import dataclass

Start = tuple[str, str, str, int]
"""Qualified name, id, file and ordinal of an element; the file is empty for none."""

_MOST = 20_000
"""Elements of a unit that are remembered at most."""
_NOWHERE: Mapping[int, tuple[int, int]] = {}
_last: dict[str, "_File"] = {}
"""What the files of the last compilation told."""


@dataclass(frozen=True, slots=True)
class _File:
    """The bytes of a file, its elements, and what each says, in order."""

    data: bytes
    starts: list[Start]
    told: list[tuple[Start, str]]


def told(sources: Iterable[Source], starts: Iterable[Start]) -> list[str]:
    """The elements, as ``json_text`` would write them, in the order of their names."""
    by_file: dict[str, list[Start]] = {}
    for start in starts:
        by_file.setdefault(start[2], []).append(start)
    there = {source.name: source for source in sources if source.name in by_file}
    found = {file: _in_file(file, there.get(file), ours) for file, ours in by_file.items()}
    every = sorted(chain.from_iterable([one.told for one in found.values()]))
    _last.clear()
    if len(every) <= _MOST:
        _last.update(found)
    return [text for _, text in every]


def _in_file(file: str, source: Source | None, starts: list[Start]) -> _File:
    data = b"" if source is None else source.data
    known = _last.get(file)
    if known is not None and known.data == data and known.starts == starts:
        return known
    return _File(data, starts, sorted(zip(starts, _made(file, source, starts), strict=True)))


def _made(file: str, source: Source | None, starts: Sequence[Start]) -> Iterable[str]:
    ordinals = {file: [ordinal for *_, ordinal in starts]}
    places = positions([source], ordinals)[file] if source is not None else _NOWHERE
    for name, id, _, ordinal in starts:
        yield _element(id, name, file, *places.get(ordinal, (0, 0)))


def _element(id: str, name: str, file: str, line: int, column: int) -> str:
    source = (
        f'{{\n    "file": {encode_basestring(file)},\n    "line": {line or "null"},\n'
        f'    "column": {column or "null"}\n   }}'
        if file
        else "null"
    )
    return (
        f'{{\n   "id": {encode_basestring(id)},\n'
        f'   "qualified_name": {encode_basestring(name)},\n   "source": {source}\n  }}'
    )
