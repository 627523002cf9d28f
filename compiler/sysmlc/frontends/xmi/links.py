"""Which files a document refers to; found without parsing it, before the unit is known."""

from sysmlc.patterns import pattern
from sysmlc.sources import Source

_HREF = pattern(rb"""href\s*=\s*(?:"([^"#]+)|'([^'#]+))""")


def links(source: Source) -> list[str]:
    """Files named by hrefs, without fragments, each once and in order.

    A document in UTF-16 gives none: its hrefs are read, but as references to other units.
    """
    found = (double or single for double, single in _HREF.findall(source.data))
    return list(dict.fromkeys(_unescaped(href.decode("utf-8", "replace")) for href in found))


def _unescaped(href: str) -> str:
    if "&" not in href:
        return href
    from html import unescape

    return unescape(href)
