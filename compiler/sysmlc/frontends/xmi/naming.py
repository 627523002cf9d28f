"""Tables: the features of UML that name elements, whatever becomes of them."""

import re

from sysmlc.frontends.xmi.vocabulary import FOLDED_REFERENCES, REDUNDANT, REFERENCES

SAID_ELSEWHERE = REDUNDANT | {
    "abstraction",
    "associationEnd",
    "datatype",
    "definingEnd",
    "deployedElement",
    "deployment",
    "enumeration",
    "featuringClassifier",
    "generalizationSet",
    "implementingClassifier",
    "importedMember",
    "inActivity",
    "inheritedMember",
    "inheritedParameter",
    "interface",
    "interruptingEdge",
    "metaclass",
    "namespace",
    "nestedPackage",
    "nestingPackage",
    "opposite",
    "owningAssociation",
    "owningInstance",
    "package",
    "part",
    "predecessorClause",
    "profile",
    "protectedNode",
    "redefinedElement",
    "subgroup",
    "submachineState",
    "substitutingClassifier",
    "successorClause",
    "superClass",
    "superGroup",
    "superPartition",
}
"""``REDUNDANT``, and what is kept though another feature says it (UML 2.5.1: opposite, derived)."""

KEPT_REFERENCES = frozenset(
    {
        "bodyOutput",
        "bodyPart",
        "connector",
        "constrainingClassifier",
        "decider",
        "decisionInput",
        "decisionInputFlow",
        "decomposedAs",
        "destroyAt",
        "end",
        "extendedSignature",
        "inState",
        "inputElement",
        "insertAt",
        "instance",
        "interrupts",
        "newClassifier",
        "observation",
        "oldClassifier",
        "onPort",
        "outputElement",
        "port",
        "protocol",
        "raisedException",
        "redefinedInterface",
        "reducer",
        "regionAsInput",
        "regionAsOutput",
        "replyToCall",
        "representation",
        "returnValueRecipient",
        "selection",
        "setupPart",
        "test",
        "transformation",
    }
)
"""References of UML 2.5.1 that no table makes an edge: the graph has ids in an attribute."""

NAMING = frozenset(REFERENCES) | frozenset(FOLDED_REFERENCES) | SAID_ELSEWHERE | KEPT_REFERENCES
"""Features that name elements, whatever becomes of them."""

ASKED_LATER = frozenset(
    {
        "connector",
        "decision_input",
        "decision_input_flow",
        "defining_end",
        "interrupts",
        "on_port",
        "port",
        "raised_exception",
        "test",
        "body_part",
        "setup_part",
    }
)
"""Kept ids that the pass ``resolve`` looks for itself, and reports."""

ATTRIBUTES = frozenset(
    {
        "URI",
        "aggregation",
        "alias",
        "allowSubstitutable",
        "body",
        "concurrency",
        "content",
        "default",
        "deploymentLocation",
        "direction",
        "effect",
        "executionLocation",
        "fileName",
        "firstEvent",
        "format",
        "interactionOperator",
        "kind",
        "language",
        "location",
        "lower",
        "messageKind",
        "messageSort",
        "mode",
        "mustIsolate",
        "name",
        "ordering",
        "qualifiedName",
        "setting",
        "symbol",
        "upper",
        "value",
        "viewpoint",
        "visibility",
    }
)
"""Features of UML 2.5.1 that have values; truth values have names as ``isAbstract``."""

_FLAG = re.compile(r"is[A-Z]")


def is_known(feature: str) -> bool:
    """Whether UML has a feature of this name."""
    return feature in ATTRIBUTES or feature in NAMING or _FLAG.match(feature) is not None
