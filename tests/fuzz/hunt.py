"""``python -m fuzz.hunt --count 1000``: spoils models and looks for what is no answer.

A mutant is the number that seeds it, so ``--seed N --count 1`` makes it again. An answer is a
list of findings and an exit code 0, 1 or 2 within five seconds of processor time and one
gigabyte, the same in every run.
"""

import argparse
import hashlib
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

from lxml import etree

from dialects.magicdraw import write_mdzip, write_xml
from dialects.mutate import damage, mutate
from fuzz.aml_changes import AML_CHANGES
from fuzz.changes import CHANGES
from fuzz.damages import DAMAGES, mutate_archive
from fuzz.guard import MEGABYTE, Bounds, Ended, Guard

SECONDS = 5
MEMORY = 1024 * MEGABYTE
ARGS = ("-o", "out", "--emit", "+graph,+ecore,+ir", "--diagrams", "both", "--verify-each")
_EVERY = 20
"""One mutant of so many is compiled again with another hash seed."""
_AML = {".aml", ".amlx"}
_EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*/*.uml"))


@dataclass(frozen=True, slots=True)
class Mutant:
    """A spoilt model: file name, what was done to which model, content."""

    seed: int
    name: str
    done: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Found:
    """A mutant that was not answered as it should be, and why."""

    mutant: Mutant
    what: str


def models(corpus: Path | None, largest: int) -> list[Path]:
    """The examples, and the files of the corpus up to a size in bytes."""
    inside = corpus.rglob("*") if corpus else ()
    wanted = {".uml", ".xml", ".mdxml", ".mdzip", ".xmi", *_AML}
    real = [p for p in inside if p.suffix in wanted and p.stat().st_size <= largest]
    return [*_EXAMPLES, *sorted(real)]


def mutant(seed: int, among: Sequence[Path]) -> Mutant:
    """The mutant of a number. Small models are chosen more often than large ones."""
    random = Random(seed)
    weights = [1 / (20_000 + path.stat().st_size) for path in among]
    path = random.choices(among, weights)[0]
    is_example = path in _EXAMPLES
    dialect = random.choice(["uml", "uml", "xml", "mdzip"]) if is_example else path.suffix[1:]
    whole = _document(path, dialect if is_example else "")
    changes = AML_CHANGES if path.suffix in _AML else None
    if dialect in ("mdzip", "amlx"):
        done, data = mutate_archive(whole, random, changes)
    elif _is_well_formed(path):
        done, data = mutate(whole, random, CHANGES, DAMAGES, changes)
    else:
        done, data = damage(whole, random, DAMAGES)
    return Mutant(seed, f"m{seed}.{dialect}", f"{path.name}: {done}", data)


@cache
def _is_well_formed(path: Path) -> bool:
    try:
        etree.parse(path)
    except etree.XMLSyntaxError:
        return False
    return True


@cache
def _document(path: Path, dialect: str) -> bytes:
    writer = {"xml": write_xml, "mdzip": write_mdzip}.get(dialect, bytes)
    return writer(path.read_bytes())


class Hunter:
    """Compiles mutants in processes of their own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.bounds = Bounds(SECONDS + 1, 120, MEMORY + 200 * MEGABYTE)
        self._guard, self._other = Guard(0), Guard(1)
        self.codes: Counter[int] = Counter()
        self.seconds = 0.0
        self.slowest = (0.0, 0)
        self.largest = (0.0, 0)

    def close(self) -> None:
        """End the processes."""
        self._guard.close()
        self._other.close()

    def look(self, spoilt: Mutant) -> Iterator[Found]:
        """What is wrong with the answer to this mutant."""
        folder = self._fresh(spoilt)
        ended = self._compile(self._guard, folder, spoilt)
        self._count(spoilt, ended)
        if ended.is_fault:
            yield Found(spoilt, f"exit {ended.code}: {_sign(ended)}")
        elif ended.seconds > SECONDS:
            yield Found(spoilt, f"{ended.seconds:.1f} s of processor time")
        elif ended.megabytes * MEGABYTE > MEMORY:
            yield Found(spoilt, f"{ended.megabytes:.0f} MB")
        elif ended.code and not ended.err:
            yield Found(spoilt, f"exit {ended.code} without a word")
        elif spoilt.seed % _EVERY == 0:
            yield from self._again(spoilt, ended, _state(folder))

    def _again(self, spoilt: Mutant, first: Ended, before: str) -> Iterator[Found]:
        folder = self._fresh(spoilt)
        second = self._compile(self._other, folder, spoilt)
        if (first.code, first.out, first.err) != (second.code, second.out, second.err):
            yield Found(spoilt, "other findings with another hash seed")
        elif before != _state(folder):
            yield Found(spoilt, "other outputs with another hash seed")

    def _compile(self, guard: Guard, folder: Path, spoilt: Mutant) -> Ended:
        return guard.run(folder, "build", spoilt.name, *ARGS, bounds=self.bounds)

    def _fresh(self, spoilt: Mutant) -> Path:
        folder = self.folder / "work"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / ".git").mkdir()
        (folder / spoilt.name).write_bytes(spoilt.data)
        return folder

    def _count(self, spoilt: Mutant, ended: Ended) -> None:
        self.codes[ended.code] += 1
        self.seconds += ended.seconds
        self.slowest = max(self.slowest, (ended.seconds, spoilt.seed))
        self.largest = max(self.largest, (ended.megabytes, spoilt.seed))


def _sign(ended: Ended) -> str:
    """The line that tells most."""
    lines = [line for line in (ended.err + ended.out).splitlines() if line.strip()]
    told = [line for line in lines if "fault" in line or "SM90" in line]
    return (told or lines[-1:] or ["killed without a word"])[0]


def _state(folder: Path) -> str:
    """A digest of all outputs."""
    digest = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def main() -> int:
    """Hunt; print what is found and how it went; 1 when something was found."""
    asked = _arguments()
    among = models(asked.corpus, asked.largest * 1024)
    found = 0
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        hunter = Hunter(Path(folder))
        for seed in range(asked.seed, asked.seed + asked.count):
            spoilt = mutant(seed, among)
            for finding in hunter.look(spoilt):
                found += 1
                print(f"{seed} {spoilt.done}: {finding.what}", flush=True)
                if asked.keep:
                    asked.keep.mkdir(parents=True, exist_ok=True)
                    (asked.keep / spoilt.name).write_bytes(spoilt.data)
        hunter.close()
    print(_summary(hunter, asked.count, found), flush=True)
    return 1 if found else 0


def _summary(hunter: Hunter, count: int, found: int) -> str:
    codes = ", ".join(f"exit {code}: {number}" for code, number in sorted(hunter.codes.items()))
    return (
        f"{count} mutants, {found} not answered; {codes}; {hunter.seconds:.0f} s; slowest"
        f" {hunter.slowest[0]} s ({hunter.slowest[1]}); largest {hunter.largest[0]} MB"
        f" ({hunter.largest[1]})"
    )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--corpus", type=Path, help="a folder of real models to spoil too")
    parser.add_argument("--largest", type=int, default=300, help="largest model, in kB")
    parser.add_argument("--keep", type=Path, help="folder for the mutants that were found")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
