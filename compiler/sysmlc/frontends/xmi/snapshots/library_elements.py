"""From the needed entries of snapshots to elements of the graph, marked as library content."""

from collections.abc import Callable, Iterable, Mapping

from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.metaclasses import OWNERS, kind_of
from sysmlc.frontends.xmi.profiles import mangled
from sysmlc.frontends.xmi.snapshots.closure import APPLICATION, canonical, type_of
from sysmlc.frontends.xmi.snapshots.entries import Entry, Snapshots
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, Reference
from sysmlc.ir.identity import derived_id

_BASE = "base_"
_PATH = "partWithPort"


class LibraryElements:
    """Adds entries to a graph.

    ``files`` are the libraries' names as the model writes them, by snapshot; ``taken`` are ids
    of the models, which hide those of the snapshots. ``ids`` are the graph's ids, or the
    canonical hrefs, of what was added, by id.
    """

    def __init__(
        self,
        snapshots: Snapshots,
        graph: Graph,
        files: Mapping[str, str],
        taken: Callable[[str], bool],
    ) -> None:
        self._snapshots = snapshots
        self._graph = graph
        self._files = files
        self._is_taken = taken
        self.ids: dict[str, str] = {}

    def add(self, entries: Iterable[Entry]) -> None:
        """Add the entries, with the owners above them and the edges between them."""
        found = [entry for entry in entries if not self._is_taken(entry.id)]
        for entry in found:
            self.ids[entry.id] = canonical(self._snapshots, entry) or entry.id
        for entry in found:
            self._add(entry)
        for entry in found:
            self._connect(entry)

    # -- elements ------------------------------------------------------------------------------

    def _add(self, entry: Entry) -> None:
        if entry.owner in self._graph:
            self._element(entry)
            return
        path = self._snapshots.path(entry)
        for one in reversed([one for one in path if one.id in self.ids]):
            self._element(one)

    def _element(self, entry: Entry) -> None:
        if self.ids[entry.id] != entry.id or entry.id in self._graph:
            return
        owner = self._owner(entry)
        kind, subkind = _kind(entry)
        if kind is None or _is_root_model(entry) or _is_base(entry, owner):
            return
        if kind in OWNERS and (owner is None or owner.kind not in OWNERS[kind]):
            return
        made = Element(
            entry.id,
            kind,
            entry.name,
            None if owner is None else owner.id,
            entry.ordinal,
            entry.source,
        )
        made.attrs.update(self._attributes(entry, subkind))
        self._graph.add(made)

    def _owner(self, entry: Entry) -> Element | None:
        above = self._snapshots.entries.get(entry.owner)
        if above is None or self._is_taken(above.id):
            return None
        return self._graph.get(above.id)

    def _attributes(self, entry: Entry, subkind: str) -> dict[str, AttrValue]:
        attrs: dict[str, AttrValue] = {"external": True, "library": True}
        attrs["href"] = f"{self._files.get(entry.source, '')}#{entry.id}"
        if subkind:
            attrs["subkind"] = subkind
        for name, value in entry.values.items():
            if name in v.FLAGS and value == "true":
                attrs[v.FLAGS[name]] = True
            elif name in v.TEXTS and value != v.TEXTS[name][1]:
                attrs[v.TEXTS[name][0]] = value
        return attrs

    # -- edges ---------------------------------------------------------------------------------

    def _connect(self, entry: Entry) -> None:
        made = self._graph.get(entry.id)
        if made is None or not made.attrs.get("library"):
            self._connect_part(entry)
        elif made.kind is Kind.APPLICATION:
            self._apply(made, entry)
        else:
            self._refer(made, entry)

    def _refer(self, made: Element, entry: Entry) -> None:
        for feature in (*entry.references, *entry.values):
            edge = Edge.PATH if feature == _PATH else v.SPECIAL.get((made.kind, feature))
            edge = edge or v.REFERENCES.get(feature)
            if edge is not None:
                self._link(edge, made, entry.targets(feature))
        if made.kind is Kind.CONNECTOR_END and made.owner is not None:
            self._graph.connect(Edge.END, made.owner, made)

    def _connect_part(self, entry: Entry) -> None:
        """What is an edge of its owner: a generalization, or a stereotype's metaclass."""
        owner = self._graph.get(entry.owner)
        if owner is None or not owner.attrs.get("library"):
            return
        if owner.kind is Kind.STEREOTYPE and entry.name.startswith(_BASE):
            self._link(Edge.EXTENDS, owner, entry.targets("type"))
        for feature, edge in v.FOLDED_REFERENCES.items():
            self._link(edge, owner, entry.targets(feature))

    def _link(self, edge: Edge, source: Element, targets: Iterable[str]) -> None:
        for target in targets:
            known = self.ids.get(target, target)
            if known in self._graph:
                self._graph.connect(edge, source, known)
            elif known != target:
                name = known.rpartition("#")[2]
                self._graph.pending.append(Reference(edge, source.id, known, Kind.CLASS, name))
            else:
                _note_unresolved(self._graph, source, edge)

    # -- stereotypes ---------------------------------------------------------------------------

    def _apply(self, made: Element, entry: Entry) -> None:
        """One instance holds the slots of all stereotypes of an element."""
        slots = self._snapshots.owned(entry.id)
        for number, id in enumerate(entry.targets("classifier")):
            stereotype = self._snapshots.entries.get(id)
            if stereotype is None:
                continue
            application = self._further(made, stereotype) if number else made
            self._name_application(application, stereotype)
            above = _generals(self._snapshots, stereotype)
            for slot in slots:
                self._tag(application, slot, above)

    def _further(self, made: Element, stereotype: Entry) -> Element:
        id = derived_id(made.id, stereotype.id)
        attrs = {key: made.attrs[key] for key in ("external", "library", "href")}
        again = Element(id, made.kind, "", made.owner, made.ordinal, made.source, attrs)
        return self._graph.add(again)

    def _name_application(self, application: Element, stereotype: Entry) -> None:
        name = mangled(stereotype.name)
        self._graph.rename(application, name)
        self._graph.set(application, stereotype=name, namespace="")
        if application.owner is not None:
            self._graph.connect(Edge.SUBJECT, application, application.owner)
        self._link(Edge.INSTANCE_OF, application, [stereotype.id])

    def _tag(self, application: Element, slot: Entry, stereotypes: frozenset[str]) -> None:
        values = [_value(one, self.ids) for one in self._snapshots.owned(slot.id)]
        for id in slot.targets("definingFeature") if values else ():
            feature = self._snapshots.entries.get(id)
            if feature is not None and feature.owner in stereotypes:
                name = f"tag.{feature.name}"
                self._graph.set(
                    application, **{name: values[0] if len(values) == 1 else tuple(values)}
                )


