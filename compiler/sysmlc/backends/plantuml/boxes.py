"""Boxes of classifiers: their headings, and their features in compartments."""

from collections.abc import Callable, Iterator, Mapping, Sequence

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.relations import list_block_allocations
from sysmlc.backends.plantuml.views import Aliases, Box, Compartment
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query.classifiers import is_quantity_kind, is_unit, quantity_kind_of, unit_of
from sysmlc.support.plantuml_text import escape_line, join_rows, shrink, wrap_lines

_BY_ROLE = {
    "value": "values",
    "part": "parts",
    "reference": "references",
    "flow property": "flow properties",
    "constraint property": "constraints",
    "constraint parameter": "parameters",
}
_BY_KIND = {
    Kind.PROPERTY: "attributes",
    Kind.FLOW_PROPERTY: "flow properties",
    Kind.PORT: "ports",
    Kind.OPERATION: "operations",
    Kind.RECEPTION: "receptions",
    Kind.CONSTRAINT: "constraints",
    Kind.ENUMERATION_LITERAL: "literals",
    Kind.ACTIVITY: "behaviors",
    Kind.STATE_MACHINE: "behaviors",
    Kind.INTERACTION: "behaviors",
    Kind.SLOT: "slots",
    Kind.COLLABORATION_USE: "collaborations",
    Kind.PARAMETER: "parameters",
}
_TITLES = (
    "literals values parts references attributes flow_properties ports "
    "parameters constraints operations receptions slots collaborations behaviors allocations"
)
_ORDER = tuple(title.replace("_", " ") for title in _TITLES.split())
_ROW_WIDTH = 64


def make_box(
    graph: Graph,
    item: Element,
    aliases: Aliases,
    in_lines: set[str],
    in_rows: Mapping[str, tuple[str, ...]],
    features: Sequence[Element] | None = None,
) -> Box:
    """Return the box of a classifier, with its features in compartments.

    If *features* is given, only these have rows. A feature in *in_lines* is drawn as a line, so it
    has no row; *in_rows* lists further ids that the row of a feature shows.
    """
    rows: dict[str, list[str]] = {}
    shows = [item.id]
    for feature in graph.owned(item) if features is None else features:
        title = _find_compartment(feature)
        if title and feature.id not in in_lines:
            rows.setdefault(title, []).extend(_format_rows(graph, feature))
            shows += [part.id for part in _iter_shown(graph, feature)]
            shows += in_rows.get(feature.id, ())
    if features is None:
        rows["allocations"], allocations = list_block_allocations(graph, item)
        shows += allocations
    compartments = tuple(Compartment(t, tuple(rows[t])) for t in _ORDER if rows.get(t))
    measures = _list_measure_rows(graph, item)
    if measures:
        compartments = (Compartment("", measures), *compartments)
        shows += _iter_measure_ids(graph, item)
    alias = aliases.make(item.id, item.name, str(item.kind))
    return Box(alias, make_heading(graph, item), _choose_style(item), compartments, tuple(shows))


def _find_compartment(feature: Element) -> str:
    if feature.kind is Kind.PROPERTY or feature.role == "constraint parameter":
        return _BY_ROLE.get(feature.role, "attributes")
    return _BY_KIND.get(feature.kind, "")


def _format_rows(graph: Graph, feature: Element) -> tuple[str, ...]:
    text = _TEXTS.get(feature.kind)
    if text is not None:
        return wrap_lines(text(graph, feature), _ROW_WIDTH)
    parts = (
        _format_keywords(graph, feature),
        labels.feature(graph, feature),
        format_unit(graph, feature) if feature.role == "value" else "",
    )
    return wrap_lines(" ".join(part for part in parts if part), _ROW_WIDTH)


def _format_behaviour(graph: Graph, feature: Element) -> str:
    words = labels.guillemets(labels.keywords(graph, feature))
    return f"{words} {labels.name(feature)}{labels.signature(graph, feature)}".strip()


