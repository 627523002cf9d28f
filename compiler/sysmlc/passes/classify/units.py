"""Units and quantity kinds: their elements, their symbols, and the value types that use them.

SysML 1.0 to 1.2 have stereotypes for both; since SysML 1.3 both are instances of library blocks
(SysML 1.6 clause 8.3.3.2 and annex E.5, QUDV). Tools without the library write plain text.
"""

import re
from collections.abc import Iterator, Mapping

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.element import derived_id
from sysmlc.ir.query import generals
from sysmlc.ir.query.classifiers import is_quantity_kind, is_unit
from sysmlc.passes.classify.tags import tag_elements, tag_value

_QUANTITY_KIND = re.compile(r"(Simple|Derived|Specialized)?QuantityKind")
_UNIT = re.compile(
    r"(Simple|Derived|Prefixed|ConversionBased|(Linear|Affine|General)Conversion)?Unit"
)
_KINDS = (Kind.UNIT, Kind.QUANTITY_KIND, Kind.INSTANCE, Kind.DATA_TYPE)
_LIBRARY = re.compile(r"UnitAndQuantityKind|QUDV")
_TEXT_ATTRIBUTES = {
    "symbol": "symbol",
    "description": "description",
    "definitionURI": "definition_uri",
}
_VALUE_TYPE_NAME = re.compile(r"(?P<kind>[^\[\]]+)\[(?P<unit>[^\[\]]+)\]")
"""Name of a value type of MagicDraw's ISO 80000 library: ``length[metre]``."""


def link_units(graph: Graph, meanings: Mapping[str, tuple[str, ...]]) -> None:
    """Set the roles of units and quantity kinds, and link value types to them; see docs/ir.md."""
    for instance in graph.of_kind(Kind.INSTANCE):
        if not instance.role:
            graph.set(instance, role=_library_role(graph, instance))
    for unit in graph.of_kind(*_KINDS):
        if is_unit(unit) or is_quantity_kind(unit):
            _describe_unit(graph, unit)
    _give_symbols(graph)
    for id in (id for id, names in meanings.items() if "ValueType" in names or "Unit" in names):
        for subject in graph.targets(graph[id], Edge.SUBJECT):
            _link_by_tags(graph, graph[id], subject)
    for value_type in graph.of_kind(Kind.DATA_TYPE):
        _link_by_name(graph, value_type)


# -- units and quantity kinds ------------------------------------------------------------------


def _library_role(graph: Graph, instance: Element) -> str | None:
    for direct in graph.targets(instance, Edge.INSTANCE_OF):
        for classifier in (direct, *generals(graph, direct)):
            role = _role_of_block(classifier.name)
            if role and (classifier.attrs.get("external") or _is_in_library(graph, classifier)):
                return role
    return None


def _role_of_block(name: str) -> str:
    if _UNIT.fullmatch(name):
        return "unit"
    return "quantity kind" if _QUANTITY_KIND.fullmatch(name) else ""


def _is_in_library(graph: Graph, block: Element) -> bool:
    return any(_LIBRARY.search(above.name) for above in graph.ancestors(block))


# -- symbols and descriptions ------------------------------------------------------------------


def _describe_unit(graph: Graph, unit: Element) -> None:
    for slot in graph.owned(unit):
        if slot.kind is Kind.SLOT:
            for feature in graph.targets(slot, Edge.INSTANCE_OF):
                if feature.name in _TEXT_ATTRIBUTES and slot.attrs.get("value") not in (None, ""):
                    graph.set(unit, **{_TEXT_ATTRIBUTES[feature.name]: slot.attrs["value"]})
                elif feature.name in ("quantityKind", "quantityKinds"):
                    for kind in graph.targets(slot, Edge.REFERENCES):
                        graph.connect(Edge.REFERENCES, unit, kind)
    for application in graph.sources(unit, Edge.SUBJECT):
        if application.kind is Kind.APPLICATION:
            for tag, attribute in _TEXT_ATTRIBUTES.items():
                text = tag_value(application, tag)
                if text not in (None, ""):
                    graph.set(unit, **{attribute: text})


# -- value types -------------------------------------------------------------------------------


def _link_by_tags(graph: Graph, application: Element, subject: Element) -> None:
    """Link a value type to the elements in its tags ``unit`` and ``quantityKind``.

    Until SysML 1.1 the latter tag is called ``dimension``.
    """
    for tag, kind in (
        ("unit", Kind.UNIT),
        ("quantityKind", Kind.QUANTITY_KIND),
        ("dimension", Kind.QUANTITY_KIND),
    ):
        tag_content = tag_value(application, tag)
        targets = tag_elements(graph, application, tag) or _find_stubs(graph, subject, tag_content)
        if not targets and _is_name(tag_content):
            targets = [
                _ensure_named(graph, application.id, subject, kind, str(tag_content).strip())
            ]
        for target in targets:
            _give_unit_role(graph, target, kind)
            if target is not subject:
                graph.connect(Edge.REFERENCES, subject, target)


