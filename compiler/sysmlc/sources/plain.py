"""XML that is written plainly: whether a text is well-formed, told without a parser.

Expat takes long to say what can be seen on the way when the text is cut at the signs that start
tags: what is left is here, characters and references of the whole file at once. Nothing that expat
refuses may pass; what is only unusual (other encodings, comments, CDATA) is left to expat.
"""

import re
from collections.abc import Iterator

from sysmlc.sources.encoding import codec

_CHUNK = 1 << 16
"""Bytes that are cut at once: what comes of them stays near the processor."""

_DECLARATION = re.compile(rb"<\?xml\s[^<>]*\?>")
_HEAD = re.compile(rb"""\s*<([A-Za-z_][\w.:-]*)(?:[^"'<>]|"[^"<]*"|'[^'<]*')*>""")
_NEAR = 1 << 16
"""Bytes in which the root has to be."""
_CHARACTERS = bytes([*b"\t\n\r", *range(0x20, 0x100)])
"""All bytes that may stand in XML in UTF-8, once it is known to be UTF-8."""
_NO_CHARACTERS = (b"\xef\xbf\xbe", b"\xef\xbf\xbf")
"""U+FFFE and U+FFFF, which are UTF-8 and no characters of XML."""
_APART = 64
"""Bytes a reference from which on a parser is faster."""
_REFERENCE = re.compile(rb"&([^;<&]{0,12};?)")
_NAMED = {b"amp;": "&", b"lt;": "<", b"gt;": ">", b"quot;": '"', b"apos;": "'"}
_IN_TURN = tuple((f"&{name.decode()}", sign) for name, sign in reversed(_NAMED.items()))
"""The ampersand last: what it starts is no reference."""
_NUMBER = re.compile(r"#(?:x([0-9a-fA-F]{1,6})|([0-9]{1,7}));")
_IN_TEXT = re.compile(r"&([^;]*;)")


def start_of(data: bytes) -> int | None:
    """Where the root's start tag is over; None when more than it and the declaration is before.

    Behind it there are only tags, texts and references, in UTF-8.
    """
    mark, name = codec(data)
    if name not in ("utf-8", "ascii"):
        return None
    declared = _DECLARATION.match(data, mark)
    start = declared.end() if declared else mark
    # Single characters first: to look for two takes ten times as long.
    for sign in (b"?", b"!"):
        if data.find(sign, start) >= 0 and data.find(b"<" + sign, start) >= 0:
            return None
    found = _HEAD.match(data[start : start + _NEAR])
    return None if found is None or found[0].endswith(b"/>") else start + found.end()


def alone(data: bytes, start: int) -> bytes:
    """The root without content: a parser can tell what it says, and whether all is right so far."""
    head = data[:start]
    name = head[head.rindex(b"<") + 1 :].split(None, 1)[0].rstrip(b">")
    return b"%s</%s>" % (head, name)


def is_sound(data: bytes, start: int) -> bool:
    """Whether all characters and references are right of what has no CDATA and no comments.

    That they are UTF-8 is seen when they are decoded.
    """
    if (b"]" in data and b"]]>" in data) or data.translate(None, _CHARACTERS):
        return False
    if not data.isascii() and any(one in data for one in _NO_CHARACTERS):
        return False
    return b"&" not in data or _has_right_references(data, start)


def _has_right_references(data: bytes, start: int) -> bool:
    if data.count(b"&", start) > len(data) // _APART:
        return False
    return all(map(_is_reference, set(_REFERENCE.findall(data, start))))


def _is_reference(written: bytes) -> bool:
    if written in _NAMED:
        return True
    number = _NUMBER.fullmatch(written.decode("latin-1"))
    return number is not None and _is_character(_code(number))


def _code(number: re.Match[str]) -> int:
    return int(number[1], 16) if number[1] else int(number[2])


def _is_character(code: int) -> bool:
    """Whether it is a character of XML (XML 1.0, production 2)."""
    if code < 0x20:
        return code in (0x9, 0xA, 0xD)
    return code <= 0xD7FF or 0xE000 <= code <= 0xFFFD or 0x10000 <= code <= 0x10FFFF


def texts(data: bytes, start: int) -> Iterator[str]:
    """What stands behind a place, in texts of some size that end before the sign of a tag.

    Bytes become text here: new memory is what takes longest in that, and so it is used again.
    Raises UnicodeDecodeError.
    """
    end = len(data)
    while start < end:
        stop = data.find(b"<", start + _CHUNK)
        stop = end if stop < 0 else stop
        text = data[start:stop].decode()
        yield text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text
        start = stop


def said(text: str) -> str:
    """The text with the characters that are referred to, all known to be right."""
    if "&" not in text:
        return text
    if "&#" in text:
        return _IN_TEXT.sub(_character, text)
    for written, sign in _IN_TURN:
        text = text.replace(written, sign)
    return text


def _character(reference: re.Match[str]) -> str:
    number = _NUMBER.fullmatch(reference[1])
    return chr(_code(number)) if number else _NAMED[reference[1].encode()]
