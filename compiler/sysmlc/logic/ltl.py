"""Reader of formulas: the neutral form that ``printing`` writes, and SPIN's spelling of LTL."""

from collections.abc import Mapping

from sysmlc.logic.contract import Domain
from sysmlc.logic.formula import Formula
from sysmlc.logic.infix import Reader
from sysmlc.logic.spelling import NEUTRAL, Cursor, FormulaError, line_and_column, tokens

__all__ = ["FormulaError", "line_and_column", "parse_formula"]


def parse_formula(
    text: str, variables: Mapping[str, Domain], reader: type[Reader] = Reader
) -> Formula:
    """Read a formula; a name is a variable, or a literal when an enumeration asks for it.

    Raises FormulaError, which says where, when the text is no formula or names what is neither.
    """
    reading = reader(Cursor(tokens(text, NEUTRAL)), NEUTRAL, variables)
    formula = reading.formula()
    if reading.cursor.next.kind != "end":
        reading.cursor.fail()
    return formula