def _generals(snapshots: Snapshots, stereotype: Entry) -> frozenset[str]:
    """Ids of the stereotype and of all that it specialises."""
    found: set[str] = set()
    waiting = [stereotype.id]
    while waiting:
        id = waiting.pop()
        if id not in found:
            found.add(id)
            parts = [one for one in snapshots.owned(id) if one.feature == "generalization"]
            waiting.extend(up for one in parts for up in one.targets("general"))
    return frozenset(found)


def _kind(entry: Entry) -> tuple[Kind | None, str]:
    if entry.feature == APPLICATION:
        return Kind.APPLICATION, ""
    return kind_of(type_of(entry)) or (None, "")


def _is_root_model(entry: Entry) -> bool:
    """The model that holds a used project is not shown by MagicDraw either."""
    return entry.type == "Model" and not entry.owner


def _is_base(entry: Entry, owner: Element | None) -> bool:
    is_stereotype = owner is not None and owner.kind is Kind.STEREOTYPE
    return is_stereotype and entry.name.startswith(_BASE)


def _value(entry: Entry, ids: Mapping[str, str]) -> str:
    for feature in ("instance", "element"):
        for target in entry.targets(feature):
            return ids.get(target, target)
    return entry.values.get("value", "")


def _note_unresolved(graph: Graph, source: Element, edge: Edge) -> None:
    known = source.attrs.get("unresolved")
    names = {str(name) for name in known} if isinstance(known, tuple) else set()
    graph.set(source, unresolved=tuple(sorted(names | {edge.value})))
