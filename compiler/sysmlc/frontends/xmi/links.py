"""How a document refers to others; found without parsing it, before the unit is known."""

import re

from sysmlc.frontends.xmi.profiles import default_namespace
from sysmlc.sources import Source

_HREF = re.compile(rb"""href\s*=\s*(?:"([^"#]+)|'([^'#]+))""")

_ROOT = re.compile(rb"<uml:(Profile|Model|Package)\b([^>]*)")
_NAME = re.compile(rb"""\sname\s*=\s*(?:"([^"]*)|'([^']*))""")
_EMF_NAMESPACE = re.compile(rb"""\bnsURI\s*=\s*["']([^"']+)""")
_XML_NAMESPACE = re.compile(rb"""\bxmlns:[\w.-]+\s*=\s*["']([^"']+)""")


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


def profile_namespaces(source: Source) -> frozenset[str] | None:
    """Return the namespaces of the stereotypes in a profile; None for any other document.

    Papyrus saves one for each version of the profile, MagicDraw derives it from the name.
    """
    root = _ROOT.search(source.data)
    if root is None or root[1] != b"Profile":
        return None
    name = _NAME.search(root[2])
    own = _text(name[1] or name[2] or b"") if name is not None else ""
    namespaces = map(_text, _EMF_NAMESPACE.findall(source.data))
    return frozenset([default_namespace(own), *namespaces])


def used_namespaces(source: Source) -> frozenset[str]:
    """Return the XML namespaces that a document declares with a prefix."""
    return frozenset(map(_text, _XML_NAMESPACE.findall(source.data)))


def _text(data: bytes) -> str:
    return _unescaped(data.decode("utf-8", "replace"))
