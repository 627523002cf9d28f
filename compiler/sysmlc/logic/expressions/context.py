"""What names mean inside a classifier: its properties as variables with finite domains."""

from collections.abc import Iterator, Mapping
from dataclasses import field

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.domains import contains, describe
from sysmlc.logic.expressions.context_objects import direction_at, of_objects, of_ports
from sysmlc.logic.expressions.mentioned import BEHAVIOURS, Mentioned, mentioned
from sysmlc.logic.expressions.ranges import declared_range, integer
from sysmlc.logic.formula import Literal
from sysmlc.logic.names import unique
from sysmlc.logic.samples import arrow, machine
from sysmlc.values import dataclass, replace

ASSUMED_RANGE = rule(
    "SM410",
    "assumed-range",
    Severity.INFO,
    "property '{name}' has no range; {range} is assumed",
    why="Contracts have finite domains: an Integer needs a least and a greatest value.",
    help="constrain it ({name} >= {low} and {name} <= {high}) or give it a value type with a range",
    wrong=machine(arrow("a", "b", "start", "size > 2")),
    right=machine(arrow("a", "b", "start", "level > 2")),
)

DEFAULT_OUTSIDE = rule(
    "SM433",
    "default-out-of-range",
    Severity.ERROR,
    "default value '{default}' of property '{name}' is none of {domain}",
    why="The property cannot start with it.",
    help="correct the default value or the range",
    wrong=machine(arrow("a", "b", "start", "level > 2")).replace("default=0", "default=33", 1),
    right=machine(arrow("a", "b", "start", "level > 2")).replace("default=0", "default=3", 1),
)

_BOOLEAN = frozenset(["boolean", "bool", "eboolean"])
_INTEGER = frozenset(
    ["integer", "int", "natural", "positive", "unlimitednatural", "eint", "short", "long", "byte"]
)
_UNSIGNED = frozenset(["natural", "positive", "unlimitednatural"])


@dataclass(frozen=True, slots=True)
class Feature:
    """A property as a variable; ``domain`` is None when its values are not finite."""

    element: Element
    variable: str
    domain: Domain | None
    default: Literal | None = None
    constant: bool = False
    is_assumed: bool = False
    """Whether the range is assumed; ``note_range`` says so when the property is used."""
    refused: str = ""
    """A default value that is not in the domain."""
    direction: str = ""
    """``in``, ``out`` or ``inout`` as its owner sees it; empty when it has none."""


@dataclass(frozen=True, slots=True)
class Context:
    """What the names of expressions mean inside one classifier."""

    name: str
    features: dict[str, Feature]
    literals: dict[str, tuple[str, str]]
    """Enumeration literals by written name: (enumeration, identifier)."""
    numbers: dict[str, int] = field(default_factory=dict)
    """Numbers that enumeration literals stand for, by written name."""


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
    numbers = _numbers(graph)
    if classifier is None:
        return Context("", {}, _literals(graph), numbers)
    named = _known(graph, classifier, within)
    variables = _variables(named)
    fixed = {one.name: value for one in named.values() if (value := _fixed(one)) is not None}
    features = {
        name: _feature(graph, named[name], variable, assumed, fixed, _seen(classifier, name))
        for name, variable in variables.items()
    }
    features |= {
        name: replace(one, direction=direction_at(graph, classifier, name, one.element))
        for name, one in features.items()
        if "direction" in one.element.attrs
    }
    behaviour = within or classifier
    if behaviour.kind in BEHAVIOURS and any(_is_open(graph, one) for one in features.values()):
        said = mentioned(graph, behaviour, numbers)
        for name, one in features.items():
            if one.is_assumed and name in said.numbers:
                wide = _widened(assumed, said, name)
                made = _feature(graph, one.element, one.variable, wide, fixed)
                features[name] = replace(made, direction=one.direction)
        features |= _texts(graph, features, said)
    return Context(classifier.name, features, _literals(graph), numbers)


