"""The back end ``monitor``: monitors in C99 and Python agree with the contract.

The runs come from the reference interpreter; in most of them one value is changed.
"""

import math
import random
import shutil
import subprocess
import sys
from fractions import Fraction

import pytest
from msgspec.structs import replace

from backend_runs import emit, refine_and_emit
from machine_samples import arrow, machine
from sysmlc import compile_texts
from sysmlc.backends.monitor import BACKEND
from sysmlc.controllers.monitor import build_monitor, find_first_violation
from sysmlc.diagnostics import Sink
from sysmlc.logic import domains
from sysmlc.logic.contract import Class, Conjunct, Contract, EnumerationDomain, Owner, Variable
from sysmlc.logic.formula import eq, var
from sysmlc.logic.machines import interpreter
from sysmlc.logic.machines.reader import read_machine
from sysmlc.logic.regions import LINE, Cut, Interval, Regions, split_line
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


def run_c(files, runs, folder):
    """Return the same by the monitor in C."""
    for path, text in files.items():
        (folder / path.rpartition("/")[2]).write_text(text)
    steps = ",\n".join(print_step(step) for run in runs for step in run)
    text = MAIN.format(steps=steps, length=len(runs[0]), runs=len(runs))
    (folder / "main.c").write_text(text)
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    sources = [str(path) for path in sorted(folder.glob("*.c"))]
    subprocess.run([COMPILER, *flags, *sources, "-o", str(folder / "main")], check=True)
    result = subprocess.run([folder / "main"], check=True, capture_output=True, text=True)
    pairs = [tuple(map(int, line.split())) for line in result.stdout.splitlines()]
    return [None if broken < 0 else (broken, step) for broken, step in pairs]


def print_step(step):
    """Return the values of a step as an initialiser of ``gate_values``."""
    return f"{{ {', '.join(f'.{name} = {print_value(step[name])}' for name in step)} }}"


def print_value(value):
    """Return a value of Python in C."""
    if isinstance(value, str):
        return f"GATE_{value}".upper()
    if not isinstance(value, float):
        return str(int(value))
    if math.isnan(value):
        return "NAN"
    return value.hex() if math.isfinite(value) else f"{'-' if value < 0 else ''}INFINITY"


