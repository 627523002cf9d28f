"""The back ends gr1c, slugs, tlsf, smv, chase and spot: their files can be read again."""

import pytest
import spot

from machine_samples import arrow, machine
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.forms import NOT_EXPRESSIBLE
from sysmlc.diagnostics import Sink
from sysmlc.driver.registry import load_backends
from sysmlc.ir.text import parse_text
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.passes import pipeline
from sysmlc.support.output import Output

GATE = machine(arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"))
ENDINGS = {
    "gr1c": [".spc"],
    "slugs": [".slugsin", ".structuredslugs"],
    "tlsf": [".tlsf"],
    "smv": [".smv"],
    "chase": [".chase.json", ".chase.ltl"],
    "spot": [".spot.ltl", ".spot.part"],
}


def emitted(text, name):
    graph, sink, output = parse_text(text), Sink(), Output()
    pipeline.run(graph, sink, verify_each=True)
    (backend,) = load_backends([name])
    backend.emit(graph, output, sink, EmitOptions())
    return graph, {one.path: one for one in output.artefacts()}, sink


@pytest.mark.parametrize("name", ENDINGS)
def test_every_tool_gets_files_that_our_readers_understand(name):
    graph, files, sink = emitted(GATE, name)
    assert [one.rule.code for one in sink if one.rule is NOT_EXPRESSIBLE] == []
    assert list(files) == [f"contracts/Plant.Gate{ending}" for ending in ENDINGS[name]]
    for path, file in files.items():
        if path.endswith((".spot.part", ".spot.ltl")):
            continue
        heard = Sink()
        assert len(formats.read(file.text, path, heard)) == 1
        assert [one.message for one in heard] == []
        assert set(file.trace) >= {graph.derived(Contract)[0].origin}


def test_spot_gets_a_formula_and_who_decides():
    _, files, _ = emitted(GATE, "spot")
    formula = files["contracts/Plant.Gate.spot.ltl"].text
    part = files["contracts/Plant.Gate.spot.part"].text
    named = {word for line in part.splitlines() for word in line.split()[1:]}
    assert named >= {str(one) for one in spot.atomic_prop_collect(spot.formula(formula))}
    assert [line.split()[0] for line in part.splitlines()] == [".inputs", ".outputs"]


@pytest.mark.parametrize(("name", "count"), [("gr1c", 1), ("slugs", 2), ("tlsf", 0), ("spot", 0)])
def test_what_a_tool_has_no_words_for_is_told_at_the_constraint(name, count):
    _graph, files, sink = emitted(NOT_EXPRESSIBLE.read_page().wrong, name)
    told = [one for one in sink if one.rule is NOT_EXPRESSIBLE]
    assert [one.subject.name for one in told] == ["Lamp::Lit"] * count
    assert len(files) == (len(ENDINGS[name]) if not count else 0)
    assert all("F G state=On" in one.message for one in told)


def test_the_same_model_gives_the_same_bytes():
    first, second = (emitted(GATE, "tlsf")[1] for _ in range(2))
    assert {p: f.text for p, f in first.items()} == {p: f.text for p, f in second.items()}
