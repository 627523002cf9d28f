"""Units and quantity kinds: what is one, what it says, and which value type has which.

SysML 1.0 to 1.2 have stereotypes for them; since SysML 1.3 they are instances of library blocks
(SysML 1.6 clause 8.3.3.2 and annex E.5, QUDV). Tools without the library write plain text.
"""

import re
from collections.abc import Iterator, Mapping

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.ir.query import generals
from sysmlc.ir.query.units import is_quantity_kind, is_unit
from sysmlc.passes.classify.tags import elements, value

_QUANTITY_KIND = re.compile(r"(Simple|Derived|Specialized)?QuantityKind")
_UNIT = re.compile(
    r"(Simple|Derived|Prefixed|ConversionBased|(Linear|Affine|General)Conversion)?Unit"
)
_KINDS = (Kind.UNIT, Kind.QUANTITY_KIND, Kind.INSTANCE, Kind.DATA_TYPE)
_LIBRARY = re.compile(r"UnitAndQuantityKind|QUDV")
_TEXTS = {"symbol": "symbol", "description": "description", "definitionURI": "definition_uri"}
_NAMED = re.compile(r"(?P<kind>[^\[\]]+)\[(?P<unit>[^\[\]]+)\]")
"""Name of a value type of MagicDraw's ISO 80000 library: ``length[metre]``."""


def give_units(graph: Graph, known: Mapping[str, tuple[str, ...]]) -> None:
    """Find units and quantity kinds, and lead each value type to its own; see docs/ir.md."""
    _give_library_roles(graph)
    for unit in graph.of_kind(*_KINDS):
        if is_unit(unit) or is_quantity_kind(unit):
            _describe(graph, unit)
    give_symbols(graph)
    for id in (id for id, names in known.items() if "ValueType" in names or "Unit" in names):
        for subject in graph.targets(graph[id], Edge.SUBJECT):
            _refer(graph, graph[id], subject)
    for value_type in graph.of_kind(Kind.DATA_TYPE):
        _refer_by_name(graph, value_type)


# -- what is a unit ----------------------------------------------------------------------------


def _give_library_roles(graph: Graph) -> None:
    for instance in graph.of_kind(Kind.INSTANCE):
        if not instance.role:
            graph.set(instance, role=_library_role(graph, instance))


def _library_role(graph: Graph, instance: Element) -> str | None:
    for direct in graph.targets(instance, Edge.INSTANCE_OF):
        for one in (direct, *generals(graph, direct)):
            role = _role_of_block(one.name)
            if role and (one.attrs.get("external") or _is_in_library(graph, one)):
                return role
    return None


def _role_of_block(name: str) -> str:
    if _UNIT.fullmatch(name):
        return "unit"
    return "quantity kind" if _QUANTITY_KIND.fullmatch(name) else ""


def _is_in_library(graph: Graph, block: Element) -> bool:
    return any(_LIBRARY.search(above.name) for above in graph.ancestors(block))


# -- what it says ------------------------------------------------------------------------------


def _describe(graph: Graph, unit: Element) -> None:
    for slot in graph.owned(unit):
        for feature in graph.targets(slot, Edge.INSTANCE_OF) if slot.kind is Kind.SLOT else ():
            if feature.name in _TEXTS and slot.attrs.get("value") not in (None, ""):
                graph.set(unit, **{_TEXTS[feature.name]: slot.attrs["value"]})
            elif feature.name in ("quantityKind", "quantityKinds"):
                for kind in graph.targets(slot, Edge.REFERENCES):
                    graph.connect(Edge.REFERENCES, unit, kind)
    for application in graph.sources(unit, Edge.SUBJECT):
        for tag, attribute in _TEXTS.items() if application.kind is Kind.APPLICATION else ():
            given = value(application, tag)
            if given not in (None, ""):
                graph.set(unit, **{attribute: given})


# -- which value type has which ----------------------------------------------------------------


def _refer(graph: Graph, application: Element, subject: Element) -> None:
    """Follow the tags ``unit`` and ``quantityKind`` (``dimension`` in SysML 1.0 and 1.1)."""
    for tag, kind in (
        ("unit", Kind.UNIT),
        ("quantityKind", Kind.QUANTITY_KIND),
        ("dimension", Kind.QUANTITY_KIND),
    ):
        given = value(application, tag)
        found = elements(graph, application, tag) or _stubs(graph, subject, given)
        if not found and _is_readable(given):
            found = [_named(graph, application.id, subject, kind, str(given).strip())]
        for target in found:
            _settle(graph, target, kind)
            if target is not subject:
                graph.connect(Edge.REFERENCES, subject, target)


