"""Projects of models (.kpar, or a folder): files, checksums and usages (KerML 1.0, 10.3)."""

import hashlib
import json
import operator as op
import re
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any
from urllib.parse import unquote, urlsplit

from msgspec import Struct, field

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.sources import DEFAULT_LIMITS, Fault, Limits, Source, SourceError, read_entries
from sysmlc.support.escapes import parse_json

_ALGORITHMS = {
    name.upper().replace("_", ""): name
    for name in ["md5", "sha1", "sha224", "sha384", "sha512", "sha3_256", "sha3_384", "sha3_512"]
}
_BLAKE_DIGEST_SIZES = {"BLAKE2B256": 32, "BLAKE2B384": 48, "BLAKE2B512": 64}


def _compute_checksum(source: Source, algorithm: str) -> str | None:
    """Return the checksum in hex, or None for an unknown algorithm; hyphens are ignored."""
    canonical_name = algorithm.upper().replace("-", "")
    if canonical_name == "SHA256":
        return source.sha256
    if canonical_name in _ALGORITHMS:
        # Without `usedforsecurity` a FIPS build of Python refuses MD5 and SHA-1.
        name = _ALGORITHMS[canonical_name]
        return hashlib.new(name, source.data, usedforsecurity=False).hexdigest()
    if canonical_name in _BLAKE_DIGEST_SIZES:
        size = _BLAKE_DIGEST_SIZES[canonical_name]
        return hashlib.blake2b(source.data, digest_size=size).hexdigest()
    if canonical_name == "ADLER32":
        return f"{zlib.adler32(source.data):08x}"
    return None


PROJECT, META = ".project.json", ".meta.json"
MODELS = (".sysml", ".kerml", ".sysmlx", ".kermlx")
"""Suffixes of the model files of a project; interchange as JSON is not read."""

_FIELDS: dict[str, type] = {"name": str, "version": str, "usage": list}
_LISTS: dict[str, type] = {"index": dict, "checksum": dict}


class ProjectUsage(Struct, frozen=True):
    """A project that another one uses: its IRI or path, and the versions that are accepted."""

    resource: str
    constraint: str = ""


class Project(Struct, frozen=True):
    """A project: its location, name and version, the projects that it uses, its model files.

    ``index`` has the file of each root member by name. ``place`` is the location of the description
    of the project, for messages.
    """

    path: str
    name: str
    version: str = ""
    usages: tuple[ProjectUsage, ...] = ()
    index: Mapping[str, str] = field(default_factory=dict)
    files: tuple[Source, ...] = ()
    place: Place | None = None


def open_archive(archive: Source, sink: Sink, limits: Limits = DEFAULT_LIMITS) -> Project | None:
    """Return the project of a .kpar; a damaged archive is reported and gives None.

    Raises SourceError for an archive that exceeds the limits.
    """
    try:
        sources = read_entries(archive, _is_project_file, limits)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(archive.name, place=Place(archive.name))
        sink.report(rules.MALFORMED, subject, file=archive.name, problem=problem.message)
        return None
    return read_project(archive.name, sources, sink)


def _is_project_file(entry: str) -> bool:
    """Whether a file of an archive or a folder is a model or describes the project."""
    name = entry.rpartition("/")[2]
    return name in (PROJECT, META) or name.endswith(MODELS)


def read_project(path: str, sources: Sequence[Source], sink: Sink) -> Project:
    """Return the project at ``path``; check its checksums, report missing files."""
    files = {_relative_name(path, source.name): source for source in sources}
    models = tuple(source for name, source in files.items() if name.endswith(MODELS))
    description = _read_json(files.get(PROJECT), f"{path}!{PROJECT}", _FIELDS, sink)
    name = description.get("name") or path
    meta = files.get(META)
    meta_data = _read_json(meta, f"{path}!{META}", _LISTS, sink)
    place = Place(files[PROJECT].name, offset=0) if PROJECT in files else None
    version = str(description.get("version", ""))
    index = {str(member): str(file) for member, file in meta_data.get("index", {}).items()}
    usages = _read_usages(description)
    project = Project(path, str(name), version, usages, index, models, place)
    if meta is not None:
        _check_files(project, meta, meta_data, files, sink)
    return project


