"""Cells as CSV (RFC 4180) and as Markdown, safe for spreadsheets and for renderers."""

import csv
import io

from sysmlc.backends.reqtable.table import Cell, Table
from sysmlc.support.escapes import escape_markdown

_FORMULA = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")
"""First characters that make a spreadsheet calculate (OWASP, CSV injection)."""


def csv_text(table: Table) -> str:
    """The table with a header row; lines end with CR LF, line ends inside a cell are LF."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerow(table.columns)
    for row in table.rows:
        writer.writerow(_plain(cell) for cell in row.cells)
    return stream.getvalue()


def _plain(cell: Cell) -> str:
    text = "\n".join("\n".join(value.splitlines()) for value in cell.values)
    return f"'{text}" if text.startswith(_FORMULA) or text.lstrip().startswith(_FORMULA) else text


def markdown_cell(cell: Cell) -> str:
    """The values on lines of their own; what Markdown or HTML would read is escaped."""
    rows = (row for value in cell.values for row in value.splitlines())
    return "<br>".join(escape_markdown(row) for row in rows if row.strip())
