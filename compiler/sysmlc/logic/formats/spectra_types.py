"""Types of Spectra: ``boolean``, ``{A, B}``, ``Int(0..7)``, and names for them."""

from collections.abc import Callable

from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.formula import Const
from sysmlc.logic.infix import Part
from sysmlc.logic.spelling import Cursor, FormulaError

Constant = Callable[[], Part]
"""Reads a bound that is no number but the name of one."""


class Types:
    """Reads types; ``named`` are those that the file defines."""

    def __init__(self, cursor: Cursor) -> None:
        self._cursor = cursor
        self.named: dict[str, Domain] = {}

    def read(self, constant: Constant) -> Domain:
        """The type that comes next. Raises FormulaError."""
        cursor = self._cursor
        if cursor.took("boolean"):
            return BooleanDomain()
        if cursor.took("{"):
            return self._literals()
        if cursor.took("Int"):
            cursor.expect("(")
            return self.range(constant, ")")
        name = cursor.expect_kind("name", "a type")
        if name.text not in self.named:
            raise FormulaError(f"'{name.text}' is no type", name.at)
        return self.named[name.text]

    def _literals(self) -> Domain:
        found: list[str] = []
        while not found or self._cursor.took(","):
            token = self._cursor.next
            if token.kind not in ("name", "number"):
                self._cursor.fail("a value is expected")
            if token.text in found:
                raise FormulaError(f"'{token.text}' is there twice", token.at)
            found.append(self._cursor.take().text)
        self._cursor.expect("}")
        return EnumerationDomain(tuple(found))

    def range(self, constant: Constant, end: str) -> IntegerDomain:
        """``0..7`` up to a closing sign. Raises FormulaError."""
        at = self._cursor.next.at
        low = self._bound(constant)
        self._cursor.expect("..")
        high = self._bound(constant)
        self._cursor.expect(end)
        if low > high:
            raise FormulaError(f"the range {low}..{high} is empty", at)
        return IntegerDomain(low, high)

    def _bound(self, constant: Constant) -> int:
        token = self._cursor.next
        if token.kind != "name":
            return self._cursor.integer()
        part = constant()
        if not isinstance(part.formula, Const) or not isinstance(part.formula.value, int):
            raise FormulaError(f"'{token.text}' is no number", token.at)
        return part.formula.value
