"""Questions that passes and back ends ask of a graph, answered without changing it."""

from collections.abc import Callable, Iterable, Iterator

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

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

_OPPOSITE = {"in": "out", "out": "in"}
_PARAMETER, _REQUIREMENT = Kind.PARAMETER, Kind.REQUIREMENT
"""Members by names of the module: in Python 3.11 those of a class take ten times as long."""


# -- stereotypes -------------------------------------------------------------------------------


def applications(graph: Graph, element: Element) -> list[Element]:
    """Stereotype applications on the element, in order."""
    found = graph.sources(element, Edge.SUBJECT)
    return [one for one in found if one.kind is Kind.APPLICATION]


def lineage(application: Element) -> tuple[str, ...]:
    """Local names from the applied stereotype to the most general one.

    Before ``classify`` has run it is the applied stereotype's name alone.
    """
    names = application.attrs.get("lineage")
    if isinstance(names, tuple):
        return tuple(str(name) for name in names)
    return (str(application.attrs.get("stereotype", "")),)


def stereotypes(graph: Graph, element: Element) -> tuple[str, ...]:
    """Local names of the stereotypes that apply, general ones included, each once."""
    names = (name for one in applications(graph, element) for name in lineage(one))
    return tuple(dict.fromkeys(names))


def has_stereotype(graph: Graph, element: Element, *names: str) -> bool:
    """Whether one of the stereotypes, or one that specialises it, applies."""
    return not set(names).isdisjoint(stereotypes(graph, element))


def tag(graph: Graph, element: Element, name: str) -> AttrValue:
    """First tagged value of this name on the element, or None; an exact name goes first.

    MagicDraw writes ``Text`` and ``Id`` where Papyrus writes ``text`` and ``id``, so that case
    is ignored when no name fits exactly. Enterprise Architect may tell tags of the element
    itself, beside a stereotype that has none.
    """
    found = applications(graph, element)
    for application in found:
        if f"tag.{name}" in application.attrs:
            return application.attrs[f"tag.{name}"]
    for application in found:
        # Who asks for all values at once is noted as a reader of each (``ir.reads``).
        for key in application.attrs:
            if key.lower() == f"tag.{name.lower()}":
                return application.attrs[key]
    return element.attrs.get(f"tag.{name}")


# -- classifiers and features ------------------------------------------------------------------


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


# -- relations ---------------------------------------------------------------------------------


def flow_source(graph: Graph, flow: Element) -> Element | None:
    """Where a flow or transition starts."""
    return graph.target(flow, Edge.FLOW_SOURCE)


def flow_target(graph: Graph, flow: Element) -> Element | None:
    """Where a flow or transition ends."""
    return graph.target(flow, Edge.FLOW_TARGET)


def runs_both_ways(graph: Graph, flow: Element) -> bool:
    """Whether an item flow leads from either of its ends to the other."""
    sources = {one.id for one in graph.targets(flow, Edge.FLOW_SOURCE)}
    return len(sources) > 1 and sources == {t.id for t in graph.targets(flow, Edge.FLOW_TARGET)}


def incoming(graph: Graph, node: Element, *kinds: Kind) -> list[Element]:
    """Flows (of these kinds) or transitions that end at the node."""
    return _of(graph.sources(node, Edge.FLOW_TARGET), kinds)


def outgoing(graph: Graph, node: Element, *kinds: Kind) -> list[Element]:
    """Flows (of these kinds) or transitions that start at the node."""
    return _of(graph.sources(node, Edge.FLOW_SOURCE), kinds)


def _of(elements: Iterable[Element], kinds: tuple[Kind, ...]) -> list[Element]:
    return [one for one in elements if not kinds or one.kind in kinds]


def ends(graph: Graph, relation: Element) -> list[Element]:
    """Ends of a connector or association, in order."""
    return graph.targets(relation, Edge.END)


def opposite_end(graph: Graph, relation: Element, end: Element) -> Element | None:
    """The other end of a binary connector or association, or None."""
    others = [one for one in ends(graph, relation) if one is not end]
    return others[0] if len(others) == 1 else None


def role_of(graph: Graph, end: Element) -> Element | None:
    """The part or port that a connector end is attached to."""
    return graph.target(end, Edge.ROLE)


def is_boundary(graph: Graph, end: Element) -> bool:
    """Whether a connector end is a port of the connector's own classifier, not of a part.

    A port nested in such a port is one too.
    """
    role = role_of(graph, end)
    steps = [] if role is None else [*graph.targets(end, Edge.PATH), role]
    return bool(steps) and all(step.kind is Kind.PORT for step in steps)


