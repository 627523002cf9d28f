"""Names of metaclasses and features: from those of the graph to those of UML 2.5.1."""

import re
from functools import cache

_LETTER = re.compile(r"[-_](\w)")
_BOOLEANS = """Abstract Active Assured Behavior CombineDuplicate Composite Conjugated Control
    ControlType Covering Derived DerivedUnion DestroyDuplicates DestroyLinks DestroyOwnedObjects
    Determinate Dimension Direct Disjoint Exception External FinalSpecialization ID
    IndirectlyInstantiated Leaf LocallyReentrant Multicast Multireceive Ordered Orthogonal Query
    ReadOnly Reentrant Relative RemoveDuplicates ReplaceAll Required Service Simple
    SingleExecution Static Stream Strict Substitutable Synchronous TestedFirst Unique
    Unmarshall"""
_FLAGS = {
    re.sub(r"(?<=[a-z0-9])([A-Z])", r"_\1", name).lower(): f"is{name}" for name in _BOOLEANS.split()
}
_RENAMED = _FLAGS | {"readonly": "isReadOnly", "uri": "URI", "u_r_i": "URI"}
_KEPT_NAMES = """
    activity aggregation alias allowSubstitutable concurrency context decider decisionInput
    decisionInputFlow decomposedAs definingEnd effect ordering bodyOutput bodyPart
    changeExpression classifierBehavior condition conveyed deploymentLocation direction end
    exceptionInput exceptionType executionLocation extendedSignature extension fileName
    firstEvent fromAction handlerBody implementingClassifier incoming inputElement insertAt
    inState interruptingEdge interrupts isolated language loopVariable loopVariableInput mapping
    messageKind mode mustIsolate newClassifier oldClassifier onPort outputElement
    parameterSet port predecessorClause successorClause protocol qualifiedName regionAsInput
    regionAsOutput result selection setting setupPart stateInvariant substitutingClassifier test
    transformation transition unmarshallType URI useCase viewpoint replyToCall
    returnInformation instance visibility metamodelReference metaclassReference lower upper
    contract representation symbol priority isSubmachineState selector joinSpec location
    format content target sort value"""
_KEPT = frozenset(_KEPT_NAMES.split())
"""Attributes and references of UML that the graph keeps under their own names."""


@cache
def camel(name: str) -> str:
    """``hyphenated-name`` or ``snake_name`` as ``camelCase``."""
    return _LETTER.sub(lambda found: found[1].upper(), name)


@cache
def capital(name: str) -> str:
    """``hyphenated-name`` as ``CamelCase``."""
    found = camel(name)
    return found[:1].upper() + found[1:]


@cache
def feature_of(attribute: str) -> str:
    """The UML feature that an attribute of the graph is kept of, or the empty string."""
    if attribute in _RENAMED:
        return _RENAMED[attribute]
    found = camel(attribute)
    return found if found in _KEPT else ""
