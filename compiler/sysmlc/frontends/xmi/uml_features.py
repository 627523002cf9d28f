"""The features of UML: references, flags, words, and the features of each metaclass.

The sets hold the features of any metaclass in any version of UML 2; ``metamodels/uml-features.txt``
says which metaclass has a feature (UML 2.5.1).
"""

from functools import cache

from sysmlc.frontends.xmi.metaclasses import DEFAULT_TYPES
from sysmlc.frontends.xmi.vocabulary import FOLDED_REFERENCES, REDUNDANT, REFERENCES
from sysmlc.support import resources

_REDUNDANT_REFERENCES_WORDS = """
    abstraction associationEnd datatype definingEnd deployedElement deployment enumeration
    featuringClassifier generalizationSet implementingClassifier importedMember inActivity
    inheritedMember inheritedParameter interface interruptingEdge metaclass namespace nestedPackage
    nestingPackage opposite owningAssociation owningInstance package part predecessorClause profile
    protectedNode redefinedElement subgroup submachineState substitutingClassifier successorClause
    superClass superGroup superPartition
"""
REDUNDANT_REFERENCES = REDUNDANT | frozenset(_REDUNDANT_REFERENCES_WORDS.split())
"""References whose relation another feature or ownership states (UML 2.5.1: opposite, derived)."""

_STORED_REFERENCES_WORDS = """
    bodyOutput bodyPart connector constrainingClassifier decider decisionInput decisionInputFlow
    decomposedAs destroyAt end extendedSignature inState inputElement insertAt instance interrupts
    newClassifier observation oldClassifier onPort outputElement port protocol raisedException
    redefinedInterface reducer regionAsInput regionAsOutput replyToCall representation
    returnValueRecipient selection setupPart test transformation
"""
_STORED_REFERENCES = frozenset(_STORED_REFERENCES_WORDS.split())
"""References of UML 2.5.1 that are no edges: the graph stores their ids in an attribute."""

NAMING = REDUNDANT_REFERENCES | _STORED_REFERENCES | REFERENCES.keys() | FOLDED_REFERENCES.keys()
"""All features that name elements."""

_CHECKED_BY_RESOLVE_WORDS = """
    connector decision_input decision_input_flow defining_end interrupts on_port port
    raised_exception test body_part setup_part
"""
CHECKED_BY_RESOLVE = frozenset(_CHECKED_BY_RESOLVE_WORDS.split())
"""Attributes of the graph whose ids the pass ``resolve`` checks and reports."""

_TEXTS_WORDS = """
    URI aggregation alias allowSubstitutable body concurrency content default deploymentLocation
    direction effect executionLocation fileName firstEvent format interactionOperator kind language
    location lower messageKind messageSort mode mustIsolate name ordering qualifiedName setting
    symbol upper value viewpoint visibility
"""
_TEXTS = frozenset(_TEXTS_WORDS.split())
"""Features of UML 2.5.1 that are texts, numbers or words."""

_FLAGS_WORDS = """
    isAbstract isActive isAssured isBehavior isCombineDuplicate isComposite isConjugated isControl
    isControlType isCovering isDerived isDerivedUnion isDestroyDuplicates isDestroyLinks
    isDestroyOwnedObjects isDeterminate isDimension isDirect isDisjoint isException isExternal
    isFinalSpecialization isID isIndirectlyInstantiated isLeaf isLocallyReentrant isMulticast
    isMultireceive isOrdered isOrthogonal isQuery isReadOnly isReentrant isRelative
    isRemoveDuplicates isReplaceAll isRequired isService isSimple isSingleExecution isStatic
    isStream isStrict isSubmachineState isSubstitutable isSynchronous isTestedFirst isUnique
    isUnmarshall
"""
FLAGS = frozenset(_FLAGS_WORDS.split())
"""Features of UML 2.5.1 that are truth values."""

WORDS = {
    "visibility": ("public", "private", "protected", "package"),
    "concurrency": ("sequential", "guarded", "concurrent"),
    "effect": ("create", "read", "update", "delete"),
    "ordering": ("unordered", "ordered", "LIFO", "FIFO"),
    "mode": ("parallel", "iterative", "stream"),
}
"""Enumerated attributes and their values (UML 2.5.1).

A later pass checks aggregations and directions, because plants have them too; the values of
``kind`` depend on the metaclass.
"""

VALUES: dict[str, tuple[str, ...]] = {**WORDS, **dict.fromkeys(FLAGS, ("true", "false"))}
"""The valid values of flags and enumerated attributes."""

_CONTAINED_WORDS = """
    changeExpression defaultValue doActivity event exceptionInput exceptionType executableNode expr
    fragment fromAction handlerBody icon joinSpec lowerValue mapping max maxint min minint
    nameExpression nestedClassifier ownedActual ownedBehavior ownedDefault ownedElement ownedGroup
    ownedNode ownedParameteredElement ownedType packagedElement partWithPort referred returnValue
    selector specification upperBound upperValue weight when
"""
_CONTAINED = frozenset(_CONTAINED_WORDS.split())
"""Features that contain elements, and references that handlers of single metaclasses follow."""

FEATURES = _TEXTS | FLAGS | NAMING | _CONTAINED | DEFAULT_TYPES.keys()
"""Every feature of UML, of any metaclass, in any version of UML 2."""


# -- the features of each metaclass ----------------------------------------------------------------

_Metaclasses = dict[str, tuple[tuple[str, ...], frozenset[str]]]
"""Generals and own features of each metaclass."""


def is_misplaced(metaclass: str, feature: str) -> bool:
    """Whether UML has the feature, but not for this metaclass.

    *metaclass* is named as in ``xmi:type``, without prefix. Nothing is misplaced in a metaclass
    that UML does not have.
    """
    features = _list_features(metaclass)
    return bool(features) and feature not in features and feature in _list_all_features()


@cache
def _list_features(metaclass: str) -> frozenset[str]:
    """Return the features of a metaclass, inherited ones included; none for an unknown one."""
    generals, own_features = _read_metaclasses().get(metaclass, ((), frozenset()))
    return own_features.union(*map(_list_features, generals))


@cache
def _list_all_features() -> frozenset[str]:
    return frozenset[str]().union(*(features for _, features in _read_metaclasses().values()))


@cache
def _read_metaclasses() -> _Metaclasses:
    lines = resources.read_text("metamodels", "uml-features.txt").splitlines()
    return dict(_read_line(line) for line in lines if not line.startswith("#"))


def _read_line(line: str) -> tuple[str, tuple[tuple[str, ...], frozenset[str]]]:
    name, _, rest = line.partition(":")
    generals, _, features = rest.partition("|")
    return name, (tuple(generals.split()), frozenset(features.split()))
