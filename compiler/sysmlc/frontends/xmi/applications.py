"""Applications of stereotypes: siblings of the model that name their base elements."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import application_tags, metaclasses
from sysmlc.frontends.xmi.behaviour import references
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.enterprise_architect.profiles import stereotype_of
from sysmlc.frontends.xmi.unit import Lowered
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.identity import derived_id

_BASE = "base_"
_MEASURES = ("unit", "quantityKind", "dimension")
"""Tags of ``ValueType`` that lead to libraries (SysML 1.6 clause 8.3.2.16)."""
_Target = tuple[str, int, bool]


def lower(context: Context) -> None:
    """Lower the applications that the walk over the document has found."""
    for row in context.applications:
        _application(context, row)
    for element, row in context.ends:
        _path(context, element, row)


def note_namespaces(context: Context) -> None:
    """Papyrus says the namespace of a profile by applying ``EPackage`` to it."""
    for row in context.applications:
        values = context.document.attributes[row]
        if "nsURI" in values and f"{_BASE}Package" in values:
            package = context.unit.target_id(context.lowered, values[f"{_BASE}Package"], False)
            if package:
                context.unit.profiles.add(values["nsURI"], package)


def _application(context: Context, row: int) -> None:
    document = context.document
    bases = _bases(context, row)
    if f"{_BASE}Diagram" in document.attributes[row] or (bases and not _meaningful(context, bases)):
        context.subtree(row, Verdict.IGNORED_NOTATION)
        return
    kept = _kept(context, bases)
    folded = [] if kept else _folded(context, bases)
    if folded:
        _on_folded(context, row, folded)
        return
    if not kept and not any(is_href for _, _, is_href in bases):
        context.subtree(row, Verdict.UNSUPPORTED)
        context.baseless.append(row)
        return
    context.subtree(row, Verdict.MAPPED if kept else Verdict.EXTERNAL)
    element = _element(context, row, kept[0][0].gids[kept[0][1]] if kept else None)
    for target, at, is_href in bases:
        context.link(Edge.SUBJECT, element.id, target, at, "subject", is_href)
    application_tags.read(context, element, row)
    _specialities(context, element, row, kept)


def _bases(context: Context, row: int) -> list[_Target]:
    document = context.document
    features = [name for name in document.attributes[row] if name.startswith(_BASE)]
    features += [
        feature
        for child in document.children(row)
        if (feature := document.features[child]).startswith(_BASE)
    ]
    found: dict[str, _Target] = {}
    for feature in dict.fromkeys(features):
        for target in references(document, row, feature):
            found.setdefault(target[0], target)
    return list(found.values())


def _meaningful(context: Context, bases: list[_Target]) -> bool:
    found = [context.unit.find(context.lowered, t, is_href) for t, _, is_href in bases]
    return any(f is None or f[0].verdicts[f[1]] is not Verdict.IGNORED_NOTATION for f in found)


def _kept(context: Context, bases: list[_Target]) -> list[tuple[Lowered, int]]:
    """Bases that are elements of the graph."""
    found = [context.unit.find(context.lowered, t, is_href) for t, _, is_href in bases]
    return [place for place in found if place is not None and place[0].own[place[1]]]


def _folded(context: Context, bases: list[_Target]) -> list[tuple[str, str]]:
    """Bases that another element tells of: its id, and what they are in the model."""
    found = [context.unit.find(context.lowered, t, is_href) for t, _, is_href in bases]
    return [
        (gid, metaclasses.hyphenated(lowered.document.types[row]))
        for lowered, row in (place for place in found if place is not None)
        if lowered.verdicts[row] is Verdict.MAPPED and lowered.document.types[row]
        for gid in _holders(context, lowered, row)
    ]


def _holders(context: Context, lowered: Lowered, row: int) -> list[str]:
    """The triggers that name an event; else the element that the row is part of."""
    if lowered.document.types[row] not in metaclasses.EVENT_TYPES:
        return [lowered.gids[row]] if lowered.gids[row] else []
    id = lowered.document.id(row)
    named = (one for one, at in context.triggers if id in context.document.targets(at, "event"))
    return [trigger.id for trigger in named] if lowered is context.lowered else []


def _on_folded(context: Context, row: int, folded: list[tuple[str, str]]) -> None:
    """An application on what is no element of its own: a generalization, an event."""
    context.subtree(row, Verdict.MAPPED)
    element = _element(context, row, folded[0][0])
    element.attrs["on"] = folded[0][1]
    for holder, _ in folded:
        context.graph.connect(Edge.REFERENCES, element, holder)
    application_tags.read(context, element, row)


def _element(context: Context, row: int, owner: str | None) -> Element:
    document = context.document
    name, namespace, stereotype = _stereotype(context, row)
    id = document.id(row)
    known = context.unit.graph_id(document.name, id) if id else ""
    ordinal = document.ordinals[row]
    if not known or known in context.graph:
        known = derived_id(owner or document.name, f"{name}[{ordinal}]")
    attrs: dict[str, AttrValue] = {"stereotype": name, "namespace": namespace}
    element = context.graph.add(
        Element(known, Kind.APPLICATION, name, owner, ordinal, document.name, attrs)
    )
    context.gids[row] = element.id
    if stereotype is not None:
        context.graph.connect(Edge.INSTANCE_OF, element, stereotype)
    return element


def _stereotype(context: Context, row: int) -> tuple[str, str, Element | None]:
    """Name, namespace and stereotype of an application."""
    document = context.document
    namespace, feature = document.namespace(row), document.features[row]
    stereotype = context.unit.profiles.find(context.graph, namespace, feature)
    return (*stereotype_of(context, row), stereotype)


def _specialities(
    context: Context, element: Element, row: int, kept: list[tuple[Lowered, int]]
) -> None:
    """What SysML's own stereotypes add to the elements that they are applied to."""
    document = context.document
    if element.name == "ItemFlow" and kept:
        flow = context.graph[kept[0][0].gids[kept[0][1]]]
        item = element.attrs.get("tag.itemProperty")
        if isinstance(item, str) and flow.kind is Kind.ITEM_FLOW:
            context.graph.set(flow, item_property=item)
    for feature in _MEASURES if kept else ():
        _measure(context, row, feature, context.graph[kept[0][0].gids[kept[0][1]]])
    path = references(document, row, "propertyPath")
    for holder, at in kept if path else ():
        context.unit.paths[holder.gids[at]] = (context.lowered, path)


