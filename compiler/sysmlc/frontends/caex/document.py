"""A CAEX file as columns: one row an element, in document order; folded texts have none."""

from collections.abc import Iterator

from sysmlc.diagnostics import Place, Verdict
from sysmlc.frontends.caex.vocabulary import FOLDED, SIGNS


class Node:
    """One row of a document. There is one node for each row that was asked for.

    ``tag`` is its local name, ``name`` the attribute ``Name``, ``ordinal`` its place in the file.
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
        """Place among all elements of the file."""
        return self.document.ordinals[self.row]

    @property
    def parent(self) -> "Node | None":
        """The node around it; None at the root."""
        row = self.document.parents[self.row]
        return None if row < 0 else self.document.node(row)

    @property
    def element(self) -> str:
        """Id of what it became in the graph, or the empty string."""
        return self.document.elements[self.row]

    @element.setter
    def element(self, id: str) -> None:
        self.document.elements[self.row] = id

    @property
    def verdict(self) -> Verdict | None:
        """What became of it; None while nothing did."""
        return self.document.verdicts[self.row]

    @verdict.setter
    def verdict(self, verdict: Verdict) -> None:
        self.document.verdicts[self.row] = verdict

    @property
    def children(self) -> list["Node"]:
        """The nodes directly below it."""
        document = self.document
        return [document.node(row) for row in document.children(self.row)]

    @property
    def texts(self) -> dict[str, str]:
        """Texts of the folded children by tag, its own under the empty name."""
        columns = self.document.texts.items()
        return {tag: column[self.row] for tag, column in columns if self.row in column}

    def text(self, tag: str) -> str | None:
        """Text of a child, or None when there is no such child."""
        document, row = self.document, self.row
        column = document.texts.get(tag)
        if column is not None and row in column:
            return column[row]
        if document.ends[row] == row + 1:
            return None
        child = next(self.of(tag), None)
        return None if child is None else child.own_text

    @property
    def own_text(self) -> str:
        """The text of the element itself."""
        return self.document.texts[""].get(self.row, "")

    def all_texts(self, tag: str) -> list[str]:
        """Texts of all children with this tag."""
        column = self.document.texts.get(tag, {})
        folded = [column[self.row]] if self.row in column else []
        return folded + [child.own_text for child in self.of(tag)]

    def of(self, *tags: str) -> Iterator["Node"]:
        """Children with these tags, in order."""
        document, row = self.document, self.row
        if document.ends[row] == row + 1:
            return iter(())
        all_tags = document.tags
        return map(document.node, [r for r in document.children(row) if all_tags[r] in tags])

    def above(self) -> Iterator["Node"]:
        """The nodes that the node lies in, nearest first."""
        node = self.parent
        while node is not None:
            yield node
            node = node.parent

    def walk(self) -> Iterator["Node"]:
        """The node and all below it, in document order."""
        return map(self.document.node, range(self.row, self.document.ends[self.row]))


class Document:
    """Columns of one file.

    ``tags`` are local names; ``ends[row]`` is the first row after the row's content;
    ``ordinals`` are places among all elements of the file. ``texts`` holds by tag the texts of
    folded children, and under the empty name the row's own, for the rows that have some.
    ``has_stray`` tells whether text may stand where CAEX has none. ``elements`` are ids of what
    the rows became in the graph. ``signs`` are the tags as numbers (``vocabulary.SIGNS``):
    bytes are looked through in a tenth of the time of a list. ``ids`` are the IDs, empty where
    there is none.
    """

    __slots__ = (
        "_nodes",
        "attributes",
        "elements",
        "ends",
        "has_stray",
        "ids",
        "is_built_in",
        "name",
        "ordinals",
        "parents",
        "signs",
        "tags",
        "texts",
        "verdicts",
    )

    def __init__(self, name: str, is_built_in: bool = False) -> None:
        self.name = name
        self.is_built_in = is_built_in
        self.clear()

    def clear(self) -> None:
        """Have no rows."""
        self.tags: list[str] = []
        self.attributes: list[dict[str, str]] = []
        self.parents: list[int] = []
        self.ends: list[int] = []
        self.signs = b""
        self.ids: list[str] = []
        self.ordinals: list[int] = []
        self.texts: dict[str, dict[int, str]] = {tag: {} for tag in ("", *FOLDED)}
        self.verdicts: list[Verdict | None] = []
        self.elements: list[str] = []
        self.has_stray = False
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
        """The node of a row, always the same one."""
        known = self._nodes.get(row)
        if known is None:
            known = self._nodes[row] = Node(self, row)
        return known

    def children(self, row: int) -> list[int]:
        """Rows directly below a row."""
        end, ends = self.ends[row], self.ends
        rows = []
        row += 1
        while row < end:
            rows.append(row)
            row = ends[row]
        return rows

    def tagged(self, tag: str, start: int, end: int) -> Iterator[int]:
        """Rows from ``start`` to ``end`` with a tag of CAEX."""
        sign, find = SIGNS[tag], self.signs.find
        row = find(sign, start, end)
        while row >= 0:
            yield row
            row = find(sign, row + 1, end)

    def place(self, node: Node) -> Place:
        """Place of a node."""
        return Place(self.name, node.ordinal)

    def forget(self) -> None:
        """Let the nodes go: document and nodes know each other."""
        self._nodes.clear()