def _stubs(graph: Graph, subject: Element, given: AttrValue) -> list[Element]:
    """What the front end has left of a unit in a file that is not there."""
    referred = graph.targets(subject, Edge.REFERENCES)
    return [one for one in referred if given and one.attrs.get("href") == given]


def _is_readable(given: AttrValue) -> bool:
    """Whether it is a name; what has ``#`` or looks like a tool's id is a broken reference."""
    if not isinstance(given, str) or not given.strip():
        return False
    return "#" not in given and not re.fullmatch(r"_\S{15,}|EAID_\S+", given)


def _settle(graph: Graph, target: Element, kind: Kind) -> None:
    """What a value type names as its unit is a unit, also when nothing else is known of it."""
    if target.kind is not kind and not target.role:
        graph.set(target, role="unit" if kind is Kind.UNIT else "quantity kind")


def _named(graph: Graph, origin: str, owner: Element, kind: Kind, name: str) -> Element:
    id = derived_id(origin, f"{kind} {name}")
    known = graph.get(id)
    if known is not None:
        return known
    made = Element(id, kind, name, owner.id)
    made.attrs["origin"] = origin
    if owner.attrs.get("external"):
        made.attrs["external"] = True
    return graph.add(made)


def _refer_by_name(graph: Graph, value_type: Element) -> None:
    found = _NAMED.fullmatch(value_type.name) if value_type.attrs.get("external") else None
    if found is None or not _is_used(graph, value_type):
        return
    if not any(map(is_unit, graph.targets(value_type, Edge.REFERENCES))):
        for kind, name in ((Kind.UNIT, found["unit"]), (Kind.QUANTITY_KIND, found["kind"])):
            made = _named(graph, value_type.id, value_type, kind, name.strip())
            graph.connect(Edge.REFERENCES, value_type, made)


def _is_used(graph: Graph, value_type: Element) -> bool:
    return any(not one.attrs.get("external") for one in _users(graph, value_type))


def _users(graph: Graph, value_type: Element) -> Iterator[Element]:
    yield from graph.sources(value_type, Edge.TYPED_BY)
    yield from graph.sources(value_type, Edge.SPECIALIZES)


def give_symbols(graph: Graph) -> None:
    """Set the symbol of each unit without one whose factors are all known."""
    for unit in graph.of_kind(Kind.INSTANCE):
        if is_unit(unit) and "symbol" not in unit.attrs:
            parts = [_part(graph, factor) for factor in _referred(graph, unit, "factor")]
            if parts and all(parts):
                graph.set(unit, symbol="·".join(parts))


def _part(graph: Graph, factor: Element) -> str:
    unit = next(_referred(graph, factor, "unit"), None)
    if unit is None or not is_unit(unit):
        return ""
    exponent = _exponent(graph, factor)
    text = str(unit.attrs.get("symbol") or unit.name)
    return text if exponent in ("", "1") else f"{text}^{exponent}"


def _exponent(graph: Graph, factor: Element) -> str:
    rational = next(_referred(graph, factor, "exponent"), None)
    if rational is None:
        return _shown(_slot_value(graph, factor, "exponent"))
    above, below = (_shown(_slot_value(graph, rational, n)) for n in ("numerator", "denominator"))
    return above if below in ("", "1") else f"({above}/{below})"


def _shown(value: AttrValue) -> str:
    return "" if value is None else str(value)


def _slots(graph: Graph, instance: Element, feature: str) -> Iterator[Element]:
    for slot in graph.owned(instance):
        if slot.kind is Kind.SLOT:
            names = {one.name for one in graph.targets(slot, Edge.INSTANCE_OF)}
            if names & {feature, f"{feature}s"}:
                yield slot


def _referred(graph: Graph, instance: Element, feature: str) -> Iterator[Element]:
    for slot in _slots(graph, instance, feature):
        yield from graph.targets(slot, Edge.REFERENCES)


def _slot_value(graph: Graph, instance: Element, feature: str) -> AttrValue:
    found = (slot.attrs.get("value") for slot in _slots(graph, instance, feature))
    return next((one for one in found if one is not None), None)