def _measure(context: Context, row: int, feature: str, base: Element) -> None:
    """A unit in a library that is not there leaves a stub: its value type refers to it."""
    for target, at, is_href in references(context.document, row, feature):
        if is_href and context.unit.find(context.lowered, target, True) is None:
            context.link(Edge.REFERENCES, base.id, target, at, feature, True)


def _path(context: Context, end: Element, row: int) -> None:
    """Path of a connector end: the nested path, with the part that has the port at its end.

    MagicDraw repeats that part in the nested path, and other tools the role itself.
    """
    holder, nested = context.unit.paths.get(end.id, (context.lowered, []))
    with_port = references(context.document, row, "partWithPort")
    needless = {_fragment(step) for step in references(context.document, row, "role")}
    needless -= {_fragment(step) for step in with_port}
    while nested and _fragment(nested[-1]) in needless:
        nested = nested[:-1]
    seen = {_fragment(step) for step in nested}
    steps = [(holder, step) for step in nested]
    steps += [(context.lowered, step) for step in with_port if _fragment(step) not in seen]
    for lowered, (target, at, is_href) in steps:
        context.link_from(lowered, Edge.PATH, end.id, target, at, "partWithPort", is_href)


def _fragment(step: _Target) -> str:
    return step[0].rpartition("#")[2]
