"""Whether a source is AutomationML: told by its root element, not by its name."""

import re

from sysmlc.sources import Source

_HEAD = 1 << 14
_ROOT = re.compile(rb"<(?:[\w.-]+:)?CAEXFile[\s>/]")
_FIRST = re.compile(rb"<(?![?!])")


def score(source: Source) -> float:
    """1 when the first element is a CAEXFile, 0.3 when one stands in the damaged head, else 0.

    The namespace differs between versions and writers, and hybrids exist: it does not decide.
    """
    head = source.data[:_HEAD].replace(b"\0", b"")
    found = _ROOT.search(head)
    if found is None:
        return 0.0
    first = _FIRST.search(head)
    return 1.0 if first is not None and first.start() == found.start() else 0.3
