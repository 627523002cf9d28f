"""From the bytes of a file to its columns, the fastest way that the file allows."""

from sysmlc.frontends.xmi import pieces
from sysmlc.frontends.xmi.columns import fill, fill_swiftly
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.indexing import index, index_kinds, index_shapes
from sysmlc.frontends.xmi.prefixes import IrregularError, Prefixes
from sysmlc.sources import Source, SourceError


def read(source: Source) -> Document:
    """The columns of the file. Raises SourceError."""
    return _plainly(source) or _swiftly(source) or _generally(source)


def _plainly(source: Source) -> Document | None:
    """The columns of a file that is written plainly."""
    document, prefixes = Document(source.name), Prefixes()
    tags = pieces.fill(document, source, prefixes)
    if tags is None:
        return None
    index_kinds(document, tuple(prefixes.declared.values()), tags.kinds, tags.xmi)
    return document


def _swiftly(source: Source) -> Document | None:
    """The columns of a file whose root declares all prefixes."""
    document, prefixes = Document(source.name), Prefixes()
    try:
        index(document, fill_swiftly(document, source, prefixes))
        if prefixes.expand(document):
            index_shapes(document)
        prefixes.check_hidden(source.data)
    except (IrregularError, SourceError):
        return None
    return document


def _generally(source: Source) -> Document:
    document = Document(source.name)
    index(document, fill(document, source))
    return document
