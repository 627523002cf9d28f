"""Partition the files of a folder into compile units (docs/decisions, "Compile units").

Files are connected when one refers to the other: by href, by the path of an external reference,
by an entry of an overlay, or in SysML v2 by the name of a root package. Texts of one folder are
connected too, and so are files that are named one by one. A unit is a set of connected files with
the libraries that it uses, so that a library may belong to several units.
"""

import os
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from pathlib import Path

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.driver.compilation import OpenedUnit, Request, file_of, load_drawings, open_unit
from sysmlc.driver.inputs import Recognised, ask_names, find_unit_root
from sysmlc.driver.reading import ReadFile, Reading
from sysmlc.frontends.base import FileNames, UnitFrontend
from sysmlc.ir.algorithms import find_reachable
from sysmlc.support.output import assign_file_names


@dataclass(eq=False, slots=True)
class Bundle:
    """Files that always belong to the same unit: texts of one folder, files named together.

    ``references`` are the bundles to which the files refer.
    """

    folder: Path
    files: list[ReadFile] = field(default_factory=list)
    is_library: bool = False
    declared: frozenset[str] = frozenset()
    used: AbstractSet[str] = frozenset()
    references: set["Bundle"] = field(default_factory=set)

    def sources(self) -> list[str]:
        """Return the names of all sources of its files."""
        return [name for file in self.files for name in file.sources]


def open_units(request: Request) -> list[OpenedUnit]:
    """Read the inputs of a request and partition them into compile units, sorted by first file.

    There is at least one unit, even if nothing can be read. Findings about files that belong to no
    unit are in the sink of the first one.
    """
    opened = open_unit(request)
    recognised = {item.source.name: item for item in opened.reading.recognised}
    bundles = _make_bundles(opened.reading.files, recognised, opened.root)
    # An overlay of the command line that names no models applies to all.
    overlays = [file for file in opened.reading.files if file.is_overlay and file.is_named]
    if len(bundles) < 2 or not all(overlay.references for overlay in overlays):
        groups = [bundles]
    else:
        groups = _group(bundles, recognised, opened.sink)
    names = _name_units(
        [_own_files(group) for group in groups], find_unit_root(request.inputs, None)
    )
    if len(groups) < 2:
        return [replace(opened, name=names[0])]
    return _split(request, opened, groups, names)


def _make_bundles(
    files: Sequence[ReadFile], recognised: Mapping[str, Recognised], root: Path
) -> list[Bundle]:
    """Bundle the named files and the files of folders of text; any other file is alone."""
    models = [file for file in files if file.sources]
    texts = {file.path for file in models if _is_folder_unit(file, recognised)}
    mixed = {
        folder
        for file in models
        if file.path not in texts and not file.is_overlay
        for folder in file.path.parents
    }
    bundles: dict[object, Bundle] = {}
    for file in models:
        folder = file.path.parent
        key: object = file.path
        if file.is_named:
            key = "named"
        elif file.path in texts:
            key = folder = _find_text_folder(folder, root, mixed)
        bundles.setdefault(key, Bundle(folder)).files.append(file)
    return list(bundles.values())


def _find_text_folder(folder: Path, root: Path, mixed: AbstractSet[Path]) -> Path:
    """Return the topmost folder above *folder* below which there are texts only.

    It is *folder* itself when other models lie in it or below it.
    """
    while folder not in mixed and root in folder.parents and folder.parent not in mixed:
        folder = folder.parent
    return folder


def _is_folder_unit(file: ReadFile, recognised: Mapping[str, Recognised]) -> bool:
    frontends = [recognised[name].frontend for name in file.sources if name in recognised]
    return bool(frontends) and all(
        isinstance(frontend, UnitFrontend) and frontend.is_folder_unit for frontend in frontends
    )


def _group(
    bundles: list[Bundle], recognised: Mapping[str, Recognised], sink: Sink
) -> list[list[Bundle]]:
    """Connect the bundles and return the bundles of each unit."""
    for bundle in bundles:
        _read_names(bundle, recognised, sink)
    _refer_by_path(bundles)
    _refer_by_name(bundles)
    units = _connect([bundle for bundle in bundles if not bundle.is_library])
    # Libraries that no model uses form units of their own.
    covered = {bundle for unit in units for bundle in unit}
    units += _connect([bundle for bundle in bundles if bundle not in covered])
    return sorted(units, key=lambda unit: _own_files(unit)[0].path)


def _read_names(bundle: Bundle, recognised: Mapping[str, Recognised], sink: Sink) -> None:
    names = [_names_of(recognised[name], sink) for name in bundle.sources() if name in recognised]
    bundle.is_library = bool(names) and all(name.is_library for name in names)
    bundle.declared = frozenset().union(*(name.declared for name in names))
    local = bundle.declared.union(*(name.local for name in names))
    bundle.used = frozenset().union(*(name.used for name in names)) - local


