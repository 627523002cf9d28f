"""Item types: the blocks that flow, and their domain (thesis 3.4.1)."""

from sysmlc.ir import Edge, Element, Kind, derived_id
from sysmlc.ir.query import domain_of
from sysmlc.overlay.model import ItemEntry, Key, Term
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.finder import PACKAGE, TYPE, Finder


def add_items(finder: Finder) -> None:
    """Add or find all item types, then say what each specialises."""
    entries = finder.refinement.items
    for entry in entries:
        item = _item(finder, entry.key)
        if item is not None:
            finder.items[entry.key.text] = item
            _describe(finder, entry, item)
    for entry in entries:
        for general in entry.specializes if entry.key.text in finder.items else ():
            _specialize(finder, finder.items[entry.key.text], general)


def check_domains(finder: Finder) -> None:
    """Report item types without a domain: those of entries, and those that overlays let flow."""
    told = {
        finder.items[e.key.text].id: e.key
        for e in finder.refinement.items
        if e.key.text in finder.items
    }
    for connector in finder.refinement.connectors:
        for flow in connector.flows:
            item = finder.items.get(flow.item.text) or _quietly(finder, flow.item)
            if item is not None:
                told.setdefault(item.id, Key(flow.item.text, "", flow.item.spot))
    for id, key in told.items():
        if domain_of(finder.graph, finder.graph[id]) is None:
            finder.report(rules.NO_DOMAIN, key, item=finder.graph[id].name)


def _quietly(finder: Finder, term: Term) -> Element | None:
    found = finder.named(term.text, TYPE)
    return found[0] if len(found) == 1 else None


def _item(finder: Finder, key: Key) -> Element | None:
    """What the model has under this id or path, else a new block with this name."""
    is_known = key.path or finder.named(key.text, TYPE)
    if is_known or any(sign in key.text for sign in "/:#["):
        return finder.entry(key, TYPE)
    package = _package(finder)
    id = derived_id(package.id, f"item:{key.text}")
    if id not in finder.graph:
        _tell_namesakes(finder, key)
    return finder.add(id, Kind.CLASS, key.text, package.id, key.spot, role="block")


def _package(finder: Finder) -> Element:
    name = finder.refinement.package
    found = finder.named(name, PACKAGE)
    if found:
        return found[0]
    id = derived_id(name, "package of an overlay")
    return finder.add(id, Kind.PACKAGE, name, None, finder.refinement.spot)


def _tell_namesakes(finder: Finder, key: Key) -> None:
    graph = finder.graph
    same = [one for one in graph.of_kind(*TYPE.kinds) if one.name == key.text]
    if same:
        finder.report(rules.NAMESAKE, key, item=key.text, other=finder.path(same[0]))


def _describe(finder: Finder, entry: ItemEntry, item: Element) -> None:
    graph = finder.graph
    known = item.attrs.get("domain")
    if entry.domain and known not in (None, entry.domain):
        finder.report(
            rules.OTHER_WISE,
            entry.key,
            name=item.name,
            what="domain",
            new=entry.domain,
            old=str(known),
        )
    graph.set(item, domain=entry.domain or known)
    describe(finder, item, entry.description, entry.key)


def describe(finder: Finder, element: Element, text: str, term: Term | Key) -> None:
    """Add what the overlay says of an element as a comment."""
    if text:
        id = derived_id(element.id, "description of an overlay")
        made = finder.add(id, Kind.COMMENT, "", element.id, term.spot, body=text)
        finder.graph.connect(Edge.REFERENCES, made, element)


def _specialize(finder: Finder, item: Element, general: Term) -> None:
    found = finder.term(general, TYPE)
    if found is not None and found is not item:
        finder.graph.connect(Edge.SPECIALIZES, item, found)
