"""Requirements: their id and text in every dialect, and the rules that hold between them."""

from html.parser import HTMLParser

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS, tag

REPEATED_ID = rule(
    "SM213",
    "repeated-requirement-id",
    Severity.WARNING,
    "requirement '{requirement}' has the id {id}, as '{first}' has",
    help="give each requirement an id of its own",
)
NO_ID = rule(
    "SM214",
    "requirement-without-id",
    Severity.INFO,
    "requirement '{requirement}' has no id",
    help="fill in the tag id (Papyrus) or Id (MagicDraw, Cameo) of «Requirement»",
)
COPY_DIFFERS = rule(
    "SM215",
    "copy-with-other-text",
    Severity.WARNING,
    "requirement '{copy}' is a copy of '{master}' and has another text",
    help="copy the text of '{master}', or replace «copy» by «deriveReqt»",
)


_KINDS = (*CLASSIFIERS, Kind.PACKAGE, Kind.OPERATION)


def complete_requirement(graph: Graph, requirement: Element) -> None:
    """Set ``req_id`` and ``text`` from the tags, whose case depends on the tool."""
    for attribute, tag_name in (("req_id", "id"), ("text", "text")):
        value = tag(graph, requirement, tag_name)
        if value is not None:
            text = _extract_text(value) if isinstance(value, str) else value
            graph.set(requirement, **{attribute: text})


# -- rules -------------------------------------------------------------------------------------


def check_requirements(graph: Graph, sink: Sink) -> None:
    """Report missing and repeated ids, and copies with another text than their master."""
    by_id: dict[str, list[Element]] = {}
    for requirement in (
        element for element in graph.of_kind(*_KINDS) if element.role == "requirement"
    ):
        id = str(requirement.attrs.get("req_id", "")).strip()
        if id:
            by_id.setdefault(id, []).append(requirement)
        elif not requirement.attrs.get("external") and requirement.kind is not Kind.REQUIREMENT:
            name = graph.qualified_name(requirement)
            sink.report(NO_ID, graph.subject(requirement), requirement=name)
    for id, requirements in by_id.items():
        _report_repeated(graph, sink, id, requirements)
    for dependency in graph.of_kind(Kind.DEPENDENCY):
        if dependency.role == "copy":
            _check_copy(graph, sink, dependency)


def _report_repeated(graph: Graph, sink: Sink, id: str, requirements: list[Element]) -> None:
    first = graph.qualified_name(requirements[0])
    for requirement in requirements[1:]:
        name = graph.qualified_name(requirement)
        subject = graph.subject(requirement)
        cause = f"id {id}"
        sink.report(REPEATED_ID, subject, cause=cause, id=id, requirement=name, first=first)


def _check_copy(graph: Graph, sink: Sink, dependency: Element) -> None:
    for copy in graph.targets(dependency, Edge.CLIENT):
        for master in graph.targets(dependency, Edge.SUPPLIER):
            copy_text, master_text = _normalise_text(copy), _normalise_text(master)
            # MagicDraw leaves the text of a copy empty; it then has the text of its master.
            if copy_text and master_text and copy_text != master_text:
                names = graph.qualified_name(copy), graph.qualified_name(master)
                subject = graph.subject(dependency)
                sink.report(COPY_DIFFERS, subject, copy=names[0], master=names[1])


def _normalise_text(requirement: Element) -> str:
    return " ".join(str(requirement.attrs.get("text", "")).split())


_BLOCK_TAGS = frozenset(["p", "br", "li", "tr", "div", "h1", "h2", "h3", "h4", "ul", "ol", "table"])
_SILENT_TAGS = frozenset(["head", "style", "script"])


def _extract_text(text: str) -> str:
    """Return a text without markup: MagicDraw stores formatted texts as HTML documents.

    The result has one line for each block element.
    """
    if not text.lstrip()[:6].lower().startswith("<html"):
        return text
    parser = _TextExtractor()
    parser.feed(text)
    parser.close()
    rows = (" ".join(row.split()) for row in "".join(parser.fragments).splitlines())
    return "\n".join(row for row in rows if row)


class _TextExtractor(HTMLParser):
    """Collects the text outside of head, style and script elements."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.fragments: list[str] = []
        self._silent_depth = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._silent_depth += tag in _SILENT_TAGS
        if tag in _BLOCK_TAGS:
            self.fragments.append("\n")

    def handle_endtag(self, tag: str) -> None:
        # Documents of tools may have an end tag without a start tag.
        self._silent_depth = max(0, self._silent_depth - (tag in _SILENT_TAGS))
        if tag in _BLOCK_TAGS:
            self.fragments.append("\n")

    def handle_data(self, data: str) -> None:
        if not self._silent_depth:
            self.fragments.append(data.replace("\n", " "))
