"""Pass ``inherit``: effective features of every classifier, and checks of generalizations."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.algorithms import strongly_connected_components
from sysmlc.ir.query import CLASSIFIERS, FEATURES, bounds, conforms, generals

GENERALIZATION_CYCLE = rule(
    "SM200",
    "generalization-cycle",
    Severity.ERROR,
    "'{element}' specialises itself: {cycle}",
    help="remove one generalization of the cycle",
)
GENERALIZATION_KIND = rule(
    "SM201",
    "generalization-kind",
    Severity.WARNING,
    "{kind} '{element}' specialises {general_kind} '{general}'",
    help="use a realization, or make both the same kind of element",
)
NOT_INHERITED = rule(
    "SM202",
    "redefines-stranger",
    Severity.WARNING,
    "'{element}' {relation} '{other}', but '{owner}' does not inherit from {other_owner}",
    help="let '{owner}' specialise {other_owner}, or remove the relation",
)
TYPE_NOT_NARROWER = rule(
    "SM203",
    "type-not-narrower",
    Severity.WARNING,
    "'{element}' {relation} '{other}' but its type '{type}' is not a kind of '{other_type}'",
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
    """Add the effective features of every classifier, and check generalizations.

    Assumes resolved references. Guarantees ``feature`` edges from each classifier to its own
    properties, ports, operations and receptions, and then to those of its generals, each once and
    without redefined features. Private features are included, because instances have them.
    Classifiers on a generalization cycle are reported and do not inherit along the cycle.
    """

    name: ClassVar[str] = "inherit"
    after: ClassVar[tuple[str, ...]] = ("resolve", "overlay")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Add the edges and report; see the class."""
        hierarchy = _Hierarchy(graph)
        for cycle in hierarchy.cycles:
            _report_cycle(graph, sink, cycle)
        for classifier in graph.of_kind(*CLASSIFIERS):
            features = hierarchy.effective_features(classifier)
            if features != graph.targets(classifier, Edge.FEATURE):
                graph.replace_targets(Edge.FEATURE, classifier, features)
            _check_generals(graph, sink, classifier)
        for edge in _RELATIONS:
            for _, source, target in tuple(graph.edges(edge)):
                _check_relation(graph, sink, edge, graph[source], graph[target], hierarchy)


