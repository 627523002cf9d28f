"""Safe XML parsing with expat: no DOCTYPE, entities, network or XInclude.

Expat parses the whole buffer at once, because in chunks its time is quadratic in the length of
attributes. Every DOCTYPE is refused, so that a document cannot declare entities.
"""

from typing import NoReturn
from xml.parsers import expat

from sysmlc.sources.encoding import (
    find_declared_encoding,
    find_encoding_fault,
    has_known_encoding,
)
from sysmlc.sources.source import DEFAULT_LIMITS, Fault, Limits, Source, SourceError

SEPARATOR = "}"
"""Separates namespace and local name in the names that handlers receive."""

_BUFFER = 1 << 20
"""Bytes of text that a handler receives at once; the default would cut texts into thousands."""

_INVALID_TOKEN = expat.errors.codes[expat.errors.XML_ERROR_INVALID_TOKEN]

Parser = expat.XMLParserType
"""An expat parser; ``CurrentByteIndex`` is the position in the bytes of the source."""


def make_parser() -> Parser:
    """Return an expat parser that resolves namespaces and refuses every DOCTYPE.

    Handlers receive names as ``namespace}local``, attributes as a dictionary, and text at once.
    """
    return _configure(expat.ParserCreate(namespace_separator=SEPARATOR))


def make_plain_parser(names: dict[str, str] | None = None) -> Parser:
    """Return an expat parser that does not resolve namespaces, for XML with unbound prefixes.

    Handlers receive names as they are written, or the value of the name in *names* if it has one.
    """
    return _configure(expat.ParserCreate(intern={} if names is None else names))


def _configure(parser: Parser) -> Parser:
    parser.buffer_size = _BUFFER
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = _refuse_doctype
    return parser


def parse(source: Source, parser: Parser) -> None:
    """Run *parser* over the whole source.

    Raises SourceError, with the offset of the fault, for XML that is not well-formed, has a
    DOCTYPE, or has an encoding that cannot be read.
    """
    try:
        if not has_known_encoding(source.data):
            raise LookupError("unknown")
        parser.Parse(source.data, True)
    except expat.ExpatError as problem:
        message, offset = _explain(problem, source, max(parser.ErrorByteIndex, 0))
        raise SourceError(message, source.name, offset) from None
    except _DoctypeError:
        message = "it has a DOCTYPE, which is refused because entities can hide anything"
        raise SourceError(message, source.name, parser.CurrentByteIndex, Fault.REFUSED) from None
    except (ValueError, LookupError) as problem:
        encoding = find_declared_encoding(source.data)
        unreadable = f"its encoding '{encoding}' cannot be read: {problem}"
        message, offset = find_encoding_fault(source.data) or (unreadable, 0)
        raise SourceError(message, source.name, offset) from None


def refuse_depth(source: Source, parser: Parser, limits: Limits = DEFAULT_LIMITS) -> NoReturn:
    """Raise the SourceError of a document that is nested more deeply than ``limits.depth``."""
    message = f"nested more than {limits.depth} deep"
    raise SourceError(message, source.name, parser.CurrentByteIndex, Fault.LIMIT)


class _DoctypeError(Exception):
    pass


def _refuse_doctype(*_declaration: object) -> NoReturn:
    raise _DoctypeError


def _explain(problem: expat.ExpatError, source: Source, offset: int) -> tuple[str, int]:
    """Return a message and the offset of the fault.

    Expat calls a byte that the encoding cannot decode an invalid token, like wrong markup.
    """
    if problem.code == _INVALID_TOKEN and source.data[offset : offset + 1] >= b"\x80":
        encoding_fault = find_encoding_fault(source.data)
        if encoding_fault:
            return encoding_fault
    reason = expat.ErrorString(problem.code) or "unknown fault"
    return f"not well-formed XML: {reason}", offset
