"""Detection of SysML v2 and KerML by the first bytes of a file."""

import re

from sysmlc.sources import Source
from sysmlc.sources.files import is_description_entry

_SUFFIXES = (".sysml", ".kerml")
_SKIPPED = re.compile(rb"(?:\xef\xbb\xbf)?(?:\s+|//\*.*?\*/|//[^\n]*|/\*.*?\*/)*", re.DOTALL)
"""Byte order mark, white space, notes and comments."""
_WORD = re.compile(rb"[a-z]+|#(?=[\w'])|@(?=[\w'])")
_WORDS = """
    package library standard private public protected import part action state item attribute port
    requirement constraint abstract doc comment enum interface connection flow use verification
    analysis view viewpoint occurrence individual allocation calc concern metadata namespace class
    classifier feature datatype struct assoc behavior function predicate interaction type alias
    dependency variation rendering case rep language locale ref # @ metaclass
"""
_FIRST_WORDS = frozenset(word.encode() for word in _WORDS.split())
_XMI_ROOT = re.compile(rb"<(?:sysml|kerml):[A-Z]\w*[\s>]")
_BEFORE_XML = b"\xef\xbb\xbf \t\r\n"


def score_source(source: Source) -> float:
    """Return how certain it is, from 0 to 1, that a source is text or XMI of SysML v2 or KerML."""
    if is_description(source):
        return 1.0
    head = source.data[:8192]
    if head.lstrip(_BEFORE_XML).startswith(b"<"):
        return 1.0 if _XMI_ROOT.search(head) and b"omg.org/spec/" in head else 0.0
    return _score_text(source.name, head)


def _score_text(name: str, head: bytes) -> float:
    skipped = _SKIPPED.match(head)
    word = _WORD.match(head, skipped.end() if skipped else 0)
    starts_with_keyword = word is not None and word[0] in _FIRST_WORDS
    if name.lower().endswith(_SUFFIXES):
        return 1.0 if starts_with_keyword else 0.5
    # Many other texts start with such a word ("part of ...") or with '#'.
    has_declaration = b"{" in head or b";" in head
    return 0.6 if starts_with_keyword and has_declaration and b"\0" not in head else 0.0


def is_description(source: Source) -> bool:
    """Whether a source is the description that a project archive contains (KerML 1.0, 10.3)."""
    return is_description_entry(source.name.rpartition("!")[2]) and "!" in source.name


def is_xml(source: Source) -> bool:
    """Whether a source is an interchange file, not text."""
    return source.data[:64].lstrip(_BEFORE_XML).startswith(b"<")


def language_of(source: Source) -> str:
    """Return ``kerml`` or ``sysml``, by the suffix of the file name."""
    return "kerml" if source.name.lower().endswith((".kerml", ".kermlx")) else "sysml"
