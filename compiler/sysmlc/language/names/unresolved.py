"""Names that lead nowhere, told in the modeller's words, once for each use."""

from collections.abc import Iterable

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.language.names import contexts
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.names.results import result
from sysmlc.language.names.rules import UNRESOLVED
from sysmlc.language.tree import Document, Node, Relation
from sysmlc.suggest import did_you_mean


def report(
    lookup: Lookup, document: Document, node: Node, relation: Relation, sink: Sink
) -> None:
    """Report the first name of a chain that was not found."""
    reference = relation.reference
    index = len(reference.targets or ())
    start = contexts.start(node, relation)
    if index == 0 and start.operand is not None and result(start.operand, lookup) is None:
        return
    name = "::".join(reference.chain[index])
    before = reference.targets[-1] if reference.targets else None
    inside = f" in '{before.name}'" if before is not None and before.name else ""
    sink.report(
        UNRESOLVED,
        subject(document, node, reference.start),
        name=name,
        inside=inside,
        advice=did_you_mean(reference.chain[index][-1], _known(lookup, before or start.scope)),
    )


def _known(lookup: Lookup, scope: Node | None) -> Iterable[str]:
    while scope is not None:
        yield from lookup.owned(scope)
        scope = contexts.outer(scope)


def subject(document: Document, node: Node, offset: int) -> Subject:
    """The element and the place of a name in it."""
    place = Place(document.path, offset=_bytes(document, offset))
    return Subject(node.name or "", place=place)


def _bytes(document: Document, offset: int) -> int:
    return len(document.text[:offset].encode()) if offset >= 0 else -1