_TEXTS: dict[Kind, Callable[[Graph, Element], str]] = {
    Kind.OPERATION: labels.operation,
    Kind.CONSTRAINT: lambda _, feature: labels.condition(feature),
    Kind.ACTIVITY: _format_behaviour,
    Kind.STATE_MACHINE: _format_behaviour,
    Kind.INTERACTION: _format_behaviour,
    Kind.SLOT: labels.slot,
    Kind.COLLABORATION_USE: labels.collaboration_use,
    Kind.ENUMERATION_LITERAL: lambda _, feature: labels.name(feature),
}
"""Functions that format features other than properties, ports and parameters."""


def _format_keywords(graph: Graph, feature: Element) -> str:
    """Return the stereotypes of a feature, except those that its compartment implies."""
    implied = {
        "flowProperty",
        "partProperty",
        "valueProperty",
        "constraintProperty",
        "part",
        "value",
    }
    words = labels.keywords(graph, feature) if feature.kind is not Kind.RECEPTION else ("signal",)
    return labels.guillemets(
        word for word in words if word not in implied and feature.role != "constraint property"
    )


def make_heading(graph: Graph, item: Element, where: str = "") -> str:
    """Return the heading of a box: stereotypes, name, and *where* a foreign element is defined."""
    words = shrink(escape_line(labels.guillemets(labels.keywords(graph, item))))
    mark = "//" if item.attrs.get("abstract") else "**"
    is_instance = item.kind is Kind.INSTANCE
    own_text = labels.name(item) + labels.template(graph, item)
    text = labels.instance(graph, item) if is_instance else own_text
    rows = [f"{mark}{row}{mark}" for row in wrap_lines(text)]
    return join_rows([words, *rows, *(shrink(row) for row in wrap_lines(where, 48))])


def make_stub(graph: Graph, item: Element, aliases: Aliases) -> Box:
    """Return the box of an element that another diagram defines."""
    owner = graph.owner(item)
    where = f"from {graph.qualified_name(owner)}" if owner is not None else ""
    if item.attrs.get("external"):
        file = str(item.attrs.get("href", "")).partition("#")[0]
        where = f"in {file}" if file else "external"
    alias = aliases.make(item.id, item.name, str(item.kind))
    return Box(alias, make_heading(graph, item, where), "elsewhere", shows=(item.id,))


def _choose_style(item: Element) -> str:
    if item.kind in (Kind.DATA_TYPE, Kind.ENUMERATION, Kind.SIGNAL, Kind.INSTANCE):
        return "value"
    return "interface" if item.kind is Kind.INTERFACE or "interface" in item.role else "block"


def _iter_shown(graph: Graph, feature: Element) -> Iterator[Element]:
    """Yield the feature, and the parameters that its signature shows."""
    yield feature
    if feature.kind in (Kind.OPERATION, Kind.ACTIVITY, Kind.STATE_MACHINE):
        yield from (item for item in graph.owned(feature) if item.kind is Kind.PARAMETER)
    if feature.kind is Kind.COLLABORATION_USE:
        yield from graph.owned(feature)


def _list_measure_rows(graph: Graph, item: Element) -> tuple[str, ...]:
    """Return rows such as ``unit = kilogram (kg)`` of a value type."""
    if item.role != "value type" or is_unit(item) or is_quantity_kind(item):
        return ()
    measures = (("unit", unit_of(graph, item)), ("quantityKind", quantity_kind_of(graph, item)))
    pairs = ((title, element) for title, element in measures if element is not None)
    return tuple(
        row
        for title, element in pairs
        for row in wrap_lines(f"{title} = {_format_measure(element)}")
    )


def _iter_measure_ids(graph: Graph, item: Element) -> Iterator[str]:
    """Yield the ids of the units and quantity kinds that ``_list_measure_rows`` shows."""
    for element in graph.targets(item, Edge.REFERENCES):
        if is_unit(element) or is_quantity_kind(element):
            yield element.id


def format_unit(graph: Graph, feature: Element) -> str:
    """Return ``{unit = kg}`` for a value property, unless its type is named after the unit."""
    unit = unit_of(graph, feature)
    if unit is None:
        return ""
    text = str(unit.attrs.get("symbol") or labels.name(unit))
    type_ = labels.type_name(graph, feature)
    return "" if text in type_ or labels.name(unit) in type_ else f"{{unit = {text}}}"


def _format_measure(element: Element) -> str:
    symbol = str(element.attrs.get("symbol", ""))
    name = labels.name(element)
    return f"{name} ({symbol})" if symbol and symbol != name else name