def end_direction(graph: Graph, end: Element) -> str | None:
    """Direction of the port at a connector end, as the outermost part of its path shows it.

    A conjugated port turns round the ports nested in it too (SysML 1.6 clause 9.3.2.15).
    """
    port = role_of(graph, end)
    given = None if port is None else port.attrs.get("direction")
    direction = given if isinstance(given, str) else None
    for step in graph.targets(end, Edge.PATH):
        if step.kind is Kind.PORT and step.attrs.get("conjugated"):
            direction = opposite(direction)
    return direction


def flow_directions(graph: Graph, port: Element) -> list[tuple[Element, str]]:
    """Flow properties of a port's type, each with its direction at the port itself."""
    type_ = type_of(graph, port)
    found = [] if type_ is None else flow_properties(graph, type_)
    given = [(one, str(one.attrs.get("direction", "inout"))) for one in found]
    if not port.attrs.get("conjugated"):
        return given
    return [(one, opposite(direction) or direction) for one, direction in given]


def connectors_of(graph: Graph, role: Element) -> Iterator[Element]:
    """Connectors that have an end at the part or port."""
    for end in graph.sources(role, Edge.ROLE):
        connector = graph.source(end, Edge.END)
        if connector is not None:
            yield connector


def allocated_to(graph: Graph, element: Element) -> list[Element]:
    """What the element is allocated to: itself, or what it is a usage of.

    What a definition is allocated to holds for all its usages (SysML 1.6 clause 15.3.1.1): the
    type of a part, the behaviour that an action calls.
    """
    return _allocated(graph, element, graph.targets)


def allocated_from(graph: Graph, element: Element) -> list[Element]:
    """What is allocated to the element, or to what it is a usage of."""
    return _allocated(graph, element, graph.sources)


def _allocated(
    graph: Graph, element: Element, follow: Callable[[Element, Edge], list[Element]]
) -> list[Element]:
    definitions = [*graph.targets(element, Edge.CALLS), type_of(graph, element)]
    known = [element, *(one for one in definitions if one is not None)]
    found = (other for one in known for other in follow(one, Edge.ALLOCATED_TO))
    return list(dict.fromkeys(found))


def opposite(direction: str | None) -> str | None:
    """The direction seen from the other side; ``inout`` and None stay."""
    return None if direction is None else _OPPOSITE.get(direction, direction)


# -- names and bounds --------------------------------------------------------------------------


def component_name(graph: Graph, element: Element) -> str:
    """Qualified name of the component that a behaviour or requirement belongs to.

    A classifier behaviour is its classifier, another behaviour ``<Owner>.<behaviour>``, one
    that a package owns stands alone, a requirement is its subject (design, section 6).
    """
    subject = _satisfier(graph, element) if element.role == "requirement" else None
    component = subject or element
    if component.kind in BEHAVIORS:
        return _behavior_name(graph, component)
    return graph.qualified_name(component)


def _behavior_name(graph: Graph, behavior: Element) -> str:
    owner = graph.owner(behavior)
    if owner is None or owner.kind in (Kind.PACKAGE, Kind.PROFILE):
        return graph.qualified_name(behavior)
    above = component_name(graph, owner)
    if behavior in graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        return above
    return f"{above}.{behavior.name or f'<{behavior.kind}>'}"


def _satisfier(graph: Graph, requirement: Element) -> Element | None:
    return graph.target(requirement, Edge.SUBJECT) or graph.source(requirement, Edge.SATISFIES)


def is_requirement(element: Element) -> bool:
    """Whether it is a requirement, in SysML v1 or v2."""
    return element.attrs.get("role") == "requirement" or element.kind is _REQUIREMENT


def ids_in(value: object) -> Iterator[str]:
    """The ids that an attribute holds, at whatever depth of tuples (docs/ir.md, ``clauses``)."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from ids_in(part)


def bounds(multiplicity: AttrValue) -> tuple[int, int | None] | None:
    """Lower and upper bound of a multiplicity; upper None is unlimited.

    Absent means exactly 1. The result is None when the text is not numbers.
    """
    lower, dots, upper = str("1" if multiplicity is None else multiplicity).partition("..")
    if not dots:
        lower, upper = ("0", "*") if lower == "*" else (lower, lower)
    if not _is_number(lower) or not (upper == "*" or _is_number(upper)):
        return None
    return int(lower), None if upper == "*" else int(upper)


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdecimal()
