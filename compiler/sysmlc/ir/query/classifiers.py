"""Classifiers: generals, features, parameters, units, stereotypes, behaviour."""

import re
from collections.abc import Iterator

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.support.units import Time, read_time

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
"""Kinds of classifiers (UML 2.5.1 clause 9.9.4); behaviours are classes."""

BEHAVIORS = (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION)
FLOW_DIRECTIONS = ("in", "out", "inout")
"""Literals of SysML's FlowDirection (SysML 1.6 clause 9.3.2)."""
STRUCTURAL_FEATURES = (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY)
FEATURES = (*STRUCTURAL_FEATURES, Kind.OPERATION, Kind.RECEPTION)
DOMAINS = ("physical", "information")
_UNIT_KINDS = (Kind.UNIT, Kind.INSTANCE, Kind.DATA_TYPE, Kind.PROPERTY)
_QUALIFIER = re.compile(r"(?:\w+|'[^']*')::")


def generals(graph: Graph, classifier: Element) -> list[Element]:
    """Return all general classifiers of *classifier*, nearest first, also in cyclic models."""
    return _list_transitive_targets(graph, classifier, Edge.SPECIALIZES)


def _list_transitive_targets(graph: Graph, element: Element, edge: Edge) -> list[Element]:
    """Return the elements that *element* reaches by edges of a kind, in breadth-first order."""
    level = graph.targets(element, edge)
    if not level:
        return level
    reached = dict.fromkeys(level)
    while level:
        if len(level) == 1:
            # Most classifiers have one general, and chains can be thousands of classifiers long.
            level = [target for target in graph.targets(level[0], edge) if target not in reached]
        else:
            targets = (target for source in level for target in graph.targets(source, edge))
            level = [target for target in dict.fromkeys(targets) if target not in reached]
        reached.update(dict.fromkeys(level))
    reached.pop(element, None)
    return list(reached)


def conforms(graph: Graph, specific: Element, general: Element) -> bool:
    """Whether the first classifier is, specialises or realises the second one."""
    if specific is general:
        return True
    family = [specific, *generals(graph, specific)]
    realised = [target for item in family for target in graph.targets(item, Edge.REALIZES)]
    return general in family or general in realised


def features(graph: Graph, classifier: Element) -> list[Element]:
    """Return the effective features, inherited ones included; before ``inherit`` the owned ones."""
    effective = graph.targets(classifier, Edge.FEATURE)
    return effective or [item for item in graph.owned(classifier) if item.kind in FEATURES]


def type_of(graph: Graph, element: Element) -> Element | None:
    """Return the type of *element*, else the type of the nearest feature that it redefines."""
    own_type = graph.target(element, Edge.TYPED_BY)
    if own_type is not None:
        return own_type
    redefined = redefined_features(graph, element)
    types = (graph.target(feature, Edge.TYPED_BY) for feature in redefined)
    return next((type_ for type_ in types if type_ is not None), None)


def redefined_features(graph: Graph, feature: Element) -> list[Element]:
    """Return all features that *feature* redefines, nearest first, also in cyclic models."""
    return _list_transitive_targets(graph, feature, Edge.REDEFINES)


def parts(graph: Graph, block: Element) -> list[Element]:
    """Return the effective parts of a block: composite properties typed by a class."""
    return [feature for feature in features(graph, block) if feature.role == "part"]


def ports(graph: Graph, block: Element) -> list[Element]:
    """Return the effective ports of a block."""
    return [feature for feature in features(graph, block) if feature.kind is Kind.PORT]


def flow_properties(graph: Graph, type_: Element) -> list[Element]:
    """Return the effective flow properties of the type of a port."""
    return [feature for feature in features(graph, type_) if is_flow_property(feature)]


def is_flow_property(feature: Element) -> bool:
    """Whether *feature* is a flow property (SysML 1.6 clause 9.3.2.7)."""
    return feature.kind is Kind.FLOW_PROPERTY or feature.role == "flow property"


def parameters(graph: Graph, owner: Element, *directions: str) -> list[Element]:
    """Return the parameters of an operation or behaviour with these directions (all by default)."""
    owned = [element for element in graph.owned(owner) if element.kind is Kind.PARAMETER]
    return [item for item in owned if not directions or direction_of(item) in directions]


def direction_of(parameter: Element) -> str:
    """Return the direction of a parameter; the default is ``in`` (UML 2.5.1 clause 9.9.12)."""
    return str(parameter.attrs.get("direction", "in"))


def definition_of(graph: Graph, subject: Element) -> Element:
    """Return the element whose features formulas may name: the method of an operation, if any."""
    method = graph.target(subject, Edge.METHOD) if subject.kind is Kind.OPERATION else None
    return method or subject


def classifier_behavior(graph: Graph, classifier: Element) -> Element | None:
    """Return the classifier behaviour, else the nearest inherited one, else None."""
    for item in (classifier, *generals(graph, classifier)):
        behavior = graph.target(item, Edge.CLASSIFIER_BEHAVIOR)
        if behavior is not None:
            return behavior
    return None


