"""A property as a variable: which values it is declared to have, which one it starts with."""

from collections.abc import Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.domains import contains
from sysmlc.logic.expressions.enumerations import literals_of
from sysmlc.logic.expressions.ranges import declared_range, integer
from sysmlc.logic.formula import Literal

_BOOLEAN = frozenset(["boolean", "bool", "eboolean"])
_INTEGER = frozenset(
    ["integer", "int", "natural", "positive", "unlimitednatural", "eint", "short", "long", "byte"]
)
_UNSIGNED = frozenset(["natural", "positive", "unlimitednatural"])
_STRING = frozenset(["string", "estring", "java.lang.string"])


class Feature(Struct, frozen=True):
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


def fixed(element: Element) -> int | None:
    """The Integer that an element always is."""
    return integer(element.attrs.get("default")) if element.attrs.get("readonly") else None


def feature(
    graph: Graph,
    element: Element,
    variable: str,
    assumed: tuple[int, int],
    fixed: Mapping[str, int],
    seen: tuple[Element, str] | None = None,
) -> Feature:
    """The property as a variable.

    ``assumed`` is the range of an Integer that has none, ``fixed`` has Integers that never change,
    ``seen`` is the classifier that knows the property by a dotted name.
    """
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
        literals = tuple(literals_of(graph, type_).values())
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


# -- texts -------------------------------------------------------------------------------------


def is_text(graph: Graph, feature: Feature) -> bool:
    """Whether it holds texts, of which nobody knows yet which ones."""
    type_ = query.type_of(graph, feature.element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    return feature.domain is None and bool(_names(family) & _STRING)


def as_text(feature: Feature, domain: EnumerationDomain) -> Feature:
    """The same with the texts that it can be."""
    text = first_text(feature.element)
    default = None if text is None else domain.literals[domain.texts.index(text)]
    constant = feature.element.attrs.get("readonly") is True and default is not None
    return replace(feature, domain=domain, default=default, constant=constant, refused="")


def first_text(element: Element) -> str | None:
    """The text that a property starts with."""
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
    return literals_of(graph, type_).get(name)
