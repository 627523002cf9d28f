"""Split what is too much for one picture: connected things stay together as far as they fit."""

from collections.abc import Collection, Iterator, Mapping, Sequence

LIMIT = 40
"""Boxes in one diagram; above it pictures measured on real models are no longer readable."""


def chunks(
    items: Sequence[str],
    neighbours: Mapping[str, Collection[str]],
    limit: int = LIMIT,
    sizes: Mapping[str, int] | None = None,
) -> list[list[str]]:
    """Divide ``items`` so that each part with its neighbours has at most ``limit`` members.

    ``sizes`` says for how many members an item counts (1 when it is not there). An item that
    has more neighbours than fit is a part of its own. Inside a part the order of ``items`` is
    kept.
    """
    size = sizes or {}
    every = {*items, *(near for item in items for near in neighbours.get(item, ()))}
    if items and sum(size.get(member, 1) for member in every) <= limit:
        return [list(dict.fromkeys(items))]
    place = {item: index for index, item in enumerate(items)}
    parts: list[list[str]] = []
    shown: set[str] = set()
    for item in _connected(items, neighbours):
        wider = shown | {item} | set(neighbours.get(item, ()))
        if not parts or sum(size.get(member, 1) for member in wider) > limit:
            parts.append([])
            wider = {item} | set(neighbours.get(item, ()))
        parts[-1].append(item)
        shown = wider
    return [sorted(part, key=place.__getitem__) for part in parts]


def _connected(items: Sequence[str], neighbours: Mapping[str, Collection[str]]) -> Iterator[str]:
    """The items component by component, each breadth first from its first item."""
    waiting = dict.fromkeys(items)
    for start in items:
        queue = [start] if start in waiting else []
        waiting.pop(start, None)
        for item in queue:
            yield item
            near = [o for o in dict.fromkeys(neighbours.get(item, ())) if o in waiting]
            for other in near:
                del waiting[other]
            queue.extend(near)


def numbered(name: str, index: int, count: int) -> str:
    """Name of one part: the name itself when there is only one."""
    return name if count == 1 else f"{name}::{index + 1}-of-{count}"


def footer(index: int, count: int, whole: str) -> str:
    """The note on a part that says what it is a part of; nothing when it is the whole."""
    return "" if count == 1 else f"part {index + 1} of {count} of {whole}; grey: shown elsewhere"
