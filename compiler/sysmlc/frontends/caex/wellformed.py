"""Whether a text is well-formed XML, told without a parser where nothing in it is out of the way.

Expat takes a tenth of the time of reading to say that a plant is well-formed (XML 1.0, section
2.1), and all that it looks at is looked at anyway when the text is cut. What is left is here:
characters and references of the whole file at once, its root by expat itself, and end tags, each
different one once. Nothing that expat refuses may pass; what is only unusual is left to expat.
"""

import re
from sys import intern

from sysmlc.frontends.caex.tags import NotPlainError
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, parse, parser

Root = tuple[str, dict[str, str]]
"""Local name and attributes."""

_CHARACTERS = bytes([*b"\t\n\r", *range(0x20, 0x100)])
"""All bytes that may stand in XML in UTF-8, once it is known to be UTF-8."""
_NO_CHARACTERS = (b"\xef\xbf\xbe", b"\xef\xbf\xbf")
"""U+FFFE and U+FFFF, which are UTF-8 and no characters of XML."""
_NAMED = (b"&amp;", b"&lt;", b"&gt;", b"&quot;", b"&apos;")

_END = re.compile(r"/([A-Za-z_][A-Za-z0-9_.-]*)[ \t\n]*>(.*)", re.DOTALL)
_LOOSE_END = re.compile(r"/(?:[^>]*:)?([^>:]*?)\s*>(.*)", re.DOTALL)
_HEAD = re.compile(rb"""[^<]*(?:<\?xml[^>]*>[^<]*)?<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_NEAR = 1 << 16
"""Bytes in which the root has to be."""
_BLANK = " \t\n"


def is_sound(data: bytes) -> bool:
    """Whether all characters and references are right of what has no CDATA and no comments.

    That they are UTF-8 has to be seen elsewhere.
    """
    if (b"]" in data and b"]]>" in data) or data.translate(None, _CHARACTERS):
        return False
    if not data.isascii() and any(one in data for one in _NO_CHARACTERS):
        return False
    return _has_named_references_only(data)


def _has_named_references_only(data: bytes) -> bool:
    at = data.find(b"&")
    while at >= 0:
        if not data.startswith(_NAMED, at):
            return False
        at = data.find(b"&", at + 1)
    return True


def root(source: Source) -> Root | None:
    """The root; None when the file is not well-formed, which the general way tells."""
    made, found = parser(), []

    def start(tag: str, values: dict[str, str]) -> None:
        found.append((tag.rpartition(SEPARATOR)[2], values))
        made.StartElementHandler = None

    made.StartElementHandler = start
    try:
        parse(source, made)
    except SourceError:
        return None
    finally:
        made.StartElementHandler = None
    return found[0]


def root_alone(source: Source) -> Root | None:
    """The root of a file, of which what stands before it is checked, too, and nothing else."""
    found = _HEAD.match(source.data[:_NEAR])
    # A root that has to be looked for, or has another name, is not worth a shorter way.
    return root(Source(source.name, found[0] + b"</CAEXFile>") if found else source)


def is_end(piece: str) -> bool:
    """Whether nothing stands behind the last end tag but white space."""
    return not piece.partition(">")[2].strip(_BLANK)


class Ends(dict[str, str]):
    """Names of the elements that end tags end, by the tags and the texts behind them.

    ``is_sound`` says whether all are as they should be, ``has_stray`` whether text was behind.
    """

    def __init__(self) -> None:
        super().__init__()
        self.is_sound = True
        self.has_stray = False

    def __missing__(self, piece: str) -> str:
        sound = _END.fullmatch(piece)
        found = sound or _LOOSE_END.fullmatch(piece)
        if found is None:
            raise NotPlainError
        self.is_sound = self.is_sound and sound is not None
        self.has_stray = self.has_stray or bool(found[2].strip())
        self[piece] = name = intern(found[1])
        return name