def _names_of(item: Recognised, sink: Sink) -> FileNames:
    frontend = item.frontend
    is_asked = isinstance(frontend, UnitFrontend)
    return ask_names(frontend, item.source, sink) if is_asked else FileNames()


def _refer_by_path(bundles: Sequence[Bundle]) -> None:
    bundle_of = {file.path: bundle for bundle in bundles for file in bundle.files}
    for bundle in bundles:
        targets = {path for file in bundle.files for path in file.references}
        bundle.references |= {bundle_of[path] for path in targets if path in bundle_of} - {bundle}


def _refer_by_name(bundles: Sequence[Bundle]) -> None:
    """Connect a bundle with the nearest one that declares a name that it uses.

    When several bundles declare the name, such as copies of a model, the one in the folder that
    is nearest to the user is meant.
    """
    declaring: dict[str, list[Bundle]] = {}
    for bundle in bundles:
        for name in bundle.declared:
            declaring.setdefault(name, []).append(bundle)
    for bundle in bundles:
        for name in bundle.used & declaring.keys():
            bundle.references.add(
                max(declaring[name], key=lambda other: _count_shared(bundle.folder, other.folder))
            )


def _count_shared(left: Path, right: Path) -> int:
    """Return the number of leading folders that the two paths share."""
    return len(Path(os.path.commonpath([left, right])).parts)


def _connect(bundles: Sequence[Bundle]) -> list[list[Bundle]]:
    """Return the connected components of *bundles*, each with all that it refers to."""
    neighbours: dict[Bundle, set[Bundle]] = {bundle: set() for bundle in bundles}
    for bundle in bundles:
        for other in bundle.references & neighbours.keys():
            neighbours[bundle].add(other)
            neighbours[other].add(bundle)
    components: list[AbstractSet[Bundle]] = []
    visited: set[Bundle] = set()
    for bundle in bundles:
        if bundle not in visited:
            component = find_reachable([bundle], neighbours.__getitem__)
            visited |= component
            components.append(component)
    return [
        list(find_reachable(component, lambda bundle: bundle.references))
        for component in components
    ]


def _own_files(unit: Sequence[Bundle]) -> list[ReadFile]:
    """Return the models of a unit, sorted by path, or its libraries if it has no models."""
    bundles = [bundle for bundle in unit if not bundle.is_library] or unit
    files = [file for bundle in bundles for file in bundle.files]
    return sorted(
        [file for file in files if not file.is_overlay] or files, key=lambda file: file.path
    )


def _name_units(units: Sequence[Sequence[ReadFile]], base: Path) -> list[str]:
    """Name each unit after its folder, or after its first file where units share a folder."""
    folders = [
        Path(os.path.commonpath([file.path.parent for file in files])) if files else base
        for files in units
    ]
    paths = [
        files[0].path if files and folders.count(folder) > 1 else folder
        for folder, files in zip(folders, units, strict=True)
    ]
    qualified = [_qualify(path, base) for path in paths]
    names = assign_file_names(qualified)
    return [names[name] for name in qualified]


def _qualify(path: Path, base: Path) -> str:
    if path == base or not path.is_relative_to(base):
        return path.name
    return "::".join(path.relative_to(base).parts)


def _split(
    request: Request, opened: OpenedUnit, units: Sequence[Sequence[Bundle]], names: Sequence[str]
) -> list[OpenedUnit]:
    parts: list[OpenedUnit] = []
    shares = [
        {s for bundle in unit for file in bundle.files for s in file.sources} for unit in units
    ]
    assigned = frozenset().union(*shares)
    for index, (share, name) in enumerate(zip(shares, names, strict=True)):
        # Files of no unit, such as unreadable ones, are reported once: with the first unit.
        sink = opened.sink.subset(
            diagnostic
            for diagnostic in opened.sink
            if (file := file_of(diagnostic)) in share or (index == 0 and file not in assigned)
        )
        reading = _select(opened.reading, share)
        drawings = load_drawings(request, reading, opened.root, sink)
        parts.append(OpenedUnit(opened.root, reading, sink, opened.frontends, drawings, name))
    return parts


def _select(reading: Reading, names: AbstractSet[str]) -> Reading:
    return Reading(
        tuple(item for item in reading.recognised if item.source.name in names),
        reading.is_complete,
        reading.roots,
        tuple(overlay for overlay in reading.overlays if overlay.source.name in names),
        tuple(file for file in reading.files if not names.isdisjoint(file.sources)),
    )
