"""Requirements: their id and text in every dialect, and what must hold between them."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS, tag
from sysmlc.passes.classify.requirement_rules import COPY_DIFFERS, NO_ID, REPEATED_ID

_KINDS = (*CLASSIFIERS, Kind.PACKAGE, Kind.OPERATION)


def give_requirement(graph: Graph, requirement: Element) -> None:
    """Set ``req_id`` and ``text`` from the tags, however the tool spells them."""
    for attribute, tag_name in (("req_id", "id"), ("text", "text")):
        value = tag(graph, requirement, tag_name)
        if value is not None:
            shown = readable(value) if isinstance(value, str) else value
            graph.set(requirement, **{attribute: shown})


def readable(text: str) -> str:
    """The text itself, or the words of an HTML document: MagicDraw keeps formatted text so."""
    if not text.lstrip()[:6].lower().startswith("<html"):
        return text
    from sysmlc.passes.classify.formatted import words

    return words(text)


# -- rules -------------------------------------------------------------------------------------


def check_requirements(graph: Graph, sink: Sink) -> None:
    """Report missing and repeated ids, and copies whose text is not their master's."""
    known: dict[str, list[Element]] = {}
    for requirement in (one for one in graph.of_kind(*_KINDS) if one.role == "requirement"):
        id = str(requirement.attrs.get("req_id", "")).strip()
        if id:
            known.setdefault(id, []).append(requirement)
        elif not requirement.attrs.get("external") and requirement.kind is not Kind.REQUIREMENT:
            name = graph.qualified_name(requirement)
            sink.report(NO_ID, graph.subject(requirement), requirement=name)
    for id, requirements in known.items():
        _report_repeated(graph, sink, id, requirements)
    for dependency in graph.of_kind(Kind.DEPENDENCY):
        if dependency.role == "copy":
            _check_copy(graph, sink, dependency)


def _report_repeated(graph: Graph, sink: Sink, id: str, requirements: list[Element]) -> None:
    first = graph.qualified_name(requirements[0])
    for other in requirements[1:]:
        name = graph.qualified_name(other)
        sink.report(REPEATED_ID, graph.subject(other), id=id, requirement=name, first=first)


def _check_copy(graph: Graph, sink: Sink, dependency: Element) -> None:
    for copy in graph.targets(dependency, Edge.CLIENT):
        for master in graph.targets(dependency, Edge.SUPPLIER):
            own, others = _text(copy), _text(master)
            # A copy without a text of its own takes its master's: MagicDraw leaves it empty.
            if own and others and own != others:
                names = graph.qualified_name(copy), graph.qualified_name(master)
                subject = graph.subject(dependency)
                sink.report(COPY_DIFFERS, subject, copy=names[0], master=names[1])


def _text(requirement: Element) -> str:
    return " ".join(str(requirement.attrs.get("text", "")).split())
