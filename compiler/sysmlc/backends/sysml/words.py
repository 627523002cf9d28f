"""Names, strings and comments as SysML v2 spells them (KerML 1.0, 8.2.2)."""

import re
from functools import cache

_WORDS = """
    about abstract accept action actor after alias all allocate allocation analysis and as assert
    assign assoc assume at attribute behavior bind binding bool by calc case chains class
    classifier comment composite concern conjugate conjugates conjugation connect connection
    connector const constant constraint crosses datatype decide def default defined dependency
    derived difference differences disjoining disjoint do doc done else end entry enum event
    exhibit exit expose expr false feature featured featuring filter first flow for fork frame
    from function hastype if implies import in include individual inout interaction interface
    intersects inv inverse inverting istype item join language library locale loop member merge
    message meta metaclass metadata multiplicity namespace new nonunique not null objective
    occurrence of or ordered out package parallel part perform port portion predicate private
    protected public redefines redefinition ref references render rendering rep require
    requirement return satisfy send snapshot specialization specializes stakeholder standard state
    step struct subclassifier subject subset subsets subtype succession terminate then timeslice to
    transition true type typed typing unions until use use-case variant variation verification
    verify via view viewpoint when while xor start
"""
RESERVED = frozenset(_WORDS.split()) - {"start", "done", "use-case"}
"""Reserved words of SysML and KerML; ``start`` and ``done`` are names of library features."""
_BASIC = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_ESCAPES = {"\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r", "\b": "\\b", "\f": "\\f"}
_ESCAPED = re.compile(r"[\\\n\t\r\b\f'\"]")
_CONTROL = re.compile("[\x00-\x07\x0b\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff\u2028\u2029]")


def writable(text: str) -> str:
    """The text without control characters, which no escape of SysML can say."""
    return _CONTROL.sub("\ufffd", text)


@cache
def quoted(name: str) -> str:
    """A name, in quotes unless it is a basic name."""
    if _BASIC.fullmatch(name) and name not in RESERVED:
        return name
    return _between(name, "'")


def string(text: str) -> str:
    """A string literal."""
    return _between(text, '"')


def _between(text: str, quote: str) -> str:
    escapes = _ESCAPES | {quote: f"\\{quote}"}
    found = _ESCAPED.sub(lambda one: escapes.get(one[0], one[0]), writable(text))
    return f"{quote}{found}{quote}"


def comment_lines(text: str) -> list[str]:
    """The lines of a comment, with its marks; a text that would end it early is set apart."""
    lines = writable(text).replace("*/", "* /").replace("\r\n", "\n").strip().splitlines()
    if len(lines) < 2:
        return [f"/* {lines[0].strip()} */" if lines else "/* */"]
    return ["/*", *(f" * {line}".rstrip() for line in lines), " */"]
