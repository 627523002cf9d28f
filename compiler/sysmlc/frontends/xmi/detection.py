"""Detection of UML in XMI by the root element and its namespaces, not by the file name."""

import re

from sysmlc.frontends.xmi import namespaces
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import parse, parser

_HEAD = 1 << 24
"""Bytes of a damaged file that are searched: a DOCTYPE can be long."""
_TRACES = re.compile(rb"omg\.org/spec/(XMI|UML)|eclipse\.org/uml2|<(xmi:XMI|uml:\w+)[\s>/]")


class _RootReadError(Exception):
    """Ends parsing at the root element."""

    def __init__(self, score: float) -> None:
        super().__init__()
        self.score = score


def score_source(source: Source) -> float:
    """Return how certain it is, from 0 to 1, that the source is UML in XMI.

    1 for a UML namespace, 0.5 for XMI whose root declares none. A file that is damaged or has a
    DOCTYPE gets 0.3 if its head mentions UML or XMI, so that the front end reports its fault.
    """
    if not _may_be_xml(source.data):
        return 0.0
    declared: list[str] = []
    xml_parser = parser()

    def start(tag: str, _attributes: dict[str, str]) -> None:
        raise _RootReadError(_score_root(tag, declared))

    xml_parser.StartNamespaceDeclHandler = lambda _prefix, uri: declared.append(uri or "")
    xml_parser.StartElementHandler = start
    try:
        parse(source, xml_parser)
    except _RootReadError as root:
        return root.score
    except SourceError:
        return 0.3 if _TRACES.search(source.data[:_HEAD].replace(b"\0", b"")) else 0.0
    return 0.0


def _score_root(tag: str, declared: list[str]) -> float:
    namespace = tag.rpartition("}")[0]
    if namespaces.is_uml(namespace):
        return 1.0
    if not namespaces.is_xmi(namespace):
        return 0.0
    return 1.0 if any(map(namespaces.is_uml, declared)) else 0.5


def _may_be_xml(data: bytes) -> bool:
    head = data[:64].lstrip(b"\xef\xbb\xbf\xff\xfe \t\r\n").replace(b"\0", b"")
    return head.startswith(b"<")
