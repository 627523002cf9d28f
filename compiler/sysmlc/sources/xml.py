"""XML read without DOCTYPE, entities, network or XInclude, from whole buffers.

Expat is given the whole buffer: fed in pieces it is quadratic in long attributes, and it would
let a document with entities pass, so every DOCTYPE is refused before anything is declared.
"""

from typing import NoReturn
from xml.parsers import expat

from sysmlc.sources.error import Fault, SourceError
from sysmlc.sources.limits import DEFAULT_LIMITS, Limits
from sysmlc.sources.source import Source

SEPARATOR = "}"
"""Between namespace and local name in the names that handlers are given."""

Parser = expat.XMLParserType
"""An expat parser; ``CurrentByteIndex`` is the place in the source's bytes."""


def parser() -> Parser:
    """An expat parser that knows namespaces and refuses every DOCTYPE.

    Names are ``namespace}local``, attributes come as dicts, text comes in one piece.
    """
    made = expat.ParserCreate(namespace_separator=SEPARATOR)
    made.buffer_text = True
    made.StartDoctypeDeclHandler = _refuse_doctype
    return made


def plain_parser() -> Parser:
    """An expat parser that takes names as they are written: for XML with unbound prefixes."""
    made = expat.ParserCreate()
    made.buffer_text = True
    made.StartDoctypeDeclHandler = _refuse_doctype
    return made


def parse(source: Source, made: Parser) -> None:
    """Run ``made`` over the whole source.

    Raises SourceError, located, for what is not well-formed, has a DOCTYPE or an encoding
    that cannot be read.
    """
    try:
        made.Parse(source.data, True)
    except expat.ExpatError as problem:
        offset = max(made.ErrorByteIndex, 0)
        raise SourceError(f"not well-formed XML: {_reason(problem)}", source.name, offset) from None
    except _DoctypeError:
        message = "it has a DOCTYPE, which is refused because entities can hide anything"
        raise SourceError(message, source.name, made.CurrentByteIndex, Fault.REFUSED) from None
    except (ValueError, LookupError) as problem:
        message = f"its encoding cannot be read: {problem}"
        raise SourceError(message, source.name, 0) from None


def too_deep(source: Source, made: Parser, limits: Limits = DEFAULT_LIMITS) -> NoReturn:
    """Raise the SourceError of a document that is nested more deeply than ``limits.depth``."""
    message = f"nested more than {limits.depth} deep"
    raise SourceError(message, source.name, made.CurrentByteIndex, Fault.LIMIT)


class _DoctypeError(Exception):
    pass


def _refuse_doctype(*_declaration: object) -> NoReturn:
    raise _DoctypeError


def _reason(problem: expat.ExpatError) -> str:
    return expat.ErrorString(problem.code) or "unknown fault"
