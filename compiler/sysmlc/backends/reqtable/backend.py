"""Two files for each root of the model that holds requirements, and what they leave open."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.reqtable.rules import BAD_TEMPLATE
from sysmlc.backends.reqtable.table import Table, tables
from sysmlc.backends.reqtable.text import csv_text, markdown_cell
from sysmlc.backends.reqtable.unmet import report_open
from sysmlc.backends.templates import TemplateError, Templates
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Graph
from sysmlc.support.escapes import escape_markdown
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.output import Output

_TEMPLATE = "requirements.md.j2"
_ALWAYS = ("id", "name")


class ReqTableBackend(Struct, frozen=True):
    """Requirement tables for people (Markdown) and for other tools (CSV)."""

    name: str = "reqtable"
    summary: str = "requirement tables as CSV and Markdown"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``requirements/<root>.requirements.csv`` and ``.md``; report open requirements."""
        found = {_free(table.name, number): table for number, table in _number_tables(graph)}
        names = assign_file_names(found)
        with Templates(self.name, options.templates) as templates:
            for key, table in found.items():
                path = f"requirements/{names[key]}.requirements"
                output.add(f"{path}.csv", csv_text(table), table.trace(), self.name)
                text = _markdown(table, sink, templates)
                if text:
                    output.add(f"{path}.md", text, table.trace(), self.name)
        report_open(graph, [row.element for table in found.values() for row in table.rows], sink)


def _number_tables(graph: Graph) -> Iterator[tuple[int, Table]]:
    counts: dict[str, int] = {}
    for table in tables(graph):
        counts[table.name] = counts.get(table.name, 0) + 1
        yield counts[table.name], table


def _free(name: str, number: int) -> str:
    return name if number == 1 else f"{name}-{number}"


def _markdown(table: Table, sink: Sink, templates: Templates) -> str:
    # A column in which nothing stands only makes a page wide; a CSV file keeps its columns.
    shown = [at for at, name in enumerate(table.columns) if name in _ALWAYS or _is_used(table, at)]
    page = {
        "title": escape_markdown(table.name),
        "columns": [escape_markdown(table.columns[at]) for at in shown],
        "rows": [[markdown_cell(row.cells[at]) for at in shown] for row in table.rows],
    }
    try:
        return templates.render(_TEMPLATE, page=page)
    except TemplateError as fault:
        sink.report(BAD_TEMPLATE, Subject(_TEMPLATE), fault=fault)
        return ""


def _is_used(table: Table, at: int) -> bool:
    return any(row.cells[at].values for row in table.rows)


BACKEND = ReqTableBackend()
