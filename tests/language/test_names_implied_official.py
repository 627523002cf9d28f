"""Implied specialisations, as the release of the standard library states them in its files.

Facts of `sysml.library.xmi.implied` (relationships with `isImplied`, but for type featurings and
for those of literals and multiplicities), read by hand: that folder is not in the corpus.
"""

import pytest
from official_models import LIBRARY_FOLDER, load_standard_library
from small_models import list_implied_relations

from sysmlc.diagnostics import Sink
from sysmlc.language.names import resolve
from sysmlc.language.text import parse

pytestmark = pytest.mark.corpus

THINGS = "Subsetting Base::things"
OCCURRENCES = "Subsetting Occurrences::occurrences"
FACTS = {
    "Systems Library/Calculations.sysml": {
        "Calculations::Calculation": [],
        "Calculations::Calculation::self": ["Subsetting Calculations::calculations"],
        "Calculations::Calculation::subcalculations": [],
        "Calculations::calculations": [],
    },
    "Systems Library/Constraints.sysml": {
        "Constraints::ConstraintCheck": [],
        "Constraints::ConstraintCheck::self": [
            "Subsetting Constraints::constraintChecks",
            "Subsetting Performances::Performance::enclosedPerformances",
        ],
        "Constraints::constraintChecks": [],
        "Constraints::assertedConstraintChecks": [],
        "Constraints::negatedConstraintChecks": [],
    },
    "Systems Library/UseCases.sysml": {
        "UseCases::UseCase": [],
        "UseCases::UseCase::self": ["Subsetting UseCases::useCases"],
        "UseCases::UseCase::subj": [],
        "UseCases::UseCase::obj": [],
        "UseCases::UseCase::start": ["Subsetting UseCases::useCases"],
        "UseCases::UseCase::done": ["Subsetting UseCases::useCases"],
    },
    "Systems Library/Interfaces.sysml": {
        "Interfaces::excludingOnce::seq": [THINGS],
        "Interfaces::excludingOnce::value": [],
        "Interfaces::Interface::participant": ["Subsetting Parts::Part::ownedPorts"],
        "Interfaces::BinaryInterface": [],
        "Interfaces::BinaryInterface::participant": [],
        "Interfaces::BinaryInterface::source": ["Subsetting Parts::Part::ownedPorts"],
        "Interfaces::BinaryInterface::target": ["Subsetting Parts::Part::ownedPorts"],
    },
    "Systems Library/Ports.sysml": {
        "Ports::Port::subports": ["Subsetting Objects::Object::subobjects"],
        "Ports::Port::interfacingPorts": [],
        "Ports::Port::outgoingTransfersFromSelf": [],
        "Ports::Port::outgoingTransfersFromSelf::source": [
            "Redefinition Occurrences::Occurrence::incomingTransfersToSelf::source",
            "Redefinition Occurrences::Occurrence::outgoingTransfersFromSelf::source",
        ],
    },
    "Domain Libraries/Cause and Effect/CausationConnections.sysml": {
        "CausationConnections::causes": [OCCURRENCES],
        "CausationConnections::effects": [OCCURRENCES],
        "CausationConnections::Multicausation::causes": [],
    },
}


@pytest.mark.parametrize("path", sorted(FACTS))
def test_implied_specialisations_are_those_of_the_release(path):
    text = (LIBRARY_FOLDER / path).read_text(encoding="utf-8")
    model = resolve([parse(text, path, "sysml", Sink())], load_standard_library(), Sink())
    relations = {name: sorted(list_implied_relations(model, name)) for name in FACTS[path]}
    assert relations == FACTS[path]


@pytest.mark.long
def test_29_elements_with_15_relations_are_compared():
    elements = [relations for facts in FACTS.values() for relations in facts.values()]
    assert (len(elements), sum(map(len, elements))) == (29, 15)
