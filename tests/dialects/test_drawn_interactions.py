"""Random interactions and use cases are drawn whole, and real PlantUML renders every one."""

from random import Random

import pytest

from dialects.papyrus import PapyrusDocument
from dialects.random_interactions import Interactions
from dialects.random_rarities import Rarities
from dialects.random_structure import PLANT, Structure
from examples.compiling import compile_text

SEEDS = range(24)
DRAWN = (".sd.puml", ".uc.puml")
WORDS = ("Message", "Fragment", "Operand", "Lifeline", "Interaction", "UseCase", "Extend")


def compiled(folder, seed):
    document = PapyrusDocument("Scenarios", profiles={"Plant": PLANT})
    structure = Structure(document, Random(seed), 1)
    Interactions(structure)
    Interactions(structure)
    Rarities(structure)
    return compile_text(folder, "model.uml", document.bytes(), "plantuml")


def texts(compilation):
    return {a.path: a.text for a in compilation.list_published() if a.path.endswith(DRAWN)}


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_of_an_interaction_is_left_out(seed, tmp_path):
    compilation = compiled(tmp_path, seed)
    missing = [d.message for d in compilation.diagnostics if d.rule.code == "SM701"]
    assert [message for message in missing if any(word in message for word in WORDS)] == []
    for interaction in compilation.graph.of_kind("Interaction"):
        (drawn,) = [a for a in compilation.artefacts if a.trace[:1] == (interaction.id,)]
        inside = [e.id for e in compilation.graph.subtree(interaction) if e.kind == "Message"]
        assert set(inside) <= set(drawn.trace)


@pytest.mark.long
@pytest.mark.plantuml
def test_real_plantuml_renders_them(tmp_path, plantuml):
    made = {
        f"{seed}/{path}": text
        for seed in SEEDS
        for path, text in texts(compiled(tmp_path, seed)).items()
    }
    assert len(made) > len(SEEDS)
    assert plantuml.render(made).keys() == made.keys()
