"""The works that ``xmi.py`` and ``aml.py`` measure: ``python xml_work.py WORK FILE``."""

import sys
from contextlib import redirect_stdout, suppress
from importlib import import_module
from io import StringIO
from pathlib import Path

from work import Measurement, Work, run_work


def read_xmi(path: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Read XMI to the resolved graph."""
    return _read_graph(path, "xmi")


def read_aml(path: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Read AutomationML to the resolved graph."""
    return _read_graph(path, "caex")


def _read_graph(path: Path, package: str) -> tuple[Measurement, int]:
    """Run a front end, and then the pass ``resolve``."""
    from sysmlc.diagnostics import Coverage, Sink
    from sysmlc.ir import Graph
    from sysmlc.passes.resolve import Resolve
    from sysmlc.sources import load

    frontend = import_module(f"sysmlc.frontends.{package}").FRONTEND
    # The front end imports its reader when it is used; `startup.py` measures imports.
    import_module(f"sysmlc.frontends.{package}.reading")
    graph, sink = Graph(), Sink()
    measurement = Measurement()
    sources = [source for source in load(path, path.name) if frontend.detect(source)]
    frontend.read(sources, graph, sink, Coverage())
    measurement.end_lap("read")
    Resolve().run(graph, sink)
    measurement.end_lap("resolve")
    assert len(graph) > 0
    return measurement, sum(len(source.data) for source in sources)


def run_check(path: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Run ``sysmlc check``: the figure shows costs that only moved from the reader to a pass."""
    from sysmlc.cli.group import sysmlc

    measurement = Measurement()
    with redirect_stdout(StringIO()), suppress(SystemExit):
        sysmlc(["check", "--no-cache", str(path)])
    measurement.end_lap("check")
    return measurement, path.stat().st_size


def parse_with_lxml(path: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse the file to a tree with lxml."""
    from lxml import etree

    measurement = Measurement()
    tree = etree.parse(str(path), etree.XMLParser(huge_tree=True))
    measurement.end_lap("lxml")
    return measurement, path.stat().st_size if tree is not None else 0


def parse_with_expat(path: Path, *_arguments: str) -> tuple[Measurement, int]:
    """Parse the file with expat, without handlers: every reader on expat takes at least as long."""
    from xml.parsers.expat import ParserCreate

    measurement = Measurement()
    ParserCreate(namespace_separator="}").Parse(path.read_bytes(), True)
    measurement.end_lap("expat")
    return measurement, path.stat().st_size


def load_with_pyecore(path: Path, metamodel: str) -> tuple[Measurement, int]:
    """Load the model with pyecore; the metamodel is loaded before."""
    from xmi_pyecore import load_model, prepare_resources

    resources = prepare_resources(path, Path(metamodel))
    measurement = Measurement()
    assert load_model(resources, path) > 0
    measurement.end_lap("pyecore")
    return measurement, path.stat().st_size


WORKS: dict[str, Work] = {
    "xmi": read_xmi,
    "aml": read_aml,
    "check": run_check,
    "lxml": parse_with_lxml,
    "expat": parse_with_expat,
    "pyecore": load_with_pyecore,
}

if __name__ == "__main__":
    sys.exit(run_work(WORKS))
