"""Generator of AutomationML plants (CAEX 3.0) of any size.

The same size and seed give the same bytes. The plant is never in memory as a whole. To write a
file: ``python benchmarks/aml_model.py --megabytes 5 --seed 1 plant.aml``
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import BinaryIO

from aml_plant import FOOT, HEAD, print_line
from measuring import MEGABYTE


def write_plant(stream: BinaryIO, megabytes: float, seed: int = 1) -> int:
    """Write a plant of about this size (at least one line); return the number of bytes."""
    return sum(stream.write(chunk) for chunk in iter_chunks(megabytes, seed))


def iter_chunks(megabytes: float, seed: int) -> Iterator[bytes]:
    """Yield the bytes of a plant, one production line at a time, until the size is reached."""
    random = Random(seed)
    yield HEAD.encode()
    remaining_size = megabytes * MEGABYTE - len(HEAD) - len(FOOT)
    number = 0
    while remaining_size > 0 or not number:
        number += 1
        line = print_line(number, random).encode()
        remaining_size -= len(line)
        yield line
    yield FOOT.encode()


def main() -> int:
    """Write the file that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    with options.file.open("wb") as stream:
        size = write_plant(stream, options.megabytes, options.seed)
    print(f"{size} bytes in {options.file}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