def _relative_name(path: str, name: str) -> str:
    """Return the name of a source within the archive or folder."""
    for separator in "!/":
        if name.startswith(path + separator):
            return name[len(path) + 1 :]
    return name


def _read_json(
    source: Source | None, name: str, fields: Mapping[str, type], sink: Sink
) -> dict[str, Any]:
    """Return the content of .project.json or .meta.json; report its faults."""
    if source is None:
        _report(sink, rules.BAD_PROJECT, Place(name), file=name, problem="it is missing")
        return {}
    try:
        content = parse_json(source.data)
    except (ValueError, RecursionError) as problem:
        return _report_bad_project(sink, source, f"it is not JSON: {problem}")
    if not isinstance(content, dict):
        return _report_bad_project(sink, source, "it is not a JSON object")
    for key, kind in fields.items():
        if key in content and not isinstance(content[key], kind):
            _report_bad_project(sink, source, f"its '{key}' is of the wrong type", key)
            del content[key]
    if "name" in fields and not content.get("name"):
        _report_bad_project(sink, source, "it has no name")
    return content


def _report_bad_project(sink: Sink, source: Source, problem: str, near: str = "") -> dict[str, Any]:
    place = _locate(source, near) if near else Place(source.name, offset=0)
    _report(sink, rules.BAD_PROJECT, place, file=source.name, problem=problem)
    return {}


def _read_usages(description: Mapping[str, Any]) -> tuple[ProjectUsage, ...]:
    return tuple(
        ProjectUsage(str(usage["resource"]), str(usage.get("versionConstraint") or ""))
        for usage in description.get("usage", ())
        if isinstance(usage, dict) and "resource" in usage
    )


def _check_files(
    project: Project,
    meta: Source,
    meta_data: Mapping[str, Any],
    files: Mapping[str, Source],
    sink: Sink,
) -> None:
    """Report files that are missing, have a wrong checksum, or have none."""
    checksums = meta_data.get("checksum", {})
    listed_files = dict.fromkeys([*map(str, meta_data.get("index", {}).values()), *checksums])
    for file in listed_files:
        if file not in files:
            facts = {"project": project.name, "file": file}
            _report(sink, rules.MISSING_FILE, _locate(meta, file), **facts)
    for file, checksum in checksums.items():
        if file in files and isinstance(checksum, dict):
            _check_checksum(project, files[file], checksum, _locate(meta, file), sink)
    for source in project.files:
        file = _relative_name(project.path, source.name)
        if checksums and file not in checksums:
            facts = {"project": project.name, "file": file}
            _report(sink, rules.UNLISTED_FILE, Place(source.name), **facts)


def _check_checksum(
    project: Project, source: Source, checksum: Mapping[str, Any], place: Place, sink: Sink
) -> None:
    algorithm, expected = str(checksum.get("algorithm")), str(checksum.get("value")).lower()
    computed = _compute_checksum(source, algorithm)
    if computed is None:
        _report(sink, rules.UNKNOWN_ALGORITHM, place, file=source.name, algorithm=algorithm)
    elif computed != expected:
        facts = {"file": source.name, "project": project.name, "algorithm": algorithm}
        _report(sink, rules.CHECKSUM, place, found=computed, expected=expected, **facts)


def _locate(source: Source, text: str) -> Place:
    """Return the location of a string in a JSON file."""
    return Place(source.name, offset=max(source.data.rfind(json.dumps(text).encode()), 0))


def _report(sink: Sink, rule: Rule, place: Place, **facts: str) -> None:
    sink.report(rule, Subject(place.file, place=place), notes=(), help="", **facts)


