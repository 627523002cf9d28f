"""Lowers entries of snapshots to elements of the graph that are marked as library content."""

from collections.abc import Callable, Iterable, Mapping

from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.metaclasses import OWNERS, kind_of
from sysmlc.frontends.xmi.namespaces import mangle_name
from sysmlc.frontends.xmi.snapshots.entries import APPLICATION, Entry, Snapshots, canonical_href
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, Reference, list_items
from sysmlc.ir.element import derived_id

_BASE = "base_"
_PATH = "partWithPort"


class LibraryLowering:
    """Adds entries to a graph.

    *files* are the libraries' names as the model writes them, by snapshot. Elements for which
    *is_in_model* is true hide those of the snapshots. ``ids`` are the graph's ids, or the canonical
    hrefs, of the added entries, by id.
    """

    def __init__(
        self,
        snapshots: Snapshots,
        graph: Graph,
        files: Mapping[str, str],
        is_in_model: Callable[[str], bool],
    ) -> None:
        self._snapshots = snapshots
        self._graph = graph
        self._files = files
        self._is_in_model = is_in_model
        self.ids: dict[str, str] = {}

    def add_entries(self, entries: Iterable[Entry]) -> None:
        """Add the entries, with the owners above them and the edges between them."""
        added = [entry for entry in entries if not self._is_in_model(entry.id)]
        for entry in added:
            self.ids[entry.id] = canonical_href(self._snapshots, entry) or entry.id
        for entry in added:
            self._add_with_owners(entry)
        for entry in added:
            self._connect(entry)

    # -- elements ----------------------------------------------------------------------------------

    def _add_with_owners(self, entry: Entry) -> None:
        if entry.owner in self._graph:
            self._add_element(entry)
            return
        owners = [owner for owner in self._snapshots.iter_owners(entry) if owner.id in self.ids]
        for owner in reversed(owners):
            self._add_element(owner)

    def _add_element(self, entry: Entry) -> None:
        if self.ids[entry.id] != entry.id or entry.id in self._graph:
            return
        owner = self._find_owner(entry)
        kind, subkind = _map_kind(entry)
        if kind is None or _is_root_model(entry) or _is_metaclass_property(entry, owner):
            return
        if kind in OWNERS and (owner is None or owner.kind not in OWNERS[kind]):
            return
        element = Element(
            entry.id,
            kind,
            entry.name,
            None if owner is None else owner.id,
            entry.ordinal,
            entry.source,
        )
        element.attrs.update(self._read_attributes(entry, subkind))
        self._graph.add(element)

    def _find_owner(self, entry: Entry) -> Element | None:
        owner = self._snapshots.entries.get(entry.owner)
        if owner is None or self._is_in_model(owner.id):
            return None
        return self._graph.get(owner.id)

    def _read_attributes(self, entry: Entry, subkind: str) -> dict[str, AttrValue]:
        attributes: dict[str, AttrValue] = {"external": True, "library": True}
        attributes["href"] = f"{self._files.get(entry.source, '')}#{entry.id}"
        if subkind:
            attributes["subkind"] = subkind
        for name, value in entry.values.items():
            if name in v.FLAGS and value == "true":
                attributes[v.FLAGS[name]] = True
            elif name in v.TEXTS and value != v.TEXTS[name][1]:
                attributes[v.TEXTS[name][0]] = value
        return attributes

    # -- edges -------------------------------------------------------------------------------------

    def _connect(self, entry: Entry) -> None:
        element = self._graph.get(entry.id)
        if element is None or not element.attrs.get("library"):
            self._connect_folded(entry)
        elif element.kind is Kind.APPLICATION:
            self._apply_stereotypes(element, entry)
        else:
            self._connect_element(element, entry)

    def _connect_element(self, element: Element, entry: Entry) -> None:
        for feature in (*entry.references, *entry.values):
            edge = v.REFERENCES_BY_KIND.get((element.kind, feature)) or v.REFERENCES.get(feature)
            if feature == _PATH:
                edge = Edge.PATH
            if edge is not None:
                self._add_edges(edge, element, entry.targets(feature))
        if element.kind is Kind.CONNECTOR_END and element.owner is not None:
            self._graph.connect(Edge.END, element.owner, element)

    def _connect_folded(self, entry: Entry) -> None:
        """Add the edges of an entry that is no element: a generalization, a metaclass property."""
        owner = self._graph.get(entry.owner)
        if owner is None or not owner.attrs.get("library"):
            return
        if owner.kind is Kind.STEREOTYPE and entry.name.startswith(_BASE):
            self._add_edges(Edge.EXTENDS, owner, entry.targets("type"))
        for feature, edge in v.FOLDED_REFERENCES.items():
            self._add_edges(edge, owner, entry.targets(feature))

    def _add_edges(self, edge: Edge, source: Element, targets: Iterable[str]) -> None:
        for target in targets:
            id = self.ids.get(target, target)
            if id in self._graph:
                self._graph.connect(edge, source, id)
            elif id != target:
                name = id.rpartition("#")[2]
                self._graph.pending.append(Reference(edge, source.id, id, Kind.CLASS, name))
            else:
                _note_unresolved(self._graph, source, edge)

    # -- stereotypes -------------------------------------------------------------------------------

    def _apply_stereotypes(self, element: Element, entry: Entry) -> None:
        """Add an application for each stereotype of an element.

        A snapshot has one instance that holds the slots of all of them.
        """
        slots = self._snapshots.owned(entry.id)
        for number, id in enumerate(entry.targets("classifier")):
            stereotype = self._snapshots.entries.get(id)
            if stereotype is None:
                continue
            application = self._copy_application(element, stereotype) if number else element
            self._name_application(application, stereotype)
            generals = self._find_generals(stereotype)
            for slot in slots:
                self._store_tag(application, slot, generals)

    def _copy_application(self, application: Element, stereotype: Entry) -> Element:
        id = derived_id(application.id, stereotype.id)
        attributes = {key: application.attrs[key] for key in ("external", "library", "href")}
        copy = Element(
            id,
            application.kind,
            "",
            application.owner,
            application.ordinal,
            application.source,
            attributes,
        )
        return self._graph.add(copy)

    def _name_application(self, application: Element, stereotype: Entry) -> None:
        name = mangle_name(stereotype.name)
        self._graph.rename(application, name)
        self._graph.set(application, stereotype=name, namespace="")
        if application.owner is not None:
            self._graph.connect(Edge.SUBJECT, application, application.owner)
        self._add_edges(Edge.INSTANCE_OF, application, [stereotype.id])

    def _store_tag(self, application: Element, slot: Entry, stereotypes: frozenset[str]) -> None:
        """Store a slot as a tag if its feature belongs to one of the stereotypes."""
        values = [self._read_value(owned) for owned in self._snapshots.owned(slot.id)]
        if not values:
            return
        for id in slot.targets("definingFeature"):
            feature = self._snapshots.entries.get(id)
            if feature is not None and feature.owner in stereotypes:
                value = values[0] if len(values) == 1 else tuple(values)
                self._graph.set(application, **{f"tag.{feature.name}": value})

    def _read_value(self, entry: Entry) -> str:
        for feature in ("instance", "element"):
            for target in entry.targets(feature):
                return self.ids.get(target, target)
        return entry.values.get("value", "")

    def _find_generals(self, stereotype: Entry) -> frozenset[str]:
        """Return the ids of the stereotype and of all that it specialises."""
        generals: set[str] = set()
        worklist = [stereotype.id]
        while worklist:
            id = worklist.pop()
            if id not in generals:
                generals.add(id)
                for owned in self._snapshots.owned(id):
                    if owned.feature == "generalization":
                        worklist.extend(owned.targets("general"))
        return frozenset(generals)


def _map_kind(entry: Entry) -> tuple[Kind | None, str]:
    if entry.feature == APPLICATION:
        return Kind.APPLICATION, ""
    return kind_of(entry.metaclass) or (None, "")


def _is_root_model(entry: Entry) -> bool:
    # MagicDraw does not show the model element that contains a used project either.
    return entry.written_type == "Model" and not entry.owner


def _is_metaclass_property(entry: Entry, owner: Element | None) -> bool:
    is_in_stereotype = owner is not None and owner.kind is Kind.STEREOTYPE
    return is_in_stereotype and entry.name.startswith(_BASE)


def _note_unresolved(graph: Graph, source: Element, edge: Edge) -> None:
    names = set(map(str, list_items(source.attrs.get("unresolved"))))
    graph.set(source, unresolved=tuple(sorted(names | {edge.value})))
