"""Classifiers: what they specialise, their features, parameters and behaviour."""

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.stereotypes import tag

CLASSIFIERS = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.INTERFACE,
    Kind.DATA_TYPE,
    Kind.ENUMERATION,
    Kind.SIGNAL,
    Kind.ASSOCIATION,
    Kind.STEREOTYPE,
    Kind.REQUIREMENT,
    Kind.TEST_CASE,
    Kind.USE_CASE,
    Kind.ACTOR,
    Kind.VIEW,
    Kind.ITEM,
    Kind.UNIT,
    Kind.QUANTITY_KIND,
    Kind.ACTIVITY,
    Kind.STATE_MACHINE,
    Kind.INTERACTION,
)
"""Kinds of UML classifiers (UML 2.5.1 clause 9.9.4); behaviours are classes."""

BEHAVIORS = (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION)
FLOW_DIRECTIONS = ("in", "out", "inout")
"""Literals of SysML's FlowDirection (SysML 1.6 clause 9.3.2)."""
STRUCTURAL_FEATURES = (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY)
FEATURES = (*STRUCTURAL_FEATURES, Kind.OPERATION, Kind.RECEPTION)
DOMAINS = ("physical", "information")

_PARAMETER = Kind.PARAMETER
"""By a name of the module: in Python 3.11 that of a class takes twice as long."""


def generals(graph: Graph, classifier: Element) -> list[Element]:
    """Everything that the classifier specialises, nearest first; cycles do no harm."""
    return _above(graph, classifier, Edge.SPECIALIZES)


def _above(graph: Graph, element: Element, edge: Edge) -> list[Element]:
    level = graph.targets(element, edge)
    if not level:
        return level
    found = dict.fromkeys(level)
    while level:
        if len(level) == 1:
            # Most have one above them, and chains can be thousands long.
            level = [up for up in graph.targets(level[0], edge) if up not in found]
        else:
            ups = (up for one in level for up in graph.targets(one, edge))
            level = [up for up in dict.fromkeys(ups) if up not in found]
        found.update(dict.fromkeys(level))
    found.pop(element, None)
    return list(found)


def conforms(graph: Graph, specific: Element, general: Element) -> bool:
    """Whether the first classifier is the second, specialises it or realises it."""
    if specific is general:
        return True
    family = [specific, *generals(graph, specific)]
    realised = [up for one in family for up in graph.targets(one, Edge.REALIZES)]
    return general in family or general in realised


def features(graph: Graph, classifier: Element) -> list[Element]:
    """Effective features: what ``inherit`` found, or the own ones before it has run."""
    found = graph.targets(classifier, Edge.FEATURE)
    return found or [one for one in graph.owned(classifier) if one.kind in FEATURES]


def type_of(graph: Graph, element: Element) -> Element | None:
    """Type of a typed element; a feature without one has that of the feature it redefines."""
    own = graph.target(element, Edge.TYPED_BY)
    if own is not None:
        return own
    types = (graph.target(one, Edge.TYPED_BY) for one in redefined(graph, element))
    return next((one for one in types if one is not None), None)


def redefined(graph: Graph, feature: Element) -> list[Element]:
    """Everything that the feature redefines, nearest first; cycles do no harm."""
    return _above(graph, feature, Edge.REDEFINES)


def parts(graph: Graph, block: Element) -> list[Element]:
    """Effective parts of a block: composite properties typed by a class."""
    return [one for one in features(graph, block) if one.role == "part"]


def ports(graph: Graph, block: Element) -> list[Element]:
    """Effective ports of a block."""
    return [one for one in features(graph, block) if one.kind is Kind.PORT]


def flow_properties(graph: Graph, type_: Element) -> list[Element]:
    """Effective flow properties of the type of a port."""
    return [one for one in features(graph, type_) if is_flow_property(one)]


def is_flow_property(feature: Element) -> bool:
    """Whether the feature says what flows and in which direction (SysML 1.6 clause 9.3.2.7)."""
    return feature.kind is Kind.FLOW_PROPERTY or feature.role == "flow property"


def parameters(graph: Graph, owner: Element, *directions: str) -> list[Element]:
    """Parameters of an operation or behaviour with one of the directions (all when none given).

    A parameter without a direction is ``in`` (UML 2.5.1 clause 9.9.12).
    """
    found = [one for one in graph.owned(owner) if one.kind is _PARAMETER]
    return [one for one in found if not directions or direction_of(one) in directions]


def direction_of(parameter: Element) -> str:
    """Direction of a parameter, with UML's default."""
    return str(parameter.attrs.get("direction", "in"))


def classifier_behavior(graph: Graph, classifier: Element) -> Element | None:
    """The classifier behaviour, its own or else the nearest inherited one."""
    for one in (classifier, *generals(graph, classifier)):
        found = graph.target(one, Edge.CLASSIFIER_BEHAVIOR)
        if found is not None:
            return found
    return None


def domain_of(graph: Graph, classifier: Element) -> str | None:
    """``physical`` or ``information``: its own or that of the nearest general one that has it."""
    for one in (classifier, *generals(graph, classifier)):
        given = one.attrs.get("domain") or tag(graph, one, "domain")
        if given in DOMAINS:
            return str(given)
    return None
