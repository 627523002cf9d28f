"""Reading of the corpus: its models, their graphs, and their XML without the compiler."""

import os
import re
import zipfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from lxml import etree

from refinement import run_steps
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.sources import Source, load

XMI_SUFFIXES = (".uml", ".xmi", ".xml", ".mdxml", ".mdzip")
XMI_FOLDERS = ("papyrus", "magicdraw", "md-eclipse-export", "omg", "profile", "ea")
BAYGATE_FILES = ("BayGate.aml", "BayGate_caex215.aml", "BayGate_extlibs.aml", "BayGate.amlx")
"""BayGate in CAEX 3.0, in CAEX 2.15, with libraries in files of their own, and as a package."""

_MAGICDRAW_MODEL = re.compile(r"com\.nomagic\.magicdraw\.uml_model(?!____).*model$")


def list_models(
    *folders: str, suffixes: Sequence[str] = XMI_SUFFIXES, largest: float = float("inf")
) -> list[Path]:
    """Return the models below folders of the corpus with fewer than *largest* bytes.

    Test modules call the function while they are imported, so that it also works without a corpus.
    """
    corpus = Path(os.environ.get("SYSMLC_CORPUS", "nowhere"))
    paths = sorted(
        path
        for folder in folders
        for path in (corpus / folder).rglob("*")
        if path.suffix in suffixes
    )
    return [path for path in paths if path.stat().st_size < largest]


def load_files(*paths: Path) -> list[Source]:
    """Return the sources in files, which are called by the names of the files."""
    return [source for path in paths for source in load(path, path.name)]


def lower(
    sources: Iterable[Source],
    passes: Sequence[str] = (),
    frontend: Any = FRONTEND,
    verify_each: bool = False,
) -> tuple[Graph, Sink]:
    """Read sources by a front end and run passes; return the graph and its diagnostics."""
    graph, sink = Graph(), Sink()
    frontend.read(list(sources), graph, sink, Coverage())
    if passes:
        run_steps(passes, graph, sink, verify_each=verify_each)
    return graph, sink


# -- XML by lxml alone -------------------------------------------------------------------------


def parse_data(data: bytes) -> etree._Element:
    """Parse a document, however large it is."""
    parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
    return etree.fromstring(data, parser)


def parse_models(path: Path) -> list[etree._Element]:
    """Parse an XML file, or the model files in a project of MagicDraw."""
    if path.suffix != ".mdzip":
        return [parse_data(path.read_bytes())]
    with zipfile.ZipFile(path) as archive:
        names = [name for name in archive.namelist() if _MAGICDRAW_MODEL.match(name)]
        return [parse_data(archive.read(name)) for name in names]


def find_typed(trees: Iterable[etree._Element], metaclass: str) -> list[etree._Element]:
    """Return the elements whose ``xmi:type`` is a metaclass of UML and that are not references."""
    return [
        element
        for tree in trees
        for element in tree.iter("*")
        if "href" not in element.attrib
        and any(
            str(name).endswith("}type") and value == f"uml:{metaclass}"
            for name, value in element.attrib.items()
        )
    ]


def local_name(node: etree._Element) -> str:
    """Return the name of an XML element without its namespace."""
    return etree.QName(node).localname


def xmi_id(node: etree._Element) -> str | None:
    """Return the ``xmi:id`` of an XML element."""
    return next((str(v) for k, v in node.attrib.items() if str(k).endswith("}id")), None)
