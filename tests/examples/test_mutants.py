"""Spoilt examples: findings and an exit code, never a fault of ours and never a hang.

SYSMLC_MUTANTS=5000 tries more; the number of a mutant in a failure is its seed.
"""

import os
import signal
import subprocess
import sys
from collections import Counter
from contextlib import contextmanager
from functools import cache
from random import Random

import pytest

from dialects.magicdraw import write_mdzip, write_xml
from dialects.mutate import damage, mutate
from examples.compiling import EXAMPLES, compile_text
from sysmlc.driver.faults import INTERNAL_FAULT

MUTANTS = int(os.environ.get("SYSMLC_MUTANTS", "300"))
BATCH = 25
SECONDS = 5


@cache
def document(index: int, dialect: str) -> bytes:
    papyrus = EXAMPLES[index].read_bytes()
    return {"uml": bytes, "xml": write_xml, "mdzip": write_mdzip}[dialect](papyrus)


def mutant(seed: int) -> tuple[str, str, bytes]:
    """Name, what was done, and content of a mutant."""
    random = Random(seed)
    dialect = random.choices(["uml", "xml", "mdzip"], weights=[6, 3, 1])[0]
    whole = document(random.randrange(len(EXAMPLES)), dialect)
    done, data = (damage if dialect == "mdzip" else mutate)(whole, random)
    return f"mutant{seed}.{dialect}", done, data


@contextmanager
def time_limit(seconds: int, what: str):
    def stop(*_):
        pytest.fail(f"{what} takes more than {seconds} s of processor time")

    previous = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, previous)


@pytest.mark.parametrize("batch", range(0, MUTANTS, BATCH))
def test_a_spoilt_model_is_answered_with_findings(batch, tmp_path):
    codes: Counter[int] = Counter()
    for seed in range(batch, min(batch + BATCH, MUTANTS)):
        name, done, data = mutant(seed)
        with time_limit(SECONDS, f"{name} ({done})"):
            compilation = compile_text(tmp_path, name, data)
        faults = [
            found.message for found in compilation.diagnostics if found.rule is INTERNAL_FAULT
        ]
        assert not faults, f"{name} ({done}): {faults}"
        codes[compilation.exit_code()] += 1
    assert codes.keys() <= {0, 1, 2}
    assert codes[1] + codes[2] > 0, "no mutant had an error: the mutations do nothing"


@pytest.mark.parametrize("seed", range(1000, 1008))
def test_the_command_answers_a_spoilt_model(seed, tmp_path):
    name, done, data = mutant(seed)
    (tmp_path / name).write_bytes(data)
    command = [sys.executable, "-m", "sysmlc", name, "-o", "out"]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=60, check=False)
    said = ended.stderr.decode("utf-8")
    assert ended.returncode in (0, 1, 2), done
    assert "Traceback" not in said
    assert said if ended.returncode else True
    assert not list(tmp_path.rglob(".sysmlc-*")), "a half-written file was left"
