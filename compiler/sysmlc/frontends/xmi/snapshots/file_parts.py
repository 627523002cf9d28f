"""Snapshots inside a MagicDraw model that is saved as one XML file.

What an archive has as entries such a file has as ``filePart``s of its extension: whole documents
without their declarations.
"""

import re
from collections.abc import Iterator, Sequence

from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.sources import Source

_START = re.compile(rb"<filePart\s+name=(?:'([^'<]*)'|\"([^\"<]*)\")[^<>]*(?<!/)>")
_END = b"</filePart>"
_UTF8 = re.compile(
    rb"\s*(\xef\xbb\xbf)?\s*<(?!\?xml[^>]*encoding\s*=\s*[\"'](?!utf-8|us-ascii))", re.I
)


def split(models: Sequence[Source]) -> tuple[list[Source], list[Source]]:
    """The models without such parts, and those parts that are snapshots.

    A part is called as the entry of an archive would be. A file that is not in UTF-8 keeps its
    parts: MagicDraw writes no other.
    """
    whole: list[Source] = []
    parts: list[Source] = []
    for model in models:
        found = list(_parts(model)) if b"<filePart" in model.data else []
        parts.extend(part for _, _, part in found if is_snapshot(part))
        whole.append(_without(model, [(start, end) for start, end, _ in found]))
    return whole, parts


def _parts(model: Source) -> Iterator[tuple[int, int, Source]]:
    """Where the content of each part begins and ends, and the part."""
    data = model.data
    start = _START.search(data) if _UTF8.match(data) else None
    while start is not None:
        end = data.find(_END, start.end())
        if end < 0:
            return
        name = (start[1] or start[2] or b"").decode("utf-8", "replace")
        yield start.end(), end, Source(f"{model.name}!{name}", data[start.end() : end])
        start = _START.search(data, end)


def _without(model: Source, places: list[tuple[int, int]]) -> Source:
    if not places:
        return model
    ends = [0, *(end for _, end in places)]
    starts = [*(start for start, _ in places), len(model.data)]
    kept = b"".join(model.data[a:b] for a, b in zip(ends, starts, strict=True))
    return Source(model.name, kept)
