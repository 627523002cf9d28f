"""What ``xmi.py`` measures, each in a process of its own: ``python xmi_work.py WORK FILE``."""

import sys
from pathlib import Path

from work import Measured, Work, expat, lxml, run


def ours(path: Path, _metamodel: str) -> tuple[Measured, int]:
    """The front end, and then the pass ``resolve``."""
    from sysmlc.diagnostics import Coverage, Sink
    from sysmlc.frontends.xmi import FRONTEND, reading
    from sysmlc.ir import Graph
    from sysmlc.passes.resolve import Resolve
    from sysmlc.sources import load

    # The front end imports what reads when it is asked to: start-up is measured elsewhere.
    assert reading
    graph, sink = Graph(), Sink()
    measured = Measured()
    sources = [one for one in load(path, path.name) if FRONTEND.detect(one)]
    FRONTEND.read(sources, graph, sink, Coverage())
    measured.lap("read")
    Resolve().run(graph, sink)
    measured.lap("resolve")
    assert len(graph) > 0
    return measured, sum(len(source.data) for source in sources)


def pyecore(path: Path, metamodel: str) -> tuple[Measured, int]:
    """The model in pyecore, its metamodel aside."""
    from xmi_pyecore import load, prepare

    resources = prepare(path, Path(metamodel))
    measured = Measured()
    assert load(resources, path) > 0
    measured.lap("pyecore")
    return measured, path.stat().st_size


WORKS: dict[str, Work] = {"ours": ours, "lxml": lxml, "expat": expat, "pyecore": pyecore}

if __name__ == "__main__":
    sys.exit(run(WORKS))