def variables_of(
    graph: Graph, classifier: Element | None, within: Element | None = None
) -> dict[str, str]:
    """The variables that names stand for in ``context_of``, without what values they have."""
    return {} if classifier is None else _variables(_known(graph, classifier, within))


def _known(graph: Graph, classifier: Element, within: Element | None) -> dict[str, Element]:
    named = of_ports(graph, classifier) | _named(graph, classifier)
    named |= of_objects(graph, classifier)
    if within is not None and within is not classifier:
        named |= _named(graph, within) | of_objects(graph, within)
    return named


def _variables(named: Mapping[str, Element]) -> dict[str, str]:
    names = sorted(named, key=lambda name: (named[name].ordinal, name))
    return dict(zip(names, unique(names, "value", "event", "none"), strict=True))


def _seen(classifier: Element, name: str) -> tuple[Element, str] | None:
    return (classifier, name) if "." in name else None


def _is_open(graph: Graph, feature: Feature) -> bool:
    """Whether what a behaviour mentions tells the values of a feature."""
    return feature.is_assumed or _is_text(graph, feature)


def _named(graph: Graph, classifier: Element) -> dict[str, Element]:
    known = [*query.features(graph, classifier), *query.parameters(graph, classifier)]
    found = [one for one in known if one.name and _is_value(one)]
    return {one.name: one for one in reversed([*found, *_inherited(graph, classifier)])}


def _inherited(graph: Graph, classifier: Element) -> Iterator[Element]:
    for general in query.generals(graph, classifier):
        yield from (one for one in graph.owned(general) if one.name and _is_value(one))


def _is_value(element: Element) -> bool:
    return element.kind in (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY, Kind.PARAMETER)


def _literals(graph: Graph) -> dict[str, tuple[str, str]]:
    found: dict[str, tuple[str, str]] = {}
    for enumeration in graph.of_kind(Kind.ENUMERATION):
        for name, made in _enumeration(graph, enumeration).items():
            for written in (name, f"{enumeration.name}::{name}", f"{enumeration.name}.{name}"):
                found.setdefault(written, (enumeration.name, made))
    return found


def _numbers(graph: Graph) -> dict[str, int]:
    found: dict[str, int] = {}
    for literal in graph.of_kind(Kind.ENUMERATION_LITERAL):
        value, owner = literal.attrs.get("value"), graph.owner(literal)
        if isinstance(value, int) and not isinstance(value, bool) and owner is not None:
            for sign in ("::", "."):
                found.setdefault(f"{owner.name}{sign}{literal.name}", value)
    return found


def _enumeration(graph: Graph, enumeration: Element) -> dict[str, str]:
    owned = graph.owned(enumeration)
    names = [one.name for one in owned if one.kind is Kind.ENUMERATION_LITERAL]
    return dict(zip(names, unique(names, "literal"), strict=True))


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


def _fixed(element: Element) -> int | None:
    """The Integer that an element always is."""
    return integer(element.attrs.get("default")) if element.attrs.get("readonly") else None


