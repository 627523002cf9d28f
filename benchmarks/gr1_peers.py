"""Other programs that decide the same contracts, where their binaries are given."""

import resource
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from gr1_work import read

from sysmlc.logic import formats
from sysmlc.logic.reduction.contract_reduction import reduce_contract

FORMS = {"gr1c": ("gr1c", ("-r",)), "slugs": ("slugsin", ())}
"""The form that a program reads, and its options to decide only."""
VERDICTS = {"unrealizable": "unrealizable", "not realizable": "unrealizable"}
"""What programs write when no system keeps the contract, in lower case; looked for first."""


@dataclass(frozen=True, slots=True)
class Peer:
    """A program, and for how many seconds it may run."""

    name: str
    program: str
    limit: float

    def decided(self, name: str, text: str) -> str:
        """CPU seconds and its verdict, or why there are none."""
        form, arguments = FORMS[self.name]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "contract")
            try:
                told = formats.write(reduce_contract(read(name, text)).contract, form)
            except formats.NotExpressibleError as problem:
                return f"{self.name} cannot be told: {problem.reason}"
            path.write_text(told, encoding="utf-8")
            return f"{self.name} {self._run([self.program, *arguments, str(path)])}"

    def _run(self, command: list[str]) -> str:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=self.limit, check=False
            )
        except subprocess.TimeoutExpired:
            return f"over {self.limit:g} s"
        except OSError as problem:
            return f"does not run ({problem.strerror})"
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return f"{seconds:.3f} s {_verdict(done.stdout + done.stderr)}"


def _verdict(said: str) -> str:
    words = said.lower()
    found = next((verdict for word, verdict in VERDICTS.items() if word in words), "")
    return found or ("realizable" if "realizable" in words else "no verdict")
