"""slugsin: formulas in prefix notation over Booleans, ``$ n a b ? i`` for what is used again.

Source: slugs, doc/input_formats.md and examples.
"""

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Contract
from sysmlc.logic.formats import slugs
from sysmlc.logic.formats.base import game, lowered
from sysmlc.logic.formats.counting import in_bits
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import each_formula
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.simplify import rebuild


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file; a line in structured slugs is understood too."""
    return slugs.read(file)


def plain(contract: Contract, form: str) -> Contract:
    """The contract over bits, with not, and, or, exclusive or. Raises NotExpressibleError."""
    made = game(contract, form, primed_liveness=True)
    return lowered(made, form, lambda one: each_formula(in_bits(one), _without_implication))


def _without_implication(formula: Formula) -> Formula:
    match formula:
        case Apply(Op.IMPLIES, (left, right)):
            left, right = _without_implication(left), _without_implication(right)
            return f.either(f.negate(left), right)
        case Apply(op, args):
            return rebuild(op, tuple(map(_without_implication, args)))
        case _:
            return formula


def write(contract: Contract, form: str) -> str:
    """The contract over bits."""
    return slugs.sections(
        plain(contract, form), lambda one: _prefix(one.formula), lambda one: one.name
    )


def _prefix(formula: Formula) -> str:
    match formula:
        case Const(value):
            return "1" if value else "0"
        case Var(name, primed):
            return f"{name}'" if primed else name
        case Apply(op, args):
            return _applied(op, [_prefix(arg) for arg in args])


def _applied(op: Op, texts: list[str]) -> str:
    match op:
        case Op.NOT:
            return f"! {texts[0]}"
        case Op.IFF:
            return f"! ^ {texts[0]} {texts[1]}"
        case _:
            return f"{f'{op} ' * (len(texts) - 1)}{' '.join(texts)}"
