"""Symbolic controllers as JSON (metamodels/sysmlc-controller.schema.json)."""

from collections.abc import Iterable, Iterator

from sysmlc.logic.contract import Contract
from sysmlc.support.json_text import append_members, encode_row
from sysmlc.synthesis.controllers.machine_text import declared
from sysmlc.synthesis.controllers.table import Entry, Table

FORMAT = "sysmlc-controller/1"
_A_LINE = 8
"""Nodes on a line."""


def json_of(table: Table, contract: Contract) -> str:
    """Return the table as a JSON file with several nodes on a line."""
    head = {
        "format": FORMAT,
        "name": contract.component,
        "origin": contract.origin,
        "inputs": [declared(one) for one in table.inputs],
        "outputs": [declared(one) for one in table.outputs],
    }
    members = (
        _encode_list("bits", _encode_bits(table)),
        _encode_list("nodes", _encode_nodes(table)),
        f'  "first": {_encode_entry(table.first)}',
        _encode_list("modes", map(_encode_entry, table.modes)),
    )
    return append_members(head, members)


def _encode_list(name: str, rows: Iterable[str]) -> str:
    lines = ",\n".join(f"    {row}" for row in rows)
    return f'  "{name}": [\n{lines}\n  ]' if lines else f'  "{name}": []'


def _encode_bits(table: Table) -> Iterator[str]:
    for bit in table.bits:
        step = "before" if bit.is_before else "now"
        yield encode_row({"variable": bit.variable, "bit": bit.place, "step": step})


def _encode_nodes(table: Table) -> Iterator[str]:
    for start in range(0, len(table.nodes), _A_LINE):
        yield ", ".join(map(encode_row, table.nodes[start : start + _A_LINE]))


def _encode_entry(entry: Entry) -> str:
    return encode_row({"outputs": entry.outputs, "next": entry.onward})
