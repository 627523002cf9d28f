"""What ``xmi.py`` measures, each in a process of its own: ``python xmi_work.py WORK FILE``.

Prints CPU seconds (user and system) of the work itself, start-up aside, the growth of the
resident memory to its peak in bytes, and the bytes of XML that were read, as JSON.
"""

import json
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

_KILOBYTE = 1024


class Measured:
    """CPU time and memory from its making on."""

    def __init__(self) -> None:
        self._start = time.process_time()
        self._memory = _peak()
        self.times: dict[str, float] = {}

    def lap(self, name: str) -> None:
        """Note the CPU time since the last lap."""
        now = time.process_time()
        self.times[name] = now - self._start
        self._start = now

    def memory(self) -> int:
        """Growth of the peak of the resident memory so far."""
        return _peak() - self._memory


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KILOBYTE


def ours(path: Path, _metamodel: str) -> tuple[Measured, int]:
    """The front end, and then the pass ``resolve``."""
    from sysmlc.diagnostics import Coverage, Sink
    from sysmlc.frontends.xmi import FRONTEND
    from sysmlc.ir import Graph
    from sysmlc.passes.resolve import Resolve
    from sysmlc.sources import load

    graph, sink = Graph(), Sink()
    measured = Measured()
    sources = [one for one in load(path, path.name) if FRONTEND.detect(one)]
    FRONTEND.read(sources, graph, sink, Coverage())
    measured.lap("read")
    Resolve().run(graph, sink)
    measured.lap("resolve")
    assert len(graph) > 0
    return measured, sum(len(source.data) for source in sources)


def lxml(path: Path, _metamodel: str) -> tuple[Measured, int]:
    """A tree of the whole file, and nothing done with it."""
    from lxml import etree

    measured = Measured()
    tree = etree.parse(str(path), etree.XMLParser(huge_tree=True))
    measured.lap("lxml")
    return measured, path.stat().st_size if tree is not None else 0


def expat(path: Path, _metamodel: str) -> tuple[Measured, int]:
    """The parser below ours, without handlers: the least that any reader needs."""
    from xml.parsers.expat import ParserCreate

    measured = Measured()
    ParserCreate(namespace_separator="}").Parse(path.read_bytes(), True)
    measured.lap("expat")
    return measured, path.stat().st_size


def pyecore(path: Path, metamodel: str) -> tuple[Measured, int]:
    """The model in pyecore, its metamodel aside."""
    from xmi_pyecore import load, prepare

    resources = prepare(path, Path(metamodel))
    measured = Measured()
    assert load(resources, path) > 0
    measured.lap("pyecore")
    return measured, path.stat().st_size


WORKS: dict[str, Callable[[Path, str], tuple[Measured, int]]] = {
    "ours": ours,
    "lxml": lxml,
    "expat": expat,
    "pyecore": pyecore,
}


def main() -> int:
    """Do one work once."""
    work, path, metamodel = sys.argv[1:4]
    measured, size = WORKS[work](Path(path), metamodel)
    json.dump({"times": measured.times, "memory": measured.memory(), "size": size}, sys.stdout)
    return 0


if __name__ == "__main__":
    sys.exit(main())
