"""Coverage of a document: the verdict of every node, and the losses with their reasons."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from sysmlc.diagnostics import Coverage, Rule, Verdict
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.sysml.rules import APPROXIMATED, UNSUPPORTED
from sysmlc.ir import Element
from sysmlc.language.tree import Document, Node

_REASONS: dict[Verdict, tuple[Rule | None, str]] = {
    Verdict.UNSUPPORTED: (UNSUPPORTED, "not read"),
    Verdict.APPROXIMATED: (APPROXIMATED, "read without part of its meaning"),
    Verdict.EXTERNAL: (None, "stands for an element of a library"),
    Verdict.IGNORED_NOTATION: (None, "means nothing beyond what it shows or names"),
}
_UNSUPPORTED = "unsupported"


class Verdicts:
    """Which nodes were read, and verdicts of those that the graph represents in part or not at all.

    A node without a verdict of its own shares the verdict of its owner. Integers are identities of
    nodes.
    """

    def __init__(self) -> None:
        self.by_node: dict[int, Verdict] = {}
        self.paths_to_verdicts: set[int] = set()
        """Identities of nodes with a verdict, and of all nodes that contain one."""
        self.dropped: set[int] = set()
        """Identities of approximated nodes that the graph does not represent at all."""
        self.losses: dict[tuple[str, str], list[Node]] = {}
        """Nodes by the two texts of their diagnostic: the construct and its approximation.

        For an unsupported node these are ``unsupported`` and its metaclass.
        """
        self.lowered: set[int] = set()
        """Nodes that were lowered, or for which an element was added."""
        self.skipped: set[int] = set()
        """Members that a handler reads together with their owner."""

    def mark_unsupported(self, node: Node) -> None:
        """Record that the graph represents neither the node nor its members."""
        self._set_verdict(node, Verdict.UNSUPPORTED)
        self.losses.setdefault((_UNSUPPORTED, node.kind), []).append(node)

    def mark_external(self, node: Node) -> None:
        """Record that the node belongs to a library and not to the model."""
        self._set_verdict(node, Verdict.EXTERNAL)

    def mark_ignored(self, node: Node) -> None:
        """Record that the node has no meaning beyond notation."""
        self._set_verdict(node, Verdict.IGNORED_NOTATION)

    def mark_approximated(self, node: Node, construct: str, approximation: str) -> None:
        """Record that the graph has only an approximation of the node, which may be "nothing"."""
        self._set_verdict(node, Verdict.APPROXIMATED)
        if approximation == "nothing":
            self.dropped.add(id(node))
        self.losses.setdefault((construct, approximation), []).append(node)

    def iter_losses(self) -> Iterator[tuple[str, str, list[Node]]]:
        """Yield each lost construct, its approximation, and the nodes.

        Unsupported nodes have an empty construct, and their metaclass as the second text.
        """
        for (construct, approximation), nodes in self.losses.items():
            yield "" if construct == _UNSUPPORTED else construct, approximation, nodes

    def _set_verdict(self, node: Node, verdict: Verdict) -> None:
        self.by_node[id(node)] = verdict
        container: Node | None = node
        while container is not None and id(container) not in self.paths_to_verdicts:
            self.paths_to_verdicts.add(id(container))
            container = container.owner


def describe_loss(construct: str, approximation: str) -> str:
    """Return what becomes of a construct that the graph represents in part."""
    treatment = "not read" if approximation == "nothing" else f"read as {approximation}"
    return f"{construct} is {treatment}"


class _Judged(NamedTuple):
    """A node with its verdict, and whether the node only shares the verdict of its owner."""

    node: Node
    verdict: Verdict
    is_shared: bool


def count_verdicts(
    verdicts: Verdicts,
    elements: Mapping[int, Element],
    document: Document,
    nodes_by_kind: Mapping[str, Sequence[Node]],
    coverage: Coverage,
) -> None:
    """Count each node of a document once, and list the losses if the report is detailed."""
    counts = coverage.file(document.path)
    judged = [
        entry
        for entry in _iter_judged(verdicts, document.root)
        if entry.verdict is not Verdict.MAPPED
    ]
    numbers = Counter((entry.node.kind, entry.verdict) for entry in judged)
    for (kind, verdict), number in numbers.items():
        counts.count(kind, verdict, number)
    unmapped = Counter(entry.node.kind for entry in judged)
    for kind, nodes in nodes_by_kind.items():
        if len(nodes) > unmapped[kind]:
            counts.count(kind, Verdict.MAPPED, len(nodes) - unmapped[kind])
    if coverage.is_detailed:
        counts.losses.extend(_iter_losses(verdicts, elements, document, judged))


def _iter_judged(verdicts: Verdicts, root: Node) -> Iterator[_Judged]:
    """Yield nodes in the order of the text, without subtrees that are mapped completely.

    Members of an approximated node are mapped unless the node was dropped.
    """
    stack = [_Judged(root, Verdict.MAPPED, False)]
    dropped = set(verdicts.dropped)
    while stack:
        entry = stack.pop()
        yield entry
        node, verdict, _ = entry
        is_dropped = id(node) in dropped
        is_represented = verdict is Verdict.APPROXIMATED and not is_dropped
        shared = Verdict.MAPPED if is_represented else verdict
        for member in reversed(node.members):
            own_verdict = verdicts.by_node.get(id(member))
            if own_verdict is None and is_dropped:
                dropped.add(id(member))
            if shared is not Verdict.MAPPED or id(member) in verdicts.paths_to_verdicts:
                stack.append(_Judged(member, own_verdict or shared, own_verdict is None))


def _iter_losses(
    verdicts: Verdicts, elements: Mapping[int, Element], document: Document, judged: list[_Judged]
) -> Iterator[Loss]:
    """Yield one loss for each node with a verdict, with the number of nodes that share it."""
    reasons = {
        id(node): (APPROXIMATED, describe_loss(construct, approximation))
        for construct, approximation, nodes in verdicts.iter_losses()
        for node in nodes
        if construct
    }
    groups: list[tuple[_Judged, int]] = []
    for entry in judged:
        if entry.is_shared and groups:
            first, number = groups[-1]
            groups[-1] = (first, number + 1)
        else:
            groups.append((entry, 1))
    for (node, verdict, _), number in groups:
        rule, reason = reasons.get(id(node)) or _REASONS[verdict]
        yield Loss(
            node.kind,
            verdict,
            document.ordinal_of(node),
            number,
            _find_element_id(elements, node),
            "" if id(node) in elements else node.name or "",
            rule,
            reason,
        )


def _find_element_id(elements: Mapping[int, Element], node: Node) -> str:
    """Return the id of the element of the node, or of the nearest node that contains it."""
    container: Node | None = node
    while container is not None and id(container) not in elements:
        container = container.owner
    return "" if container is None else elements[id(container)].id
