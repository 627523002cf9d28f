"""Before and after: each structural pass on a small model, in IR text, and twice equals once."""

import pytest
from pass_runs import (
    STRUCTURAL,
    list_diagnostics,
    print_after_second_run,
    print_before,
    read_models,
    run_until,
)

from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify

MODELS = read_models()


@pytest.mark.parametrize("name", MODELS)
def test_model_before_and_after_the_pass(name, golden):
    pass_name = name.partition("-")[0]
    graph, sink = run_until(MODELS[name], pass_name)
    found = "".join(f"{line}\n" for line in list_diagnostics(sink))
    notes = "".join(f"  {note}\n" for one in sink for note in one.notes)
    golden.check(
        f"passes/{name}",
        {
            "before.ir": print_before(MODELS[name], pass_name),
            "after.ir": print_text(graph),
            "found.txt": found + notes,
        },
    )


@pytest.mark.parametrize("pass_name", STRUCTURAL)
@pytest.mark.parametrize("name", MODELS)
def test_twice_equals_once_and_the_graph_stays_valid(name, pass_name):
    graph, _ = run_until(MODELS[name], pass_name)
    assert verify(graph) == []
    once = print_text(graph)
    assert print_after_second_run(graph, pass_name) == once
    assert print_text(parse_text(once)) == once
