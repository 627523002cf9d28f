"""A CAEX file as columns: one row for each element in document order, except folded texts.

One pass of expat reads the file. Expat calls the handlers for each element of the file, so they
only append to columns.
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Place, Verdict
from sysmlc.frontends.caex.vocabulary import FOLDED_TAGS, TAG_CODES, TEXTLESS_TAGS
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.xml import SEPARATOR, make_parser, parse, refuse_depth


class Node:
    """One row of a document, created when it is first asked for.

    ``tag`` is the local name of the element, ``name`` its XML attribute ``Name``.
    """

    __slots__ = ("attributes", "document", "name", "row", "tag")

    def __init__(self, document: "Document", row: int) -> None:
        self.document = document
        self.row = row
        self.tag = document.tags[row]
        self.attributes = document.attributes[row]
        self.name = self.attributes.get("Name", "")

    @property
    def ordinal(self) -> int:
        """Position among all elements of the file."""
        return self.document.ordinals[self.row]

    @property
    def parent(self) -> "Node | None":
        """The parent node; None for the root."""
        row = self.document.parents[self.row]
        return None if row < 0 else self.document.node(row)

    @property
    def element_id(self) -> str:
        """Id of the graph element that represents the node, or the empty string."""
        return self.document.element_ids[self.row]

    @element_id.setter
    def element_id(self, id: str) -> None:
        self.document.element_ids[self.row] = id

    @property
    def verdict(self) -> Verdict | None:
        """How the node was read; None before that."""
        return self.document.verdicts[self.row]

    @verdict.setter
    def verdict(self, verdict: Verdict) -> None:
        self.document.verdicts[self.row] = verdict

    @property
    def children(self) -> list["Node"]:
        """The child nodes."""
        document = self.document
        return [document.node(row) for row in document.child_rows(self.row)]

    @property
    def texts(self) -> dict[str, str]:
        """Texts of the folded children by tag, and its own text under the empty name."""
        columns = self.document.texts.items()
        return {tag: column[self.row] for tag, column in columns if self.row in column}

    @property
    def own_text(self) -> str:
        """The text of the element itself."""
        return self.document.texts[""].get(self.row, "")

    def child_text(self, tag: str) -> str | None:
        """Return the text of the first child with this tag, or None when there is no such child."""
        document, row = self.document, self.row
        column = document.texts.get(tag)
        if column is not None and row in column:
            return column[row]
        if document.ends[row] == row + 1:
            return None
        child = next(self.iter_children(tag), None)
        return None if child is None else child.own_text

    def child_texts(self, tag: str) -> list[str]:
        """Return the texts of all children with this tag."""
        column = self.document.texts.get(tag, {})
        folded = [column[self.row]] if self.row in column else []
        return folded + [child.own_text for child in self.iter_children(tag)]

    def has_child(self, *tags: str) -> bool:
        """Whether the node has a child with one of these tags."""
        return next(self.iter_children(*tags), None) is not None

    def iter_children(self, *tags: str) -> Iterator["Node"]:
        """Yield the children with these tags, in order."""
        document, row = self.document, self.row
        if document.ends[row] == row + 1:
            return iter(())
        all_tags = document.tags
        rows = [child for child in document.child_rows(row) if all_tags[child] in tags]
        return map(document.node, rows)

    def iter_ancestors(self) -> Iterator["Node"]:
        """Yield the ancestors of the node, nearest first."""
        node = self.parent
        while node is not None:
            yield node
            node = node.parent

    def iter_subtree(self) -> Iterator["Node"]:
        """Yield the node and all nodes below it, in document order."""
        return map(self.document.node, range(self.row, self.document.ends[self.row]))

    def mark_subtree(self, verdict: Verdict = Verdict.MAPPED) -> None:
        """Give the node and all nodes below it one verdict."""
        for row in range(self.row, self.document.ends[self.row]):
            self.document.verdicts[row] = verdict


class Document:
    """The columns of one file. A row is the index of an XML element in each list."""

    __slots__ = (
        "_nodes",
        "attributes",
        "element_ids",
        "ends",
        "has_stray_text",
        "ids",
        "is_built_in",
        "misplaced_classes",
        "name",
        "ordinals",
        "parents",
        "tag_codes",
        "tags",
        "texts",
        "verdicts",
    )

    def __init__(self, name: str, is_built_in: bool = False) -> None:
        self.name = name
        self.is_built_in = is_built_in
        self.tags: list[str] = []
        """Local names of the elements."""
        self.tag_codes = b""
        """The tags as ``vocabulary.TAG_CODES``: bytes are searched ten times as fast as a list."""
        self.attributes: list[dict[str, str]] = []
        self.parents: list[int] = []
        self.ends: list[int] = []
        """For each row the first row after its content."""
        self.ids: list[str] = []
        """XML attributes ``ID``, or the empty string."""
        self.ordinals: list[int] = []
        """Positions among all elements of the file; folded elements have positions but no rows."""
        self.texts: dict[str, dict[int, str]] = {tag: {} for tag in ("", *FOLDED_TAGS)}
        """Texts of folded children by tag and row, and under the empty name the row's own text."""
        self.misplaced_classes: list[int] = []
        """Rows of interfaces whose class was in RefBaseSystemUnitPath, and is read all the same."""
        self.has_stray_text = False
        """Whether text may stand where CAEX has none."""
        self.verdicts: list[Verdict | None] = []
        self.element_ids: list[str] = []
        """Ids of the graph elements that represent the rows, or the empty string."""
        self._nodes: dict[int, Node] = {}

    @property
    def root(self) -> Node:
        """The element that holds all others."""
        return self.node(0)

    @property
    def version(self) -> str:
        """Version of the schema as the file states it: "2.15", "3.0", or the empty string."""
        return self.attributes[0].get("SchemaVersion", "")

    def node(self, row: int) -> Node:
        """Return the node of a row, always the same object."""
        node = self._nodes.get(row)
        if node is None:
            node = self._nodes[row] = Node(self, row)
        return node

    def child_rows(self, row: int) -> list[int]:
        """Return the rows directly below a row."""
        end, ends = self.ends[row], self.ends
        rows = []
        child = row + 1
        while child < end:
            rows.append(child)
            child = ends[child]
        return rows

    def iter_rows(self, tag: str, start: int, end: int) -> Iterator[int]:
        """Yield the rows from *start* to *end* that have a tag of CAEX."""
        code, find = TAG_CODES[tag], self.tag_codes.find
        row = find(code, start, end)
        while row >= 0:
            yield row
            row = find(code, row + 1, end)

    def locate(self, node: Node) -> Place:
        """Return the location of a node, for diagnostics."""
        return Place(self.name, node.ordinal)

    def release_nodes(self) -> None:
        """Drop the nodes: they refer to the document, which refers to them."""
        self._nodes.clear()


