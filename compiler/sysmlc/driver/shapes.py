"""Entries of the cache by the shapes of texts: what a run with other literals needs of this one."""

import marshal
from collections.abc import Iterator, Mapping

from sysmlc.cache import Cache
from sysmlc.driver.compilation import Opened
from sysmlc.driver.dependencies import Dependencies
from sysmlc.driver.recording import Made, Recorded
from sysmlc.frontends.base import Valued
from sysmlc.ir.reads import Literal
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Kept:
    """What is kept by shape: the key of the outcome, its texts by file, what was recorded."""

    key: str
    digests: Mapping[str, str]
    texts: Mapping[str, bytes]
    recorded: Recorded


def keep_shape(cache: Cache, on: Dependencies, opened: Opened, recorded: Recorded) -> None:
    """Keep what is needed to do parts of a compilation again."""
    shapes = dict(_shapes(opened))
    sources = opened.reading.sources()
    texts = {one.name: one.data for one in sources if one.name in shapes}
    digests = {name: digest for name, digest, _ in on.inputs}
    if shapes:
        entry = (on.key(), digests, texts, _packed(recorded))
        cache.put(on.key(shapes), marshal.dumps(entry))  # type: ignore[arg-type]


def kept_shape(cache: Cache, on: Dependencies, opened: Opened) -> Kept | None:
    """What an earlier run kept whose texts differ from those of now in literals only."""
    shapes = dict(_shapes(opened))
    found = cache.get(on.key(shapes)) if shapes else None
    return _kept(found) if found else None


def _shapes(opened: Opened) -> Iterator[tuple[str, str]]:
    """What each text says but for literals, by the name of its file."""
    for one in opened.reading.recognised:
        said = one.frontend.shape(one.source) if isinstance(one.frontend, Valued) else ""
        if said:
            yield one.source.name, said


# -- as bytes ----------------------------------------------------------------------------------


def _packed(one: Recorded) -> tuple[object, ...]:
    return (
        one.graph,
        [(x.file, x.form, x.id, x.key) for x in one.literals],
        one.asked,
        dict(one.readers),
        dict(one.stored),
        dict(one.used),
        dict(one.heard),
        [(x.path, x.backend, x.trace, x.about) for x in one.made],
    )


def _kept(data: bytes) -> Kept | None:
    """What was kept; None when it is damaged."""
    try:
        key, digests, texts, packed = marshal.loads(data)
        graph, literals, asked, readers, stored, used, heard, made = packed
    except (EOFError, TypeError, ValueError):
        return None
    recorded = Recorded(
        graph,
        tuple(Literal(*one) for one in literals),
        asked,
        readers,
        stored,
        used,
        heard,
        tuple(Made(*one) for one in made),
    )
    return Kept(key, digests, texts, recorded)
