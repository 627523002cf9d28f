"""Generates UML/SysML models of any size as Papyrus or MagicDraw saves them, streaming.

The same size, seed and dialect give the same bytes. Run it to write a file:
``python benchmarks/xmi_model.py --megabytes 10 --seed 1 --dialect papyrus plant.uml``
"""

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import BinaryIO

from measuring import MEGABYTE
from model_cells import Part, cell, shared
from model_dialects import DIALECTS, MARK, NUMBER, Dialect

_VARIANTS = 8
"""Cells that differ in words and numbers; the file is made of them in turn."""

_STRIDE = 4096
"""Numbers that a cell can give to its elements."""


class _Template:
    """Text with places for ids; one for the tree and one for the stereotypes of a part."""

    def __init__(self, text: str) -> None:
        pieces = text.split(MARK)
        self._texts = pieces[0::2]
        self._keys = pieces[1::2]

    def filled(self, values: dict[str, str]) -> bytes:
        """The text with the values of the keys."""
        texts = iter(self._texts)
        parts = [next(texts)]
        for key, text in zip(self._keys, texts, strict=True):
            parts.append(values[key])
            parts.append(text)
        return "".join(parts).encode()

    def keys(self) -> list[str]:
        """The keys, each once."""
        return list(dict.fromkeys(self._keys))


@dataclass(frozen=True, slots=True)
class _Cell:
    tree: _Template
    applications: _Template

    def values(self, number: int, ids: "_Ids") -> dict[str, str]:
        """Id of each key in the cell with this number."""
        keys = dict.fromkeys([*self.tree.keys(), *self.applications.keys()])
        made = {key: ids.at(key, number, place) for place, key in enumerate(keys)}
        made[NUMBER] = str(number)
        return made


class _Ids:
    """Ids of a file: of elements that cells share, and of the others by their place."""

    def __init__(self, dialect: Dialect, seed: int) -> None:
        self._dialect = dialect
        self._seed = seed
        self._shared: dict[str, str] = {}

    def at(self, key: str, number: int, place: int) -> str:
        if key.startswith("@"):
            fresh = self._dialect.id(len(self._shared) + 1, self._seed)
            return self._shared.setdefault(key, fresh)
        return self._dialect.id(number * _STRIDE + place, self._seed)


def write(stream: BinaryIO, megabytes: float, seed: int = 1, dialect: str = "papyrus") -> int:
    """Write a model of about this size (at least one cell); return the number of bytes."""
    written = 0
    for chunk in chunks(megabytes, seed, dialect):
        written += stream.write(chunk)
    return written


def chunks(megabytes: float, seed: int, dialect: str) -> Iterator[bytes]:
    """The bytes of a model, a cell at a time; stereotypes follow the model as in real files."""
    way = DIALECTS[dialect]
    ids = _Ids(way, seed)
    chance = Random(seed)
    common = _templates(shared(), way)
    variants = [_templates(cell(chance), way) for _ in range(_VARIANTS)]
    first = common.values(0, ids)
    number = _count(megabytes, common, variants, ids)
    order = [chance.choice(variants) for _ in range(number)]
    model = _Template(way.model).filled({"@model": ids.at("@model", 0, 0)})
    yield way.head.encode() + model + common.tree.filled(first)
    for place, one in enumerate(order, 1):
        yield one.tree.filled(one.values(place, ids))
    yield _end_of(way) + common.applications.filled(first)
    for place, one in enumerate(order, 1):
        yield one.applications.filled(one.values(place, ids))
    yield way.tail.encode()


def _templates(part: Part, way: Dialect) -> _Cell:
    pieces = [] if len(part.nodes) > 1 else list(way.extension(part))
    for node in part.nodes:
        pieces += way.node(node, 2)
    applications = "".join(map(way.application, part.applications))
    return _Cell(_Template("".join(pieces)), _Template(applications))


def _end_of(way: Dialect) -> bytes:
    return way.model.partition("<")[0].encode() + b"</uml:Model>\n"


def _count(megabytes: float, common: _Cell, variants: list[_Cell], ids: _Ids) -> int:
    sizes = [_size(one, ids) for one in variants]
    average = sum(sizes) / len(sizes)
    return max(1, round((megabytes * MEGABYTE - _size(common, ids)) / average))


def _size(one: _Cell, ids: _Ids) -> int:
    values = one.values(1000, ids)
    return len(one.tree.filled(values)) + len(one.applications.filled(values))


def main() -> int:
    """Write one file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--dialect", choices=sorted(DIALECTS), default="papyrus")
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    with options.file.open("wb") as stream:
        written = write(stream, options.megabytes, options.seed, options.dialect)
    print(f"{written} bytes in {options.file}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
