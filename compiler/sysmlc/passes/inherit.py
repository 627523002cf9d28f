"""Pass ``inherit``: effective features of every classifier, and rules of inheritance."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.algorithms import strongly_connected_components
from sysmlc.ir.query import CLASSIFIERS, FEATURES, bounds, conforms, generals

GENERALIZATION_CYCLE = rule(
    "SM200",
    "generalization-cycle",
    Severity.ERROR,
    "'{element}' specialises itself: {cycle}",
    help="remove one generalization of the circle",
)
GENERALIZATION_KIND = rule(
    "SM201",
    "generalization-kind",
    Severity.WARNING,
    "{kind} '{element}' specialises {general_kind} '{general}'",
    help="use a realization, or make both the same kind of element",
)
REDEFINES_STRANGER = rule(
    "SM202",
    "redefines-stranger",
    Severity.WARNING,
    "'{element}' {relation} '{other}', which it does not inherit",
    help="add the generalization that is missing, or remove the relation",
)
TYPE_NOT_NARROWER = rule(
    "SM203",
    "type-not-narrower",
    Severity.WARNING,
    "'{element}' {relation} '{other}' but its type '{type}' is no kind of '{other_type}'",
    help="let '{type}' specialise '{other_type}'",
)
MULTIPLICITY_WIDER = rule(
    "SM204",
    "multiplicity-wider",
    Severity.WARNING,
    "'{element}' with multiplicity {multiplicity} {relation} '{other}' with {other_multiplicity}",
    help="narrow the multiplicity of '{element}'",
)


_CLASSES = frozenset({Kind.CLASS, Kind.COMPONENT, Kind.ACTIVITY, Kind.STATE_MACHINE})
_RELATIONS = {Edge.REDEFINES: "redefines", Edge.SUBSETS: "subsets"}


class Inherit(Struct, frozen=True):
    """Give every classifier its effective features, and check generalization.

    Assumes resolved references. Guarantees ``feature`` edges from each classifier to its own
    properties, ports, operations and receptions and then to those of each general in turn, each
    once, without what one of them redefines. Private features are among them, for instances
    have them. Generalizations that close a circle are reported and give nothing.
    """

    name: ClassVar[str] = "inherit"
    after: ClassVar[tuple[str, ...]] = ("resolve", "overlay")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Add the edges and report; see the class."""
        hierarchy = _Hierarchy(graph)
        for circle in hierarchy.circles:
            _report_circle(graph, sink, circle)
        for classifier in graph.of_kind(*CLASSIFIERS):
            features = hierarchy.features(classifier)
            if features != graph.targets(classifier, Edge.FEATURE):
                graph.replace_targets(Edge.FEATURE, classifier, features)
            _check_generals(graph, sink, classifier)
        for edge in _RELATIONS:
            for _, source, target in tuple(graph.edges(edge)):
                _check_relation(graph, sink, edge, graph[source], graph[target], hierarchy)


