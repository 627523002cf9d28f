"""Reads the bytes of a CAEX file into the columns of a document with one pass of expat.

Expat calls the handlers for each element of the file, so they only append to columns.
"""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.vocabulary import TAG_CODES, TEXTLESS_TAGS
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.xml import SEPARATOR, parse, parser, too_deep

_TextColumn = dict[int, str]


def read_document(source: Source, is_built_in: bool = False) -> Document:
    """Return the document of a CAEX file. Raises SourceError."""
    reader = _ColumnReader(source, is_built_in)
    reader.run()
    return reader.document


class _TextColumns(dict[str, _TextColumn | None]):
    """The column for the text of each tag as expat writes it.

    A folded tag has a column of its own, a tag without text has None, and all other tags share
    the column for the text of the row itself.
    """

    def __init__(self, texts: dict[str, _TextColumn]) -> None:
        super().__init__()
        self._texts = texts

    def __missing__(self, tag: str) -> _TextColumn | None:
        name = tag.rpartition(SEPARATOR)[2]
        default = None if name in TEXTLESS_TAGS else self._texts[""]
        self[tag] = column = self._texts.get(name, default) if name else default
        return column


class _ColumnReader:
    """The parser handlers that fill the columns of one document.

    An element whose tag is folded (``vocabulary.FOLDED_TAGS``) gets no row when it has no
    attributes: its text becomes an entry of its parent's row. Text elsewhere is noted as stray.
    """

    def __init__(self, source: Source, is_built_in: bool) -> None:
        self.document = Document(source.name, is_built_in)
        self._source = source
        self._parser = parser()
        self._stray_texts: set[str] = set()

    def run(self) -> None:
        """Parse the source and complete the columns. Raises SourceError."""
        self._set_handlers()
        try:
            parse(self._source, self._parser)
        finally:
            # The parser and its handlers refer to one another; the garbage collector is off.
            self._parser.StartElementHandler = None
            self._parser.EndElementHandler = None
            self._parser.CharacterDataHandler = None
        document = self.document
        document.has_stray_text = any(map(str.strip, self._stray_texts))
        local_names = {tag: tag.rpartition(SEPARATOR)[2] for tag in set(document.tags)}
        document.tags = [local_names[tag] for tag in document.tags]
        if document.tags[0] != "CAEXFile":
            raise SourceError("its root element is no CAEXFile", self._source.name, 0)
        document.ids = [attributes.get("ID", "") for attributes in document.attributes]
        document.tag_codes = bytes(map(TAG_CODES.__getitem__, document.tags))
        document.verdicts = list[Verdict | None]([None]) * len(document.tags)
        document.element_ids = [""] * len(document.tags)

    def _set_handlers(self) -> None:
        document, expat = self.document, self._parser
        tags, ends, texts = document.tags, document.ends, document.texts
        own_texts, text_columns = texts[""], _TextColumns(texts)
        open_rows = [-1]
        ordinal = -1
        following = 0
        folding: _TextColumn | None = None
        folding_depth = 0

        def start_element(tag: str, attributes: dict[str, str]) -> None:
            nonlocal ordinal, following, folding, folding_depth
            ordinal += 1
            parent = open_rows[-1]
            column = text_columns[tag]
            if column is not None:
                # These handlers are installed for elements with text only, as most have none.
                expat.CharacterDataHandler = add_text
                expat.EndElementHandler = end_text_element
                is_foldable = not attributes and column is not own_texts and folding is None
                # A second element of the same tag gets a row, so that no text is lost.
                if is_foldable and parent >= 0 and parent not in column:
                    folding, folding_depth = column, len(open_rows)
                    column[parent] = ""
                    return
            row = following
            following = row + 1
            open_rows.append(row)
            tags.append(tag)
            document.attributes.append(attributes)
            document.parents.append(parent)
            document.ordinals.append(ordinal)
            ends.append(0)
            if len(open_rows) > DEFAULT_LIMITS.depth:
                too_deep(self._source, expat)

        def end_element(_tag: str) -> None:
            ends[open_rows.pop()] = following

        def end_text_element(_tag: str) -> None:
            nonlocal folding
            expat.CharacterDataHandler = self._stray_texts.add
            if folding is None:
                expat.EndElementHandler = end_element
            elif len(open_rows) == folding_depth:
                folding = None
                expat.EndElementHandler = end_element
                return
            ends[open_rows.pop()] = following

        def add_text(text: str) -> None:
            row = open_rows[-1]
            is_folded = folding is not None and len(open_rows) == folding_depth
            column = folding if is_folded and folding is not None else own_texts
            column[row] = column.get(row, "") + text

        expat.StartElementHandler = start_element
        expat.EndElementHandler = end_element
        expat.CharacterDataHandler = self._stray_texts.add
