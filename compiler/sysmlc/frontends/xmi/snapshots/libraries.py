"""What the models of a unit take from the snapshots beside them."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from sysmlc.diagnostics import Coverage, Place, Sink, Subject, Verdict
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.xmi import hrefs
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.profiles import last_segment, mangled
from sysmlc.frontends.xmi.snapshot_rules import BROKEN_SNAPSHOT
from sysmlc.frontends.xmi.snapshots.closure import needed
from sysmlc.frontends.xmi.snapshots.entries import Snapshots
from sysmlc.frontends.xmi.snapshots.library_elements import LibraryElements
from sysmlc.frontends.xmi.snapshots.unknown_attributes import by_file
from sysmlc.frontends.xmi.unit import Unit
from sysmlc.sources import Source, SourceError

_HREF = re.compile(rb"""href\s*=\s*(?:"([^"#]*)#([^"]+)"|'([^'#]*)#([^']+)')""")

_PROJECT = re.compile(r"(PROJECT\$h.+?)_resource_")


def read(sources: Sequence[Source], sink: Sink) -> Snapshots:
    """The snapshots; one that is damaged is reported and left out. Raises SourceError."""
    problems: list[SourceError] = []
    snapshots = Snapshots(sources, problems)
    for problem in problems:
        subject = Subject(problem.file, place=Place(problem.file, offset=problem.offset))
        sink.report(BROKEN_SNAPSHOT, subject, file=problem.file, problem=problem.message)
    return snapshots


def add(
    unit: Unit, contexts: Sequence[Context], models: Sequence[Source], snapshots: Snapshots
) -> None:
    """Add what the models refer to in the snapshots to the graph, and tell the unit its ids."""
    found = [href for model in models for href in _hrefs(model)]
    files = _files(found, snapshots)
    wanted = {id: None for path, id in found if _is_there(snapshots, files, path, id)}
    wanted.update(dict.fromkeys(_stereotypes(contexts, snapshots)))
    made = LibraryElements(snapshots, unit.graph, files, unit.has)
    made.add(needed(snapshots, (id for id in wanted if not unit.has(id))))
    for id, known in made.ids.items():
        unit.library[id] = known, files[snapshots.entries[id].source]


def _is_there(snapshots: Snapshots, files: Mapping[str, str], path: str, id: str) -> bool:
    entry = snapshots.entries.get(id)
    return entry is not None and hrefs.can_lead_into(files[entry.source], path, id)


def _hrefs(model: Source) -> Iterator[tuple[str, str]]:
    for one in _HREF.findall(model.data):
        path, id = one[:2] if one[1] else one[2:]
        yield path.decode("utf-8", "replace"), id.decode("utf-8", "replace")


def _stereotypes(contexts: Iterable[Context], snapshots: Snapshots) -> Iterator[str]:
    """Ids of the custom stereotypes that the models apply.

    Applications do not refer to them: the profile is named in a namespace that MagicDraw makes.
    """
    applied = {
        (mangled(c.document.features[row]), last_segment(c.document.namespace(row)))
        for c in contexts
        for row in c.applications
        if c.document.namespace(row).endswith(".xmi")
    }
    for entry in snapshots.entries.values():
        if entry.type == "Stereotype":
            name = mangled(entry.name)
            if any((name, mangled(one.name)) in applied for one in snapshots.path(entry)):
                yield entry.id


def _files(found: Iterable[tuple[str, str]], snapshots: Snapshots) -> dict[str, str]:
    """Names of the libraries by snapshot."""
    written: dict[str, Counter[str]] = {}
    for path, id in found:
        entry = snapshots.entries.get(id)
        if entry is not None and path and "?" not in path and "://" not in path:
            written.setdefault(entry.source, Counter())[path] += 1
    return {source: _name(source, written.get(source, Counter())) for source in snapshots.counts}


def _name(source: str, paths: Counter[str]) -> str:
    """The path that most hrefs write, else the project as the entry's name has it."""
    if paths:
        return max(paths, key=lambda path: (paths[path], path))
    project = _PROJECT.search(source)
    return project[1].replace("$h", "-") if project else source


def account(
    snapshots: Snapshots,
    files: Iterable[Source],
    unit: Unit,
    coverage: Coverage,
    approximated: Iterable[str] = (),
) -> None:
    """Count every element of the snapshots once: what no model needs stays outside.

    ``files`` are the snapshots that are files; parts of a model are counted there;
    ``approximated`` are ids of what is read without some of its attributes.
    """
    used, odd = by_file(snapshots, unit.library), by_file(snapshots, approximated)
    for name in (file.name for file in files if file.name in snapshots.counts):
        for type_name, number in snapshots.counts[name].items():
            read = min(used[name][type_name], number)
            unread = min(odd[name][type_name], read)
            _count(coverage, name, type_name, Verdict.MAPPED, read - unread)
            _count(coverage, name, type_name, Verdict.APPROXIMATED, unread, _UNREAD)
            _count(coverage, name, type_name, Verdict.EXTERNAL, number - read, _UNUSED)


def _count(
    coverage: Coverage, name: str, type_name: str, verdict: Verdict, number: int, why: str = ""
) -> None:
    if number:
        coverage.file(name).count(type_name, verdict, number)
        if why and coverage.is_detailed:
            coverage.file(name).losses.append(Loss(type_name, verdict, 0, number, reason=why))


_UNREAD = "read without attributes that UML does not know"
_UNUSED = "belongs to a used project, and no model needs it"
