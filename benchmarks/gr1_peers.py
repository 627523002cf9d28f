"""Other synthesis programs, which decide the same contracts for comparison."""

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from gr1_work import read_contract
from measuring import read_children_time

from sysmlc.logic import formats
from sysmlc.logic.reduction.contract_reduction import reduce_contract

FORMATS = {"gr1c": ("gr1c", ("-r",)), "slugs": ("slugsin", ())}
"""Format that each program reads, and its options for a decision without a controller."""
VERDICTS = {"unrealizable": "unrealizable", "not realizable": "unrealizable"}
"""Verdict by a text in the output, in lower case. They are searched before "realizable", which they
contain."""


@dataclass(frozen=True, slots=True)
class Peer:
    """A program and the seconds that it may run."""

    name: str
    program: str
    limit: float

    def decide(self, name: str, text: str, own_seconds: float = 0.0) -> str:
        """Return CPU seconds and the verdict of the program, or the reason for their absence.

        With our own CPU seconds, the text ends with their ratio to those of the program.
        """
        format_, arguments = FORMATS[self.name]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "contract")
            try:
                contract = reduce_contract(read_contract(name, text)).contract
                written = formats.write(contract, format_)
            except formats.NotExpressibleError as problem:
                return f"{self.name} cannot express the contract: {problem.reason}"
            path.write_text(written, encoding="utf-8")
            command = [self.program, *arguments, str(path)]
            return f"{self.name} {self._run_program(command, own_seconds)}"

    def _run_program(self, command: list[str], own_seconds: float) -> str:
        before = read_children_time()
        try:
            process = subprocess.run(
                command, capture_output=True, text=True, timeout=self.limit, check=False
            )
        except subprocess.TimeoutExpired:
            return f"over {self.limit:g} s"
        except OSError as problem:
            return f"does not run ({problem.strerror})"
        seconds = read_children_time() - before
        ratio = f" (ours {own_seconds / seconds:.2f} x)" if own_seconds and seconds else ""
        return f"{seconds:.3f} s {_read_verdict(process.stdout + process.stderr)}{ratio}"


def _read_verdict(output: str) -> str:
    text = output.lower()
    verdict = next((verdict for phrase, verdict in VERDICTS.items() if phrase in text), "")
    return verdict or ("realizable" if "realizable" in text else "no verdict")
