"""Before and after: each structural pass on a small model, in IR text, and twice equals once."""

import pytest
from passing import STRUCTURAL, again, before, lines, models, refined

from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify

MODELS = models()


@pytest.mark.parametrize("name", MODELS)
def test_model_before_and_after_the_pass(name, golden):
    pass_name = name.partition("-")[0]
    graph, sink = refined(MODELS[name], pass_name)
    found = "".join(f"{line}\n" for line in lines(sink))
    notes = "".join(f"  {note}\n" for one in sink for note in one.notes)
    golden.check(
        f"passes/{name}",
        {
            "before.ir": before(MODELS[name], pass_name),
            "after.ir": print_text(graph),
            "found.txt": found + notes,
        },
    )


@pytest.mark.parametrize("pass_name", STRUCTURAL)
@pytest.mark.parametrize("name", MODELS)
def test_twice_equals_once_and_the_graph_stays_valid(name, pass_name):
    graph, _ = refined(MODELS[name], pass_name)
    assert verify(graph) == []
    once = print_text(graph)
    assert again(graph, pass_name) == once
    assert print_text(parse_text(once)) == once
