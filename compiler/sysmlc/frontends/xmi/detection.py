"""Whether a source is UML in XMI: told by its root element and namespaces, not by its name."""

import re

from sysmlc.frontends.xmi import namespaces
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import parse, parser

_HEAD = 1 << 24
"""Bytes of a damaged file that are searched: a DOCTYPE can be long."""


class _DecidedError(Exception):
    def __init__(self, score: float) -> None:
        super().__init__()
        self.score = score


def score(source: Source) -> float:
    """From 0 to 1: 1 for a UML namespace, 0.5 for XMI with none in its root.

    A file that is damaged or has a DOCTYPE but names UML or XMI in its head is ours too, so
    that its fault is reported.
    """
    if not _may_be_xml(source.data):
        return 0.0
    declared: list[str] = []
    made = parser()

    def start(tag: str, _attributes: dict[str, str]) -> None:
        raise _DecidedError(_judge(tag, declared))

    made.StartNamespaceDeclHandler = lambda _prefix, uri: declared.append(uri or "")
    made.StartElementHandler = start
    try:
        parse(source, made)
    except _DecidedError as decided:
        return decided.score
    except SourceError:
        return _damaged(source.data)
    return 0.0


def _judge(tag: str, declared: list[str]) -> float:
    namespace = tag.rpartition("}")[0]
    if namespaces.is_uml(namespace):
        return 1.0
    if not namespaces.is_xmi(namespace):
        return 0.0
    return 1.0 if any(map(namespaces.is_uml, declared)) else 0.5


def _may_be_xml(data: bytes) -> bool:
    head = data[:64].lstrip(b"\xef\xbb\xbf\xff\xfe \t\r\n").replace(b"\0", b"")
    return head.startswith(b"<")


def _damaged(data: bytes) -> float:
    head = data[:_HEAD].replace(b"\0", b"")
    known = re.search(rb"omg\.org/spec/(XMI|UML)|eclipse\.org/uml2|<(xmi:XMI|uml:\w+)[\s>/]", head)
    return 0.3 if known else 0.0
