"""What files say, apart from where: equal for texts that are only laid out otherwise."""

from collections.abc import Callable, Container, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import forms
from sysmlc.frontends.sysml.detect import is_xml
from sysmlc.frontends.sysml.libraries import FILES
from sysmlc.ir import AttrValue
from sysmlc.ir.reads import Literal, Value
from sysmlc.language.text import words
from sysmlc.language.text.scan import TOKEN
from sysmlc.sources.encoding import codec

if TYPE_CHECKING:
    from sysmlc.cache import Cache
    from sysmlc.sources import Source


def digest(source: "Source", cache: "Cache | None") -> str:
    """Digest of the tokens of a file; empty for XML, entries of archives, what is not UTF-8.

    The name of a library of ours counts anywhere in a text, for it may bring that library.
    """
    return _told(source, cache, 0)


def shape(source: "Source", cache: "Cache | None") -> str:
    """The same without the values of literals."""
    return _told(source, cache, 1)


def spans(source: "Source") -> words.Spans:
    """Where the tokens of a file are, in characters; none where ``digest`` is empty."""
    text = _text(source)
    return (_spans(text) or []) if text is not None else []


def values(
    old: "Source", new: "Source", found: "Sequence[Literal]", asked: Container[int]
) -> dict[Value, AttrValue] | None:
    """The attributes that other literals make other ones, for texts of one shape.

    None where a literal is another one that is no attribute, or is among those ``asked`` for.
    """
    before, after = _text(old) or "", _text(new) or ""
    changed: dict[int, AttrValue] = {}
    for one, other in zip(_spans(before) or (), _spans(after) or (), strict=True):
        piece = after[slice(*other)]
        if piece != before[slice(*one)]:
            changed[one[0]] = words.literal(piece)
    made = {}
    for literal in found:
        places = set(forms.places(literal.form))
        if not places.isdisjoint(changed):
            made[literal.id, literal.key] = forms.value(literal.form, _reader(before, changed))
    given = {place for literal in found for place in forms.places(literal.form)}
    is_whole = all(at in given and at not in asked for at in changed)
    return made if is_whole and None not in made.values() else None


def _reader(text: str, changed: dict[int, AttrValue]) -> Callable[[int], AttrValue]:
    def literal(at: int) -> AttrValue:
        if at in changed:
            return changed[at]
        token = TOKEN.match(text, at)
        return words.literal(token[0]) if token else None

    return literal


@lru_cache(maxsize=4)
def _spans(text: str) -> words.Spans | None:
    return words.spans(text)


def _told(source: "Source", cache: "Cache | None", which: int) -> str:
    return _both(source, cache)[which]


@lru_cache(maxsize=256)
def _both(source: "Source", cache: "Cache | None") -> tuple[str, str]:
    """What a file says and its shape: both are asked for, before and after."""
    text = _text(source)
    if text is None:
        return "", ""
    named = "".join([str(int(name in text)) for name in FILES])
    said, shape = _digests(source, text, cache)
    return f"{said}{named}" if said else "", f"{shape}{named}" if shape else ""


def _digests(source: "Source", text: str, cache: "Cache | None") -> tuple[str, str]:
    from sysmlc.language.stored import code

    if cache is None:
        return words.digests(text)
    key = f"{source.sha256}-words-{code()}"
    known = cache.get(key)
    if known is None:
        known = " ".join(words.digests(text)).encode()
        cache.put(key, known)
    said, _, shape = known.decode().partition(" ")
    return said, shape


def _text(source: "Source") -> str | None:
    if "!" in source.name or is_xml(source) or codec(source.data)[1] != "utf-8":
        return None
    try:
        return source.data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return None
