"""Entries about item types: the blocks that flow, and their domain (thesis 3.4.1)."""

from sysmlc.ir import Edge, Element, Kind, derived_id
from sysmlc.ir.query import domain_of
from sysmlc.overlay.model import ItemEntry, Key, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import PACKAGE, TYPE, Finder


def add_items(finder: Finder) -> None:
    """Add or find all item types, then add their generalizations."""
    entries = finder.refinement.items
    for entry in entries:
        item = _ensure_item(finder, entry.key)
        if item is not None:
            finder.items[entry.key.text] = item
            _describe_item(finder, entry, item)
    for entry in entries:
        for general in entry.specializes if entry.key.text in finder.items else ():
            _specialize(finder, finder.items[entry.key.text], general)


def check_domains(finder: Finder) -> None:
    """Report item types without a domain: those of entries, and those that overlays let flow."""
    keys = {
        finder.items[entry.key.text].id: entry.key
        for entry in finder.refinement.items
        if entry.key.text in finder.items
    }
    for connector in finder.refinement.connectors:
        for flow in connector.flows:
            item = finder.items.get(flow.item.text) or _find_item(finder, flow.item)
            if item is not None:
                keys.setdefault(item.id, Key(flow.item.text, "", flow.item.spot))
    for id, key in keys.items():
        if domain_of(finder.graph, finder.graph[id]) is None:
            finder.report(rules.NO_DOMAIN, key, item=finder.graph[id].name)


def _find_item(finder: Finder, term: Term) -> Element | None:
    elements = finder.find_named(term.text, TYPE)
    return elements[0] if len(elements) == 1 else None


def _ensure_item(finder: Finder, key: Key) -> Element | None:
    """Return the element with this id or path, else a new block with this name."""
    is_known = key.path or finder.find_named(key.text, TYPE)
    if is_known or any(separator in key.text for separator in "/:#["):
        return finder.find_entry(key, TYPE)
    package = _ensure_package(finder)
    id = derived_id(package.id, f"item:{key.text}")
    if id not in finder.graph:
        _report_namesakes(finder, key)
    return finder.ensure_element(id, Kind.CLASS, key.text, package.id, key.spot, role="block")


def _ensure_package(finder: Finder) -> Element:
    name = finder.refinement.package
    packages = finder.find_named(name, PACKAGE)
    if packages:
        return packages[0]
    id = derived_id(name, "package of an overlay")
    return finder.ensure_element(id, Kind.PACKAGE, name, None, finder.refinement.spot)


def _report_namesakes(finder: Finder, key: Key) -> None:
    graph = finder.graph
    namesakes = [element for element in graph.of_kind(*TYPE.kinds) if element.name == key.text]
    if namesakes:
        finder.report(rules.NAMESAKE, key, item=key.text, other=finder.path_of(namesakes[0]))


def _describe_item(finder: Finder, entry: ItemEntry, item: Element) -> None:
    graph = finder.graph
    stated = item.attrs.get("domain")
    if entry.domain and stated not in (None, entry.domain):
        finder.report(
            rules.OTHER_WISE,
            entry.key,
            name=item.name,
            what="domain",
            new=entry.domain,
            old=str(stated),
        )
    graph.set(item, domain=entry.domain or stated)
    add_description(finder, item, entry.description, entry.key)


def add_description(finder: Finder, element: Element, text: str, term: Term | Key) -> None:
    """Add the description of an element as a comment."""
    if text:
        id = derived_id(element.id, "description of an overlay")
        comment = finder.ensure_element(id, Kind.COMMENT, "", element.id, term.spot, body=text)
        finder.graph.connect(Edge.REFERENCES, comment, element)


def _specialize(finder: Finder, item: Element, general: Term) -> None:
    general_item = finder.find_term(general, TYPE)
    if general_item is not None and general_item is not item:
        finder.graph.connect(Edge.SPECIALIZES, item, general_item)
