"""Front end for UML 2 and SysML v1 in XMI.

Files are detected by the root element and its namespaces, not by their names. The modules that
read are imported when needed.
"""

import html
import re
from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.xmi import namespaces
from sysmlc.frontends.xmi.namespaces import default_namespace
from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.ir import Graph
from sysmlc.ir.pending import Drawing
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import make_parser, parse

# Links and names are searched in the bytes: the unit decides which files are parsed at all.
_HREF = re.compile(rb"""href\s*=\s*(?:"([^"#]+)|'([^'#]+))""")
_ROOT = re.compile(rb"<uml:(Profile|Model|Package)\b([^>]*)")
_NAME = re.compile(rb"""\sname\s*=\s*(?:"([^"]*)|'([^']*))""")
_EMF_NAMESPACE = re.compile(rb"""\bnsURI\s*=\s*["']([^"']+)""")
_XML_NAMESPACE = re.compile(rb"""\bxmlns:[\w.-]+\s*=\s*["']([^"']+)""")


class XmiFrontend:
    """Reads UML 2 and SysML v1 models in XMI of Papyrus, MagicDraw/Cameo and similar tools."""

    name = "xmi"
    is_folder_unit = False

    def detect(self, source: Source) -> float:
        """Return how certain it is, from 0 to 1, that the source is UML in XMI."""
        return 1.0 if is_snapshot(source) else score_source(source)

    def links(self, source: Source) -> Sequence[str]:
        """Return the files that hrefs refer to, each once and in order.

        Snapshots refer only to entries of their own archive. A document in UTF-16 gives no links.
        """
        if is_snapshot(source):
            return []
        paths = (double or single for double, single in _HREF.findall(source.data))
        return list(dict.fromkeys(map(_decode, paths)))

    def read_names(self, source: Source) -> FileNames:
        """Return the namespaces of a profile, and those that a model uses.

        A profile is a library; models refer to one another by hrefs only.
        """
        if is_snapshot(source):
            return FileNames(is_library=True)
        declared = _read_profile_namespaces(source)
        return FileNames(
            is_library=declared is not None,
            declared=declared or frozenset(),
            used=frozenset(map(_decode, _XML_NAMESPACE.findall(source.data))),
        )

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; see ``reading.read``."""
        from sysmlc.frontends.xmi import reading

        reading.read(sources, graph, sink, coverage)

    def list_companions(self, name: str) -> Sequence[str]:
        """Return Papyrus' notation file, or MagicDraw's entries with shapes."""
        from sysmlc.frontends.xmi.diagrams import list_companions

        return list_companions(name)

    def read_drawings(
        self, sources: Sequence[Source], beside: Sequence[Source], graph: Graph, sink: Sink
    ) -> None:
        """Store the diagrams of the authors for the pass ``views``."""
        from sysmlc.frontends.xmi.diagrams import read_diagrams

        ordered = sorted(sources, key=lambda source: source.name)
        models = [source for source in ordered if not is_snapshot(source)]
        graph.store(Drawing, [*graph.derived(Drawing), *read_diagrams(models, beside, sink)])


def _read_profile_namespaces(source: Source) -> frozenset[str] | None:
    """Return the namespaces of the stereotypes in a profile; None for any other document.

    Papyrus saves a namespace for each version; MagicDraw derives it from the profile's name.
    """
    root = _ROOT.search(source.data)
    if root is None or root[1] != b"Profile":
        return None
    match = _NAME.search(root[2])
    name = _decode(match[1] or match[2] or b"") if match is not None else ""
    namespaces = map(_decode, _EMF_NAMESPACE.findall(source.data))
    return frozenset([default_namespace(name), *namespaces])


def _decode(data: bytes) -> str:
    return html.unescape(data.decode("utf-8", "replace"))


# -- detection ---------------------------------------------------------------------------------

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
    DOCTYPE gets 0.3 if its head mentions UML or XMI, so that the front end reports its fault. In
    EMF's namespace of XMI, which diagrams of Eclipse have, too, the first element inside decides.
    """
    if not _may_be_xml(source.data):
        return 0.0
    declared: list[str] = []
    xml_parser = make_parser()
    is_inside = False

    def start(tag: str, _attributes: dict[str, str]) -> None:
        nonlocal is_inside
        namespace = tag.rpartition("}")[0]
        if is_inside:
            raise _RootReadError(1.0 if namespaces.is_uml(namespace) else 0.0)
        is_inside = namespace == namespaces.EMF_XMI
        if not is_inside:
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


FRONTEND = XmiFrontend()
