"""Adds the parts of used projects that the models of a unit refer to, from their snapshots.

Attributes of the added elements that UML does not have are reported once for each snapshot.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject, Verdict
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.xmi import hrefs, rules
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.namespaces import mangle_name, profile_in_namespace
from sysmlc.frontends.xmi.snapshots.entries import Snapshots, compute_closure, is_snapshot
from sysmlc.frontends.xmi.snapshots.library_elements import LibraryLowering
from sysmlc.frontends.xmi.uml_features import FEATURES
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.frontends.xmi.unknown_names import TOOL_ATTRIBUTES, suggest
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, make_parser, parse

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
    contexts: Sequence[Context],
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
        _add_needed(unit, contexts, models, library)
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


def _add_needed(
    unit: Unit, contexts: Sequence[Context], models: Sequence[Source], snapshots: Snapshots
) -> None:
    references = [reference for model in models for reference in _iter_hrefs(model)]
    files = _name_libraries(references, snapshots)
    wanted: dict[str, None] = {}
    for path, id in references:
        entry = snapshots.entries.get(id)
        if entry is not None and hrefs.can_lead_into(files[entry.source], path, id):
            wanted[id] = None
    wanted.update(dict.fromkeys(_find_applied_stereotypes(contexts, snapshots)))
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


def _find_applied_stereotypes(contexts: Iterable[Context], snapshots: Snapshots) -> Iterator[str]:
    """Yield the ids of the custom stereotypes that the models apply.

    Applications do not refer to them; they are in a namespace that MagicDraw derives from the name
    of the profile.
    """
    applied = {
        (mangle_name(document.features[row]), profile_in_namespace(document.namespace(row)))
        for context in contexts
        for document in (context.document,)
        for row in context.applications
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
