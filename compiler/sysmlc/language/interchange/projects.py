"""Projects of models (.kpar, or a folder): files, checksums and usages (KerML 1.0, 10.3)."""

import hashlib
import json
import re
import zlib
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import unquote, urlsplit

from msgspec import Struct, field

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.sources import DEFAULT_LIMITS, Fault, Limits, Source, SourceError, entries

_ALGORITHMS = {
    "SHA1": "sha1",
    "SHA224": "sha224",
    "SHA256": "sha256",
    "SHA384": "sha384",
    "SHA512": "sha512",
    "SHA3256": "sha3_256",
    "SHA3384": "sha3_384",
    "SHA3512": "sha3_512",
    "MD5": "md5",
}
_BLAKE = {"BLAKE2B256": 32, "BLAKE2B384": 48, "BLAKE2B512": 64}


def digest(source: Source, algorithm: str) -> str | None:
    """The checksum in hex, or None for an algorithm that is not known; hyphens do not count."""
    known = algorithm.upper().replace("-", "")
    if known == "SHA256":
        return source.sha256
    if known in _ALGORITHMS:
        return hashlib.new(_ALGORITHMS[known], source.data, usedforsecurity=False).hexdigest()
    if known in _BLAKE:
        return hashlib.blake2b(source.data, digest_size=_BLAKE[known]).hexdigest()
    if known == "ADLER32":
        return f"{zlib.adler32(source.data):08x}"
    return None


PROJECT, META = ".project.json", ".meta.json"
MODELS = (".sysml", ".kerml", ".sysmlx", ".kermlx")
"""Suffixes of the model files of a project; interchange as JSON is not read."""

_FIELDS: dict[str, type] = {"name": str, "version": str, "usage": list}
_LISTS: dict[str, type] = {"index": dict, "checksum": dict}


class Usage(Struct, frozen=True):
    """A project that another one uses: its IRI or path, and the versions that will do."""

    resource: str
    constraint: str = ""


class Project(Struct, frozen=True):
    """A project: where it is, its name and version, what it uses, its model files.

    ``index`` says which file has a root member of that name; ``place`` is where the project is
    described, for messages.
    """

    path: str
    name: str
    version: str = ""
    usages: tuple[Usage, ...] = ()
    index: Mapping[str, str] = field(default_factory=dict)
    files: tuple[Source, ...] = ()
    place: Place | None = None


def open_archive(archive: Source, sink: Sink, limits: Limits = DEFAULT_LIMITS) -> Project | None:
    """The project of a .kpar; a damaged one is reported and gives None.

    Raises SourceError for what exceeds the limits.
    """
    try:
        found = entries(archive, is_project_file, limits)
    except SourceError as problem:
        if problem.fault is Fault.LIMIT:
            raise
        subject = Subject(archive.name, place=Place(archive.name))
        sink.report(rules.MALFORMED, subject, file=archive.name, problem=problem.message)
        return None
    return project(archive.name, found, sink)


def is_project_file(entry: str) -> bool:
    """Whether a file of an archive or a folder is a model or describes the project."""
    name = entry.rpartition("/")[2]
    return name in (PROJECT, META) or name.endswith(MODELS)


def project(path: str, sources: Sequence[Source], sink: Sink) -> Project:
    """The project at ``path`` with its sources: checksums examined, missing files told."""
    files = {_inside(path, source.name): source for source in sources}
    models = tuple(source for name, source in files.items() if name.endswith(MODELS))
    said = _described(files.get(PROJECT), f"{path}!{PROJECT}", _FIELDS, sink)
    name = said.get("name") or path
    meta = files.get(META)
    listed = _described(meta, f"{path}!{META}", _LISTS, sink)
    place = Place(files[PROJECT].name, offset=0) if PROJECT in files else None
    made = Project(path, str(name), str(said.get("version", "")), _usages(said), {}, models, place)
    if meta is None:
        return made
    _examine(made, meta, listed, files, sink)
    index = {str(member): str(file) for member, file in listed.get("index", {}).items()}
    return Project(path, made.name, made.version, made.usages, index, models, place)


def _inside(path: str, name: str) -> str:
    """The name of a source within the archive or folder."""
    for separator in "!/":
        if name.startswith(path + separator):
            return name[len(path) + 1 :]
    return name


def _described(
    source: Source | None, name: str, fields: Mapping[str, type], sink: Sink
) -> dict[str, Any]:
    """What .project.json or .meta.json says; what is wrong with it is reported."""
    if source is None:
        _report(sink, rules.BAD_PROJECT, Place(name), file=name, problem="it is missing")
        return {}
    try:
        said = json.loads(source.data)
    except (ValueError, RecursionError) as problem:
        return _bad(sink, source, f"it is no JSON: {problem}")
    if not isinstance(said, dict):
        return _bad(sink, source, "it is no JSON object")
    for wanted, kind in fields.items():
        if wanted in said and not isinstance(said[wanted], kind):
            _bad(sink, source, f"its '{wanted}' is of the wrong type", wanted)
            del said[wanted]
    if "name" in fields and not said.get("name"):
        _bad(sink, source, "it has no name")
    return said


def _bad(sink: Sink, source: Source, problem: str, near: str = "") -> dict[str, Any]:
    place = _place(source, near) if near else Place(source.name, offset=0)
    _report(sink, rules.BAD_PROJECT, place, file=source.name, problem=problem)
    return {}


