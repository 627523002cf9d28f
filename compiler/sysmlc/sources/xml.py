"""XML read without DOCTYPE, entities, network or XInclude, from whole buffers.

Expat is given the whole buffer: fed in pieces it is quadratic in long attributes, and it would
let a document with entities pass, so every DOCTYPE is refused before anything is declared.
"""

from typing import NoReturn
from xml.parsers import expat

from sysmlc.sources.encoding import fault, find_declared_encoding, is_known
from sysmlc.sources.error import Fault, SourceError
from sysmlc.sources.limits import DEFAULT_LIMITS, Limits
from sysmlc.sources.source import Source

SEPARATOR = "}"
"""Between namespace and local name in the names that handlers are given."""

_BUFFER = 1 << 20
"""Bytes of text that come in one piece: long texts are not put together from thousands."""

_INVALID_TOKEN = expat.errors.codes[expat.errors.XML_ERROR_INVALID_TOKEN]

Parser = expat.XMLParserType
"""An expat parser; ``CurrentByteIndex`` is the place in the source's bytes."""


def parser() -> Parser:
    """An expat parser that knows namespaces and refuses every DOCTYPE.

    Names are ``namespace}local``, attributes come as dicts, text comes in one piece.
    """
    made = expat.ParserCreate(namespace_separator=SEPARATOR)
    made.buffer_size = _BUFFER
    made.buffer_text = True
    made.StartDoctypeDeclHandler = _refuse_doctype
    return made


def plain_parser(names: dict[str, str] | None = None) -> Parser:
    """An expat parser that takes names as they are written: for XML with unbound prefixes.

    ``names`` says what handlers are given for a name; what it lacks is given as written.
    """
    made = expat.ParserCreate(intern={} if names is None else names)
    made.buffer_size = _BUFFER
    made.buffer_text = True
    made.StartDoctypeDeclHandler = _refuse_doctype
    return made


def parse(source: Source, made: Parser) -> None:
    """Run ``made`` over the whole source.

    Raises SourceError, located, for what is not well-formed, has a DOCTYPE or an encoding
    that cannot be read.
    """
    try:
        if not is_known(source.data):
            raise LookupError("unknown")
        made.Parse(source.data, True)
    except expat.ExpatError as problem:
        message, offset = _explain(problem, source, max(made.ErrorByteIndex, 0))
        raise SourceError(message, source.name, offset) from None
    except _DoctypeError:
        message = "it has a DOCTYPE, which is refused because entities can hide anything"
        raise SourceError(message, source.name, made.CurrentByteIndex, Fault.REFUSED) from None
    except (ValueError, LookupError) as problem:
        unknown = f"its encoding '{find_declared_encoding(source.data)}' cannot be read: {problem}"
        message, offset = fault(source.data) or (unknown, 0)
        raise SourceError(message, source.name, offset) from None


def too_deep(source: Source, made: Parser, limits: Limits = DEFAULT_LIMITS) -> NoReturn:
    """Raise the SourceError of a document that is nested more deeply than ``limits.depth``."""
    message = f"nested more than {limits.depth} deep"
    raise SourceError(message, source.name, made.CurrentByteIndex, Fault.LIMIT)


class _DoctypeError(Exception):
    pass


def _refuse_doctype(*_declaration: object) -> NoReturn:
    raise _DoctypeError


def _explain(problem: expat.ExpatError, source: Source, offset: int) -> tuple[str, int]:
    """Return what is wrong and where; invalid bytes are an encoding fault, not one of the
    markup.
    """
    if problem.code == _INVALID_TOKEN and source.data[offset : offset + 1] >= b"\x80":
        encoding_fault = fault(source.data)
        if encoding_fault:
            return encoding_fault
    reason = expat.ErrorString(problem.code) or "unknown fault"
    return f"not well-formed XML: {reason}", offset
