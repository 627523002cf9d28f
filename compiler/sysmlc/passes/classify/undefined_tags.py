"""Tags that a profile of the unit does not define: each is told once for each stereotype."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import generals
from sysmlc.passes.classify.vocabulary import mangled

_SAMPLE = (
    'Profile q "Plant"\n  Stereotype s "Cell"\n    Property n "number"\nClass a "A"\n'
    '  Application t "Cell" stereotype="Cell" {}="3"\n    -> instance-of s\n    -> subject a'
)

UNDEFINED_TAG = rule(
    "SM156",
    "undefined-tag",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' on '{element}'{others} is none that its profile "
    "defines",
    why="The profile is part of the unit, and neither the stereotype nor one that it specialises "
    "has such a property: most likely the property was renamed or removed since. The graph keeps "
    "the value, but nothing is made of it.",
    help="apply the profile again in the modelling tool, or correct the name of the tag",
    wrong=_SAMPLE.format("tag.numbr"),
    right=_SAMPLE.format("tag.number"),
)

_TAG = "tag."


def check_tags(graph: Graph, sink: Sink) -> None:
    """Report tags of applications whose stereotypes, general ones included, are in the unit."""
    known: dict[str, frozenset[str] | None] = {}
    found: dict[tuple[str, str], list[Element]] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        stereotype = graph.target(application, Edge.INSTANCE_OF)
        if stereotype is None:
            continue
        if stereotype.id not in known:
            known[stereotype.id] = _properties(graph, stereotype)
        for tag in _undefined(application, known[stereotype.id]):
            found.setdefault((stereotype.id, tag), []).append(application)
    for (_, tag), applications in found.items():
        _report(graph, sink, tag, applications)


def _properties(graph: Graph, stereotype: Element) -> frozenset[str] | None:
    """Names of its properties as XML shows them; None when some of them cannot be known."""
    family = [stereotype, *generals(graph, stereotype)]
    if any(one.attrs.get("external") or one.attrs.get("library") for one in family):
        return None
    owned = (part for one in family for part in graph.owned(one) if part.kind is Kind.PROPERTY)
    return frozenset(mangled(part.name).lower() for part in owned)


def _undefined(application: Element, known: frozenset[str] | None) -> Iterator[str]:
    if known is not None:
        tags = (name.removeprefix(_TAG) for name in application.attrs if name.startswith(_TAG))
        yield from (tag for tag in tags if mangled(tag).lower() not in known)


def _report(graph: Graph, sink: Sink, tag: str, applications: list[Element]) -> None:
    first, others = applications[0], len(applications) - 1
    subject = graph.subject(first)
    sink.report(
        UNDEFINED_TAG,
        subject,
        tag=tag,
        stereotype=first.name,
        element=graph.qualified_name(graph.target(first, Edge.SUBJECT) or first),
        others=f" and {others} more" if others else "",
    )
