"""What the text of a contract shows: who decides what is assumed and promised."""

from collections.abc import Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula, primed, variables
from sysmlc.synthesis.lints import rules


class LintFinding(Struct, frozen=True):
    """A finding about a conjunct, or about the contract when there is none."""

    rule: Rule
    conjunct: Conjunct | None = None
    name: str = ""
    said: str = ""


def check_ownership(contract: Contract) -> Iterator[LintFinding]:
    """Conjuncts about what the other side decides, and primes where none may be."""
    owners = {one.name: one.owner for one in contract.variables}
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
    """The contract with what is assumed of inputs alone asked of the step that it is about.

    A game asks ``G p`` of the step that comes after: it would seem that the environment could break
    it and come to a dead end, or be brought there.
    """
    inputs = {one.name for one in contract.variables if one.owner is Owner.ENVIRONMENT}
    return replace(
        contract,
        assumptions=tuple(
            made for one in contract.assumptions for made in _split_assumption(one, inputs)
        ),
    )


def _split_assumption(conjunct: Conjunct, inputs: set[str]) -> Iterator[Conjunct]:
    names = {one.name for one in variables(conjunct.formula)}
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
    """Who alone decides whether it holds: of a step, the one whose next values it is about.

    What recurs may be brought about by the other side, through what it assumes or promises.
    """
    names = _primed_names(conjunct.formula) or {one.name for one in variables(conjunct.formula)}
    found = {owners[name] for name in names if name in owners}
    is_immediate = conjunct.class_ in (Class.INIT, Class.SAFETY)
    return next(iter(found)) if len(found) == 1 and is_immediate else None


def _owners_of(conjunct: Conjunct, owners: dict[str, Owner]) -> set[Owner]:
    return {owners[one.name] for one in variables(conjunct.formula) if one.name in owners}


def _primed_names(formula: Formula) -> set[str]:
    return {one.name for one in variables(formula) if one.primed}