def _find_stubs(graph: Graph, subject: Element, href: AttrValue) -> list[Element]:
    """Return the stubs that the front end added for a unit in a file outside the compile unit."""
    referred = graph.targets(subject, Edge.REFERENCES)
    return [element for element in referred if href and element.attrs.get("href") == href]


def _is_name(text: AttrValue) -> bool:
    """Whether the text of a tag is the name of a unit, not a broken reference.

    Broken references contain ``#`` or have the form of a tool's id.
    """
    if not isinstance(text, str) or not text.strip():
        return False
    return "#" not in text and not re.fullmatch(r"_\S{15,}|EAID_\S+", text)


def _give_unit_role(graph: Graph, target: Element, kind: Kind) -> None:
    """Set the role of the target of a tag, unless its kind or a role states the same."""
    if target.kind is not kind and not target.role:
        graph.set(target, role="unit" if kind is Kind.UNIT else "quantity kind")


def _ensure_named(graph: Graph, origin: str, owner: Element, kind: Kind, name: str) -> Element:
    id = derived_id(origin, f"{kind} {name}")
    existing = graph.get(id)
    if existing is not None:
        return existing
    element = Element(id, kind, name, owner.id)
    element.attrs["origin"] = origin
    if owner.attrs.get("external"):
        element.attrs["external"] = True
    return graph.add(element)


def _link_by_name(graph: Graph, value_type: Element) -> None:
    match = (
        _VALUE_TYPE_NAME.fullmatch(value_type.name) if value_type.attrs.get("external") else None
    )
    uses = (graph.sources(value_type, edge) for edge in (Edge.TYPED_BY, Edge.SPECIALIZES))
    if match is None or all(user.attrs.get("external") for users in uses for user in users):
        return
    if not any(map(is_unit, graph.targets(value_type, Edge.REFERENCES))):
        for kind, name in ((Kind.UNIT, match["unit"]), (Kind.QUANTITY_KIND, match["kind"])):
            element = _ensure_named(graph, value_type.id, value_type, kind, name.strip())
            graph.connect(Edge.REFERENCES, value_type, element)


def _give_symbols(graph: Graph) -> None:
    """Set the symbol of each derived unit without a symbol, such as ``m·s^-1``, from its factors.

    A DerivedUnit of QUDV has UnitFactors, each with a unit and an exponent, which is a number or an
    instance of Rational (SysML 1.6 annex E.5). All factors must be known.
    """
    for unit in graph.of_kind(Kind.INSTANCE):
        if is_unit(unit) and "symbol" not in unit.attrs:
            parts = [
                _write_factor(graph, factor) for factor in _referred_by_slots(graph, unit, "factor")
            ]
            if parts and all(parts):
                graph.set(unit, symbol="·".join(parts))


def _write_factor(graph: Graph, factor: Element) -> str:
    unit = next(_referred_by_slots(graph, factor, "unit"), None)
    if unit is None or not is_unit(unit):
        return ""
    exponent = _write_exponent(graph, factor)
    text = str(unit.attrs.get("symbol") or unit.name)
    return text if exponent in ("", "1") else f"{text}^{exponent}"


def _write_exponent(graph: Graph, factor: Element) -> str:
    rational = next(_referred_by_slots(graph, factor, "exponent"), None)
    if rational is None:
        return _as_text(_slot_value(graph, factor, "exponent"))
    numerator, denominator = (
        _as_text(_slot_value(graph, rational, feature)) for feature in ("numerator", "denominator")
    )
    return numerator if denominator in ("", "1") else f"({numerator}/{denominator})"


def _as_text(value: AttrValue) -> str:
    return "" if value is None else str(value)


def _find_slots(graph: Graph, instance: Element, feature: str) -> Iterator[Element]:
    for slot in graph.owned(instance):
        if slot.kind is Kind.SLOT:
            names = {defining.name for defining in graph.targets(slot, Edge.INSTANCE_OF)}
            if names & {feature, f"{feature}s"}:
                yield slot


def _referred_by_slots(graph: Graph, instance: Element, feature: str) -> Iterator[Element]:
    for slot in _find_slots(graph, instance, feature):
        yield from graph.targets(slot, Edge.REFERENCES)


def _slot_value(graph: Graph, instance: Element, feature: str) -> AttrValue:
    values = (slot.attrs.get("value") for slot in _find_slots(graph, instance, feature))
    return next((value for value in values if value is not None), None)
