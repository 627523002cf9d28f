"""What names mean inside a classifier: its properties as variables with finite domains."""

from collections.abc import Iterator, Mapping

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.domains import describe
from sysmlc.logic.expressions.context_objects import of_objects, of_ports
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.enumerations import Enumerations
from sysmlc.logic.expressions.features import Features, variables

VALUES = (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY, Kind.PARAMETER)
"""Kinds of what has a value in a context."""

ASSUMED_RANGE = rule(
    "SM410",
    "assumed-range",
    Severity.INFO,
    "property '{name}' has no range; {range} is assumed",
    help="constrain it ({name} >= {low} and {name} <= {high}) or give it a value type with a range",
)

DEFAULT_OUTSIDE = rule(
    "SM433",
    "default-out-of-range",
    Severity.ERROR,
    "default value '{default}' of property '{name}' is none of {domain}",
    help="correct the default value or the range",
)


class Context(Struct, frozen=True):
    """What the names of expressions mean inside one classifier."""

    name: str
    features: Mapping[str, Feature]
    enumerations: Enumerations

    @property
    def variables(self) -> Mapping[str, str]:
        """The variable of each feature, without a look at its values."""
        return self.features.variables if isinstance(self.features, Features) else {}

    @property
    def literals(self) -> dict[str, tuple[str, str]]:
        """Enumeration literals by written name: (enumeration, identifier)."""
        return self.enumerations.literals

    def number(self, written: str) -> int | None:
        """The number that an enumeration literal stands for, by written name."""
        return self.enumerations.number(written)


def context_of(
    graph: Graph,
    classifier: Element | None,
    assumed: tuple[int, int] = (0, 15),
    within: Element | None = None,
) -> Context:
    """The context that a classifier gives; empty without one. A behaviour gives its parameters.

    ``assumed`` is the range of Integers that have none; ``within`` a behaviour of the classifier,
    whose own names go before.
    """
    known = Enumerations(graph)
    if classifier is None:
        return Context("", {}, known)
    named = _known(graph, classifier, within)
    features = Features(graph, classifier, within, named, assumed, known)
    return Context(classifier.name, features, known)


def variables_of(
    graph: Graph, classifier: Element | None, within: Element | None = None
) -> dict[str, str]:
    """The variables that names stand for in ``context_of``, without what values they have."""
    return {} if classifier is None else variables(graph, _known(graph, classifier, within))


def _known(graph: Graph, classifier: Element, within: Element | None) -> dict[str, Element]:
    named = of_ports(graph, classifier) | named_values(graph, classifier)
    named |= of_objects(graph, classifier)
    if within is not None and within is not classifier:
        named |= named_values(graph, within) | of_objects(graph, within)
    return named


def named_values(graph: Graph, classifier: Element) -> dict[str, Element]:
    """What has values in a classifier by its name, what it inherits, too; own ones go before."""
    known = [*query.features(graph, classifier), *query.parameters(graph, classifier)]
    found = [one for one in known if one.name and one.kind in VALUES]
    return {one.name: one for one in reversed([*found, *_inherited(graph, classifier)])}


def _inherited(graph: Graph, classifier: Element) -> Iterator[Element]:
    for general in query.generals(graph, classifier):
        yield from (one for one in graph.owned(general) if one.name and one.kind in VALUES)


def note_range(graph: Graph, feature: Feature, sink: Sink) -> None:
    """Report, of a property that matters, an assumed range and a default value outside it."""
    domain = feature.domain
    if feature.refused and domain is not None:
        subject, name = graph.subject(feature.element), feature.element.name
        shown = describe(domain)
        sink.report(DEFAULT_OUTSIDE, subject, default=feature.refused, name=name, domain=shown)
    if feature.is_assumed and isinstance(domain, IntegerDomain):
        low, high, name = domain.low, domain.high, feature.element.name
        subject, shown = graph.subject(feature.element), f"{low}..{high}"
        sink.report(ASSUMED_RANGE, subject, name=name, range=shown, low=low, high=high)
