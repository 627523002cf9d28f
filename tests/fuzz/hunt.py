"""``python -m fuzz.hunt --count 1000``: mutate models and report those that sysmlc cannot handle.

A mutant is determined by its seed: ``--seed N --count 1`` makes it again. sysmlc must answer every
mutant with a list of diagnostics and exit code 0, 1 or 2, within five seconds of processor time
and one gigabyte, and in the same way in every run.
"""

import argparse
import hashlib
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from fuzz.fork_server import MEGABYTE, CommandResult, ForkServer, Limits
from fuzz.mutants import SUFFIXES, Mutant, list_models, make_mutant, make_unchanged

SECONDS = 5
MEMORY = 1024 * MEGABYTE
BACKENDS = "+aml,+ecore,+graph,+ir,+reqtable,+sysml,+uml"
OPTIONS = ("-o", "out", "--diagrams", "both", "--verify-each")
_OTHER_SEED_EVERY = 20
"""Every mutant with a seed divisible by this number is compiled with two hash seeds."""
_INTERCHANGE_EVERY = 8
"""Every mutant with a seed divisible by this number is also written as interchange, slowly."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A mutant that sysmlc did not handle, and the problem."""

    mutant: Mutant
    problem: str


class Hunter:
    """Compiles mutants in processes of their own and counts the results."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.limits = Limits(SECONDS + 1, 120, MEMORY + 200 * MEGABYTE)
        self._server, self._other_seed_server = ForkServer(0), ForkServer(1)
        self.codes: Counter[int] = Counter()
        self.seconds = 0.0
        self.slowest = (0.0, 0)
        self.largest = (0.0, 0)

    def close(self) -> None:
        """End the fork servers."""
        self._server.close()
        self._other_seed_server.close()

    def check(self, mutant: Mutant) -> Iterator[Failure]:
        """Compile a mutant and yield the problem, if there is one."""
        folder = self._prepare_folder(mutant)
        result = self._compile(self._server, folder, mutant)
        self._count_result(mutant, result)
        if result.is_crash:
            yield Failure(mutant, f"exit {result.code}: {_find_main_line(result)}")
        elif result.seconds > SECONDS:
            yield Failure(mutant, f"{result.seconds:.1f} s of processor time")
        elif result.megabytes * MEGABYTE > MEMORY:
            yield Failure(mutant, f"{result.megabytes:.0f} MB")
        elif result.code and not result.err:
            yield Failure(mutant, f"exit {result.code} without output")
        elif mutant.seed % _OTHER_SEED_EVERY == 0:
            yield from self._compare_with_other_seed(mutant, result, _digest(folder))

    def _compare_with_other_seed(
        self, mutant: Mutant, first: CommandResult, before: str
    ) -> Iterator[Failure]:
        folder = self._prepare_folder(mutant)
        second = self._compile(self._other_seed_server, folder, mutant)
        if (first.code, first.out, first.err) != (second.code, second.out, second.err):
            yield Failure(mutant, "other findings with another hash seed")
        elif before != _digest(folder):
            yield Failure(mutant, "other outputs with another hash seed")

    def _compile(self, server: ForkServer, folder: Path, mutant: Mutant) -> CommandResult:
        backends = BACKENDS if mutant.seed % _INTERCHANGE_EVERY else f"{BACKENDS},+sysmlx"
        args = ("build", mutant.name, "--emit", backends, *OPTIONS)
        return server.run(folder, *args, limits=self.limits)

    def _prepare_folder(self, mutant: Mutant) -> Path:
        folder = self.folder / "work"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / ".git").mkdir()
        write_files(mutant.files, folder)
        return folder

    def _count_result(self, mutant: Mutant, result: CommandResult) -> None:
        self.codes[result.code] += 1
        self.seconds += result.seconds
        self.slowest = max(self.slowest, (result.seconds, mutant.seed))
        self.largest = max(self.largest, (result.megabytes, mutant.seed))


def write_files(files: Iterable[tuple[str, bytes]], folder: Path) -> None:
    """Write files, given by path and content, below *folder*."""
    for name, data in files:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def _find_main_line(result: CommandResult) -> str:
    """Return the most specific line of the output."""
    lines = [line for line in (result.err + result.out).splitlines() if line.strip()]
    specific_lines = [line for line in lines if "fault" in line or "SM90" in line]
    return (specific_lines or lines[-1:] or ["killed without output"])[0]


def _digest(folder: Path) -> str:
    """Return a digest of all files in the folder."""
    digest = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def main() -> int:
    """Compile mutants and print their problems and a summary; return 1 if there are problems."""
    options = _parse_arguments()
    models = list_models(options.corpus, options.largest * 1024, options.kinds.split(","))
    failure_count = 0
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        hunter = Hunter(Path(folder))
        for seed in range(options.seed, options.seed + options.count):
            if options.as_is and seed >= len(models):
                break
            mutant = (
                make_unchanged(seed, models[seed]) if options.as_is else make_mutant(seed, models)
            )
            for failure in hunter.check(mutant):
                failure_count += 1
                print(f"{seed} {mutant.description}: {failure.problem}", flush=True)
                if options.keep:
                    write_files(mutant.files, options.keep)
        hunter.close()
    print(_format_summary(hunter, failure_count), flush=True)
    return 1 if failure_count else 0


def _format_summary(hunter: Hunter, failure_count: int) -> str:
    codes = ", ".join(f"exit {code}: {number}" for code, number in sorted(hunter.codes.items()))
    count = hunter.codes.total()
    return (
        f"{count} mutants, {failure_count} not answered; {codes}; {hunter.seconds:.0f} s; slowest"
        f" {hunter.slowest[0]} s ({hunter.slowest[1]}); largest {hunter.largest[0]} MB"
        f" ({hunter.largest[1]})"
    )


def _parse_arguments() -> argparse.Namespace:
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
