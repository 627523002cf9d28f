"""Symbolic controllers as JSON (metamodels/sysmlc-controller.schema.json)."""

from collections.abc import Iterator

from sysmlc.logic.contract import Contract
from sysmlc.output import json_text
from sysmlc.synthesis.controllers.machine_text import declared
from sysmlc.synthesis.controllers.table import Entry, Table

FORMAT = "sysmlc-controller/1"
_A_LINE = 8
"""Nodes on a line."""


def json_of(table: Table, contract: Contract) -> str:
    """The table as JSON text."""
    head = {
        "format": FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [declared(one) for one in table.inputs],
        "outputs": [declared(one) for one in table.outputs],
    }
    parts = (
        _rows("bits", _bits(table)),
        _rows("nodes", _nodes(table)),
        f'  "first": {_entry(table.first)}',
        _rows("modes", map(_entry, table.modes)),
    )
    return f"{json_text(head, 2)[:-2]},\n" + ",\n".join(parts) + "\n}\n"


def _rows(name: str, rows: Iterator[str]) -> str:
    lines = ",\n".join(f"    {row}" for row in rows)
    return f'  "{name}": [\n{lines}\n  ]' if lines else f'  "{name}": []'


def _bits(table: Table) -> Iterator[str]:
    for one in table.bits:
        step = "before" if one.is_before else "now"
        name = json_text(one.variable, 0)
        yield f'{{"variable": {name}, "bit": {one.place}, "step": "{step}"}}'


def _nodes(table: Table) -> Iterator[str]:
    for at in range(0, len(table.nodes), _A_LINE):
        yield ", ".join(str(list(one)) for one in table.nodes[at : at + _A_LINE])


def _entry(entry: Entry) -> str:
    return f'{{"outputs": {list(entry.outputs)}, "next": {list(entry.onward)}}}'
