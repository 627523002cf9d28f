"""Outcomes of earlier runs for the same bytes, or for texts that say the same in other places."""

import marshal
from collections.abc import Iterable, Iterator, Mapping

from sysmlc.cache import Cache
from sysmlc.driver.compilation import Opened, Request
from sysmlc.driver.dependencies import Dependencies
from sysmlc.driver.faults import FAILED
from sysmlc.driver.outcome import Outcome
from sysmlc.driver.recall import recall, remember
from sysmlc.driver.recording import Recorded
from sysmlc.driver.shapes import keep_shape, kept_shape
from sysmlc.driver.tracing import COVERAGE, TRACE
from sysmlc.frontends.base import Worded
from sysmlc.sources import Source

STILL = frozenset({"contracts", "plantuml", "recipe"})
"""Back ends whose files state no places in the inputs."""


def kept(
    cache: Cache, on: Dependencies, opened: Opened, request: Request
) -> tuple[Outcome, Recorded | None] | None:
    """The outcome that an earlier run came to, or that it would come to now; else None.

    One that is to be kept for these texts comes with what was recorded.
    """
    found = recall(cache, on.key(), opened.root) or _moved(cache, on, opened)
    return (found, None) if found else _restated(cache, on, opened, request)


def keep(
    cache: Cache,
    on: Dependencies,
    opened: Opened,
    outcome: Outcome,
    backends: Iterable[str],
    recorded: Recorded | None = None,
) -> None:
    """Keep an outcome that back ends made; where no places matter to them, by its words too.

    With what was ``recorded`` it is also kept by the shapes of its texts, without literals.
    """
    remember(cache, on.key(), outcome, on.unit())
    if outcome.exit_code() == FAILED or not _is_still(outcome, backends):
        return
    wordings = dict(_wordings(opened))
    if wordings:
        sources = opened.reading.sources()
        texts = {one.name: one.data for one in sources if one.name in wordings}
        cache.put(on.key(wordings), marshal.dumps((on.key(), _digests(on, wordings), texts)))
    if recorded is not None:
        keep_shape(cache, on, opened, recorded)


def _is_still(outcome: Outcome, backends: Iterable[str]) -> bool:
    """Whether no place is in what the back ends say; that of the platform names lines."""
    made = {file.backend for file in outcome.files if file.path not in (COVERAGE, TRACE)}
    return made <= STILL and {*backends} <= STILL | {"platform"}


def _moved(cache: Cache, on: Dependencies, opened: Opened) -> Outcome | None:
    wordings = dict(_wordings(opened))
    entry = cache.get(on.key(wordings)) if wordings else None
    if entry is None:
        return None
    key, known, texts = marshal.loads(entry)
    found = recall(cache, key, opened.root)
    return found and _adapted(found, known, texts, opened)


def _restated(
    cache: Cache, on: Dependencies, opened: Opened, request: Request
) -> tuple[Outcome, Recorded] | None:
    known = kept_shape(cache, on, opened)
    if known is None:
        return None
    from sysmlc.driver.restoring import restored

    return restored(cache, known, opened, request)


def _adapted(
    found: Outcome, known: Mapping[str, str], texts: Mapping[str, bytes], opened: Opened
) -> Outcome | None:
    """The outcome with places moved from texts of that time, whose digests are ``known``."""
    from sysmlc.driver.moving import LostError, Move, moved

    moves, sources = {}, []
    for one in opened.reading.recognised:
        name, frontend = one.source.name, one.frontend
        is_other = name in known and one.source.sha256 != known[name]
        if is_other and isinstance(frontend, Worded):
            moves[name] = Move(frontend, Source(name, texts[name]), one.source)
            sources.append(one.source)
    try:
        return moved(found, moves, sources, known)
    except LostError:
        return None


def _wordings(opened: Opened) -> Iterator[tuple[str, str]]:
    """What each text says, by the name of its file; others are known by their bytes."""
    for one in opened.reading.recognised:
        said = one.frontend.wording(one.source) if isinstance(one.frontend, Worded) else ""
        if said:
            yield one.source.name, said


def _digests(on: Dependencies, names: Iterable[str]) -> dict[str, str]:
    return {name: digest for name, digest, _ in on.inputs if name in names}
