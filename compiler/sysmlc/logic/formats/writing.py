"""Writers' common part: formulas in the notation of a format, and the limits of a format."""

from collections.abc import Callable, Iterator, Mapping

from msgspec import Struct

from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formats.draft import SIDES
from sysmlc.logic.formats.lowering import TooManyValuesError
from sysmlc.logic.formula import (
    Apply,
    Const,
    Formula,
    Literal,
    Op,
    Var,
    has_primes,
    replace_leaves,
    variables,
)
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.logic.reduction.contract_reduction import (
    is_gr1,
    reduce_contract,
    state_assumptions_of_inputs,
)
from sysmlc.logic.syntax import ARITHMETIC, COMPARISONS

_PREFIX = (Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY)
LTL_WORDS = {op: str(op) for op in Op}


class NotExpressibleError(ValueError):
    """A contract that a format cannot express; ``conjunct`` is the first such conjunct, if any."""

    def __init__(self, format_name: str, reason: str, conjunct: Conjunct | None = None) -> None:
        self.format_name, self.reason, self.conjunct = format_name, reason, conjunct
        subject = f"'{print_formula(conjunct.formula)}': " if conjunct else ""
        super().__init__(f"{format_name} cannot say {subject}{reason}")


def add_prime(name: str) -> str:
    """Return ``x'``, the next value of a variable."""
    return f"{name}'"


def add_next_operator(name: str) -> str:
    """Return ``X x``, the next value of a Boolean variable."""
    return f"X {name}"


class Notation(Struct, frozen=True):
    """Spelling of formulas in a format, with parentheses around every operand that is compound.

    Formats differ in the precedence of their operators, so parentheses are written wherever a
    reader could doubt.
    """

    words: Mapping[Op, str]
    next_value: Callable[[str], str]
    """Spells the value of a variable in the next step."""
    literal: Callable[[Literal], str] = print_literal
    format_name: str = ""
    """What messages call the format."""

    def print(self, formula: Formula) -> str:
        """Return the formula as text. Raises KeyError for an operator without a word."""
        match formula:
            case Const(value):
                return self.literal(value)
            case Var(name, primed):
                return self.next_value(name) if primed else name
            case Apply(op, (operand,)) if op in _PREFIX:
                space = "" if op is Op.NOT else " "
                return f"{self.words[op]}{space}{self._print_operand(op, operand)}"
            case Apply(op, args):
                space = "" if op in COMPARISONS else " "
                word = f"{space}{self.words[op]}{space}"
                return word.join(self._print_operand(op, arg) for arg in args)

    def print_conjunct(self, conjunct: Conjunct) -> str:
        """Return the formula of a conjunct as text. Raises NotExpressibleError."""
        try:
            return self.print(conjunct.formula)
        except KeyError as error:
            reason = f"there is no word for {error}"
            raise NotExpressibleError(self.format_name, reason, conjunct) from None

    def print_ltl_conjunct(self, conjunct: Conjunct) -> str:
        """Return a conjunct behind the temporal operators of its class: G, or G F.

        Raises NotExpressibleError.
        """
        operators = {Class.SAFETY: (Op.ALWAYS,), Class.LIVENESS: (Op.ALWAYS, Op.EVENTUALLY)}
        prefix = " ".join(self.words[op] for op in operators.get(conjunct.class_, ()))
        text = self.print_conjunct(conjunct)
        return f"{prefix}({text})" if prefix else text

    def _print_operand(self, op: Op, formula: Formula) -> str:
        text = self.print(formula)
        if not isinstance(formula, Apply):
            # A primed variable can be "X x", which needs parentheses like an operator.
            return f"({text})" if " " in text and isinstance(formula, Var) else text
        if formula.op in _PREFIX:
            is_clear = op not in COMPARISONS
        elif formula.op in ARITHMETIC:
            is_clear = op in COMPARISONS
        else:
            is_clear = formula.op in COMPARISONS and op not in (*_PREFIX, *COMPARISONS)
        return text if is_clear else f"({text})"


