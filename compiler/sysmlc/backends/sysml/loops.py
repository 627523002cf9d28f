"""Loops over the elements of a collection: expansion regions that SysML v2 has a word for."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.expressions import expression
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Element


def over(book: Book, entry: Entry, element: Element) -> str:
    """``for p in belt.pallets``, when the text can say the collection; else the empty string.

    What declares the variable is said by it.
    """
    is_loop = element.subkind == "expansion" and element.attrs.get("mode") == "iterative"
    given = element.attrs.get("collection")
    variable = next((one for one in entry.members if _is_variable(one)), None)
    if not is_loop or not isinstance(given, str) or variable is None:
        return ""
    found = expression(book, entry.parent, given)
    if found is None:
        return ""
    book.declared.add(id(variable))
    book.loops.add(element.id)
    if variable.element is not None:
        book.said.add(variable.element.id)
    return f"for {quoted(variable.name)} in {found}"


def _is_variable(entry: Entry) -> bool:
    return entry.element is not None and entry.element.subkind == "variable"
