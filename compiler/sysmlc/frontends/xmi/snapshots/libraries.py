"""Adds the parts of used projects that the models of a unit refer to, from their snapshots.

Entries of snapshots are lowered to elements of the graph that are marked as library content.
Attributes of the added elements that UML does not have are reported once for each snapshot.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject, Verdict
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.xmi import hrefs, rules
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.metaclasses import OWNERS, kind_of
from sysmlc.frontends.xmi.namespaces import mangle_name, profile_in_namespace
from sysmlc.frontends.xmi.snapshots.entries import (
    APPLICATION,
    Entry,
    Snapshots,
    canonical_href,
    compute_closure,
    is_snapshot,
)
from sysmlc.frontends.xmi.uml_features import FEATURES
from sysmlc.frontends.xmi.unit import File, Unit
from sysmlc.frontends.xmi.unknown_names import TOOL_ATTRIBUTES, suggest
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, Reference, list_items
from sysmlc.ir.element import derived_id
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, make_parser, parse

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


# -- libraries -------------------------------------------------------------------------------------


_HREF = re.compile(rb"""href\s*=\s*(?:"([^"#]*)#([^"]+)"|'([^'#]*)#([^']+)')""")
_PROJECT = re.compile(r"(PROJECT\$h.+?)_resource_")

_PART_START = re.compile(rb"<filePart\s+name=(?:'([^'<]*)'|\"([^\"<]*)\")[^<>]*(?<!/)>")
_PART_END = b"</filePart>"
_UTF8 = re.compile(
    rb"\s*(\xef\xbb\xbf)?\s*<(?!\?xml[^>]*encoding\s*=\s*[\"'](?!utf-8|us-ascii))", re.I
)

_UNREAD = "read without attributes that UML does not know"
_UNUSED = "belongs to a used project, and no model needs it"


def add_libraries(
    unit: Unit,
    models: Sequence[Source],
    snapshots: Sequence[Source],
    sink: Sink,
    coverage: Coverage,
) -> None:
    """Add the library elements that the models need from snapshots, and count the snapshots.

    Snapshots are files beside the models (entries of an archive), or parts of a model file.
    """
    models, parts = split_file_parts(models)
    sources = [*snapshots, *parts]
    if sources:
        library = _read_snapshots(sources, sink)
        _add_needed(unit, models, library)
        approximated = report_unknown_attributes(library, sources, unit, sink)
        _report_coverage(library, snapshots, unit, coverage, approximated)


# -- snapshots inside a model file -----------------------------------------------------------------


def split_file_parts(models: Sequence[Source]) -> tuple[list[Source], list[Source]]:
    """Return the models without their file parts, and the parts that are snapshots.

    A project saved as one XML file has the entries of an archive as ``filePart`` of its extension:
    whole documents without their declarations. A part is named like such an entry. A file that is
    not in UTF-8 keeps its parts: MagicDraw writes UTF-8 only.
    """
    models_without_parts: list[Source] = []
    snapshots: list[Source] = []
    for model in models:
        parts = list(_iter_parts(model)) if b"<filePart" in model.data else []
        snapshots.extend(part for _, _, part in parts if is_snapshot(part))
        models_without_parts.append(_cut(model, [(start, end) for start, end, _ in parts]))
    return models_without_parts, snapshots


def _iter_parts(model: Source) -> Iterator[tuple[int, int, Source]]:
    """Yield start and end of the content of each part, and the part as a source."""
    data = model.data
    start = _PART_START.search(data) if _UTF8.match(data) else None
    while start is not None:
        end = data.find(_PART_END, start.end())
        if end < 0:
            return
        name = (start[1] or start[2] or b"").decode("utf-8", "replace")
        yield start.end(), end, Source(f"{model.name}!{name}", data[start.end() : end])
        start = _PART_START.search(data, end)


def _cut(model: Source, ranges: list[tuple[int, int]]) -> Source:
    """Return the model without these ranges of bytes."""
    if not ranges:
        return model
    starts = [0, *(end for _, end in ranges)]
    ends = [*(start for start, _ in ranges), len(model.data)]
    pieces = (model.data[start:end] for start, end in zip(starts, ends, strict=True))
    return Source(model.name, b"".join(pieces))


# -- elements that the models need -----------------------------------------------------------------


def _read_snapshots(sources: Sequence[Source], sink: Sink) -> Snapshots:
    problems: list[SourceError] = []
    snapshots = Snapshots(sources, problems)
    for problem in problems:
        subject = Subject(problem.file, place=Place(problem.file, offset=problem.offset))
        sink.report(rules.BROKEN_SNAPSHOT, subject, file=problem.file, problem=problem.message)
    return snapshots


def _add_needed(unit: Unit, models: Sequence[Source], snapshots: Snapshots) -> None:
    references = [reference for model in models for reference in _iter_hrefs(model)]
    files = _name_libraries(references, snapshots)
    wanted: dict[str, None] = {}
    for path, id in references:
        entry = snapshots.entries.get(id)
        if entry is not None and hrefs.can_lead_into(files[entry.source], path, id):
            wanted[id] = None
    wanted.update(dict.fromkeys(_find_applied_stereotypes(unit.files, snapshots)))
    lowering = LibraryLowering(snapshots, unit.graph, files, unit.has_id)
    ids = (id for id in wanted if not unit.has_id(id))
    lowering.add_entries(compute_closure(snapshots, ids))
    for id, graph_id in lowering.ids.items():
        unit.library_ids[id] = graph_id, files[snapshots.entries[id].source]


def _iter_hrefs(model: Source) -> Iterator[tuple[str, str]]:
    """Yield path and id of all hrefs, searched in the bytes."""
    for match in _HREF.findall(model.data):
        path, id = match[:2] if match[1] else match[2:]
        yield path.decode("utf-8", "replace"), id.decode("utf-8", "replace")


def _find_applied_stereotypes(files: Iterable[File], snapshots: Snapshots) -> Iterator[str]:
    """Yield the ids of the custom stereotypes that the models apply.

    Applications do not refer to them; they are in a namespace that MagicDraw derives from the name
    of the profile.
    """
    applied = {
        (mangle_name(document.features[row]), profile_in_namespace(document.namespace(row)))
        for file in files
        for document in (file.document,)
        for row in file.applications
        if document.namespace(row).endswith(".xmi")
    }
    for entry in snapshots.entries.values():
        if entry.written_type == "Stereotype":
            name = mangle_name(entry.name)
            owners = snapshots.iter_owners(entry)
            if any((name, mangle_name(owner.name)) in applied for owner in owners):
                yield entry.id


def _name_libraries(references: Iterable[tuple[str, str]], snapshots: Snapshots) -> dict[str, str]:
    """Return the name of each library by its snapshot.

    The name is the path that most hrefs write, else the project in the name of the entry.
    """
    written: dict[str, Counter[str]] = {}
    for path, id in references:
        entry = snapshots.entries.get(id)
        if entry is not None and path and "?" not in path and "://" not in path:
            written.setdefault(entry.source, Counter())[path] += 1
    return {
        source: _name_library(source, written.get(source, Counter())) for source in snapshots.counts
    }


def _name_library(source: str, paths: Counter[str]) -> str:
    if paths:
        return max(paths, key=lambda path: (paths[path], path))
    project = _PROJECT.search(source)
    return project[1].replace("$h", "-") if project else source


# -- coverage --------------------------------------------------------------------------------------


def _report_coverage(
    snapshots: Snapshots,
    files: Iterable[Source],
    unit: Unit,
    coverage: Coverage,
    approximated: Iterable[str],
) -> None:
    """Count every element of the snapshots once; elements that no model needs are external.

    *files* are the snapshots that are files: parts of a model are counted with the model.
    *approximated* are ids of elements that are read without some of their attributes.
    """
    used = _count_by_file(snapshots, unit.library_ids)
    incomplete = _count_by_file(snapshots, approximated)
    for name in (file.name for file in files if file.name in snapshots.counts):
        for type_name, number in snapshots.counts[name].items():
            read = min(used[name][type_name], number)
            unread = min(incomplete[name][type_name], read)
            _count(coverage, name, type_name, Verdict.MAPPED, read - unread)
            _count(coverage, name, type_name, Verdict.APPROXIMATED, unread, _UNREAD)
            _count(coverage, name, type_name, Verdict.EXTERNAL, number - read, _UNUSED)


def _count_by_file(snapshots: Snapshots, ids: Iterable[str]) -> Mapping[str, Counter[str]]:
    """Return the number of elements of each type by snapshot."""
    counts = {name: Counter[str]() for name in snapshots.counts}
    for id in ids:
        entry = snapshots.entries[id]
        counts[entry.source][entry.coverage_type] += 1
    return counts


def _count(
    coverage: Coverage, name: str, type_name: str, verdict: Verdict, number: int, reason: str = ""
) -> None:
    if number:
        coverage.file(name).count(type_name, verdict, number)
        if reason and coverage.is_detailed:
            coverage.file(name).losses.append(Loss(type_name, verdict, 0, number, reason=reason))


# -- unknown attributes ------------------------------------------------------------------------

_KNOWN_BESIDE_UML = TOOL_ATTRIBUTES | {"ID", "_extensionEndOfType"}
"""Attributes without namespace that MagicDraw writes in snapshots beside those of UML."""


def report_unknown_attributes(
    snapshots: Snapshots, sources: Iterable[Source], unit: Unit, sink: Sink
) -> set[str]:
    """Report the unknown attributes of the elements that are added to the unit.

    Return the ids of the elements that have one.
    """
    incomplete: set[str] = set()
    for source in sources:
        names = snapshots.attribute_names.get(source.name, frozenset())
        unknown = frozenset(filter(_is_unknown, names))
        if unknown:
            for name, holders in _find_holders(source, unknown).items():
                added = {id: ordinal for id, ordinal in holders.items() if id in unit.library_ids}
                if added:
                    _report(snapshots, source, unit, sink, name, added)
                    incomplete |= added.keys()
    return incomplete


def _is_unknown(name: str) -> bool:
    return SEPARATOR not in name and name not in FEATURES and name not in _KNOWN_BESIDE_UML


def _find_holders(source: Source, names: frozenset[str]) -> dict[str, dict[str, int]]:
    """Return the ids and ordinals of the elements that have an attribute, by attribute name.

    The snapshot is parsed again instead of storing all attributes: few have unknown ones.
    """
    holders: dict[str, dict[str, int]] = {}
    ids, ordinal = [""], -1

    def start(_: str, values: dict[str, str]) -> None:
        nonlocal ordinal
        ordinal += 1
        ids.append(values.get("ID", ids[-1]))
        for name in names.intersection(values):
            holders.setdefault(name, {}).setdefault(ids[-1], ordinal)

    xml_parser = make_parser()
    xml_parser.StartElementHandler = start
    xml_parser.EndElementHandler = lambda _: ids.pop()
    parse(source, xml_parser)
    return dict(sorted(holders.items()))


def _report(
    snapshots: Snapshots, source: Source, unit: Unit, sink: Sink, name: str, holders: dict[str, int]
) -> None:
    first = next(iter(holders))
    path = list(snapshots.iter_owners(snapshots.entries[first]))
    element = "::".join(owner.name or owner.metaclass for owner in reversed(path))
    sink.report(
        rules.UNKNOWN_IN_LIBRARY,
        # The subject is the snapshot: diagnostics about elements of libraries are suppressed.
        Subject(element, place=Place(source.name, holders[first])),
        help=suggest(name, FEATURES),
        attribute=name,
        element=element,
        others=f" and {len(holders) - 1} more" if len(holders) > 1 else "",
        library=unit.library_ids[first][1],
    )
