"""The official models of SysML v2 in the corpus: texts, standard library, interchange files."""

import os
from functools import cache
from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.language.interchange import link, read
from sysmlc.language.library import Library, find_library
from sysmlc.language.text import parse
from sysmlc.language.tree import Document
from sysmlc.sources import Source

FOLDER = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "sysml2"
LIBRARY_FOLDER = FOLDER / "omg-release" / "sysml.library"
_XMI_FOLDER = FOLDER / "interchange" / "xmi"
XMI_FILES = sorted(path.relative_to(_XMI_FOLDER).as_posix() for path in _XMI_FOLDER.rglob("*.*mlx"))
"""Files of the standard library in interchange format."""


@cache
def load_standard_library() -> Library:
    return find_library(LIBRARY_FOLDER, {})


def parse_folder(folder: Path) -> list[Document]:
    """Parse the texts of a folder and of all folders in it."""
    paths = sorted(path for path in folder.rglob("*") if path.suffix in (".sysml", ".kerml"))
    sources = [Source(path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths]
    return [
        parse(source.data.decode("utf-8-sig"), source.name, path.suffix[1:], Sink(), source)
        for path, source in zip(paths, sources, strict=True)
    ]


def load_xmi_sources() -> list[Source]:
    return [Source(name, (_XMI_FOLDER / name).read_bytes()) for name in XMI_FILES]


def read_xmi_library() -> list[Document]:
    """Return the documents of the standard library, read from its interchange files."""
    sink = Sink()
    documents = [read(source, sink) for source in load_xmi_sources()]
    link(documents, sink)
    assert [diagnostic.message for diagnostic in sink] == []
    return documents
