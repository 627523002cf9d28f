"""Names that lead nowhere, told in the modeller's words, once for each use."""

import re

from sysmlc.diagnostics import Sink, Subject
from sysmlc.language.names import contexts
from sysmlc.language.names.advice import advice
from sysmlc.language.names.generals import GENERAL
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.names.model import Model
from sysmlc.language.names.results import result
from sysmlc.language.names.rules import TOO_CIRCULAR, UNRESOLVED
from sysmlc.language.places import place
from sysmlc.language.tree import Document, Node, Reference, Relation

_NAME = r"(?:'(?:[^'\\]|\\.)*'|[\w$~]+)"
_LINK = re.compile(rf"{_NAME}(?:\s*::\s*{_NAME})*")
"""A qualified name, one link of a chain."""


def report(model: Model, document: Document, node: Node, relation: Relation, sink: Sink) -> None:
    """Report the first name of a chain that was not found."""
    lookup = model.lookup
    reference = relation.reference
    index = len(reference.targets or ())
    start = contexts.start(node, relation)
    before = _before(node, lookup, reference, start)
    if before is None and (index or start.operand is not None or start.before is not None):
        return
    if _is_incomplete(before or (start.scope if start.inherited else None), lookup):
        return
    name = "::".join(reference.chain[index])
    if reference in lookup.given_up:
        sink.report(
            TOO_CIRCULAR, subject(document, node, _place(document, reference, index)), name=name
        )
        return
    inside = f" in '{before.name}'" if before is not None and before.name else ""
    sink.report(
        UNRESOLVED,
        subject(document, node, _place(document, reference, index)),
        name=name,
        inside=inside,
        advice=advice(model, (node, relation), reference.chain[index], start, before),
    )


def _before(node: Node, lookup: Lookup, reference: Reference, start: contexts.Start) -> Node | None:
    """The element in which the name that was not found should be, if it is not a scope."""
    if reference.targets:
        return reference.targets[-1]
    if start.operand is not None:
        return result(start.operand, lookup)
    return lookup.target(node, start.before) if start.before is not None else None


def _is_incomplete(scope: Node | None, lookup: Lookup) -> bool:
    """Whether a general of ``scope`` was not found: the name may come from it, once is enough."""
    waiting = [scope] if scope is not None else []
    seen = set(waiting)
    while waiting:
        node = waiting.pop()
        for relation in node.relations:
            if relation.kind in GENERAL:
                general = lookup.target(node, relation)
                if general is None:
                    return True
                if general not in seen:
                    seen.add(general)
                    waiting.append(general)
    return False


def _place(document: Document, reference: Reference, index: int) -> int:
    """Where the link of a chain stands that was not found."""
    if index == 0 or reference.start < 0:
        return reference.start
    links = list(_LINK.finditer(document.text, reference.start, reference.end))
    return links[index].start() if index < len(links) else reference.start


def subject(document: Document, node: Node, start: int) -> Subject:
    """The element, and the place of a name in it or, where that is not known, its own."""
    return Subject(node.name or "", place=place(document, start if start >= 0 else node.start))
