"""The back end ``reqtable``: requirements as tables in CSV and Markdown."""

import csv
import io
from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.reqtable.table import Cell, Table, is_listed, make_tables
from sysmlc.backends.templates import TemplateError, Templates
from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.ir import Edge, Element, Graph
from sysmlc.ir.query import generals, list_restated
from sysmlc.support.escapes import escape_markdown
from sysmlc.support.output import Output, assign_file_names

BAD_TEMPLATE = rule(
    "SM717",
    "bad-requirement-template",
    Severity.ERROR,
    "the template requirements.md.j2 cannot be used: {fault}",
    help="compare it with templates/reqtable of sysmlc",
)

_TEMPLATE = "requirements.md.j2"
_MANDATORY_COLUMNS = ("id", "name")
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")
"""Start of a cell that a spreadsheet evaluates as a formula (OWASP, CSV injection)."""


class ReqTableBackend(Struct, frozen=True):
    """Writes requirement tables for people (Markdown) and for other tools (CSV)."""

    name: str = "reqtable"
    summary: str = "requirement tables as CSV and Markdown"
    is_default: bool = False
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``requirements/<root>.requirements.csv`` and ``.md``; report open requirements."""
        tables = dict(_iter_named_tables(graph))
        file_names = assign_file_names(tables)
        with Templates(self.name, options.templates) as templates:
            for name, table in tables.items():
                path = f"requirements/{file_names[name]}.requirements"
                trace = tuple(table.trace())
                output.add(f"{path}.csv", format_csv(table), trace, self.name, name=table.name)
                try:
                    text = templates.render(_TEMPLATE, page=_make_page(table))
                except TemplateError as fault:
                    sink.report(BAD_TEMPLATE, Subject(_TEMPLATE), fault=fault)
                    continue
                if text:
                    output.add(f"{path}.md", text, trace, self.name, name=table.name)
        requirements = [row.element for table in tables.values() for row in table.rows]
        _report_open_requirements(graph, requirements, sink)


BACKEND = ReqTableBackend()


def _iter_named_tables(graph: Graph) -> Iterator[tuple[str, Table]]:
    """Yield the tables with their names; the second table of a name gets the suffix ``-2``."""
    counts: dict[str, int] = {}
    for table in make_tables(graph):
        counts[table.name] = number = counts.get(table.name, 0) + 1
        yield table.name if number == 1 else f"{table.name}-{number}", table


# -- CSV ---------------------------------------------------------------------------------------


def format_csv(table: Table) -> str:
    """Return the table with a header row (RFC 4180).

    Rows end with CR LF; line ends inside a cell are LF.
    """
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerow(table.columns)
    for row in table.rows:
        writer.writerow(_format_csv_cell(cell) for cell in row.cells)
    return stream.getvalue()


def _format_csv_cell(cell: Cell) -> str:
    """Return the values on separate lines, quoted if a spreadsheet would evaluate the cell."""
    text = "\n".join("\n".join(value.splitlines()) for value in cell.values)
    return f"'{text}" if text.startswith(_FORMULA) or text.lstrip().startswith(_FORMULA) else text


# -- Markdown ----------------------------------------------------------------------------------


def _make_page(table: Table) -> dict[str, object]:
    """Return the values that the template prints."""
    # An empty column only makes a page wide; a CSV file keeps its columns.
    columns = [
        (index, name)
        for index, name in enumerate(table.columns)
        if name in _MANDATORY_COLUMNS or any(row.cells[index].values for row in table.rows)
    ]
    return {
        "title": escape_markdown(table.name),
        "columns": [escape_markdown(name) for _, name in columns],
        "rows": [
            [format_markdown_cell(row.cells[index]) for index, _ in columns] for row in table.rows
        ],
    }


def format_markdown_cell(cell: Cell) -> str:
    """Return the values on separate lines, with all markup escaped."""
    lines = (line for value in cell.values for line in value.splitlines())
    return "<br>".join(escape_markdown(line) for line in lines if line.strip())


# -- open requirements -----------------------------------------------------------------------------

UNSATISFIED = rule(
    "SM715",
    "unsatisfied-requirement",
    Severity.INFO,
    "nothing satisfies requirement '{requirement}'",
    help="draw «satisfy» from the block or behaviour to the requirement",
)
UNVERIFIED = rule(
    "SM716",
    "unverified-requirement",
    Severity.INFO,
    "nothing verifies requirement '{requirement}'",
    help="draw «verify» from a test case to the requirement",
)


def _report_open_requirements(graph: Graph, requirements: list[Element], sink: Sink) -> None:
    """Report each requirement that nothing satisfies, and each that nothing verifies."""
    for open_rule, edge in ((UNSATISFIED, Edge.SATISFIES), (UNVERIFIED, Edge.VERIFIES)):
        closed = _find_closed(graph, requirements, edge)
        for requirement in requirements:
            if requirement.id not in closed:
                name = graph.qualified_name(requirement)
                sink.report(open_rule, graph.subject(requirement), requirement=name)


def _find_closed(graph: Graph, requirements: Iterable[Element], edge: Edge) -> frozenset[str]:
    """Return the ids of the requirements with a relation *edge*, directly or by implication.

    A compound requirement is satisfied if all requirements in it are (SysML 1.6 clause 16.3.1), and
    a requirement is satisfied if one derived from it is. So is a definition if all its usages are.
    """
    worklist = [element for element in requirements if _has_relation(graph, element, edge)]
    closed = {requirement.id for requirement in worklist}
    for requirement in worklist:
        for implied in _iter_implied(graph, requirement, closed):
            if implied.id not in closed:
                closed.add(implied.id)
                worklist.append(implied)
    return frozenset(closed)


def _has_relation(graph: Graph, requirement: Element, edge: Edge) -> bool:
    # A SysML v2 requirement leads to its subject itself; a usage has that of its definition.
    family = (requirement, *generals(graph, requirement))
    has_subject = edge is Edge.SATISFIES and any(
        graph.targets(member, Edge.SUBJECT) for member in family
    )
    restated = list_restated(graph, requirement)
    return has_subject or any(graph.sources(member, edge) for member in restated)


def _iter_implied(graph: Graph, requirement: Element, closed: set[str]) -> Iterator[Element]:
    """Yield the requirements that have the relation because *requirement* has it."""
    yield from graph.targets(requirement, Edge.DERIVES)
    for general in graph.targets(requirement, Edge.SPECIALIZES):
        specials = filter(is_listed, graph.sources(general, Edge.SPECIALIZES))
        if is_listed(general) and all(special.id in closed for special in specials):
            yield general
    owner = graph.owner(requirement)
    if owner is not None and is_listed(owner):
        contained = [element for element in graph.owned(owner) if is_listed(element)]
        if all(element.id in closed for element in contained):
            yield owner
