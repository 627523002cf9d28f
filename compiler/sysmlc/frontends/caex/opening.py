"""From a file to its columns, in the way that it is written for."""

from sysmlc.frontends.caex import columns, pieces
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.vocabulary import SIGNS
from sysmlc.sources import Source, SourceError


def read(source: Source, is_built_in: bool = False) -> Document:
    """The columns of the file. Raises SourceError."""
    document = Document(source.name, is_built_in)
    if not pieces.fill(document, source):
        columns.fill(document, source)
    if document.tags[0] != "CAEXFile":
        raise SourceError("its root element is no CAEXFile", source.name, 0)
    rows = len(document.tags)
    document.signs = bytes(map(SIGNS.__getitem__, document.tags))
    document.verdicts = [None] * rows
    document.elements = [""] * rows
    return document
