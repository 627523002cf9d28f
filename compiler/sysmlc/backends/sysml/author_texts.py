"""Texts of SysML v2 and KerML among the inputs, which the output repeats byte for byte.

Members that passes add to an element of such a text stand at the end of its body.
"""

from collections.abc import Iterable, Iterator, Mapping

from sysmlc.backends.sysml.printing import INDENT, Line, print_lines
from sysmlc.backends.sysml.rules import UNCHANGED_TEXT
from sysmlc.backends.sysml.writer import Writer
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Element, Graph
from sysmlc.language.library import SHIPPED
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, byte_order_mark_length
from sysmlc.overlay import Change
from sysmlc.support.output import make_path_of_input

BYTE_ORDER_MARK = "\ufeff"
_BLANKS = " \t"
_RESULT = "ResultExpressionMembership"
"""Membership of an expression without a semicolon, which ends the body of a constraint."""

Insertions = Mapping[Element, list[Line]]
"""Elements of texts with the lines of the members that passes added to them."""


def list_texts(graph: Graph) -> list[Document]:
    """Return the texts of the unit, without interchange files and libraries of sysmlc."""
    return [
        document
        for model in graph.derived(Model)
        for document in model.documents
        if document.source is not None
        and not document.path.startswith(SHIPPED)
        and (document.text or not document.source.data)
    ]


def path_of_text(document: Document) -> str:
    """Return the path of a text below the folder of the back end."""
    return make_path_of_input(document.path)


def is_whole_model(graph: Graph, author_files: frozenset[str]) -> bool:
    """Whether the texts contain all elements of the model."""
    return all(element.source in author_files or element.attrs.get("external") for element in graph)


# -- members that passes add -------------------------------------------------------------------


def write_insertions(writer: Writer) -> None:
    """Write the members that passes added to elements of the texts."""
    plan = writer.plan
    stack = [root for root in plan.roots if plan.is_author_member(root)]
    while stack:
        namespace = stack.pop()
        author_members = [m for m in namespace.members if plan.is_author_member(m)]
        added_members = [m for m in namespace.members if not plan.is_author_member(m)]
        lines = [line for member in added_members for line in writer.write_member(member)]
        lines += namespace.take_added_lines()
        if lines:
            writer.insertions[namespace.require_element()] = lines
        stack.extend(author_members)


def report_changes(graph: Graph, author_files: frozenset[str], sink: Sink) -> None:
    """Report the facts of overlays about elements of the texts: only members are inserted."""
    for change in graph.derived(Change):
        element = graph.get(change.element_id)
        if element is not None and element.source in author_files:
            name = graph.qualified_name(element)
            subject = Subject(name, element.id, change.place)
            file = element.source
            sink.report(UNCHANGED_TEXT, subject, name=name, fact=change.fact, file=file)


def edit_text(document: Document, insertions: Insertions) -> str:
    """Return the text of a file with the lines at the end of the bodies of their owners."""
    mark = BYTE_ORDER_MARK if byte_order_mark_length(document.source) else ""
    text = document.text
    edits = [
        _make_edit(document, owner, lines)
        for owner, lines in insertions.items()
        if owner.source == document.path
    ]
    for start, end, replacement in sorted(edits, reverse=True):
        text = text[:start] + replacement + text[end:]
    return mark + text


def _make_edit(document: Document, owner: Element, lines: list[Line]) -> tuple[int, int, str]:
    """Return the range of the text to replace, and its replacement."""
    text = document.text
    node = _find_node(document, owner)
    indent = _read_indent(text, node.start)
    rows = print_lines(lines).rstrip("\n").split("\n")
    body = "".join(f"{indent}{INDENT}{row}\n" if row else "\n" for row in rows)
    result = next((m for m in node.members if m.membership == _RESULT), None)
    if result is not None:
        replacement = f"{body}{indent}{INDENT}".lstrip(_BLANKS)
        return _finish_edit(text, result.start, result.start, replacement)
    last = node.end - 1
    if text[last] != "}":
        return _finish_edit(text, last, node.end, f" {{\n{body}{indent}}}")
    start = len(text[:last].rstrip(_BLANKS))
    return _finish_edit(text, start, last, f"\n{body}{indent}")


def _finish_edit(text: str, start: int, end: int, replacement: str) -> tuple[int, int, str]:
    """Return an edit with the line ends of the text, without an empty line before it."""
    if text[:start].endswith("\n"):
        replacement = replacement.removeprefix("\n")
    return start, end, replacement.replace("\n", "\r\n") if "\r\n" in text else replacement


def _read_indent(text: str, start: int) -> str:
    """Return the blanks at the start of the line that contains a character."""
    line = text[text.rfind("\n", 0, start) + 1 : start]
    return line[: len(line) - len(line.lstrip(_BLANKS))]


def _find_node(document: Document, element: Element) -> Node:
    """Return the outermost node at the location of an element, a namesake if there is one."""
    offset = document.byte_offsets.character_at(element.ordinal)
    nodes = list(_iter_nodes_at(document.root.members, offset))
    namesakes = (node for node in nodes if node.name == element.name)
    return next(namesakes, None) or nodes[0]


def _iter_nodes_at(roots: Iterable[Node], offset: int) -> Iterator[Node]:
    for root in roots:
        for node in root.walk():
            if offset == (node.name_start if node.name_start >= 0 else node.start):
                yield node