_STANDARD = ("https://www.omg.org/spec/KerML/", "https://www.omg.org/spec/SysML/")
_COMPARISONS: dict[str, Callable[[tuple[int, ...], tuple[int, ...]], bool]] = {
    "=": op.eq,
    "==": op.eq,
    "<": op.lt,
    "<=": op.le,
    ">": op.gt,
    ">=": op.ge,
}
_COMPARISON = re.compile(r"(>=|<=|>|<|==|=|\^|~)?\s*v?(\d+(?:\.\d+)*)$")


def resolve_usages(
    project: Project, projects: Sequence[Project], sink: Sink, *, has_standard: bool = False
) -> Mapping[ProjectUsage, Project]:
    """Return the project for each usage.

    Report usages for which there is no project, or none whose version satisfies the constraint.
    ``has_standard`` means that the standard libraries are available in another way.
    """
    resolved: dict[ProjectUsage, Project] = {}
    for usage in project.usages:
        used = [used for used in projects if _matches_resource(used, usage.resource)]
        candidates = [candidate for candidate in used if candidate is not project]
        fitting = [c for c in candidates if satisfies_version(c.version, usage.constraint)]
        if fitting:
            resolved[usage] = fitting[-1]
        elif not (has_standard and not candidates and usage.resource.startswith(_STANDARD)):
            _report_unresolved_usage(project, usage, candidates, sink)
    return resolved


def _matches_resource(project: Project, resource: str) -> bool:
    """Whether an IRI or a path means the project: by its file, else by the words of its name.

    The standard libraries are used as ``.../Semantic-Library.kpar`` and are called "Kernel Semantic
    Library": the words of the file are the last words of the name.
    """
    wanted = _stem(resource)
    if unquote(resource) == project.path or wanted == _stem(project.path):
        return True
    words, names = _split_words(wanted), _split_words(project.name)
    return bool(words) and names[-len(words) :] == words


def _stem(resource: str) -> str:
    last = unquote(urlsplit(resource).path).rstrip("/").rpartition("/")[2]
    return last.removesuffix(".kpar")


def _split_words(name: str) -> list[str]:
    # Names of archives often end with the version: `Robots-1.0.2`.
    bare = re.sub(r"[-_ ]v?\d+(\.\d+)+$", "", name)
    return [word.lower() for word in re.split(r"[-_ .]+", bare) if word]


def satisfies_version(version: str, constraint: str) -> bool:
    """Whether a version satisfies a constraint, which may have several parts with commas.

    A bare version means itself or a later compatible one (same first number), as ``^`` does. ``~``
    fixes the second number too. A constraint that is no comparison of numbers accepts everything.
    """
    return all(
        _satisfies_comparison(version, comparison.strip())
        for comparison in constraint.split(",")
        if comparison.strip()
    )


def _satisfies_comparison(version: str, constraint: str) -> bool:
    wanted_match, version_match = _COMPARISON.match(constraint), _COMPARISON.match(version)
    if wanted_match is None or version_match is None:
        return True
    sign = wanted_match[1] or "^"
    wanted, actual = _parse_version(wanted_match[2]), _parse_version(version_match[2])
    if sign in _COMPARISONS:
        return _COMPARISONS[sign](actual, wanted)
    fixed_parts = 1 if sign == "^" else 2
    return actual >= wanted and actual[:fixed_parts] == wanted[:fixed_parts]


def _parse_version(version: str) -> tuple[int, ...]:
    numbers = [int(number) for number in version.split(".")]
    return tuple(numbers + [0] * (3 - len(numbers)))


def _report_unresolved_usage(
    project: Project, usage: ProjectUsage, candidates: Sequence[Project], sink: Sink
) -> None:
    versions = ", ".join(candidate.version or "without a version" for candidate in candidates)
    problem = f"but the one given is {versions}" if candidates else "which is not given"
    constraint = f" ({usage.constraint})" if usage.constraint else ""
    sink.report(
        rules.UNRESOLVED_USAGE,
        Subject(project.path, place=project.place or Place(project.path)),
        project=project.name,
        resource=usage.resource,
        constraint=constraint,
        problem=problem,
    )
