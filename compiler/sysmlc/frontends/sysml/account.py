"""Every node of a document is counted once, and what is lost is listed with the reason."""

from collections import Counter
from collections.abc import Iterator

from sysmlc.diagnostics import Coverage, Rule, Verdict
from sysmlc.diagnostics.coverage import Loss
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.places import Home
from sysmlc.frontends.sysml.rules import APPROXIMATED, UNSUPPORTED
from sysmlc.frontends.sysml.usage import ByKind
from sysmlc.language.tree import Node

_Found = tuple[Node, Verdict, bool]
"""A node, what became of it, and whether that is said of its owner and not of itself."""
_REASONS: dict[Verdict, tuple[Rule | None, str]] = {
    Verdict.UNSUPPORTED: (UNSUPPORTED, "not read"),
    Verdict.APPROXIMATED: (APPROXIMATED, "read without part of its meaning"),
    Verdict.EXTERNAL: (None, "stands for what is in a library"),
    Verdict.IGNORED_NOTATION: (None, "means nothing beyond what it shows or names"),
}


def account(low: Lowering, home: Home, by_kind: ByKind, coverage: Coverage) -> None:
    """Count each node; what has no verdict of its own shares that of its owner."""
    counts = coverage.file(home.path)
    found = [one for one in _verdicts(low, home.document.root) if one[1] is not Verdict.MAPPED]
    numbers = Counter((node.kind, verdict) for node, verdict, _ in found)
    for (kind, verdict), number in numbers.items():
        counts.count(kind, verdict, number)
    lost = Counter(node.kind for node, _, _ in found)
    for kind, ours in by_kind.items():
        if len(ours) > lost[kind]:
            counts.count(kind, Verdict.MAPPED, len(ours) - lost[kind])
    if coverage.is_detailed:
        counts.losses.extend(_losses(low, home, found))


def _verdicts(low: Lowering, root: Node) -> Iterator[_Found]:
    """Nodes in the order of the text, without such that nothing in is lost.

    Inside what is lost all is lost.
    """
    open_ones: list[_Found] = [(root, Verdict.MAPPED, False)]
    lost = set(low.lost)
    while open_ones:
        node, verdict, is_shared = open_ones.pop()
        yield node, verdict, is_shared
        is_part = verdict is Verdict.APPROXIMATED and id(node) not in lost
        shared = Verdict.MAPPED if is_part else verdict
        for one in reversed(node.members):
            own = low.verdicts.get(id(one))
            if own is None and id(node) in lost:
                lost.add(id(one))
            if shared is not Verdict.MAPPED or id(one) in low.around:
                open_ones.append((one, own or shared, own is None))


def _losses(low: Lowering, home: Home, found: list[_Found]) -> Iterator[Loss]:
    """What is not mapped; what it owns counts with it while it shares the verdict."""
    reasons = {
        id(node): (APPROXIMATED, f"{said} is read as {written}")
        for (said, written), told in low.told.items()
        for node in told
        if said != "unsupported"
    }
    begun: list[tuple[Node, Verdict, int]] = []
    for node, verdict, is_shared in found:
        if is_shared and begun:
            first, known, number = begun[-1]
            begun[-1] = (first, known, number + 1)
        else:
            begun.append((node, verdict, 1))
    for node, verdict, number in begun:
        rule, reason = reasons.get(id(node)) or _REASONS[verdict]
        yield Loss(
            node.kind,
            verdict,
            home.ordinal(node),
            number,
            _around(low, node),
            "" if id(node) in low.elements else node.name or "",
            rule,
            reason,
        )


def _around(low: Lowering, node: Node) -> str:
    """Id of the nearest element that a node stands in or has become."""
    at: Node | None = node
    while at is not None and id(at) not in low.elements:
        at = at.owner
    return "" if at is None else low.elements[id(at)].id
