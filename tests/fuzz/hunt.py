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
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from fuzz.guard import MEGABYTE, Bounds, Ended, Guard
from fuzz.mutants import SUFFIXES, Mutant, models, mutant, unspoilt

SECONDS = 5
MEMORY = 1024 * MEGABYTE
EMITTED = "+aml,+ecore,+graph,+ir,+reqtable,+sysml,+uml"
ARGS = ("-o", "out", "--diagrams", "both", "--verify-each")
_EVERY = 20
"""One mutant of so many is compiled again with another hash seed."""
_EXCHANGED = 8
"""One of so many is written as interchange of SysML v2 too, which takes long."""


@dataclass(frozen=True, slots=True)
class Found:
    """A mutant that was not answered as it should be, and why."""

    mutant: Mutant
    what: str


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
        emitted = EMITTED if spoilt.seed % _EXCHANGED else f"{EMITTED},+sysmlx"
        args = ("build", spoilt.name, "--emit", emitted, *ARGS)
        return guard.run(folder, *args, bounds=self.bounds)

    def _fresh(self, spoilt: Mutant) -> Path:
        folder = self.folder / "work"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / ".git").mkdir()
        write(spoilt, folder)
        return folder

    def _count(self, spoilt: Mutant, ended: Ended) -> None:
        self.codes[ended.code] += 1
        self.seconds += ended.seconds
        self.slowest = max(self.slowest, (ended.seconds, spoilt.seed))
        self.largest = max(self.largest, (ended.megabytes, spoilt.seed))


def write(spoilt: Mutant, folder: Path) -> None:
    """Write the files of a mutant into a folder."""
    for name, data in spoilt.files:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


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
    among = models(asked.corpus, asked.largest * 1024, asked.kinds.split(","))
    found = 0
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        hunter = Hunter(Path(folder))
        for seed in range(asked.seed, asked.seed + asked.count):
            if asked.as_is and seed >= len(among):
                break
            spoilt = unspoilt(seed, among[seed]) if asked.as_is else mutant(seed, among)
            for finding in hunter.look(spoilt):
                found += 1
                print(f"{seed} {spoilt.done}: {finding.what}", flush=True)
                if asked.keep:
                    write(spoilt, asked.keep)
        hunter.close()
    print(_summary(hunter, found), flush=True)
    return 1 if found else 0


def _summary(hunter: Hunter, found: int) -> str:
    codes = ", ".join(f"exit {code}: {number}" for code, number in sorted(hunter.codes.items()))
    count = hunter.codes.total()
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
    parser.add_argument("--kinds", default=",".join(SUFFIXES), help="of models, comma separated")
    parser.add_argument("--as-is", action="store_true", help="the models themselves, unspoilt")
    parser.add_argument("--keep", type=Path, help="folder for the mutants that were found")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
