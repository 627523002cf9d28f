"""Generator of UML/SysML models of any size, as Papyrus or MagicDraw saves them.

The same size, seed and dialect give the same bytes. The model is never in memory as a whole. To
write a file: ``python benchmarks/xmi_model.py --megabytes 10 --seed 1 --dialect papyrus plant.uml``
"""

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import BinaryIO

from measuring import MEGABYTE
from model_cells import Part, build_cell, build_shared_part
from model_dialects import DIALECTS, MARK, NUMBER, Dialect

_VARIANTS = 8
"""Number of cells with different words and numbers, from which each cell of a file is chosen."""

_STRIDE = 4096
"""Distance between the id numbers of two cells: the largest number of elements of a cell."""


class _Template:
    """Text with marks, each of which is replaced by the id of a key."""

    def __init__(self, text: str) -> None:
        pieces = text.split(MARK)
        self._texts = pieces[0::2]
        self._keys = pieces[1::2]

    def fill(self, values: dict[str, str]) -> bytes:
        """Return the text with the values of the keys."""
        texts = iter(self._texts)
        parts = [next(texts)]
        for key, text in zip(self._keys, texts, strict=True):
            parts.append(values[key])
            parts.append(text)
        return "".join(parts).encode()

    def list_keys(self) -> list[str]:
        """Return the keys, each once."""
        return list(dict.fromkeys(self._keys))


@dataclass(frozen=True, slots=True)
class _Cell:
    """Templates of the elements of a cell and of the stereotype applications on them."""

    tree: _Template
    applications: _Template

    def assign_ids(self, number: int, ids: "_Ids") -> dict[str, str]:
        """Return the id of each key for the cell with this number."""
        keys = dict.fromkeys([*self.tree.list_keys(), *self.applications.list_keys()])
        values = {key: ids.find_id(key, number, place) for place, key in enumerate(keys)}
        values[NUMBER] = str(number)
        return values


class _Ids:
    """Ids of a file. An element that all cells share has one id; any other has one in each cell."""

    def __init__(self, dialect: Dialect, seed: int) -> None:
        self._dialect = dialect
        self._seed = seed
        self._shared: dict[str, str] = {}

    def find_id(self, key: str, number: int, place: int) -> str:
        """Return the id of a key, which has this place among the keys of the cell *number*."""
        if key.startswith("@"):
            fresh = self._dialect.make_id(len(self._shared) + 1, self._seed)
            return self._shared.setdefault(key, fresh)
        return self._dialect.make_id(number * _STRIDE + place, self._seed)


def write_model(stream: BinaryIO, megabytes: float, seed: int = 1, dialect: str = "papyrus") -> int:
    """Write a model of about this size (at least one cell); return the number of bytes."""
    return sum(stream.write(chunk) for chunk in iter_chunks(megabytes, seed, dialect))


def iter_chunks(megabytes: float, seed: int, dialect_name: str) -> Iterator[bytes]:
    """Yield the bytes of a model, one cell at a time.

    The stereotype applications follow the whole tree, as in files of the tools.
    """
    dialect = DIALECTS[dialect_name]
    ids = _Ids(dialect, seed)
    random = Random(seed)
    shared = _make_templates(build_shared_part(), dialect)
    variants = [_make_templates(build_cell(random), dialect) for _ in range(_VARIANTS)]
    shared_values = shared.assign_ids(0, ids)
    count = _count_cells(megabytes, shared, variants, ids)
    cells = [random.choice(variants) for _ in range(count)]
    model = _Template(dialect.model).fill({"@model": ids.find_id("@model", 0, 0)})
    yield dialect.head.encode() + model + shared.tree.fill(shared_values)
    for number, cell in enumerate(cells, 1):
        yield cell.tree.fill(cell.assign_ids(number, ids))
    yield _end_of_model(dialect) + shared.applications.fill(shared_values)
    for number, cell in enumerate(cells, 1):
        yield cell.applications.fill(cell.assign_ids(number, ids))
    yield dialect.tail.encode()


def _make_templates(part: Part, dialect: Dialect) -> _Cell:
    # The shared part has several root nodes; only a cell has diagrams.
    pieces = [] if len(part.nodes) > 1 else list(dialect.print_extension(part))
    for node in part.nodes:
        pieces += dialect.print_node(node, 2)
    applications = "".join(map(dialect.print_application, part.applications))
    return _Cell(_Template("".join(pieces)), _Template(applications))


def _end_of_model(dialect: Dialect) -> bytes:
    indent = dialect.model.partition("<")[0]
    return indent.encode() + b"</uml:Model>\n"


def _count_cells(megabytes: float, shared: _Cell, variants: list[_Cell], ids: _Ids) -> int:
    sizes = [_measure_size(variant, ids) for variant in variants]
    average = sum(sizes) / len(sizes)
    return max(1, round((megabytes * MEGABYTE - _measure_size(shared, ids)) / average))


def _measure_size(cell: _Cell, ids: _Ids) -> int:
    """Return the size in bytes of a cell with a number of four digits."""
    values = cell.assign_ids(1000, ids)
    return len(cell.tree.fill(values)) + len(cell.applications.fill(values))


def main() -> int:
    """Write the file that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--dialect", choices=sorted(DIALECTS), default="papyrus")
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    with options.file.open("wb") as stream:
        size = write_model(stream, options.megabytes, options.seed, options.dialect)
    print(f"{size} bytes in {options.file}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