def remove_primes(formula: Formula) -> Formula:
    """Return the formula with current values in place of next values."""
    return replace_leaves(formula, lambda leaf: Var(leaf.name) if isinstance(leaf, Var) else leaf)


def convert_to_word(name: str) -> str:
    """Return a qualified name as one word of ASCII letters, digits and underscores."""
    word = "".join(char if char.isascii() and char.isalnum() else "_" for char in name)
    return word if word and not word[0].isdigit() else f"_{word}"


def is_step(conjunct: Conjunct) -> bool:
    """Whether a guarantee is part of the step relation, and no requirement on it."""
    return conjunct.is_derived and conjunct.class_ in (Class.INIT, Class.SAFETY)


def is_recurring(conjunct: Conjunct) -> bool:
    """Whether an assumption is that a condition on one step holds again and again."""
    return conjunct.class_ is Class.LIVENESS and not has_primes(conjunct.formula)


def conjuncts_of(contract: Contract, owner: Owner, class_: Class) -> Iterator[Conjunct]:
    """Yield the conjuncts of a class that an owner promises.

    The environment promises the assumptions, the system the guarantees.
    """
    conjuncts = contract.assumptions if SIDES[owner] == "assumptions" else contract.guarantees
    return (conjunct for conjunct in conjuncts if conjunct.class_ is class_)


def apply_lowering(
    contract: Contract, format_name: str, lower: Callable[[Contract], Contract]
) -> Contract:
    """Return the lowered contract; raise NotExpressibleError if it would have too many values."""
    try:
        return lower(contract)
    except TooManyValuesError as error:
        raise NotExpressibleError(format_name, str(error), error.conjunct) from None


def reduce_to_gr1(
    contract: Contract,
    format_name: str,
    *,
    allow_primed_liveness: bool = False,
    separate_init: bool = False,
) -> Contract:
    """Return the contract in GR(1), with history bits where a conjunct needs them.

    Assumptions are written so that a solver evaluates them when the environment chooses inputs.

    With ``allow_primed_liveness``, goals of the format may have primes. With ``separate_init``, the
    initial conditions of each side may only have its own variables. Raises NotExpressibleError for
    the first conjunct that the format cannot express.
    """

    def is_expressible(conjunct: Conjunct) -> bool:
        is_goal = conjunct.class_ is Class.LIVENESS
        return is_gr1(conjunct) or (allow_primed_liveness and is_goal)

    conjuncts = (*contract.assumptions, *contract.guarantees)
    game = contract if all(map(is_expressible, conjuncts)) else reduce_contract(contract).contract
    game = state_assumptions_of_inputs(game)
    for conjunct in (*game.assumptions, *game.guarantees):
        if not is_expressible(conjunct):
            reason = "no reduction to GR(1) is known for it"
            raise NotExpressibleError(format_name, reason, conjunct)
    if separate_init:
        _check_initial_owners(game, format_name)
    _check_next_outputs(game, format_name)
    return game


def _check_initial_owners(contract: Contract, format_name: str) -> None:
    owners = {variable.name: variable.owner for variable in contract.variables}
    for owner in Owner:
        for conjunct in conjuncts_of(contract, owner, Class.INIT):
            if any(owners[var.name] is not owner for var in variables(conjunct.formula)):
                reason = "at the start each side speaks of its own"
                raise NotExpressibleError(format_name, reason, conjunct)


def _check_next_outputs(contract: Contract, format_name: str) -> None:
    """Raise NotExpressibleError if a safety assumption has an output of the next step.

    In a step of a GR(1) game the environment chooses its next values before the system does.
    """
    owners = {variable.name: variable.owner for variable in contract.variables}
    for conjunct in conjuncts_of(contract, Owner.ENVIRONMENT, Class.SAFETY):
        if any(
            var.primed and owners[var.name] is Owner.SYSTEM for var in variables(conjunct.formula)
        ):
            reason = "it assumes what the system does next"
            raise NotExpressibleError(format_name, reason, conjunct)
