"""Whether a text is well-formed XML, told without a parser where nothing in it is out of the way.

Expat takes a tenth of the time of reading to say that a plant is well-formed (XML 1.0, section
2.1), and all that it looks at is looked at anyway when the text is cut. What is left is here:
characters and references of the whole file at once, its root by expat itself, and end tags, each
different one once. Nothing that expat refuses may pass; what is only unusual is left to expat.
"""

import re

from sysmlc.frontends.caex.tags import NotPlainError
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, parse, parser

Root = tuple[str, dict[str, str]]
"""Local name and attributes."""

_CHARACTERS = bytes([*b"\t\n\r", *range(0x20, 0x100)])
"""All bytes that may stand in XML in UTF-8, once it is known to be UTF-8."""
_NO_CHARACTERS = (b"\xef\xbf\xbe", b"\xef\xbf\xbf")
"""U+FFFE and U+FFFF, which are UTF-8 and no characters of XML."""
_NAMED = ("amp;", "lt;", "gt;", "quot;", "apos;")

_END = re.compile(r"/([A-Za-z_][A-Za-z0-9_.-]*)[ \t\n]*>(.*)", re.DOTALL)
_LOOSE_END = re.compile(r"/(?:[^>]*:)?([^>:]*?)\s*>(.*)", re.DOTALL)
_HEAD = re.compile(rb"""[^<]*(?:<\?xml[^>]*>[^<]*)?<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_NEAR = 1 << 16
"""Bytes in which the root has to be."""
_BLANK = " \t\n"


def is_sound(source: Source, text: str) -> bool:
    """Whether all characters and references of a text without CDATA and comments are right."""
    if "]" in text and "]]>" in text:
        return False
    if not all(behind.startswith(_NAMED) for behind in text.split("&")[1:]):
        return False
    data = source.data
    if data.translate(None, _CHARACTERS):
        return False
    return data.isascii() or not any(one in data for one in _NO_CHARACTERS)


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


class Ends:
    """The end tags of a text as they come, with the names that they should have.

    ``is_sound`` says whether all are as they should be, ``has_stray`` whether text is behind one;
    both are known when ``are_right`` was asked.
    """

    def __init__(self) -> None:
        self._pieces: list[str] = []
        self._expected: list[str] = []
        self.add = self._pieces.append
        """Add an end tag with the text behind it."""
        self.expect = self._expected.append
        """Say what the end tag that is added now should end: the name as ``_LOOSE_END`` has it."""
        self.is_sound = True
        self.has_stray = False

    def are_right(self) -> bool:
        """Whether each end tag ends what it should. Raises NotPlainError for what is no tag."""
        names = {piece: self._name(piece) for piece in set(self._pieces)}
        return list(map(names.__getitem__, self._pieces)) == self._expected

    def _name(self, piece: str) -> str:
        sound = _END.fullmatch(piece)
        found = sound or _LOOSE_END.fullmatch(piece)
        if found is None:
            raise NotPlainError
        self.is_sound = self.is_sound and sound is not None
        self.has_stray = self.has_stray or bool(found[2].strip())
        return found[1]
