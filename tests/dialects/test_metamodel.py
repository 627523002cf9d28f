"""What we wrote in Papyrus's dialect is UML: uml.ecore of the corpus has no complaint."""

import os
from pathlib import Path
from random import Random

import pytest

from dialects.metamodel import Metamodel
from dialects.random_models import random_model
from examples.compiling import EXAMPLES

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def metamodel():
    corpus = os.environ.get("SYSMLC_CORPUS")
    if not corpus:
        pytest.skip("SYSMLC_CORPUS is not set")
    return Metamodel(Path(corpus) / "xmi" / "metamodel" / "uml.ecore")


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_is_uml(model, metamodel):
    assert metamodel.complaints(model.read_bytes()) == []


@pytest.mark.parametrize("seed", range(20))
def test_a_random_model_is_uml(seed, metamodel):
    assert metamodel.complaints(random_model(Random(seed))) == []


def test_the_metamodel_does_complain(metamodel):
    wrong = EXAMPLES[0].read_bytes().replace(b'"uml:StateMachine"', b'"uml:Signal"')
    assert "Signal has no feature region" in metamodel.complaints(wrong)
