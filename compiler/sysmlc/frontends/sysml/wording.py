"""What files say, apart from where: equal for texts that are only laid out otherwise."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml.detect import is_xml
from sysmlc.frontends.sysml.libraries import FILES
from sysmlc.language.text import words
from sysmlc.sources.encoding import codec

if TYPE_CHECKING:
    from sysmlc.cache import Cache
    from sysmlc.sources import Source


def digest(source: "Source", cache: "Cache | None") -> str:
    """Digest of the tokens of a file; empty for XML, entries of archives, what is not UTF-8.

    The name of a library of ours counts anywhere in a text, for it may bring that library.
    """
    text = _text(source)
    if text is None:
        return ""
    found = _digest(source, text, cache)
    named = [str(int(name in text)) for name in FILES]
    return "".join([found, *named]) if found else ""


def spans(source: "Source") -> words.Spans:
    """Where the tokens of a file are, in characters; none where ``digest`` is empty."""
    text = _text(source)
    return (words.spans(text) or []) if text is not None else []


def _digest(source: "Source", text: str, cache: "Cache | None") -> str:
    from sysmlc.language.stored import code

    if cache is None:
        return words.digest(text)
    key = f"{source.sha256}-words-{code()}"
    known = cache.get(key)
    if known is None:
        known = words.digest(text).encode() or b"-"
        cache.put(key, known)
    return known.decode().strip("-")


def _text(source: "Source") -> str | None:
    if "!" in source.name or is_xml(source) or codec(source.data)[1] != "utf-8":
        return None
    try:
        return source.data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return None
