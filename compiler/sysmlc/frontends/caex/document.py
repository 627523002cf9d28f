"""A CAEX file as columns: one row for each element in document order, except folded texts."""

from collections.abc import Iterator

from sysmlc.diagnostics import Place, Verdict
from sysmlc.frontends.caex.vocabulary import FOLDED_TAGS, TAG_CODES


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
        """The node around it; None at the root."""
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
        """The nodes directly below it."""
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
        """Whether a node with one of these tags is directly below it."""
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
        """Yield the nodes around it, nearest first."""
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
