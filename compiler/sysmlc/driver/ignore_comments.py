"""Comments in the model that accept findings: ``sysmlc: ignore SM410, SM421: the reason``.

Such a comment covers findings about the elements that it annotates, or about its owner if it
annotates none, and about all that these elements own. It never covers errors.
"""

import re
from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Diagnostic, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind

UNUSED_COMMENT = rule(
    "SM907",
    "unused-ignore-comment",
    Severity.WARNING,
    "the comment 'sysmlc: ignore {name}' matches no finding about '{element}'",
    help="remove the comment, or correct the rule; errors cannot be ignored",
)

_COMMENT = re.compile(r"\s*sysmlc:\s*ignore\s+([\w-]+(?:\s*,\s*[\w-]+)*)\s*(?::.*)?", re.DOTALL)


class _IgnoreComment(Struct, frozen=True, eq=False):
    """A comment that accepts findings of one rule (code or name) about some elements."""

    comment: Element
    rule: str
    elements: tuple[Element, ...]
    covered_ids: frozenset[str]
    """Ids of the elements and of all that they own."""

    def covers(self, diagnostic: Diagnostic) -> bool:
        """Whether the comment accepts the diagnostic."""
        is_named = self.rule in (diagnostic.rule.code, diagnostic.rule.name)
        return is_named and not diagnostic.is_error and diagnostic.subject.id in self.covered_ids


def drop_ignored(
    diagnostics: Iterable[Diagnostic], graph: Graph, severities: Sink
) -> Iterator[Diagnostic]:
    """Yield the diagnostics that no comment covers, and a diagnostic for each unused comment.

    *severities* is an empty sink with the severities of the project, to which these are reported.
    """
    comments = list(_list_comments(graph))
    used: set[_IgnoreComment] = set()
    for diagnostic in diagnostics:
        covering = [comment for comment in comments if comment.covers(diagnostic)]
        used.update(covering)
        if not covering:
            yield diagnostic
    for comment in comments:
        if comment not in used:
            names = ", ".join(graph.qualified_name(element) for element in comment.elements)
            subject = graph.subject(comment.comment)
            severities.report(UNUSED_COMMENT, subject, name=comment.rule, element=names)
    yield from severities


def _list_comments(graph: Graph) -> Iterator[_IgnoreComment]:
    for comment in graph.of_kind(Kind.COMMENT):
        match = _COMMENT.fullmatch(str(comment.attrs.get("body", "")))
        if match is None:
            continue
        owner = graph.owner(comment)
        elements = graph.targets(comment, Edge.REFERENCES) or ([] if owner is None else [owner])
        ids = frozenset(inner.id for element in elements for inner in graph.subtree(element))
        for name in re.split(r"\s*,\s*", match[1]):
            yield _IgnoreComment(comment, name, tuple(elements), ids)
