"""Compilations in a loop: nothing refers to earlier ones, and their memory is soon free."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """\
import gc
import sys
from sysmlc import compile_model

def read_megabytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096 / 1e6

def count_objects():
    return len(gc.get_objects()) + gc.get_freeze_count()

model, count, backends = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
for number in range(count):
    compile_model(model, emit=backends)
    if number == 4:
        first_megabytes = read_megabytes()
        gc.collect()
        first_objects = count_objects()
megabytes = read_megabytes() - first_megabytes
gc.collect()
print(count_objects() - first_objects, megabytes)
"""
CELLS = "".join(
    f"""\
    part def Cell{number} {{
        attribute level : ScalarValues::Natural;
        state run {{
            entry; then idle;
            state idle;
            accept Start then busy;
            state busy {{ do action work; }}
            transition first busy accept Stop do assign level := {number} then idle;
        }}
    }}
"""
    for number in range(20)
)
MODEL = f"package Cells {{\n    item def Start;\n    item def Stop;\n{CELLS}}}\n"


def measure_growth(model: Path, count: int, *backends: str) -> tuple[int, float]:
    """Return the growth in objects and in MB after the first five of *count* compilations."""
    if not Path("/proc/self/statm").exists():
        pytest.skip("only Linux shows the memory of a process in this way")
    command = [sys.executable, "-c", SCRIPT, str(model), str(count), *backends]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    objects, megabytes = result.stdout.split()
    return int(objects), float(megabytes)


def test_compilations_in_a_loop_leave_nothing(tmp_path):
    model = tmp_path / "cells.sysml"
    model.write_text(MODEL)
    objects, megabytes = measure_growth(model, 15, "contracts", "plantuml")
    assert objects < 1_000
    assert megabytes < 10


@pytest.mark.corpus
@pytest.mark.long
@pytest.mark.parametrize(
    # Growth was 0.4 MB from the 5th to the 30th and to the 200th compilation.
    ("count", "backends"),
    [(12, []), (8, ["contracts", "recipe", "plantuml"])],
)
def test_compilations_of_the_ice_laboratory_leave_nothing(count, backends, corpus):
    objects, megabytes = measure_growth(corpus / "sysml2/ice-lab", count, *backends)
    assert objects < 1_000
    assert megabytes < 10
