"""Random interactions and use cases are drawn completely, and PlantUML renders each drawing."""

from random import Random

import pytest

from dialects.papyrus import PapyrusDocument
from dialects.random_interactions import Interactions
from dialects.random_rare_constructs import RareConstructs
from dialects.random_structure import PLANT, Structure
from examples.compiling import compile_text

SEEDS = range(24)
DRAWING_SUFFIXES = (".sd.puml", ".uc.puml")
DRAWN_KINDS = ("Message", "Fragment", "Operand", "Lifeline", "Interaction", "UseCase", "Extend")


def compile_scenarios(folder, seed):
    document = PapyrusDocument("Scenarios", profiles={"Plant": PLANT})
    structure = Structure(document, Random(seed), 1)
    Interactions(structure)
    Interactions(structure)
    RareConstructs(structure)
    return compile_text(folder, "model.uml", document.as_bytes(), "plantuml")


def list_drawings(compilation):
    return {
        drawing.path: drawing.text
        for drawing in compilation.list_published()
        if drawing.path.endswith(DRAWING_SUFFIXES)
    }


@pytest.mark.parametrize("seed", SEEDS)
def test_every_part_of_an_interaction_is_drawn(seed, tmp_path):
    compilation = compile_scenarios(tmp_path, seed)
    omissions = [d.message for d in compilation.diagnostics if d.rule.code == "SM701"]
    assert [message for message in omissions if any(word in message for word in DRAWN_KINDS)] == []
    for interaction in compilation.graph.of_kind("Interaction"):
        (drawing,) = [a for a in compilation.artefacts if a.trace[:1] == (interaction.id,)]
        messages = [e.id for e in compilation.graph.subtree(interaction) if e.kind == "Message"]
        assert set(messages) <= set(drawing.trace)


@pytest.mark.long
@pytest.mark.plantuml
def test_plantuml_renders_every_drawing(tmp_path, plantuml):
    drawings = {
        f"{seed}/{path}": text
        for seed in SEEDS
        for path, text in list_drawings(compile_scenarios(tmp_path, seed)).items()
    }
    assert len(drawings) > len(SEEDS)
    assert plantuml.render(drawings).keys() == drawings.keys()