MAIN = """
#include <math.h>
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
    assert run_c(c_files, runs, tmp_path) == run_contract(graph, runs)


# -- numbers -----------------------------------------------------------------------------------


def make_number(name, cuts, limits=LINE, term=(), is_integral=False):
    """Return a variable that is the region of a number, and an output with the same literals."""
    intervals = split_line([Cut(Fraction(number), above) for number, above in cuts], limits)
    regions = Regions(intervals, "K" if name == "temp" else "", is_integral)
    literals = tuple(f"{name}_{index}" for index in range(len(intervals)))
    own = tuple((key, Fraction(factor)) for key, factor in term or [(name, 1)])
    domain = EnumerationDomain(literals, regions=regions)
    return (
        Variable(name, Owner.ENVIRONMENT, domain, term=own),
        Variable(f"shown_{name}", Owner.SYSTEM, EnumerationDomain(literals)),
    )


BELOW, ABOVE = False, True
HUGE, LAST = 10**400, sys.float_info.max
NUMBERS = (
    make_number("temp", [("0.1", BELOW), (5, BELOW), (5, ABOVE)]),
    make_number("level", [(50, ABOVE)], limits=Interval(Cut(Fraction(0)), Cut(Fraction(100)))),
    make_number("huge", [(-HUGE, ABOVE), (HUGE, BELOW)]),
    make_number("gap", [("0.5", ABOVE)], term=[("a", 1), ("temp", "-5/2")]),
    make_number("count", [(-3, BELOW), (10**10, BELOW)], is_integral=True),
)
"""Numbers, each with an output that the system sets to the region of the number."""


def find_regions(row):
    """Return the indices of the regions of a row: how many cuts are below each number."""
    temp, level, huge, count = row["temp"], row["level"], row["huge"], row["count"]
    gap = row["a"] - 2.5 * temp
    return (
        sum([temp >= 0.1, temp >= 5, temp > 5]) if temp == temp else None,
        int(level > 50) if 0 <= level < 100 else None,
        # Beyond all doubles, the nearest one is the last one.
        sum([huge > -LAST, huge >= LAST]) if huge == huge else None,
        int(gap > 0.5) if gap == gap else None,
        sum([count >= -3, count >= 10**10]),
    )


def draw_rows(number, source):
    """Return rows of values near cuts and special ones; some outputs are wrong."""
    cuts = [0.1, 5.0, 50.0, 100.0, 0.5, 12.5, 0.75]
    reals = [math.nan, math.inf, -math.inf, 0.0, -0.0, 5e-324, LAST, -LAST, *cuts]
    reals += [math.nextafter(cut, end) for cut in cuts for end in (math.inf, -math.inf)]
    counts = [-4, -3, -2, 0, 10**10 - 1, 10**10, 2**53 + 1, 2**63 - 1, -(2**63) + 1]
    for _ in range(number):
        # Most rows have few special values, because the first one may end the run.
        row = {name: source.uniform(0, 60) for name in ("temp", "level", "huge", "a")}
        row |= {name: source.choice(reals) for name in source.sample(sorted(row), 2)}
        row["count"] = source.choice(counts)
        for (_, shown), index in zip(NUMBERS, find_regions(row), strict=True):
            literals = shown.domain.literals
            is_right = index is not None and source.randrange(20)
            row[shown.name] = literals[index] if is_right else source.choice(literals)
        yield row


def find_broken(row):
    """Return the expected check: a number without a region, or an output that is not the region."""
    regions = find_regions(row)
    if None in regions:
        return regions.index(None), 1
    for number, ((_, shown), index) in enumerate(zip(NUMBERS, regions, strict=True)):
        if row[shown.name] != shown.domain.literals[index]:
            return len(NUMBERS) + number, 1
    return None


@pytest.fixture(scope="module")
def number_files():
    """The files of a monitor with ``NUMBERS``."""
    graph, _, _ = refine_and_emit(BACKEND, GATE)
    (contract,) = graph.derived(Contract)
    guarantees = tuple(
        Conjunct(eq(var(shown.name), var(number.name)), Class.SAFETY, "")
        for number, shown in NUMBERS
    )
    variables = tuple(variable for pair in NUMBERS for variable in pair)
    graph.store(Contract, [replace(contract, variables=variables, guarantees=guarantees)])
    return {path: file.text for path, file in emit(BACKEND, graph)[0].items()}


@pytest.mark.skipif(COMPILER is None, reason="no C compiler is installed")
def test_numbers_have_the_same_regions_in_c_and_in_python(number_files, tmp_path):
    rows = list(draw_rows(1_000, random.Random(32)))
    expected = [find_broken(row) for row in rows]
    runs = [[row] for row in rows]
    assert run_python(number_files["monitors/gate_monitor.py"], runs) == expected
    c_files = {path: text for path, text in number_files.items() if not path.endswith(".py")}
    assert run_c(c_files, runs, tmp_path) == expected
    assert len(set(expected)) == 2 * len(NUMBERS)


def test_floors_name_regions_from_the_top_and_gaps_between_them():
    regions = Regions((Interval(None, Cut(0)), Interval(Cut(3), Cut(3, ABOVE))))
    floors = [(Cut(3, ABOVE), None), (Cut(3), 1), (Cut(0), None), (None, 0)]
    assert list(regions.list_floors()) == floors
    assert list(Regions((LINE,)).list_floors()) == [(None, 0)]


def test_exact_numbers_are_compared_exactly(number_files):
    row = {"temp": 1, "level": 1, "huge": 1, "a": 0, "count": 1}
    row |= {shown.name: f"{number.name}_0" for number, shown in NUMBERS}
    row |= {"shown_huge": "huge_1", "shown_count": "count_1"}
    tenth = Fraction(1, 10)
    values = [tenth, tenth - Fraction(1, 10**30), 0.1, Fraction(0.1), math.nextafter(0.1, 0)]
    runs = [[row | {"temp": value, "shown_temp": "temp_1"}] for value in values]
    results = run_python(number_files["monitors/gate_monitor.py"], runs)
    assert [result is None for result in results] == [True, False, True, True, False]


HEATER = """
package Plant {
    private import ScalarValues::*;
    private import SI::*;
    part def Heater {
        in attribute temp : ISQ::ThermodynamicTemperatureValue;
        in attribute inside : ISQ::LengthValue;
        in attribute outside : ISQ::LengthValue;
        in attribute fill : Real;
        assert constraint { fill >= 0 and fill <= 100 }
        exhibit state S {
            entry; then Cold;
            state Cold;
            state Hot;
            transition first Cold if temp >= 20 ['°C_abs'] and inside < 200 [cm] then Hot;
            transition first Hot if inside > outside and fill < 50 then Cold;
        }
    }
}
"""


def test_numbers_have_units_and_checks():
    compilation = compile_texts({"heater.sysml": HEATER}, emit=["monitor"])
    files = {file.path.rpartition("/")[2]: file.text for file in compilation.artefacts}
    header = files["heater_monitor.h"]
    assert [line for line in header.splitlines() if "double " in line and ";" in line] == [
        "    double temp; /* temp in K: temp < 20 °C, temp >= 20 °C */",
        "    double inside; /* inside in m: inside < 200 cm, inside >= 200 cm */",
        "    double fill; /* fill: 0 <= fill < 50, 50 <= fill <= 100 */",
        "    double outside; /* outside in m: for inside - outside */",
    ]
    assert '#define HEATER_TEMP_UNIT "K"\n#define HEATER_INSIDE_UNIT "m"\n' in header
    assert "number >= 293.15)" in files["heater_monitor.c"]
    names = {}
    exec(files["heater_monitor.py"], names)
    assert [text for side, text, *_ in names["CHECKS"] if side == "assumption"] == [
        "'temp' has a value in each step.",
        "'inside' has a value in each step.",
        "'fill' has a value in each step: 0 <= fill <= 100.",
        "'inside - outside' has a value in each step.",
    ]
    formulas = [formula for _, _, formula, _ in names["CHECKS"]]
    assert "G (state=Cold & temp >= 20 °C & inside < 200 cm -> state'=Hot)" in formulas
    assert "G (state=Hot & inside > outside & fill < 50 -> state'=Cold)" in formulas


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
