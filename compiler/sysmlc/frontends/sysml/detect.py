"""Recognising SysML v2 and KerML by what a file begins with."""

import re

from sysmlc.sources import Source
from sysmlc.sources.files import is_description_entry

_SUFFIXES = (".sysml", ".kerml")
_SKIPPED = re.compile(rb"(?:\xef\xbb\xbf)?(?:\s+|//\*.*?\*/|//[^\n]*|/\*.*?\*/)*", re.DOTALL)
_WORD = re.compile(rb"[a-z]+|#(?=[\w'])|@(?=[\w'])")
_WORDS = """
    package library standard private public protected import part action state item attribute port
    requirement constraint abstract doc comment enum interface connection flow use verification
    analysis view viewpoint occurrence individual allocation calc concern metadata namespace class
    classifier feature datatype struct assoc behavior function predicate interaction type alias
    dependency variation rendering case rep language locale ref # @ metaclass
"""
_FIRST = frozenset(word.encode() for word in _WORDS.split())
_XMI = re.compile(rb"<(?:sysml|kerml):[A-Z]\w*[\s>]")


def score(source: Source) -> float:
    """How sure it is that the bytes are text or XMI of SysML v2 or KerML."""
    if is_description(source):
        return 1.0
    head = source.data[:8192]
    if head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return 1.0 if _XMI.search(head) and b"omg.org/spec/" in head else 0.0
    return _of_text(source.name, head)


def _of_text(name: str, head: bytes) -> float:
    is_named = name.lower().endswith(_SUFFIXES)
    start = _SKIPPED.match(head)
    word = _WORD.match(head, start.end() if start else 0)
    is_known = word is not None and word[0] in _FIRST
    if is_named:
        return 1.0 if is_known else 0.5
    # Of other texts many begin with such a word ("part of ..."), or with '#'.
    is_declaration = b"{" in head or b";" in head
    return 0.6 if is_known and is_declaration and b"\0" not in head else 0.0


def is_description(source: Source) -> bool:
    """Whether it is what a project archive says about itself (KerML 1.0, 10.3)."""
    return is_description_entry(source.name.rpartition("!")[2]) and "!" in source.name


def is_xml(source: Source) -> bool:
    """Whether it is an interchange file, not text."""
    return source.data[:64].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def language(source: Source) -> str:
    """``kerml`` or ``sysml``: as the file is named."""
    return "kerml" if source.name.lower().endswith((".kerml", ".kermlx")) else "sysml"
