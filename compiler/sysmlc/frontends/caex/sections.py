"""The text of a plainly written file in sections: each begins with a value, but the first of some.

Values are every fifth of what a plant says, and between two of them stands what others say, too.
"""

import re
from collections.abc import Iterator

WITHOUT_VALUE = "without value"
"""Stands itself, not a text that is equal, before a section that begins with no value."""

_AT_ONCE = 1 << 16
"""Bytes that are cut at once: what comes of them stays near the processor."""

_START = re.compile(rb"<(?!/)")


def in_lists(data: bytes, start: int) -> Iterator[list[str]]:
    """The sections behind the sign that starts the root.

    A section is what stands behind the start tag of a value, up to that of the next. Where none
    has begun, the section begins behind a sign that starts another tag.

    Bytes become text here: new memory is what takes longest in that, and so it is used again.
    """
    start, end = data.index(b"<", start) + 1, len(data)
    while start < end:
        found = _START.search(data, start + _AT_ONCE)
        stop = end if found is None else found.start()
        text = data[start:stop].decode()
        if "\r" in text:
            text = text.replace("\r\n", "\n").replace("\r", "\n")
        yield [WITHOUT_VALUE, *text.split("<Value>")]
        start = stop + 1
