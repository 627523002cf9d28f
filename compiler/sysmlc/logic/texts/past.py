"""Reader of temporal logic with operators of the past: Y, O, H, S."""

from collections.abc import Mapping

from msgspec.structs import replace

from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import has_primes
from sysmlc.logic.formula import Formula, Op
from sysmlc.logic.infix import Part, Reader
from sysmlc.logic.reduction.rules import is_ahead
from sysmlc.logic.spelling import NEUTRAL, PAST, PAST_WORDS, Cursor, FormulaError, tokens

_SYNTAX = replace(
    NEUTRAL,
    prefix={**NEUTRAL.prefix, **PAST_WORDS},
    infix={**NEUTRAL.infix, "S": Op.SINCE},
)


def read_past(text: str, variables: Mapping[str, Domain]) -> Formula:
    """The formula that a text in the neutral form with the past is. Raises FormulaError."""
    reader = _PastReader(Cursor(tokens(text, _SYNTAX)), _SYNTAX, variables)
    formula = reader.formula()
    if reader.cursor.next.kind != "end":
        reader.cursor.fail()
    return formula


class _PastReader(Reader):
    """Y, O, H and S of what is known by then."""

    def _prefixed(self, op: Op, weakest: int) -> Part:
        made = super()._prefixed(op, weakest)
        return self._known(op, made)

    def _applied(self, op: Op, left: Part) -> Part:
        return self._known(op, super()._applied(op, left))

    def _known(self, op: Op, made: Part) -> Part:
        args = getattr(made.formula, "args", ())
        if op in PAST and any(is_ahead(arg) or has_primes(arg) for arg in args):
            raise FormulaError(f"'{op}' cannot look back at what is yet to come", made.at)
        return made