class _Hierarchy:
    """The generalizations without cycles, and the effective features of the classifiers."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._component: dict[str, int] = {}
        self.cycles: list[list[Element]] = []
        self._features: dict[str, dict[Element, None]] = {}
        documents = graph.of_kind(Kind.DOCUMENT)
        self.caex_files = {document.source for document in documents if document.subkind == "caex"}
        # Components are in topological order, so that generals are complete before specifics.
        for number, ids in enumerate(strongly_connected_components(_index_generals(graph))):
            self._component.update(dict.fromkeys(ids, number))
            self._add_component(ids)

    def _add_component(self, ids: list[str]) -> None:
        members = sorted((self._graph[id] for id in ids), key=_document_order)
        if len(members) > 1 or members[0] in self._graph.targets(members[0], Edge.SPECIALIZES):
            self.cycles.append(members)
        for member in members:
            self._features[member.id] = self._collect_features(member)

    def direct_generals(self, classifier: Element) -> list[Element]:
        """Return the direct generals of the classifier that are not on a cycle with it."""
        component = self._component.get(classifier.id)
        general_classifiers = self._graph.targets(classifier, Edge.SPECIALIZES)
        return [
            general for general in general_classifiers if self._component[general.id] != component
        ]

    def effective_features(self, classifier: Element) -> list[Element]:
        """Return the effective features of the classifier."""
        if classifier.id not in self._features:
            return _own_features(self._graph, classifier)
        return list(self._features[classifier.id])

    def is_general_of(self, general: Element, classifier: Element) -> bool:
        """Whether *general* is a transitive general of the classifier, outside any cycle."""
        if self._component.get(general.id) == self._component.get(classifier.id):
            return False
        # Most features redefine those of a direct general; long chains take quadratic time.
        direct_generals = self._graph.targets(classifier, Edge.SPECIALIZES)
        return general in direct_generals or general in generals(self._graph, classifier)

    def _collect_features(self, classifier: Element) -> dict[Element, None]:
        features = dict.fromkeys(_own_features(self._graph, classifier))
        for general in self.direct_generals(classifier):
            features.update(self._features[general.id])
        redefined = {
            redefined_feature
            for feature in features
            for redefined_feature in self._redefined_by(feature)
        }
        return {feature: None for feature in features if feature not in redefined}

    def _redefined_by(self, feature: Element) -> Iterator[Element]:
        owner = self._graph.owner(feature)
        for redefined in self._graph.targets(feature, Edge.REDEFINES):
            former_owner = self._graph.owner(redefined)
            if (
                owner is not None
                and former_owner is not None
                and self.is_general_of(former_owner, owner)
            ):
                yield redefined


def _index_generals(graph: Graph) -> dict[str, dict[str, None]]:
    """Map each classifier in a generalization to the ids of its direct generals."""
    generals: dict[str, dict[str, None]] = {}
    for _, specific, general in graph.edges(Edge.SPECIALIZES):
        generals.setdefault(specific, {})[general] = None
        generals.setdefault(general, {})
    return generals


def _own_features(graph: Graph, classifier: Element) -> list[Element]:
    # Instances of an association hold no values of its ends, so the ends are no features.
    if classifier.kind is Kind.ASSOCIATION:
        ends = graph.targets(classifier, Edge.END)
        return [
            element
            for element in graph.owned(classifier)
            if element.kind in FEATURES and element not in ends
        ]
    return [element for element in graph.owned(classifier) if element.kind in FEATURES]


def _document_order(element: Element) -> tuple[str, int, str]:
    return element.source, element.ordinal, element.id


# -- rules -------------------------------------------------------------------------------------


def _report_cycle(graph: Graph, sink: Sink, cycle: list[Element]) -> None:
    names = [graph.qualified_name(classifier) for classifier in (*cycle, cycle[0])]
    sink.report(
        GENERALIZATION_CYCLE,
        graph.subject(cycle[0]),
        element=names[0],
        cycle=", ".join(f"'{name}'" for name in names),
    )


def _check_generals(graph: Graph, sink: Sink, classifier: Element) -> None:
    for general in graph.targets(classifier, Edge.SPECIALIZES):
        if not general.attrs.get("external") and not _is_same_kind(classifier, general):
            sink.report(
                GENERALIZATION_KIND,
                graph.subject(classifier),
                kind=classifier.kind,
                element=graph.qualified_name(classifier),
                general_kind=general.kind,
                general=graph.qualified_name(general),
            )


def _is_same_kind(specific: Element, general: Element) -> bool:
    return specific.kind is general.kind or {specific.kind, general.kind} <= _CLASSES


def _check_relation(
    graph: Graph, sink: Sink, edge: Edge, feature: Element, other: Element, hierarchy: _Hierarchy
) -> None:
    if other.attrs.get("external"):
        return
    if not _can_relate(graph, edge, feature, other, hierarchy):
        owner, other_owner = _name_owner(graph, feature), _name_owner(graph, other)
        shown = f"the other '{owner}'" if owner == other_owner else f"'{other_owner}'"
        cause = _describe_missing_generalization(graph.owner(feature), graph.owner(other))
        facts = {"owner": owner, "other_owner": shown}
        _report_relation(graph, sink, NOT_INHERITED, edge, (feature, other), cause, **facts)
        return
    _check_types(graph, sink, edge, feature, other)
    _check_multiplicities(graph, sink, edge, feature, other, hierarchy)


def _name_owner(graph: Graph, feature: Element) -> str:
    owner = graph.owner(feature)
    return "the model" if owner is None else owner.name or graph.qualified_name(owner)


def _check_types(graph: Graph, sink: Sink, edge: Edge, feature: Element, other: Element) -> None:
    type_, general = (graph.target(element, Edge.TYPED_BY) for element in (feature, other))
    if type_ is not None and type_.subkind == "attribute":
        return  # In AutomationML a nested attribute replaces the inherited attribute as a whole.
    if type_ is None or general is None or _is_narrower(graph, type_, general):
        return
    cause = _describe_missing_generalization(type_, general)
    facts = {"type": type_.name, "other_type": general.name}
    _report_relation(graph, sink, TYPE_NOT_NARROWER, edge, (feature, other), cause, **facts)


def _describe_missing_generalization(specific: Element | None, general: Element | None) -> str:
    """Return the cause of findings that a generalization between two classifiers removes."""
    ids = (element.id for element in (specific, general) if element is not None)
    return f"no generalization {' '.join(ids)}"


def _check_multiplicities(
    graph: Graph, sink: Sink, edge: Edge, feature: Element, other: Element, hierarchy: _Hierarchy
) -> None:
    type_ = graph.target(feature, Edge.TYPED_BY)
    if not _allows_more(feature, other) or (type_ is not None and type_.subkind == "attribute"):
        return
    if "multiplicity" not in other.attrs and other.source in hierarchy.caex_files:
        return  # An interface of AutomationML without Cardinality may occur any number of times.
    facts = {
        key: str(element.attrs.get("multiplicity", "1"))
        for key, element in (("multiplicity", feature), ("other_multiplicity", other))
    }
    _report_relation(graph, sink, MULTIPLICITY_WIDER, edge, (feature, other), **facts)


def _report_relation(
    graph: Graph,
    sink: Sink,
    rule: Rule,
    edge: Edge,
    features: tuple[Element, Element],
    cause: str = "",
    **facts: str,
) -> None:
    """Report a rule about a feature that redefines or subsets another one."""
    element, other = map(graph.qualified_name, features)
    facts |= {"element": element, "relation": _RELATIONS[edge], "other": other}
    sink.report(rule, graph.subject(features[0]), notes=(), help="", cause=cause, **facts)


def _can_relate(
    graph: Graph, edge: Edge, feature: Element, other: Element, hierarchy: _Hierarchy
) -> bool:
    owner, other_owner = graph.owner(feature), graph.owner(other)
    if owner is None or other_owner is None:
        return False
    if hierarchy.is_general_of(other_owner, owner) or other_owner in graph.targets(
        owner, Edge.REDEFINES
    ):
        return True
    if _is_feature_of_role(graph, owner, other_owner, hierarchy):
        return True
    # Association ends relate through the classifiers at the other side, which is not checked.
    if Kind.ASSOCIATION in (owner.kind, other_owner.kind) or owner.kind not in CLASSIFIERS:
        return True
    return edge is Edge.SUBSETS and owner is other_owner


def _is_feature_of_role(
    graph: Graph, owner: Element, role_class: Element, hierarchy: _Hierarchy
) -> bool:
    """Whether a mapping object of AutomationML may map a feature of *owner* to *role_class*.

    The mapping may belong to the class that has the feature, to a class or an instance that
    inherits it, or to an attribute inside of one of these.
    """
    owner, role_class = (_find_holder(graph, element) for element in (owner, role_class))
    if role_class.subkind != "role-class":
        return False
    clients = [owner]
    for client in clients:
        edges = (Edge.SPECIALIZES, Edge.TYPED_BY, Edge.INSTANCE_OF)
        users = [user for edge in edges for user in graph.sources(client, edge)]
        clients += (user for user in users if user not in clients)
    clients += generals(graph, owner)
    roles = [role for client in clients for role in graph.targets(client, Edge.REALIZES)]
    return any(role is role_class or hierarchy.is_general_of(role_class, role) for role in roles)


def _find_holder(graph: Graph, element: Element) -> Element:
    """Return the class around the nested attributes that *element* is the type of."""
    holder: Element | None = element
    while holder is not None and holder.subkind == "attribute":
        holder = graph.owner(holder)
    return holder or element


def _is_narrower(graph: Graph, narrow: Element, wide: Element) -> bool:
    above = [narrow, *generals(graph, narrow), wide]
    # The generals of an external stub are unknown, so that any type may conform.
    return any(classifier.attrs.get("external") for classifier in above) or conforms(
        graph, narrow, wide
    )


def _allows_more(feature: Element, other: Element) -> bool:
    limits, other_limits = (
        bounds(element.attrs.get("multiplicity")) for element in (feature, other)
    )
    if limits is None or other_limits is None or other_limits[1] is None:
        return False
    return limits[1] is None or limits[1] > other_limits[1]