def domain_of(graph: Graph, classifier: Element) -> str | None:
    """Return ``physical`` or ``information``: the own or the nearest inherited domain, or None."""
    for item in (classifier, *generals(graph, classifier)):
        domain = item.attrs.get("domain") or tag(graph, item, "domain")
        if domain in DOMAINS:
            return str(domain)
    return None


# -- units and quantity kinds (SysML 1.6 clause 8.3.2) -----------------------------------------


def is_unit(element: Element) -> bool:
    """Whether *element* is a measurement unit, in SysML v1 or v2."""
    return element.kind is Kind.UNIT or element.role == "unit"


def is_quantity_kind(element: Element) -> bool:
    """Whether *element* is a kind of quantity, in SysML v1 or v2."""
    return element.kind is Kind.QUANTITY_KIND or element.role == "quantity kind"


def unit_of(graph: Graph, feature: Element) -> Element | None:
    """Return the unit of a feature or a value type: its own or the nearest inherited one."""
    return next(filter(is_unit, _iter_references(graph, feature)), None)


def name_value_unit(graph: Graph, element: Element, key: str) -> str:
    """Return the symbol of the unit that the value in an attribute states itself; '' without."""
    unit = element.attrs.get(f"{key}_unit")
    if not isinstance(unit, str):
        return ""
    unit_element = graph.get(unit)
    if unit_element is not None and unit_element.kind in _UNIT_KINDS:
        return str(unit_element.attrs.get("symbol") or unit_element.name)
    return strip_qualifiers(unit)


def strip_qualifiers(unit: str) -> str:
    """Return the expression of a unit without qualifiers and quotes: ``m/s`` for ``SI::'m/s'``."""
    return _QUALIFIER.sub("", unit).replace("'", "")


def waits_for_change(trigger: Element) -> bool:
    """Whether a change trigger waits until its condition becomes true, as in UML.

    In SysML v2 it also fires if the condition is true when the wait begins.
    """
    return trigger.subkind == "change" and trigger.attrs.get("immediate") is not True


def time_of(trigger: Element) -> Time:
    """Return the time of a time trigger."""
    text = str(trigger.attrs.get("when") or trigger.name)
    return read_time(text, is_relative=trigger.attrs.get("relative") is True)


def quantity_kind_of(graph: Graph, feature: Element) -> Element | None:
    """Return the quantity kind of a feature or a value type, else that of its unit."""
    own_kind = next(filter(is_quantity_kind, _iter_references(graph, feature)), None)
    unit = None if own_kind else unit_of(graph, feature)
    references = [] if unit is None else graph.targets(unit, Edge.REFERENCES)
    return own_kind or next(filter(is_quantity_kind, references), None)


def _iter_references(graph: Graph, feature: Element) -> Iterator[Element]:
    is_feature = feature.kind in (*STRUCTURAL_FEATURES, Kind.PARAMETER)
    type_ = type_of(graph, feature) if is_feature else feature
    if type_ is None:
        return
    for classifier in (type_, *generals(graph, type_)):
        yield from graph.targets(classifier, Edge.REFERENCES)


# -- stereotypes and their tagged values -------------------------------------------------------


def applications(graph: Graph, element: Element) -> list[Element]:
    """Return the stereotype applications on *element*, in order."""
    sources = graph.sources(element, Edge.SUBJECT)
    return [source for source in sources if source.kind is Kind.APPLICATION]


def lineage(application: Element) -> tuple[str, ...]:
    """Return the local names from the applied stereotype to the most general one.

    Before the pass ``classify``, this is the name of the applied stereotype alone.
    """
    names = application.attrs.get("lineage")
    if isinstance(names, tuple):
        return tuple(str(name) for name in names)
    return (str(application.attrs.get("stereotype", "")),)


def stereotypes(graph: Graph, element: Element) -> tuple[str, ...]:
    """Return the local names of the stereotypes of *element*, general ones included, each once."""
    names = (name for item in applications(graph, element) for name in lineage(item))
    return tuple(dict.fromkeys(names))


def has_stereotype(graph: Graph, element: Element, *names: str) -> bool:
    """Whether one of the stereotypes, or one that specialises it, applies to *element*."""
    return not set(names).isdisjoint(stereotypes(graph, element))


def tag(graph: Graph, element: Element, name: str) -> AttrValue:
    """Return the first tagged value of this name on *element*, or None.

    Case is ignored if no tag has exactly this name, because MagicDraw writes ``Text`` and ``Id``
    where Papyrus writes ``text`` and ``id``. Enterprise Architect can write tags on the element
    itself, without a stereotype.
    """
    items = applications(graph, element)
    for application in items:
        if f"tag.{name}" in application.attrs:
            return application.attrs[f"tag.{name}"]
    for application in items:
        for key, value in application.attrs.items():
            if key.lower() == f"tag.{name.lower()}":
                return value
    return element.attrs.get(f"tag.{name}")
