"""Names of units in other languages, and what the libraries of SysML v2 call them."""

from functools import cache

from sysmlc.diagnostics import Sink
from sysmlc.language.names.model import Model
from sysmlc.language.text import parse
from sysmlc.language.text.spelling import quote_name
from sysmlc.support import resources
from sysmlc.support.units import find_unit


def find_unit_name(model: Model, name: str) -> str:
    """Return the qualified name of the unit that users write as *name*, or nothing.

    SI of the standard library lacks some units of plants, which the library of sysmlc has.
    """
    unit = find_unit(name)
    symbol = name if unit is None else unit.symbol
    for candidate in (name, symbol, symbol.replace("·", "⋅")):
        if model.find(f"SI::{candidate}") is not None:
            return f"SI::{quote_name(candidate)}"
        if candidate in _list_shipped_units():
            return f"SysMLC::Units::{quote_name(candidate)}"
    return ""


@cache
def _list_shipped_units() -> frozenset[str]:
    """Return the symbols in the package of units that every model may use."""
    text = resources.read_text("metamodels", "SysMLC.sysml")
    root = parse(text, "SysMLC.sysml", "sysml", Sink()).root
    units = next(node for node in root.walk() if node.name == "Units")
    return frozenset(str(unit.short_name or unit.name) for unit in units.members)
