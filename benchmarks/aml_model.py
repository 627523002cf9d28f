"""Generates AutomationML plants (CAEX 3.0) of any size, streaming.

The same size and seed give the same bytes. Run it to write a file:
``python benchmarks/aml_model.py --megabytes 5 --seed 1 plant.aml``
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import BinaryIO

from aml_plant import FOOT, HEAD, line
from measuring import MEGABYTE


def write(stream: BinaryIO, megabytes: float, seed: int = 1) -> int:
    """Write a plant of about this size (at least one line); return the number of bytes."""
    written = 0
    for chunk in chunks(megabytes, seed):
        written += stream.write(chunk)
    return written


def chunks(megabytes: float, seed: int) -> Iterator[bytes]:
    """The bytes of a plant, a production line at a time, until the size is reached."""
    chance = Random(seed)
    yield HEAD.encode()
    left = megabytes * MEGABYTE - len(HEAD) - len(FOOT)
    number = 0
    while left > 0 or not number:
        number += 1
        made = line(number, chance).encode()
        left -= len(made)
        yield made
    yield FOOT.encode()


def main() -> int:
    """Write one file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    with options.file.open("wb") as stream:
        written = write(stream, options.megabytes, options.seed)
    print(f"{written} bytes in {options.file}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