class _Hierarchy:
    """Generalization without its circles."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._component: dict[str, int] = {}
        self.circles: list[list[Element]] = []
        self._features: dict[str, dict[Element, None]] = {}
        # Components come out general before specific: each is ready when it is needed.
        for number, ids in enumerate(strongly_connected_components(_generals(graph))):
            self._component.update(dict.fromkeys(ids, number))
            self._enter(ids)

    def _enter(self, ids: list[str]) -> None:
        members = sorted((self._graph[id] for id in ids), key=_document_order)
        if len(members) > 1 or members[0] in self._graph.targets(members[0], Edge.SPECIALIZES):
            self.circles.append(members)
        for member in members:
            self._features[member.id] = self._collect_features(member)

    def direct(self, classifier: Element) -> list[Element]:
        """Generals of the classifier that do not lead back to it."""
        own = self._component.get(classifier.id)
        ups = self._graph.targets(classifier, Edge.SPECIALIZES)
        return [up for up in ups if self._component[up.id] != own]

    def features(self, classifier: Element) -> list[Element]:
        """Effective features of the classifier."""
        if classifier.id not in self._features:
            return _own_features(self._graph, classifier)
        return list(self._features[classifier.id])

    def is_above(self, general: Element, classifier: Element) -> bool:
        """Whether the classifier specialises the general one, directly or not, and not back."""
        same = self._component.get(general.id) == self._component.get(classifier.id)
        return not same and general in generals(self._graph, classifier)

    def _collect_features(self, classifier: Element) -> dict[Element, None]:
        found = dict.fromkeys(_own_features(self._graph, classifier))
        for up in self.direct(classifier):
            found.update(self._features[up.id])
        replaced = {old for one in found for old in self._replaced_by(one)}
        return {one: None for one in found if one not in replaced}

    def _replaced_by(self, feature: Element) -> Iterator[Element]:
        owner = self._graph.owner(feature)
        for old in self._graph.targets(feature, Edge.REDEFINES):
            former = self._graph.owner(old)
            if owner is not None and former is not None and self.is_above(former, owner):
                yield old


def _generals(graph: Graph) -> dict[str, dict[str, None]]:
    """Ids of the direct generals of what specialises or is specialised."""
    found: dict[str, dict[str, None]] = {}
    for _, specific, general in graph.edges(Edge.SPECIALIZES):
        found.setdefault(specific, {})[general] = None
        found.setdefault(general, {})
    return found


def _own_features(graph: Graph, classifier: Element) -> list[Element]:
    # The ends that an association owns are no features of it that its instances hold.
    if classifier.kind is Kind.ASSOCIATION:
        ends = graph.targets(classifier, Edge.END)
        return [one for one in graph.owned(classifier) if one.kind in FEATURES and one not in ends]
    return [one for one in graph.owned(classifier) if one.kind in FEATURES]


def _document_order(element: Element) -> tuple[str, int, str]:
    return element.source, element.ordinal, element.id


# -- rules -------------------------------------------------------------------------------------


def _report_circle(graph: Graph, sink: Sink, circle: list[Element]) -> None:
    names = [graph.qualified_name(one) for one in (*circle, circle[0])]
    sink.report(
        GENERALIZATION_CYCLE,
        graph.subject(circle[0]),
        element=names[0],
        cycle=", ".join(f"'{name}'" for name in names),
    )


def _check_generals(graph: Graph, sink: Sink, classifier: Element) -> None:
    for general in graph.targets(classifier, Edge.SPECIALIZES):
        if not general.attrs.get("external") and not _same_kind(classifier, general):
            sink.report(
                GENERALIZATION_KIND,
                graph.subject(classifier),
                kind=classifier.kind,
                element=graph.qualified_name(classifier),
                general_kind=general.kind,
                general=graph.qualified_name(general),
            )


def _same_kind(specific: Element, general: Element) -> bool:
    return specific.kind is general.kind or {specific.kind, general.kind} <= _CLASSES


def _check_relation(
    graph: Graph, sink: Sink, edge: Edge, feature: Element, other: Element, hierarchy: _Hierarchy
) -> None:
    if other.attrs.get("external"):
        return
    if not _may_relate(graph, edge, feature, other, hierarchy):
        sink.report(
            REDEFINES_STRANGER,
            graph.subject(feature),
            element=graph.qualified_name(feature),
            relation=_RELATIONS[edge],
            other=graph.qualified_name(other),
        )
        return
    _check_types(graph, sink, edge, feature, other)
    _check_multiplicities(graph, sink, edge, feature, other)


def _check_types(graph: Graph, sink: Sink, edge: Edge, feature: Element, other: Element) -> None:
    own, general = (graph.target(one, Edge.TYPED_BY) for one in (feature, other))
    if own is not None and own.subkind == "attribute":
        return  # In AutomationML an attribute with attributes replaces the inherited one wholly.
    if own is None or general is None or _narrower(graph, own, general):
        return
    sink.report(
        TYPE_NOT_NARROWER,
        graph.subject(feature),
        element=graph.qualified_name(feature),
        relation=_RELATIONS[edge],
        other=graph.qualified_name(other),
        type=own.name,
        other_type=general.name,
    )


def _check_multiplicities(
    graph: Graph, sink: Sink, edge: Edge, feature: Element, other: Element
) -> None:
    type_ = graph.target(feature, Edge.TYPED_BY)
    if not _wider(feature, other) or (type_ is not None and type_.subkind == "attribute"):
        return
    sink.report(
        MULTIPLICITY_WIDER,
        graph.subject(feature),
        element=graph.qualified_name(feature),
        relation=_RELATIONS[edge],
        other=graph.qualified_name(other),
        multiplicity=feature.attrs.get("multiplicity", "1"),
        other_multiplicity=other.attrs.get("multiplicity", "1"),
    )


def _may_relate(
    graph: Graph, edge: Edge, feature: Element, other: Element, hierarchy: _Hierarchy
) -> bool:
    owner, former = graph.owner(feature), graph.owner(other)
    if owner is None or former is None:
        return False
    if hierarchy.is_above(former, owner) or _is_of_role(graph, owner, former, hierarchy):
        return True
    # Association ends relate through the classifiers at the other side; that is not followed.
    if Kind.ASSOCIATION in (owner.kind, former.kind) or owner.kind not in CLASSIFIERS:
        return True
    return edge is Edge.SUBSETS and owner is former


def _is_of_role(graph: Graph, owner: Element, former: Element, hierarchy: _Hierarchy) -> bool:
    """Whether the owner plays the role that has the feature: AutomationML maps one on the other."""
    if former.subkind != "role-class":
        return False
    family = (owner, *generals(graph, owner))
    roles = [role for one in family for role in graph.targets(one, Edge.REALIZES)]
    return any(role is former or hierarchy.is_above(former, role) for role in roles)


def _narrower(graph: Graph, narrow: Element, wide: Element) -> bool:
    above = [narrow, *generals(graph, narrow), wide]
    # What a stand-in specialises is unknown, so nothing is held against it.
    return any(one.attrs.get("external") for one in above) or conforms(graph, narrow, wide)


def _wider(feature: Element, other: Element) -> bool:
    own, general = (bounds(one.attrs.get("multiplicity")) for one in (feature, other))
    if own is None or general is None or general[1] is None:
        return False
    return own[1] is None or own[1] > general[1]