# -- reading ---------------------------------------------------------------------------------------

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
        self._parser = make_parser()
        self._stray_texts: set[str] = set()

    def run(self) -> None:
        """Parse the source and complete the columns. Raises SourceError."""
        self._set_handlers()
        parse(self._source, self._parser)
        document = self.document
        document.has_stray_text = any(map(str.strip, self._stray_texts))
        local_names = {tag: tag.rpartition(SEPARATOR)[2] for tag in set(document.tags)}
        document.tags = [local_names[tag] for tag in document.tags]
        if document.tags[0] != "CAEXFile":
            raise SourceError("its root element is not CAEXFile", self._source.name, 0)
        document.tag_codes = bytes(map(TAG_CODES.__getitem__, document.tags))
        _move_misplaced_classes(document)
        document.ids = [attributes.get("ID", "") for attributes in document.attributes]
        document.verdicts = list[Verdict | None]([None]) * len(document.tags)
        document.element_ids = [""] * len(document.tags)

    def _set_handlers(self) -> None:
        """Install handlers that add a row for each start tag, and texts to the open row.

        A child with text only becomes no row (folding): its text is stored in the column of its
        tag, at the row of its parent. The handlers are closures over the parsing state, because
        expat calls them for each tag and text of the file.
        """
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
                refuse_depth(self._source, expat)

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


def _move_misplaced_classes(document: Document) -> None:
    """Give interfaces that name their class like internal elements the right attribute (SM633)."""
    for row in document.iter_rows("ExternalInterface", 0, len(document.tags)):
        attributes = document.attributes[row]
        if "RefBaseSystemUnitPath" in attributes and "RefBaseClassPath" not in attributes:
            attributes["RefBaseClassPath"] = attributes.pop("RefBaseSystemUnitPath")
            document.misplaced_classes.append(row)
