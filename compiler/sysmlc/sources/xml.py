"""Safe XML parsing with expat: no DOCTYPE, entities, network or XInclude.

Expat parses the whole buffer at once, because in chunks its time is quadratic in the length of
attributes. Every DOCTYPE is refused, so that a document cannot declare entities.

The encoding is the one that the byte order mark or the XML declaration states; it is never
guessed. Expat does not know encodings with several bytes for a character, such as Shift_JIS, which
Enterprise Architect writes in Japan: such sources are converted to UTF-8.
"""

import codecs
import re
from typing import NoReturn
from xml.parsers import expat

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


def make_plain_parser() -> Parser:
    """Return an expat parser that does not resolve namespaces, for XML with unbound prefixes.

    Handlers receive names as they are written.
    """
    return _configure(expat.ParserCreate())


def _configure(parser: Parser) -> Parser:
    parser.buffer_size = _BUFFER
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = _refuse_doctype
    return parser


def parse(source: Source, parser: Parser) -> None:
    """Run *parser* over the whole source, and release its handlers.

    Raises SourceError, with the offset of the fault, for XML that is not well-formed, has a
    DOCTYPE, or has an encoding that cannot be read.
    """
    try:
        if not _has_known_encoding(source.data):
            raise LookupError("unknown")
        parser.Parse(source.data, True)
    except expat.ExpatError as problem:
        message, offset = _explain(problem, source, max(parser.ErrorByteIndex, 0))
        raise SourceError(message, source.name, offset) from None
    except _DoctypeError:
        message = "it has a DOCTYPE, which is refused because entities can hide anything"
        raise SourceError(message, source.name, parser.CurrentByteIndex, Fault.REFUSED) from None
    except (ValueError, LookupError) as problem:
        encoding = _find_declared_encoding(source.data)
        unreadable = f"its encoding '{encoding}' cannot be read: {problem}"
        message, offset = find_encoding_fault(source.data) or (unreadable, 0)
        raise SourceError(message, source.name, offset) from None
    finally:
        # The parser and its handlers refer to one another; the garbage collector may be off.
        parser.StartElementHandler = parser.EndElementHandler = None
        parser.CharacterDataHandler = parser.StartNamespaceDeclHandler = None


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


# -- encodings ---------------------------------------------------------------------------------

_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
"""Byte order marks. UTF-32 comes first, because its mark starts with the mark of UTF-16."""
_UTF_16_STARTS = ((b"<\0", "utf-16-le"), (b"\0<", "utf-16-be"))
"""The start of XML in UTF-16 without a byte order mark."""
_DECLARATION = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z0-9._:+-]+)["']""")
_TEXT_DECLARATION = re.compile(r"""(<\?xml[^>]*?encoding\s*=\s*["'])([^"']+)""")
_ALIASES = {"windows-31j": "cp932", "x-sjis": "cp932", "x-euc-jp": "euc_jp", "x-gbk": "gbk"}
"""Names of encodings that Python does not know."""
_UNKNOWN_TO_EXPAT = frozenset(
    {"big5", "big5hkscs", "cp932", "cp949", "cp950", "euc_jp", "euc_jis_2004", "euc_kr", "gb18030"}
    | {"gb2312", "gbk", "hz", "iso2022_jp", "iso2022_kr", "johab", "shift_jis", "shift_jis_2004"}
    | {"utf_32_be", "utf_32_le"}
)
_NOT_FOR_FILES = frozenset(
    {
        "idna",
        "punycode",
        "undefined",
        "unicode-escape",
        "raw-unicode-escape",
        "utf-7",
        "mbcs",
        "oem",
    }
)
"""Codecs of Python that are not made for files, and UTF-7, which can hide markup."""


def _find_declared_encoding(data: bytes) -> str:
    """Return the encoding that the XML declaration names, or an empty text."""
    declaration = _DECLARATION.match(data[:1024])
    return declaration[1].decode("ascii") if declaration else ""


def find_codec(data: bytes) -> tuple[int, str]:
    """Return the length of the byte order mark, and the Python codec for the rest.

    For an unknown encoding the codec is Latin-1, which can decode any bytes.
    """
    for mark, name in _MARKS:
        if data.startswith(mark):
            return len(mark), name
    for start, name in _UTF_16_STARTS:
        if data.startswith(start):
            return 0, name
    return 0, _find_text_codec(_find_declared_encoding(data)) or "latin-1"


def convert_to_utf8(source: Source) -> Source:
    """Return the source in UTF-8 if expat does not know its encoding, else the source itself.

    The digest of the result is that of the original file. A source that its declared encoding
    cannot decode is not converted: ``find_encoding_fault`` explains why when it is parsed.
    """
    mark, name = find_codec(source.data)
    if name.replace("-", "_") not in _UNKNOWN_TO_EXPAT:
        return source
    try:
        text = source.data[mark:].decode(name)
    except UnicodeDecodeError:
        return source
    data = _TEXT_DECLARATION.sub(r"\1UTF-8", text, count=1).encode("utf-8", "surrogatepass")
    return Source(source.name, data, source.sha256)


def _has_known_encoding(data: bytes) -> bool:
    """Whether the declaration names a known encoding of texts, or no encoding."""
    return bool(_find_text_codec(_find_declared_encoding(data)))


def find_encoding_fault(data: bytes) -> tuple[str, int] | None:
    """Return why the bytes cannot be decoded, and the offset of the fault; None if they can."""
    declared = _find_declared_encoding(data)
    if not _has_known_encoding(data):
        return f"its encoding '{declared}' is unknown", data.find(declared.encode())
    mark, name = find_codec(data)
    try:
        data[mark:].decode(name)
    except UnicodeDecodeError as problem:
        message = f"it is not encoded in {declared or name}: {problem.reason}"
        return message, mark + problem.start
    return None


def _find_text_codec(encoding: str) -> str:
    """Return the Python name of a text encoding, empty for an unknown one; UTF-8 by default."""
    try:
        codec = codecs.lookup(_ALIASES.get(encoding.lower(), encoding or "utf-8"))
    except (LookupError, ValueError):
        return ""
    # Codecs such as base64 convert bytes to bytes.
    is_text = getattr(codec, "_is_text_encoding", True)
    return codec.name if is_text and codec.name not in _NOT_FOR_FILES else ""
