"""The back end ``monitor``: monitors in C99 and Python agree with the contract.

The runs come from the reference interpreter; in most of them one value is changed.
"""

import random
import shutil
import subprocess

import pytest

from backend_runs import refine_and_emit
from machine_samples import arrow, machine
from sysmlc import compile_texts
from sysmlc.backends.monitor import BACKEND
from sysmlc.controllers.monitor import build_monitor, find_first_violation
from sysmlc.diagnostics import Sink
from sysmlc.logic import domains
from sysmlc.logic.contract import Contract, EnumerationDomain
from sysmlc.logic.machines import interpreter
from sysmlc.logic.machines.reader import read_machine
from sysmlc.synthesis import contract_checks

GATE = machine(
    arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"),
    arrow("b", "a", "stop", "ready", "level := level - 1"),
    arrow("b", "b", "start", "level > 2", "level := 0"),
)
RUNS = 1_000
STEPS = 6
COMPILER = shutil.which("cc") or shutil.which("gcc")


@pytest.fixture(scope="module")
def gate():
    """The graph and the files of the gate."""
    graph, files, _ = refine_and_emit(BACKEND, GATE)
    return graph, {path: file.text for path, file in files.items()}


@pytest.fixture(scope="module")
def runs(gate):
    """Runs of the interpreter; three of four have a changed value."""
    graph, _ = gate
    (contract,) = graph.derived(Contract)
    state_machine = read_machine(graph, graph[contract.origin], Sink())
    source = random.Random(21)
    return [change_value(play(state_machine, source), contract, source) for _ in range(RUNS)]


def play(state_machine, source):
    """Return a run of the interpreter with random inputs."""

    def draw_inputs():
        return {
            variable.name: source.choice(domains.values(variable.domain))
            for variable in interpreter.list_inputs(state_machine)
        }

    run = [source.choice(interpreter.initial_steps(state_machine, draw_inputs()))]
    while len(run) < STEPS:
        steps = interpreter.next_steps(state_machine, run[-1], draw_inputs())
        run.append(source.choice(steps))
    return [dict(step) for step in run]


def change_value(run, contract, source):
    """Set a variable of one step to another value, in three of four runs."""
    if source.randrange(4):
        variable = source.choice(contract.variables)
        source.choice(run)[variable.name] = source.choice(domains.values(variable.domain))
    return run


def run_contract(graph, runs):
    """Return for each run the broken check and the number of the step, from 1."""
    (contract,) = graph.derived(Contract)
    monitor = build_monitor(contract)
    violations = [find_first_violation(monitor, run) for run in runs]
    return [
        (monitor.checks.index(violation.check), violation.step + 1) if violation else None
        for violation in violations
    ]


def run_python(text, runs):
    """Return the same by the monitor in Python."""
    names = {}
    exec(compile(text, "monitor", "exec"), names)
    results = []
    for run in runs:
        monitor = names["Monitor"]()
        for step in run:
            monitor.observe(step)
            if monitor.broken is not None:
                break
        results.append(None if monitor.broken is None else (monitor.broken, monitor.step))
    return results


def run_c(files, contract, runs, folder):
    """Return the same by the monitor in C."""
    for path, text in files.items():
        (folder / path.rpartition("/")[2]).write_text(text)
    steps = ",\n".join(print_step(step, contract) for run in runs for step in run)
    (folder / "main.c").write_text(MAIN.format(steps=steps, length=STEPS, runs=len(runs)))
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    sources = [str(path) for path in sorted(folder.glob("*.c"))]
    subprocess.run([COMPILER, *flags, *sources, "-o", str(folder / "main")], check=True)
    result = subprocess.run([folder / "main"], check=True, capture_output=True, text=True)
    pairs = [tuple(map(int, line.split())) for line in result.stdout.splitlines()]
    return [None if broken < 0 else (broken, step) for broken, step in pairs]


def print_step(step, contract):
    """Return the values of a step as an initialiser of ``gate_values``."""
    values = [
        f"GATE_{step[variable.name]}".upper()
        if isinstance(variable.domain, EnumerationDomain)
        else str(int(step[variable.name]))
        for variable in contract.variables
    ]
    return f"{{ {', '.join(values)} }}"


MAIN = """
#include <stdio.h>
#include "gate_monitor.h"

static const gate_values steps[] = {{
{steps}
}};

int main(void)
{{
    for (int run = 0; run < {runs}; run++) {{
        gate_monitor monitor;
        gate_start(&monitor);
        for (int step = 0; step < {length}; step++)
            gate_observe(&monitor, &steps[run * {length} + step]);
        printf("%d %ld\\n", monitor.broken, monitor.step);
    }}
    return 0;
}}
"""


def test_the_interpreter_breaks_nothing(gate):
    graph, _ = gate
    (contract,) = graph.derived(Contract)
    state_machine = read_machine(graph, graph[contract.origin], Sink())
    source = random.Random(4)
    runs = [play(state_machine, source) for _ in range(50)]
    assert run_contract(graph, runs) == [None] * 50


