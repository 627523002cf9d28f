"""Encodings of XML files: which ones expat reads, which are put into UTF-8 first.

What the XML declaration says counts; nothing is guessed. Encodings of several bytes a character
(Enterprise Architect writes Shift_JIS in Japan) are unknown to expat.
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
"""Byte order marks; that of UTF-32 starts as that of UTF-16 does."""
_FIRST = ((b"<\0", "utf-16-le"), (b"\0<", "utf-16-be"))
"""How XML in UTF-16 starts that has no byte order mark."""
_DECLARATION = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z0-9._:+-]+)["']""")
_IN_TEXT = re.compile(r"""(<\?xml[^>]*?encoding\s*=\s*["'])([^"']+)""")
_OTHER_NAMES = {"windows-31j": "cp932", "x-sjis": "cp932", "x-euc-jp": "euc_jp", "x-gbk": "gbk"}
_TRANSLATED = frozenset(
    {"big5", "big5hkscs", "cp932", "cp949", "cp950", "euc_jp", "euc_jis_2004", "euc_kr", "gb18030"}
    | {"gb2312", "gbk", "hz", "iso2022_jp", "iso2022_kr", "johab", "shift_jis", "shift_jis_2004"}
    | {"utf_32_be", "utf_32_le"}
)


def find_declared_encoding(data: bytes) -> str:
    """Return the encoding that the XML declaration names, or an empty text."""
    declaration = _DECLARATION.match(data[:1024])
    return declaration[1].decode("ascii") if declaration else ""


def codec(data: bytes) -> tuple[int, str]:
    """Length of the byte order mark, and the Python codec that decodes what follows it.

    The codec is Latin-1, which decodes anything, when the declared one is not known.
    """
    for mark, name in _MARKS:
        if data.startswith(mark):
            return len(mark), name
    for first, name in _FIRST:
        if data.startswith(first):
            return 0, name
    return 0, _text_codec(find_declared_encoding(data)) or "latin-1"


def in_utf8(source: Source) -> Source:
    """The source, put into UTF-8 when it is in an encoding that expat does not read.

    Its digest stays that of the file. What is not in the encoding that it declares is left as
    it is: ``fault`` says why it cannot be read.
    """
    mark, name = codec(source.data)
    if name.replace("-", "_") not in _TRANSLATED:
        return source
    try:
        text = source.data[mark:].decode(name)
    except UnicodeDecodeError:
        return source
    data = _IN_TEXT.sub(r"\1UTF-8", text, count=1).encode("utf-8", "surrogatepass")
    return Source(source.name, data, source.sha256)


def is_known(data: bytes) -> bool:
    """Whether the encoding that the declaration names, if any, is one of texts."""
    return bool(_text_codec(find_declared_encoding(data)))


def fault(data: bytes) -> tuple[str, int] | None:
    """Why the bytes cannot be decoded and where, or None when they can."""
    said = find_declared_encoding(data)
    if not is_known(data):
        return f"its encoding '{said}' is unknown", data.find(said.encode())
    mark, name = codec(data)
    try:
        data[mark:].decode(name)
    except UnicodeDecodeError as problem:
        return f"it is not encoded in {said or name}: {problem.reason}", mark + problem.start
    return None


def _text_codec(name: str) -> str:
    """Python's name of a text encoding; empty for one it does not know, UTF-8 for no name."""
    try:
        found = codecs.lookup(_OTHER_NAMES.get(name.lower(), name or "utf-8"))
    except (LookupError, ValueError):
        return ""
    is_text = getattr(found, "_is_text_encoding", True)
    return found.name if is_text and found.name not in _STRANGE else ""


_STRANGE = frozenset(
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
"""Codecs of Python for other things than files, and UTF-7, which hides markup."""
