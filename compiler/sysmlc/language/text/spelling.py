"""Names, strings and comments in SysML v2 text, as KerML 1.0, 8.2.2 spells them."""

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
_BASIC_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_ESCAPES = {"\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r", "\b": "\\b", "\f": "\\f"}
_ESCAPED = re.compile(r"[\\\n\t\r\b\f'\"]")
_CONTROL = re.compile("[\x00-\x07\x0b\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff\u2028\u2029]")


def replace_control_characters(text: str) -> str:
    """Return the text with U+FFFD for control characters: SysML has no escapes for them."""
    return _CONTROL.sub("\ufffd", text)


@cache
def quote_name(name: str) -> str:
    """Return the name, in quotes unless it is a basic name that is not reserved."""
    if _BASIC_NAME.fullmatch(name) and name not in RESERVED:
        return name
    return _enclose(name, "'")


def quote_string(text: str) -> str:
    """Return a string literal."""
    return _enclose(text, '"')


def _enclose(text: str, quote: str) -> str:
    escapes = _ESCAPES | {quote: f"\\{quote}"}
    escaped = _ESCAPED.sub(
        lambda match: escapes.get(match[0], match[0]), replace_control_characters(text)
    )
    return f"{quote}{escaped}{quote}"


def format_comment(text: str) -> list[str]:
    """Return the lines of a comment with its marks.

    ``*/`` inside the text would end the comment, so that it gets a space.
    """
    text = replace_control_characters(text).replace("*/", "* /").replace("\r\n", "\n")
    lines = text.strip().splitlines()
    if len(lines) < 2:
        return [f"/* {lines[0].strip()} */" if lines else "/* */"]
    return ["/*", *(f" * {line}".rstrip() for line in lines), " */"]
