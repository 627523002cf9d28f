"""Random small models of SysML v1 whose names and combinations are unusual but legal in UML."""

from random import Random

from dialects.random_small_behaviour import Behaviours
from dialects.random_small_structure import Draft, Structure


def draw_small_model(random: Random) -> bytes:
    """Return a model of some ten elements as Papyrus saves it."""
    draft = Draft(random)
    Structure(draft)
    Behaviours(draft)
    return draft.document.as_bytes()
