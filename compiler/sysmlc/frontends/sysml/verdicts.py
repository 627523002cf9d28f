"""What became of nodes that are not wholly in the graph."""

from sysmlc.diagnostics import Verdict
from sysmlc.language.tree import Node


class Verdicts:
    """Nodes with a verdict of their own; any other shares that of its owner."""

    def __init__(self) -> None:
        self.verdicts: dict[int, Verdict] = {}
        self.around: set[int] = set()
        """Identities of nodes with a verdict, and of all that they stand in."""
        self.lost: set[int] = set()
        """Identities of approximated nodes that are nowhere in the graph, nor is what they own."""
        self.told: dict[tuple[str, str], list[Node]] = {}
        """What is not wholly in the graph, by what is said and how it is read."""

    def unsupported(self, node: Node) -> None:
        """The node, with what it owns, has no place in the graph."""
        self._judge(node, Verdict.UNSUPPORTED)
        self.told.setdefault(("unsupported", node.kind), []).append(node)

    def external(self, node: Node) -> None:
        """The node belongs to a library and not to the model."""
        self._judge(node, Verdict.EXTERNAL)

    def ignored(self, node: Node) -> None:
        """The node means nothing beyond drawing or presentation."""
        self._judge(node, Verdict.IGNORED_NOTATION)

    def approximated(self, node: Node, said: str, written: str) -> None:
        """Part of the node's meaning is lost: ``said`` is kept as ``written``."""
        self._judge(node, Verdict.APPROXIMATED)
        if written == "nothing":
            self.lost.add(id(node))
        self.told.setdefault((said, written), []).append(node)

    def _judge(self, node: Node, verdict: Verdict) -> None:
        self.verdicts[id(node)] = verdict
        above: Node | None = node
        while above is not None and id(above) not in self.around:
            self.around.add(id(above))
            above = above.owner
