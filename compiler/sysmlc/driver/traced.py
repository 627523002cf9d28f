"""Elements and their places as ``trace.json`` shows them.

A process that stays remembers them from one compilation to the next: what an element says
follows from its id, name and ordinal and from the bytes of its file. Where these are equal it is
used again.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from json.encoder import encode_basestring
from operator import itemgetter

from sysmlc.diagnostics.locate import positions
from sysmlc.sources import Source
from sysmlc.values import dataclass

Start = tuple[str, str, str, int]
"""Qualified name, id, file and ordinal of an element; the file is empty for none."""

_START = itemgetter(0)
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
    every = sorted(chain.from_iterable([one.told for one in found.values()]), key=_START)
    _last.clear()
    if len(every) <= _MOST:
        _last.update(found)
    return [text for _, text in every]


def _in_file(file: str, source: Source | None, starts: list[Start]) -> _File:
    data = b"" if source is None else source.data
    known = _last.get(file)
    if known is not None and known.data == data and known.starts == starts:
        return known
    made = zip(starts, _made(file, source, starts), strict=True)
    return _File(data, starts, sorted(made, key=_START))


def _made(file: str, source: Source | None, starts: Sequence[Start]) -> Iterator[str]:
    ordinals = {file: [ordinal for *_, ordinal in starts]}
    places = positions([source], ordinals)[file] if source is not None else _NOWHERE
    in_file = f'{{\n    "file": {encode_basestring(file)},\n    "line": '
    for name, id, _, ordinal in starts:
        line, column = places.get(ordinal, (0, 0))
        where = f'{in_file}{line or "null"},\n    "column": {column or "null"}\n   }}'
        yield (
            f'{{\n   "id": {encode_basestring(id)},\n   "qualified_name": '
            f'{encode_basestring(name)},\n   "source": {where if file else "null"}\n  }}'
        )
