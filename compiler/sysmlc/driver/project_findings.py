"""Findings about the configuration of a project, which one compile unit alone cannot decide.

A ``[[suppress]]`` entry is unused, and a name in ``[recipe.levels]`` is unknown, only if that holds
in every unit of the project. A run that reads a part of the project does not report either.
"""

import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from msgspec.structs import replace

from sysmlc.config import Config, ConfigError, expand_files
from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.driver import faults
from sysmlc.driver.compilation import OpenedUnit
from sysmlc.driver.inputs import find_model_files, find_projects, list_suffixes, rate_source
from sysmlc.driver.outcome import Outcome
from sysmlc.frontends.base import Frontend
from sysmlc.sources import SourceError, load

_PROJECT_RULES = frozenset({faults.UNUSED_SUPPRESSION.code, faults.UNKNOWN_LEVEL_ELEMENT.code})


def judge_project_findings(
    units: Sequence[tuple[Config, OpenedUnit]], outcomes: Sequence[Outcome]
) -> list[Outcome]:
    """Return the outcomes with the findings that hold for a whole project, each once.

    Units may belong to several projects, each with a configuration of its own.
    """
    judged = list(outcomes)
    for file in dict.fromkeys(config.file for config, _ in units):
        members = [index for index, (config, _) in enumerate(units) if config.file == file]
        diagnostics = [[f.diagnostic for f in outcomes[index].findings] for index in members]
        opened = [units[index][1] for index in members]
        messages = select_project_findings(units[members[0]][0], opened, diagnostics)
        for index in members:
            findings = outcomes[index].findings
            judged[index] = replace(
                outcomes[index],
                findings=tuple(f for f in findings if _is_kept(f.diagnostic, messages)),
            )
            messages = frozenset()
    return judged


def select_project_findings(
    config: Config, units: Sequence[OpenedUnit], diagnostics: Sequence[Iterable[Diagnostic]]
) -> frozenset[str]:
    """Return the messages of the findings about the configuration that hold in all *units*."""
    messages = [
        frozenset(d.message for d in unit_diagnostics if d.rule.code in _PROJECT_RULES)
        for unit_diagnostics in diagnostics
    ]
    common = frozenset.intersection(*messages)
    return common if common and _is_whole_project(config, units) else frozenset()


def without_project_findings(
    diagnostics: Iterable[Diagnostic], messages: frozenset[str]
) -> Iterator[Diagnostic]:
    """Yield *diagnostics*; of those about the configuration, only those with *messages*."""
    return (diagnostic for diagnostic in diagnostics if _is_kept(diagnostic, messages))


def _is_kept(diagnostic: Diagnostic, messages: frozenset[str]) -> bool:
    return diagnostic.rule.code not in _PROJECT_RULES or diagnostic.message in messages


def _is_whole_project(config: Config, units: Sequence[OpenedUnit]) -> bool:
    """Whether the units read every model of the project."""
    read = {file.path for opened in units for file in opened.reading.files}
    frontends = units[0].frontends
    try:
        files = _list_files(config, list_suffixes(frontends))
        return all(path in read or not _is_model(path, frontends) for path in files)
    except ConfigError:
        return False


def _is_model(path: Path, frontends: Sequence[Frontend]) -> bool:
    """Whether a front end recognises the file; most XML files are not models."""
    try:
        sources = load(path, path.name)
    except SourceError:
        return False
    scores = (rate_source(frontend, s, Sink()) for s in sources for frontend in frontends)
    return any(score > 0 for score in scores)


def _list_files(config: Config, suffixes: frozenset[str]) -> Iterator[Path]:
    """Yield the real paths of the files of every ``[[model]]``, or else of the whole project.

    The files of the whole project are all those that are named like models.
    """
    if config.folder is None:
        return
    declared = [path for unit in config.models for path in expand_files(config, unit.files)]
    for path in declared or [config.folder]:
        if not path.is_dir():
            yield Path(os.path.realpath(path))
            continue
        folder = path.resolve()
        nested = frozenset(() if declared else find_projects(folder))
        files = find_model_files(folder, nested, suffixes)
        real_paths = (Path(os.path.realpath(file)) for file in files)
        # A link that leads out of the folder is not read.
        yield from (file for file in real_paths if file.is_relative_to(folder))
