"""What a compilation notes for parts that are done again."""

from pathlib import Path

import pytest

from sysmlc import resources
from sysmlc.cache import Cache
from sysmlc.driver import Compilation, Request, compile_model, load_backends, registry
from sysmlc.ir.rows import rows
from sysmlc.language import library

EXAMPLES = Path(__file__).parents[2] / "examples"
UNITS = sorted({path.parent for path in EXAMPLES.rglob("*.sysml")})


class Late:
    """A pass behind those that only derive values, which does something to the graph."""

    name, after = "late", ()

    def __init__(self, act):
        self._act = act

    def run(self, graph, _sink):
        self._act(graph)


@pytest.fixture
def compiled(tmp_path, monkeypatch):
    monkeypatch.setenv(library.VARIABLE, str(resources.path("metamodels", "core")))
    backends = tuple(load_backends(["contracts", "plantuml", "recipe"]))

    def run(unit: Path, *late: Late) -> Compilation:
        passes = (*registry.passes({}), *late)
        return compile_model(
            Request((unit,), backends=backends, cache=Cache(tmp_path), passes=passes)
        )

    return run


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.name)
def test_the_graph_at_the_end_is_the_one_that_was_noted(unit, compiled):
    made = compiled(unit)
    noted = made.recorded()
    assert noted is None or noted.graph == rows(made.graph)


def test_nothing_is_noted_where_a_later_pass_changed_the_graph(compiled):
    unit = EXAMPLES / "lego-recipe-v2"
    assert compiled(unit, Late(lambda graph: None)).recorded() is not None
    first = Late(lambda graph: graph.rename(next(iter(graph)), "Other"))
    assert compiled(unit, first).recorded() is None
