"""Whole models at random, as Papyrus would save them."""

from random import Random

from dialects.papyrus import PapyrusDocument
from dialects.random_behaviour import Behaviours
from dialects.random_interactions import Interactions
from dialects.random_rarities import Rarities
from dialects.random_structure import PLANT, Structure
from dialects.random_sysml import Meanings
from dialects.random_wider import Wider


def random_model(random: Random, size: int = 3) -> bytes:
    """A model of about ``size`` machines; the same choices give the same bytes."""
    document = PapyrusDocument("Random plant", profiles={"Plant": PLANT})
    structure = Structure(document, random, size)
    Behaviours(structure)
    Rarities(structure)
    Interactions(structure)
    Wider(structure)
    Meanings(structure)
    document.apply_sysml()
    return document.bytes()
