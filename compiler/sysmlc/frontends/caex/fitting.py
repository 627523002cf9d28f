"""Values that their data types do not have, and data types that XML Schema does not have."""

from sysmlc.diagnostics import Severity, rule
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.datatypes import NAMES, PRIMITIVES, Reader, local, meant, reader_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.ir import AttrValue

UNFIT = rule(
    "SM631",
    "value-not-of-data-type",
    Severity.WARNING,
    "the value '{value}' of '{element}'{more} is no {data_type}",
    help="{hint}",
)
UNKNOWN_TYPE = rule(
    "SM632",
    "unknown-data-type",
    Severity.WARNING,
    "the data type '{data_type}' of '{element}' is none of XML Schema; {hint}",
)

_HINTS = {
    "Real": "write a number with a decimal point and without a unit",
    "Integer": "write a whole number that the data type has room for",
    "Boolean": "write true or false",
    "": "write it in the form that XML Schema has for the data type, as 2026-11-21 for a date",
}


def data_type_of(stated: str, type: Type | None) -> str:
    """The data type of an attribute: its own, else that of the attribute type."""
    chain = () if stated or type is None else type.chain()
    inherited = (one.node.attributes.get("AttributeDataType", "") for one in chain)
    return stated or next(filter(None, inherited), "")


def reader(stated: str, type: Type | None) -> Reader | None:
    """How values of an attribute are read; they stay texts where only its type says more.

    The reader raises ValueError for what the data type does not have.
    """
    found = reader_of(data_type_of(stated, type))
    return found if stated or found is None else _checked(found)


def _checked(read: Reader) -> Reader:
    def check(text: str) -> AttrValue:
        read(text)
        return text

    return check


def value(context: Context, node: Node, text: str, stated: str, type: Type | None) -> AttrValue:
    """The value that a text in a node means; noted when the data type does not have it."""
    read = reader(stated, type)
    try:
        return text if read is None else read(text)
    except ValueError:
        return unfit(context, node.document, node.row, text, data_type_of(stated, type), stated)


def unfit(
    context: Context, document: Document, row: int, text: str, data_type: str, stated: str
) -> AttrValue:
    """What is meant by a text that its data type does not have; nothing is said by an empty one."""
    if text.strip():
        rows = context.unfit.setdefault((document, data_type, text), [])
        if row not in rows[-1:]:
            rows.append(row)
    return meant(text, stated)


def know(context: Context, document: Document, row: int, data_type: str) -> None:
    """Note the data type of a row when XML Schema has none of its name."""
    if data_type and local(data_type) not in NAMES:
        context.unknown_types.setdefault((document, data_type), row)


def report(context: Context) -> None:
    """Tell of each such value, and of each such data type, once a file."""
    for (document, data_type, text), rows in context.unfit.items():
        hint = _HINTS[PRIMITIVES.get(local(data_type), "")]
        facts = {"value": text, "data_type": data_type, "hint": hint}
        context.report(UNFIT, document, document.node(rows[0]), **_named(document, rows), **facts)
    for (document, data_type), row in context.unknown_types.items():
        facts = {"data_type": data_type, "hint": _near(local(data_type))}
        facts["element"] = document.node(row).name
        context.report(UNKNOWN_TYPE, document, document.node(row), **facts)


def _named(document: Document, rows: list[int]) -> dict[str, str]:
    more = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
    return {"element": document.node(rows[0]).name, "more": more}


def _near(name: str) -> str:
    """The data type that was meant, when only its spelling is wrong."""
    from difflib import get_close_matches

    folded = {known.casefold(): known for known in sorted(NAMES)}
    near = get_close_matches(name.casefold(), folded, n=1, cutoff=0.8)
    return f"did you mean 'xs:{folded[near[0]]}'?" if near else "its values count as text"
