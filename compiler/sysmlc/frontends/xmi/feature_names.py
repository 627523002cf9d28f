"""Tables: the features of UML, above all those that name elements, whatever becomes of them."""

from sysmlc.frontends.xmi.metaclasses import DEFAULT_TYPES
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
"""Features of UML 2.5.1 that are texts, numbers or one of some words."""

FLAGS = frozenset(
    {
        "isAbstract",
        "isActive",
        "isAssured",
        "isBehavior",
        "isCombineDuplicate",
        "isComposite",
        "isConjugated",
        "isControl",
        "isControlType",
        "isCovering",
        "isDerived",
        "isDerivedUnion",
        "isDestroyDuplicates",
        "isDestroyLinks",
        "isDestroyOwnedObjects",
        "isDeterminate",
        "isDimension",
        "isDirect",
        "isDisjoint",
        "isException",
        "isExternal",
        "isFinalSpecialization",
        "isID",
        "isIndirectlyInstantiated",
        "isLeaf",
        "isLocallyReentrant",
        "isMulticast",
        "isMultireceive",
        "isOrdered",
        "isOrthogonal",
        "isQuery",
        "isReadOnly",
        "isReentrant",
        "isRelative",
        "isRemoveDuplicates",
        "isReplaceAll",
        "isRequired",
        "isService",
        "isSimple",
        "isSingleExecution",
        "isStatic",
        "isStream",
        "isStrict",
        "isSubmachineState",
        "isSubstitutable",
        "isSynchronous",
        "isTestedFirst",
        "isUnique",
        "isUnmarshall",
    }
)
"""Features of UML 2.5.1 that are truth values."""

WORDS = {
    "visibility": ("public", "private", "protected", "package"),
    "concurrency": ("sequential", "guarded", "concurrent"),
    "effect": ("create", "read", "update", "delete"),
    "ordering": ("unordered", "ordered", "LIFO", "FIFO"),
    "mode": ("parallel", "iterative", "stream"),
}
"""Attributes that are one of some words (UML 2.5.1); aggregations and directions are asked later,
for plants have them too, and ``kind`` means something else for each metaclass."""

VALUES: dict[str, tuple[str, ...]] = {**WORDS, **dict.fromkeys(FLAGS, ("true", "false"))}
"""What attributes may say, where UML lists it."""

_CONTAINED = frozenset(
    {
        "changeExpression",
        "defaultValue",
        "doActivity",
        "event",
        "exceptionInput",
        "exceptionType",
        "executableNode",
        "expr",
        "fragment",
        "fromAction",
        "handlerBody",
        "icon",
        "joinSpec",
        "lowerValue",
        "mapping",
        "max",
        "maxint",
        "min",
        "minint",
        "nameExpression",
        "nestedClassifier",
        "ownedActual",
        "ownedBehavior",
        "ownedDefault",
        "ownedElement",
        "ownedGroup",
        "ownedNode",
        "ownedParameteredElement",
        "ownedType",
        "packagedElement",
        "partWithPort",
        "referred",
        "returnValue",
        "selector",
        "specification",
        "upperBound",
        "upperValue",
        "weight",
        "when",
    }
)
"""What elements contain, and names of elements that readers of single metaclasses follow."""

FEATURES = ATTRIBUTES | FLAGS | NAMING | _CONTAINED | DEFAULT_TYPES.keys()
"""Every feature of UML, of any metaclass, in any version of UML 2."""


def is_known(feature: str) -> bool:
    """Whether UML has a feature of this name."""
    return feature in FEATURES