def test_the_monitor_in_python_agrees_with_the_contract(gate, runs):
    graph, files = gate
    expected = run_contract(graph, runs)
    assert run_python(files["monitors/gate_monitor.py"], runs) == expected
    assert 300 < sum(result is not None for result in expected) < 900


@pytest.mark.skipif(COMPILER is None, reason="no C compiler is installed")
def test_the_monitor_in_c_agrees_with_the_contract(gate, runs, tmp_path):
    graph, files = gate
    c_files = {path: text for path, text in files.items() if not path.endswith(".py")}
    (contract,) = graph.derived(Contract)
    assert run_c(c_files, contract, runs, tmp_path) == run_contract(graph, runs)


def test_a_check_names_its_element(gate):
    _, files = gate
    names = {}
    exec(files["monitors/gate_monitor.py"], names)
    elements = {element for _, _, _, element in names["CHECKS"]}
    assert "Plant::Gate::level" in elements


def test_names_of_the_model_cannot_leave_comments_and_strings(tmp_path):
    text = GATE.replace('"Gate"', "\"Ga*/te??/ *\\\\typedef int q; // ''' ü\"").replace(
        '"Plant"', r'"P */ \"\"\"; abort()"'
    )
    _, files, _ = refine_and_emit(BACKEND, text)
    for path, file in files.items():
        if path.endswith(".py"):
            exec(compile(file.text, path, "exec"), {})
        (tmp_path / path.rpartition("/")[2]).write_text(file.text)
    (source,) = tmp_path.glob("*.c")
    if COMPILER is not None:
        flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wtrigraphs", "-Werror"]
        subprocess.run([COMPILER, *flags, "-fsyntax-only", str(source)], check=True)


WORDS = (
    *("linux", "unix", "asm", "new", "typeof", "int8_t", "NULL", "EOF", "main", "signal", "auto"),
    *("and", "alignas", "char8_t", "class", "concept", "constexpr", "errno", "export", "final"),
    *("friend", "I", "import", "INFINITY", "inline", "namespace", "nullptr", "operator", "stdin"),
    *("SIGINT", "static_assert", "restrict", "template", "this", "thread_local", "true", "xor_eq"),
    *("uint64_t", "wchar_t", "typeof_unqual", "_Bool", "__LINE__", "bool", "divide", "step", "now"),
)
MACROS = ("SEEK_SET", "EXIT_SUCCESS", "INT8_MAX", "UINT_LEAST8_MAX", "FLT_MAX", "GATE_MONITOR_H")
HEADERS = (
    *("assert", "complex", "ctype", "errno", "fenv", "float", "inttypes", "iso646", "limits"),
    *("locale", "math", "setjmp", "signal", "stdarg", "stdbool", "stddef", "stdint", "stdio"),
    *("stdlib", "string", "time", "wchar", "wctype"),
)
"""Headers of C99 that C++ has too."""


def name_features(words):
    """Return the gate with a Boolean feature of each name, which the first guard reads."""
    features = [
        f'    Property p{number} "{word}"\n      -> typed-by bool\n'
        for number, word in enumerate(words)
    ]
    guard = " or ".join(f"'{word}'" for word in words)
    return GATE.replace("level < 9", guard).replace(
        "    StateMachine", f"{''.join(features)}    StateMachine"
    )


def name_constant(word):
    """Return the gate with names of the block and a state that C joins to this constant."""
    block, _, state = word.partition("_")
    return GATE.replace('"Gate"', f'"{block.title()}"').replace('"A"', f'"{state.title()}"')


@pytest.mark.skipif(COMPILER is None, reason="no C compiler is installed")
@pytest.mark.parametrize("standard", ["-std=c99 -Wpedantic", "-std=gnu17", "-x c++"])
def test_words_of_c_and_macros_of_its_headers_are_no_names_of_c(tmp_path, standard):
    if "c++" in standard and not shutil.which("g++"):
        pytest.skip("no C++ compiler is installed")
    sources = []
    for text in (name_features(WORDS), *map(name_constant, MACROS)):
        _, files, _ = refine_and_emit(BACKEND, text)
        folder = tmp_path / str(len(sources))
        folder.mkdir()
        for path, file in files.items():
            (folder / path.rpartition("/")[2]).write_text(file.text)
        (source,) = folder.glob("*.c")
        source.write_text(
            "".join(f"#include <{name}.h>\n" for name in HEADERS) + source.read_text()
        )
        sources.append(str(source))
    flags = ["-Wall", "-Werror", "-fsyntax-only", *standard.split()]
    subprocess.run([COMPILER, *flags, *sources], check=True)


def test_a_contract_that_no_finite_run_breaks_has_no_monitor():
    text = contract_checks.ASSUMES.read_page().right
    compilation = compile_texts({"gate.sysml": text}, emit=["monitor"])
    files = [artefact.path for artefact in compilation.artefacts]
    diagnostics = compilation.diagnostics
    (finding,) = [item for item in diagnostics if item.rule.code == "SM579"]
    assert finding.message == (
        "the contract of 'Plant::Gate.requirements' has no monitor: no finite run breaks it"
    )
    assert {path.rpartition("/")[2] for path in files} == {
        "gate_monitor.c",
        "gate_monitor.h",
        "gate_monitor.py",
    }
