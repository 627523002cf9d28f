"""Encodings of XML files; sources in an encoding unknown to expat are converted to UTF-8.

The encoding is the one that the byte order mark or the XML declaration states; it is never
guessed. Expat does not know encodings with several bytes for a character: Enterprise Architect
writes Shift_JIS in Japan.
"""

import codecs
import re

from sysmlc.sources.source import Source

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


def find_declared_encoding(data: bytes) -> str:
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
    return 0, _find_text_codec(find_declared_encoding(data)) or "latin-1"


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


def has_known_encoding(data: bytes) -> bool:
    """Whether the declaration names a known encoding of texts, or no encoding."""
    return bool(_find_text_codec(find_declared_encoding(data)))


def find_encoding_fault(data: bytes) -> tuple[str, int] | None:
    """Return why the bytes cannot be decoded, and the offset of the fault; None if they can."""
    declared = find_declared_encoding(data)
    if not has_known_encoding(data):
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
