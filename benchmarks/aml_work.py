"""What ``aml.py`` measures, each in a process of its own: ``python aml_work.py WORK FILE``."""

import sys
from contextlib import redirect_stdout, suppress
from io import StringIO
from pathlib import Path

from work import Measured, Work, expat, lxml, run


def ours(path: Path) -> tuple[Measured, int]:
    """The front end, and then the pass ``resolve``."""
    from sysmlc.diagnostics import Coverage, Sink
    from sysmlc.frontends.caex import FRONTEND, reading
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


def check(path: Path) -> tuple[Measured, int]:
    """The whole of ``sysmlc check``: it shows when cost is only moved behind the reading."""
    from sysmlc.cli.group import sysmlc

    measured = Measured()
    with redirect_stdout(StringIO()), suppress(SystemExit):
        sysmlc(["check", "--no-cache", str(path)])
    measured.lap("check")
    return measured, path.stat().st_size


WORKS: dict[str, Work] = {"check": check, "ours": ours, "lxml": lxml, "expat": expat}

if __name__ == "__main__":
    sys.exit(run(WORKS))
