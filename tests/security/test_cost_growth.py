"""The cost of hostile models grows at most with the square of their size, without a crash."""

import sys
from functools import cache
from itertools import pairwise
from pathlib import Path

import hostile_families as families
import pytest

from sysmlc.backends import contracts
from sysmlc.backends.plantuml import block_definition
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model, list_backend_names, load_backends, siblings
from sysmlc.ir import parse_text
from sysmlc.language.names import unresolved
from sysmlc.logic.formal_texts import is_formal
from sysmlc.logic.machines import conflicts as conflicts
from sysmlc.passes.behaviours import read_transition_names
from sysmlc.sources import Source
from sysmlc.support.units import find_unit, split_quantity

MAX_GROWTH = 4.5
"""Limit of the factor by which the cost grows when the size is doubled; 4 is quadratic."""
MAX_LINEAR_GROWTH = 2.4
"""Limit of this factor for linear families; each compilation has a fixed part."""


@cache
def load_all_backends():
    return tuple(load_backends(list_backend_names()))


def compile_text(folder: Path, name: str, text: str):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return compile_model(Request((path,), backends=load_all_backends()))


def find_codes(compilation) -> set[str]:
    return {diagnostic.rule.code for diagnostic in compilation.diagnostics}


def count_calls(folder: Path, name: str, text: str) -> int:
    """Compile a model with all back ends; return the number of calls of Python and C functions."""
    calls = 0

    def count(_frame, event, _argument):
        nonlocal calls
        calls += event in ("call", "c_call")

    sys.setprofile(count)
    try:
        compilation = compile_text(folder, name, text)
    finally:
        sys.setprofile(None)
    assert "SM900" not in find_codes(compilation)
    return calls


@pytest.mark.long
@pytest.mark.parametrize("family", families.FAMILIES, ids=lambda family: family.__name__)
def test_the_cost_of_a_family_grows_at_most_with_the_square(family, tmp_path):
    name, size = families.FAMILIES[family]
    compile_text(tmp_path, name, family(size))  # fills the caches of the process
    costs = [count_calls(tmp_path, name, family(size * factor)) for factor in (1, 2, 4)]
    growth = [round(after / before, 2) for before, after in pairwise(costs)]
    print(family.__name__, costs, growth)
    is_linear = family in families.LINEAR_FAMILIES
    assert max(growth) <= (MAX_LINEAR_GROWTH if is_linear else MAX_GROWTH)


def test_guards_are_compared_up_to_a_bound(tmp_path, monkeypatch):
    monkeypatch.setattr(conflicts, "MAX_VALUATIONS", 50_000)
    few_guards = compile_text(tmp_path, "few.sysml", families.guarded_transitions(4))
    assert "SM485" not in find_codes(few_guards)
    many_guards = compile_text(tmp_path, "many.sysml", families.guarded_transitions(8))
    (diagnostic,) = [
        reported for reported in many_guards.diagnostics if reported.rule.code == "SM485"
    ]
    assert diagnostic.message.startswith("the guards of 'm' have too many combinations of values")
    assert diagnostic.subject.name == "P::A::m"


@pytest.mark.long
def test_a_long_chain_of_redefinitions_is_read(tmp_path):
    text = families.redefinitions(1200)
    path = tmp_path / "chain.sysml"
    path.write_text(text)
    compilation = compile_model(Request((path,)))
    assert not find_codes(compilation)


def test_block_diagrams_of_many_packages_take_linear_time(tmp_path):
    calls = dict.fromkeys((100, 200), 0)
    backends = tuple(load_backends(["plantuml"]))
    for size in calls:
        path = tmp_path / f"packages{size}.sysml"
        path.write_text(families.small_packages(size))

        def count(frame, event, _argument, size=size):
            calls[size] += event == "call" and frame.f_code.co_filename == block_definition.__file__

        sys.setprofile(count)
        try:
            compile_model(Request((path,), backends=backends))
        finally:
            sys.setprofile(None)
    assert 0 < calls[200] <= 2.2 * calls[100]


def test_similar_names_are_searched_for_the_first_unknown_names(tmp_path, monkeypatch):
    monkeypatch.setattr(unresolved, "_MAX_SIMILAR_NAMES", 2)
    lines = "\n".join(f"part def Alpha{n}Beta; part p{n} : Alpha{n}Beto;" for n in range(4))
    compilation = compile_text(tmp_path, "names.sysml", f"package P {{ {lines} }}")
    unknown = [found.help for found in compilation.diagnostics if found.rule.code == "SM205"]
    declare = "declare it, import the package that has it, or give its file as an input too"
    assert unknown == [
        "did you mean 'Alpha0Beta'?",
        "did you mean 'Alpha1Beta'?",
        declare,
        declare,
    ]


def test_assignments_in_a_row_do_not_double_the_paths(tmp_path):
    assignments = "assign x := x + 1; " * 40
    text = (
        "package P { part def B { attribute x : ScalarValues::Integer; exhibit state m "
        f"{{ entry; then a; state a {{ entry action {{ {assignments} }} }} }} }} }}"
    )
    compilation = compile_text(tmp_path, "assignments.sysml", text)
    assert not find_codes(compilation) & {"SM430", "SM900"}
    assert "contracts/P.B.contract.json" in {file.path for file in compilation.artefacts}


def test_a_long_chain_of_specialisations_is_checked(tmp_path):
    parts = " ".join(f"part def A{n} :> A{n + 1} {{ attribute x{n}; }}" for n in range(400))
    path = tmp_path / "chain.sysml"
    path.write_text(f"package P {{ {parts} part def A400; }}")
    assert not find_codes(compile_model(Request((path,))))


def test_a_long_chain_of_choices_gets_no_contract(tmp_path):
    links = [("i", "a"), ("a", "c0"), *((f"c{n}", f"c{n + 1}") for n in range(250)), ("c250", "a")]
    lines = [
        'Class cell "Cell" role="block"',
        "  -> classifier-behavior m",
        '  StateMachine m "m"',
        "    Region r",
        '      Pseudostate i subkind="initial"',
        '      State a "A"',
        *(f'      Pseudostate c{n} subkind="choice"' for n in range(251)),
        *(
            f"      Transition t{n}\n        -> flow-source {source}\n"
            f"        -> flow-target {target}"
            for n, (source, target) in enumerate(links)
        ),
    ]
    compilation = compile_text(tmp_path, "choices.ir", "\n".join([*lines, ""]))
    assert "SM430" in find_codes(compilation)
    assert "SM900" not in find_codes(compilation)


def test_a_contract_of_many_parallel_actions_is_not_written(tmp_path, monkeypatch):
    monkeypatch.setattr(contracts, "_MILLION", 10_000)
    actions = " ".join(f"then a{n};" for n in range(40))
    ends = " ".join(f"action a{n}; then j;" for n in range(40))
    text = f"action def A {{ first start then f; fork f; {actions} {ends} join j; then done; }}"
    compilation = compile_text(tmp_path, "fork.sysml", text)
    assert "SM711" in find_codes(compilation)
    assert "contracts/A.contract.json" not in {file.path for file in compilation.artefacts}


def test_texts_of_strangers_are_split_in_linear_time():
    """Each of these texts took minutes with expressions that try every way to divide it."""
    size = 200_000
    assert split_quantity("1 m" + " " * size + "[") is None
    assert find_unit("m" + " " * size + "x") is None
    assert not is_formal("english", "the lamp holds within 1 " + "1" * size + " -")
    word = Source("a.sysml", b"a" * size)
    assert not siblings._find_declared(word)
    text = 'Transition t "' + " " * size + '"\n'
    read_transition_names(parse_text(text), Sink())