def _usages(said: Mapping[str, Any]) -> tuple[Usage, ...]:
    stated = (one for one in said.get("usage", ()) if isinstance(one, dict) and "resource" in one)
    return tuple(
        Usage(str(one["resource"]), str(one.get("versionConstraint") or "")) for one in stated
    )


def _examine(
    made: Project,
    meta: Source,
    listed: Mapping[str, Any],
    files: Mapping[str, Source],
    sink: Sink,
) -> None:
    """Report files that are missing, are not what they were, or have no checksum."""
    checksums = listed.get("checksum", {})
    named = dict.fromkeys([*map(str, listed.get("index", {}).values()), *checksums])
    for file in named:
        if file not in files:
            facts = {"project": made.name, "file": file}
            _report(sink, rules.MISSING_FILE, _place(meta, file), **facts)
    for file, stated in checksums.items():
        if file in files and isinstance(stated, dict):
            _compare(made, files[file], stated, _place(meta, file), sink)
    for source in made.files:
        file = _inside(made.path, source.name)
        if checksums and file not in checksums:
            facts = {"project": made.name, "file": file}
            _report(sink, rules.UNLISTED_FILE, Place(source.name), **facts)


def _compare(
    made: Project, source: Source, stated: Mapping[str, Any], place: Place, sink: Sink
) -> None:
    algorithm, expected = str(stated.get("algorithm")), str(stated.get("value")).lower()
    found = digest(source, algorithm)
    if found is None:
        _report(sink, rules.UNKNOWN_ALGORITHM, place, file=source.name, algorithm=algorithm)
    elif found != expected:
        facts = {"file": source.name, "project": made.name, "algorithm": algorithm}
        _report(sink, rules.CHECKSUM, place, found=found, expected=expected, **facts)


def _place(source: Source, text: str) -> Place:
    """Where a JSON file says the text."""
    return Place(source.name, offset=max(source.data.rfind(json.dumps(text).encode()), 0))


def _report(sink: Sink, rule: Rule, place: Place, **facts: str) -> None:
    sink.report(rule, Subject(place.file, place=place), notes=(), help="", **facts)


_STANDARD = ("https://www.omg.org/spec/KerML/", "https://www.omg.org/spec/SysML/")
_COMPARISON = re.compile(r"(>=|<=|>|<|==|=|\^|~)?\s*v?(\d+(?:\.\d+)*)$")


def used(
    project: Project, given: Sequence[Project], sink: Sink, *, has_standard: bool = False
) -> Mapping[Usage, Project]:
    """The project for each usage; one that is not among the given, or too old, is reported.

    ``has_standard`` says that the standard libraries are known in another way.
    """
    found: dict[Usage, Project] = {}
    for usage in project.usages:
        named = [one for one in given if one is not project and _is_named(one, usage.resource)]
        fitting = [one for one in named if fits(one.version, usage.constraint)]
        if fitting:
            found[usage] = fitting[-1]
        elif not (has_standard and not named and usage.resource.startswith(_STANDARD)):
            _report_unresolved_usage(project, usage, named, sink)
    return found


def _is_named(project: Project, resource: str) -> bool:
    """Whether an IRI or a path means the project: by its file, else by the words of its name.

    The standard libraries are used as ``.../Semantic-Library.kpar`` and are called "Kernel
    Semantic Library": the words of the one end those of the other.
    """
    wanted = _stem(resource)
    if unquote(resource) == project.path or wanted == _stem(project.path):
        return True
    words, names = _words(wanted), _words(project.name)
    return bool(words) and names[-len(words) :] == words


def _stem(resource: str) -> str:
    last = unquote(urlsplit(resource).path).rstrip("/").rpartition("/")[2]
    return last.removesuffix(".kpar")


def _words(name: str) -> list[str]:
    bare = re.sub(r"[-_ ]v?\d+(\.\d+)+$", "", name)
    return [word.lower() for word in re.split(r"[-_ .]+", bare) if word]


def fits(version: str, constraint: str) -> bool:
    """Whether a version is one that the constraint allows; several are divided by commas.

    A bare version means itself or a later one that is compatible (same first number), as ``^``
    does; ``~`` keeps the second number too. What is no constraint of numbers allows everything.
    """
    return all(_fits(version, one.strip()) for one in constraint.split(",") if one.strip())


def _fits(version: str, constraint: str) -> bool:
    stated, found = _COMPARISON.match(constraint), _COMPARISON.match(version)
    if stated is None or found is None:
        return True
    sign, wanted, has = stated[1] or "^", _numbers(stated[2]), _numbers(found[2])
    if sign in ("=", "=="):
        return has == wanted
    if sign in ("<", "<=", ">", ">="):
        return {"<": has < wanted, "<=": has <= wanted, ">": has > wanted}.get(sign, has >= wanted)
    kept = 1 if sign == "^" else 2
    return has >= wanted and has[:kept] == wanted[:kept]


def _numbers(version: str) -> tuple[int, ...]:
    numbers = [int(number) for number in version.split(".")]
    return tuple(numbers + [0] * (3 - len(numbers)))


def _report_unresolved_usage(
    project: Project, usage: Usage, candidates: Sequence[Project], sink: Sink
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
