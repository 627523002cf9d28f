"""Formulas about the past in recorded runs and monitors: sysmlc computes their history bits."""

import random
import shutil
import subprocess

import pytest

from sysmlc.logic.contract import BooleanDomain
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formal_texts import read_temporal_logic
from sysmlc.logic.formula import Apply, Op

NAMES = ("p", "q", "ok")
DOMAINS = dict.fromkeys(NAMES, BooleanDomain())
COMPILER = shutil.which("cc") or shutil.which("gcc")
CASES = (
    ("true", "ok <-> (p S q)"),
    ("true", "ok <-> Y (p & !q)"),
    ("true", "ok <-> O (p & q)"),
    ("true", "ok <-> H (p | q)"),
    ("true", "ok <-> Y (p S Y q)"),
    ("true", "(H (p -> O q)) S (Y p) -> ok"),
    ("true", "X (p S q) -> X ok"),
    ("p -> !Y p", "ok <-> (!p S q)"),
    ("(p S q) | Y !p | !Y p", "ok -> O q"),
    ("X Y p -> X (O q)", "ok -> Y (p | q)"),
)
"""An assumption and a guarantee, each of which holds in every step."""


@pytest.fixture(scope="module")
def runs():
    die = random.Random(7)
    return [
        [{name: die.random() < 0.5 for name in NAMES} for _ in range(die.randint(1, 5))]
        for _ in range(40)
    ]


def write_model():
    """Return a model with a component and a requirement for each case."""
    lines = ["package P {", "private import ScalarValues::*;"]
    for index, (assumed, demanded) in enumerate(CASES):
        lines += [
            f"part def Case{index} {{ in attribute p : Boolean; in attribute q : Boolean;",
            "out attribute ok : Boolean; }",
            f"requirement def R{index} {{ subject it : Case{index};",
            f'assume constraint {{ language "ltl" /* G ({assumed}) */ }}',
            f'require constraint {{ language "ltl" /* G ({demanded}) */ }} }}',
        ]
    return "\n".join([*lines, "}", ""])


def holds(formula, run, step):
    """Whether a formula about a step, its past and the next step holds, by definition."""
    match formula:
        case Apply(Op.PREVIOUS, (inner,)):
            return step > 0 and holds(inner, run, step - 1)
        case Apply(Op.ONCE, (inner,)):
            return any(holds(inner, run, index) for index in range(step + 1))
        case Apply(Op.HISTORICALLY, (inner,)):
            return all(holds(inner, run, index) for index in range(step + 1))
        case Apply(Op.SINCE, (stay, goal)):
            return any(
                holds(goal, run, start)
                and all(holds(stay, run, index) for index in range(start + 1, step + 1))
                for start in range(step + 1)
            )
        case Apply(Op.NEXT, (inner,)):
            return holds(inner, run, step + 1)
        case Apply(Op.NOT, (inner,)):
            return not holds(inner, run, step)
        case Apply(Op.AND, args):
            return all(holds(arg, run, step) for arg in args)
        case Apply(Op.OR, args):
            return any(holds(arg, run, step) for arg in args)
        case Apply(Op.IMPLIES, (left, right)):
            return not holds(left, run, step) or holds(right, run, step)
        case Apply(Op.IFF, (left, right)):
            return holds(left, run, step) is holds(right, run, step)
        case _:
            return is_true(formula, run[step])


def find_first_violation(case, run):
    """Return the number of the first step, from 1, that breaks a case, or None."""
    for step in range(len(run)):
        for text in case:
            formula = read_temporal_logic(text, DOMAINS)
            first = step - 1 if "X" in text else step
            if first >= 0 and not holds(formula, run, first):
                return step + 1
    return None


def test_monitors_compute_the_past(workspace, all_passes, runs):
    workspace.write("cases.sysml", write_model())
    assert workspace.sysmlc("cases.sysml", "-o", "out", "--emit", "monitor").exit_code == 0
    for index, case in enumerate(CASES):
        names = {}
        exec((workspace.folder / f"out/monitors/case{index}_monitor.py").read_text(), names)
        assert set(names["VARIABLES"]) <= set(NAMES)
        for run in runs:
            monitor = names["Monitor"]()
            results = [monitor.observe(values) for values in run]
            broken = [step for step, check in enumerate(results, 1) if check is not None]
            assert (broken[0] if broken else None) == find_first_violation(case, run), (case, run)


@pytest.mark.skipif(COMPILER is None, reason="no C compiler is installed")
def test_monitors_in_c_compute_the_past(workspace, all_passes, runs):
    workspace.write("cases.sysml", write_model())
    assert workspace.sysmlc("cases.sysml", "-o", "out", "--emit", "monitor").exit_code == 0
    folder = workspace.folder / "out/monitors"
    for index, case in enumerate(CASES):
        workspace.write("out/monitors/main.c", write_main(f"case{index}", runs))
        flags = ["-std=c99", "-Wall", "-Wextra", "-Werror"]
        sources = [folder / "main.c", folder / f"case{index}_monitor.c"]
        subprocess.run([COMPILER, *flags, *sources, "-o", folder / "main"], check=True)
        output = subprocess.run([folder / "main"], check=True, capture_output=True, text=True)
        steps = [int(line) or None for line in output.stdout.splitlines()]
        assert steps == [find_first_violation(case, run) for run in runs], case


def write_main(prefix, runs):
    """Return a program that prints the first broken step of each run, or 0."""
    lines = ["#include <stdio.h>", f'#include "{prefix}_monitor.h"', "int main(void) {"]
    for run in runs:
        lines.append(f"{{ {prefix}_monitor monitor; {prefix}_values values; long broken = 0;")
        lines.append(f"{prefix}_start(&monitor);")
        for step in run:
            lines += [f"values.{name} = {int(value)};" for name, value in step.items()]
            lines.append(f"if ({prefix}_observe(&monitor, &values) >= 0 && !broken)")
            lines.append("broken = monitor.step;")
        lines.append('printf("%ld\\n", broken); }')
    return "\n".join([*lines, "return 0; }", ""])


@pytest.mark.parametrize("contract", ["cases.sysml", "out/contracts/P.Case0.contract.json"])
def test_a_recorded_run_needs_no_values_of_the_past(workspace, all_passes, contract):
    workspace.write("cases.sysml", write_model())
    workspace.sysmlc("cases.sysml", "-o", "out", "--emit", "contracts")
    workspace.write("right.csv", "p,q,ok\n0,1,1\n0,0,0\n1,1,1\n")
    workspace.write("wrong.csv", "p,q,ok\n0,1,1\n0,0,0\n1,1,0\n")
    right, wrong = (
        workspace.sysmlc("contracts", "accept", contract, run, "-c", "P::Case0")
        for run in ("right.csv", "wrong.csv")
    )
    assert [right.exit_code, right.stdout] == [0, "P::Case0: 3 steps, no check is broken\n"]
    assert right.stderr == ""
    assert [wrong.exit_code, wrong.stdout] == [1, "P::Case0: it breaks a guarantee in step 3\n"]


def test_a_run_in_which_nothing_can_be_checked_is_not_called_unbroken(workspace, all_passes):
    workspace.write("cases.sysml", write_model())
    workspace.write("short.csv", "p,q\n0,1\n")
    result = workspace.sysmlc("contracts", "accept", "cases.sysml", "short.csv", "-c", "P::Case0")
    assert result.exit_code == 2
    assert result.stdout == (
        "P::Case0: nothing was checked: each check needs variables without values in 'short.csv'\n"
    )
    assert "SM594" in result.stderr
