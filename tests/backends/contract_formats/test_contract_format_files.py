"""The back ends gr1c, slugs, tlsf, smv, chase and spot write files that sysmlc reads."""

import pytest
import spot

from backend_runs import refine_and_emit
from machine_samples import arrow, machine
from sysmlc import compile_texts
from sysmlc.backends.contract_formats import NOT_EXPRESSIBLE
from sysmlc.diagnostics import Sink
from sysmlc.driver.registry import load_backends
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract

GATE = machine(arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"))
ENDINGS = {
    "gr1c": [".spc"],
    "slugs": [".slugsin", ".structuredslugs"],
    "tlsf": [".tlsf"],
    "smv": [".smv"],
    "chase": [".chase.json", ".chase.ltl"],
    "spot": [".spot.ltl", ".spot.part"],
}


def emit(text, name):
    (backend,) = load_backends([name])
    return refine_and_emit(backend, text)


@pytest.mark.parametrize("name", ENDINGS)
def test_the_files_for_each_tool_are_read_without_diagnostics(name):
    graph, files, diagnostics = emit(GATE, name)
    assert not any(diagnostic.rule is NOT_EXPRESSIBLE for diagnostic in diagnostics)
    assert list(files) == [f"contracts/Plant.Gate{ending}" for ending in ENDINGS[name]]
    for path, file in files.items():
        if path.endswith((".spot.part", ".spot.ltl")):
            continue
        reader_sink = Sink()
        assert len(formats.read(file.text, path, reader_sink)) == 1
        assert [diagnostic.message for diagnostic in reader_sink] == []
        assert set(file.trace) >= {graph.derived(Contract)[0].origin}


def test_spot_gets_a_formula_and_the_owners_of_its_variables():
    _, files, _ = emit(GATE, "spot")
    formula = files["contracts/Plant.Gate.spot.ltl"].text
    partition = files["contracts/Plant.Gate.spot.part"].text
    names = {word for line in partition.splitlines() for word in line.split()[1:]}
    propositions = spot.atomic_prop_collect(spot.formula(formula))
    assert names >= {str(proposition) for proposition in propositions}
    assert [line.split()[0] for line in partition.splitlines()] == [".inputs", ".outputs"]


@pytest.mark.parametrize(("name", "count"), [("gr1c", 1), ("slugs", 2), ("tlsf", 0), ("spot", 0)])
def test_an_inexpressible_constraint_is_reported(name, count):
    text = NOT_EXPRESSIBLE.read_page().wrong
    compilation = compile_texts({"lamp.sysml": text}, emit=[name])
    reported = [item for item in compilation.diagnostics if item.rule is NOT_EXPRESSIBLE]
    assert [item.subject.name for item in reported] == ["Plant::Lit::<Constraint>"] * count
    prefix = "contracts/Plant.Lamp.requirements"
    files = [item.path for item in compilation.artefacts if item.path.startswith(prefix)]
    assert len(files) == (len(ENDINGS[name]) if not count else 0)
    assert all("F G state=on" in diagnostic.message for diagnostic in reported)


def test_the_same_model_gives_the_same_bytes():
    first, second = (emit(GATE, "tlsf")[1] for _ in range(2))
    assert first == second
