"""Random models, as Papyrus would save them."""

from random import Random

from dialects.papyrus import PapyrusDocument
from dialects.random_behaviour import Behaviours
from dialects.random_interactions import Interactions
from dialects.random_rare_constructs import RareConstructs
from dialects.random_structure import PLANT, Structure
from dialects.random_sysml_stereotypes import SysmlStereotypes
from dialects.random_uml_extras import UmlExtras


def random_model(random: Random, size: int = 3) -> bytes:
    """Return a model of about *size* machines; the same choices give the same bytes."""
    document = PapyrusDocument("Random plant", profiles={"Plant": PLANT})
    structure = Structure(document, random, size)
    Behaviours(structure)
    RareConstructs(structure)
    Interactions(structure)
    UmlExtras(structure)
    SysmlStereotypes(structure)
    document.apply_sysml()
    return document.as_bytes()
