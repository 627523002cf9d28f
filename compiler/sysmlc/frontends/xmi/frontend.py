"""The front end for UML and SysML v1 in XMI; what reads is imported when there is such a file."""

from collections.abc import Sequence

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.xmi import detection as detect
from sysmlc.frontends.xmi.snapshots.entries import is_snapshot
from sysmlc.ir import Graph
from sysmlc.sources import Source


class XmiFrontend:
    """Reads UML 2 and SysML v1 models in XMI: Papyrus, MagicDraw/Cameo, and what is like them."""

    name = "xmi"
    is_folder_unit = False

    def detect(self, source: Source) -> float:
        """How sure it is, from 0 to 1, that the source is UML in XMI."""
        if is_snapshot(source):
            return 1.0
        return detect.score(source)

    def links(self, source: Source) -> Sequence[str]:
        """The files that its hrefs name; those of a snapshot are in the same archive."""
        if is_snapshot(source):
            return []
        from sysmlc.frontends.xmi.links import links

        return links(source)

    def read_names(self, source: Source) -> FileNames:
        """A profile is a library, named by its namespaces; models name others by hrefs only."""
        if is_snapshot(source):
            return FileNames(is_library=True)
        from sysmlc.frontends.xmi.links import profile_namespaces, used_namespaces

        declared = profile_namespaces(source)
        return FileNames(
            is_library=declared is not None,
            declared=declared or frozenset(),
            used=used_namespaces(source),
        )

    def read(self, sources: Sequence[Source], graph: Graph, sink: Sink, coverage: Coverage) -> None:
        """Read the files into the graph; references are left for the pass ``resolve``.

        A damaged file is reported and left out. Raises SourceError for what exceeds the
        limits. The graph does not depend on the order of the files.
        """
        from sysmlc.frontends.xmi import reading

        reading.read(sources, graph, sink, coverage)

    def companions(self, name: str) -> Sequence[str]:
        """Papyrus' notation file, MagicDraw's entries with shapes."""
        from sysmlc.frontends.xmi.diagrams import reading as drawings

        return drawings.companions(name)

    def drawings(
        self, sources: Sequence[Source], beside: Sequence[Source], graph: Graph, sink: Sink
    ) -> None:
        """Keep the diagrams of authors for the pass ``views``."""
        from sysmlc.frontends.xmi.diagrams import reading as drawings
        from sysmlc.ir.drawing import Drawing

        ordered = sorted(sources, key=lambda source: source.name)
        models = [source for source in ordered if not is_snapshot(source)]
        graph.store(Drawing, [*graph.derived(Drawing), *drawings.read(models, beside, sink)])