def _feature(
    graph: Graph,
    element: Element,
    variable: str,
    assumed: tuple[int, int],
    fixed: Mapping[str, int],
    seen: tuple[Element, str] | None = None,
) -> Feature:
    type_ = query.type_of(graph, element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    names = _names(family)
    is_integer = bool(names & _INTEGER) or _untyped_default(element, type_, int)
    domain = _domain(graph, element, family, names, is_integer, fixed, seen)
    is_assumed = domain is None and is_integer
    if is_assumed:
        domain = _assume(element, names, assumed)
    default = _default(graph, element, type_, domain)
    constant = element.attrs.get("readonly") is True and default is not None
    written = element.attrs.get("default")
    is_range = written is not None and ".." in str(written)
    refused = "" if written is None or default is not None or is_range else str(written)
    return Feature(element, variable, domain, default, constant, is_assumed, refused)


def _domain(
    graph: Graph,
    element: Element,
    family: list[Element],
    names: set[str],
    is_integer: bool,
    fixed: Mapping[str, int],
    seen: tuple[Element, str] | None,
) -> Domain | None:
    type_ = family[0] if family else None
    if type_ is not None and type_.kind is Kind.ENUMERATION:
        literals = tuple(_enumeration(graph, type_).values())
        return EnumerationDomain(literals) if literals else None
    if names & _BOOLEAN or _untyped_default(element, type_, bool):
        return BooleanDomain()
    return declared_range(graph, element, family, fixed, seen) if is_integer else None


def _names(family: list[Element]) -> set[str]:
    """What a type and those that it specialises are called, here or where they come from."""
    hrefs = (str(one.attrs.get("href", "")).rpartition("#")[2] for one in family)
    return {one.name.lower() for one in family} | {href.lower() for href in hrefs}


def _untyped_default(element: Element, type_: Element | None, kind: type) -> bool:
    return type_ is None and type(element.attrs.get("default")) is kind


def _assume(element: Element, names: set[str], assumed: tuple[int, int]) -> Domain:
    low, high = assumed
    low = max(low, 0) if names & _UNSIGNED else low
    default = element.attrs.get("default")
    if isinstance(default, int) and not isinstance(default, bool):
        low, high = min(low, default), max(high, default)
    return IntegerDomain(low, high)


def _widened(assumed: tuple[int, int], said: Mentioned, name: str) -> tuple[int, int]:
    """The range of Integers that have none, with the numbers that one is compared with."""
    numbers = said.numbers.get(name, ())
    return min((assumed[0], *numbers)), max((assumed[1], *numbers))


# -- texts -------------------------------------------------------------------------------------

_STRING = frozenset(["string", "estring", "java.lang.string"])
_OTHER = "other"


def _texts(graph: Graph, features: dict[str, Feature], said: Mentioned) -> dict[str, Feature]:
    """Features that hold texts: the values are those that the behaviour mentions, and any other."""
    found = {name: one for name, one in features.items() if _is_text(graph, one)}
    defaults = [text for one in found.values() if (text := _first_text(one.element)) is not None]
    texts = tuple(dict.fromkeys([*said.texts, *defaults]))
    if not said.texts or not found:
        return {}
    names = [text.strip() or "empty" for text in texts]
    domain = EnumerationDomain(unique([*names, _OTHER], "text"), texts)
    return {name: _as_text(one, domain) for name, one in found.items()}


def _is_text(graph: Graph, feature: Feature) -> bool:
    type_ = query.type_of(graph, feature.element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    return feature.domain is None and bool(_names(family) & _STRING)


def _as_text(feature: Feature, domain: EnumerationDomain) -> Feature:
    text = _first_text(feature.element)
    default = None if text is None else domain.literals[domain.texts.index(text)]
    constant = feature.element.attrs.get("readonly") is True and default is not None
    return replace(feature, domain=domain, default=default, constant=constant, refused="")


def _first_text(element: Element) -> str | None:
    text = element.attrs.get("default")
    return text if isinstance(text, str) and "default_language" not in element.attrs else None


# -- defaults ----------------------------------------------------------------------------------


def _default(
    graph: Graph, element: Element, type_: Element | None, domain: Domain | None
) -> Literal | None:
    written = element.attrs.get("default")
    if domain is None or written is None:
        return None
    value = _literal_value(graph, str(written), type_, domain)
    return value if value is not None and contains(domain, value) else None


def _literal_value(
    graph: Graph, text: str, type_: Element | None, domain: Domain
) -> Literal | None:
    match domain:
        case BooleanDomain():
            return {"true": True, "false": False}.get(text.lower())
        case IntegerDomain():
            return integer(text)
        case EnumerationDomain():
            return None if type_ is None else _enumerated(graph, text, type_)


def _enumerated(graph: Graph, text: str, type_: Element) -> Literal | None:
    named = graph.get(text)
    name = text.replace(".", "::").rpartition("::")[2] if named is None else named.name
    return _enumeration(graph, type_).get(name)
