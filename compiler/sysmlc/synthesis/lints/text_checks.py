"""Lints of the text of a contract: who decides the assumptions and guarantees."""

from collections.abc import Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula, primed, variables
from sysmlc.synthesis.lints import rules


class LintFinding(Struct, frozen=True):
    """A finding about a conjunct, or about the whole contract if there is no conjunct."""

    rule: Rule
    conjunct: Conjunct | None = None
    name: str = ""
    said: str = ""


def check_ownership(contract: Contract) -> Iterator[LintFinding]:
    """Yield findings about conjuncts that the other side decides, and about misplaced primes."""
    owners = {variable.name: variable.owner for variable in contract.variables}
    for conjunct in contract.assumptions:
        if _sole_owner(conjunct, owners) is Owner.SYSTEM:
            yield LintFinding(rules.WRONG_OWNER, conjunct, "assumes", "the component")
    for conjunct in contract.guarantees:
        if _sole_owner(conjunct, owners) is Owner.ENVIRONMENT:
            yield LintFinding(rules.WRONG_OWNER, conjunct, "promises", "the environment")
        elif conjunct.class_ is Class.INIT and Owner.ENVIRONMENT in _owners_of(conjunct, owners):
            yield LintFinding(rules.INITIAL_INPUT, conjunct)
    for conjunct in (*contract.assumptions, *contract.guarantees):
        if conjunct.class_ is Class.LIVENESS and _primed_names(conjunct.formula):
            yield LintFinding(rules.NEXT_IN_LIVENESS, conjunct)


def state_assumptions_of_next_step(contract: Contract) -> Contract:
    """Return the contract with assumptions about inputs alone stated for the step that they are
    about.

    A game checks ``G p`` in the step after: otherwise it would seem that the environment could
    break the assumption and reach a dead end, or be forced there.
    """
    inputs = {
        variable.name for variable in contract.variables if variable.owner is Owner.ENVIRONMENT
    }
    return replace(
        contract,
        assumptions=tuple(
            assumption
            for variable in contract.assumptions
            for assumption in _split_assumption(variable, inputs)
        ),
    )


def _split_assumption(conjunct: Conjunct, inputs: set[str]) -> Iterator[Conjunct]:
    names = {variable.name for variable in variables(conjunct.formula)}
    if (
        conjunct.class_ is not Class.SAFETY
        or not names <= inputs
        or _primed_names(conjunct.formula)
    ):
        yield conjunct
        return
    yield replace(conjunct, class_=Class.INIT)
    yield replace(conjunct, formula=primed(conjunct.formula))


def _sole_owner(conjunct: Conjunct, owners: dict[str, Owner]) -> Owner | None:
    """Return the owner that alone decides whether the conjunct holds, or None.

    A conjunct about two steps is decided by the owner of the next values. A liveness conjunct has
    no sole owner, because the other side may bring it about through its assumptions and guarantees.
    """
    names = _primed_names(conjunct.formula) or {
        variable.name for variable in variables(conjunct.formula)
    }
    found_owners = {owners[name] for name in names if name in owners}
    is_immediate = conjunct.class_ in (Class.INIT, Class.SAFETY)
    return next(iter(found_owners)) if len(found_owners) == 1 and is_immediate else None


def _owners_of(conjunct: Conjunct, owners: dict[str, Owner]) -> set[Owner]:
    return {
        owners[variable.name] for variable in variables(conjunct.formula) if variable.name in owners
    }


def _primed_names(formula: Formula) -> set[str]:
    return {variable.name for variable in variables(formula) if variable.primed}
