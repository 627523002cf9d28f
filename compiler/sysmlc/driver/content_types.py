"""Descriptions of files that no front end recognises, for messages."""

import re

_SIGNATURES = (
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"%PDF-", "a PDF document"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\xd0\xcf\x11\xe0", "a binary project file (OLE)"),
    (b"SQLite format 3", "an SQLite database"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
)
_BLANKS = b" \t\r\n\f\v\0\xef\xbb\xbf\xff\xfe"
"""White space and bytes of byte order marks, in UTF-8 and UTF-16."""
_HTML = re.compile(rb"<(?:!doctype\s+)?html", re.IGNORECASE)
_ROOT = re.compile(rb"<([A-Za-z_][\w.:-]*)")
_HEAD = 4_096


def is_blank(data: bytes) -> bool:
    """Whether a file is empty or holds only white space and a byte order mark."""
    return not data[:_HEAD].strip(_BLANKS) and not data.strip(_BLANKS)


def describe_content(data: bytes) -> str:
    """Return a description of the content that its first bytes suggest: ``an HTML page``."""
    for signature, description in _SIGNATURES:
        if data.startswith(signature):
            return description
    head = data[:_HEAD].lstrip(_BLANKS)
    if _HTML.search(head):
        return "an HTML page"
    if head.startswith(b"<"):
        root = _ROOT.search(head)
        return f"XML with the root element '{root[1].decode()}'" if root else "damaged XML"
    if b"\0" in data[:_HEAD]:
        return "binary data"
    return "JSON" if head.startswith((b"{", b"[")) else "plain text"
