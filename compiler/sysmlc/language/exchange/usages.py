"""Which of the given projects is meant by what a project says to use (KerML 1.0, 10.3)."""

import re
from collections.abc import Mapping, Sequence
from urllib.parse import unquote, urlsplit

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.language.exchange import rules
from sysmlc.language.exchange.projects import Project, Usage

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
            _report(project, usage, named, sink)
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


def _report(project: Project, usage: Usage, named: Sequence[Project], sink: Sink) -> None:
    versions = ", ".join(one.version or "without a version" for one in named)
    problem = f"but the one given is {versions}" if named else "which is not given"
    constraint = f" ({usage.constraint})" if usage.constraint else ""
    sink.report(
        rules.UNRESOLVED_USAGE,
        Subject(project.path, place=project.place or Place(project.path)),
        project=project.name,
        resource=usage.resource,
        constraint=constraint,
        problem=problem,
    )
