"""Examples and random models in Papyrus's dialect conform to the metamodel of UML."""

from random import Random

import pytest

from dialects.metamodel import Metamodel
from dialects.random_models import random_model
from examples.compiling import EXAMPLES

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def metamodel(corpus):
    return Metamodel(corpus / "xmi" / "metamodel" / "uml.ecore")


@pytest.mark.parametrize("model", EXAMPLES, ids=lambda path: path.parent.name)
def test_an_example_conforms_to_the_metamodel(model, metamodel):
    assert metamodel.find_violations(model.read_bytes()) == []


@pytest.mark.parametrize("seed", range(20))
def test_a_random_model_conforms_to_the_metamodel(seed, metamodel):
    assert metamodel.find_violations(random_model(Random(seed))) == []


def test_a_feature_that_a_metaclass_lacks_is_a_violation(metamodel):
    wrong = EXAMPLES[0].read_bytes().replace(b'"uml:StateMachine"', b'"uml:Signal"')
    assert "Signal has no feature region" in metamodel.find_violations(wrong)
