"""Operations on two given contracts: quotient, merging, conjunction, composition.

A contract is a pair of properties: assumptions A and guarantees G. Only the saturated guarantees
``A -> G`` matter, because nothing is guaranteed where an assumption is violated. With saturated
guarantees the operations are, for contracts 1 and 2 and a system S:

- quotient ``(A and G1, A1 and G)``: the weakest contract of what is missing besides part 1
  (Incer, Sangiovanni-Vincentelli, Lin and Kang 2018);
- merging ``(A1 and A2, G1 and G2)`` of viewpoints (Passerone, Incer and Sangiovanni-Vincentelli
  2019);
- conjunction ``(A1 or A2, G1 and G2)``, the greatest lower bound (Benveniste et al. 2018, 4.2);
- composition ``(A, G1 and G2)`` with the weakest A by which neither part violates an assumption of
  the other (Benveniste et al. 2018, 4.2).

The results are conjuncts again: a conjunct that others entail is omitted, and guarantees stay as
they are written where the assumptions of the result entail those of the operand.
"""

from collections.abc import Callable, Iterable, Sequence

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import regions_of
from sysmlc.logic.formats.lowering import TooManyValuesError
from sysmlc.logic.formula import Const
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import as_ltl
from sysmlc.logic.reduction.formula_reduction import NotReducibleError
from sysmlc.logic.reduction.history import add_history, share_history
from sysmlc.logic.region_formulas import split_regions, unite_regions
from sysmlc.synthesis.algebra.fair_systems import DomainError
from sysmlc.synthesis.algebra.refinement import RunSearch
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import ManagerFactory
from sysmlc.synthesis.games.game import OutsideGr1Error

Conjuncts = tuple[Conjunct, ...]


class OwnerError(Exception):
    """Reports that two contracts disagree on the side that decides a variable."""


OBSTACLES = (
    DomainError,
    OwnerError,
    OutsideGr1Error,
    NotReducibleError,
    LimitError,
    TooManyValuesError,
)
"""Errors that the functions of this module raise."""


def check_owners(first: Contract, second: Contract) -> None:
    """Raise OwnerError if a variable is an input of one contract and an output of the other."""
    owners = {variable.name: variable.owner for variable in first.variables}
    for variable in second.variables:
        if owners.get(variable.name, variable.owner) is not variable.owner:
            output, input_ = (second, first) if variable.owner is Owner.SYSTEM else (first, second)
            raise OwnerError(
                f"'{variable.name}' is an output of '{output.component}' "
                f"and an input of '{input_.component}'"
            )


# -- common domains --------------------------------------------------------------------------------


def align_domains(first: Contract, second: Contract) -> tuple[Contract, Contract]:
    """Return both contracts with common domains of the variables that they share.

    The common domain of integers is the smallest range that includes both ranges, that of
    enumerations has the literals of both, that of numbers has regions with the cuts of both. The
    smaller domain of a contract becomes a conjunct: a component assumes the values of its inputs,
    and guarantees those of its outputs. Raises DomainError for domains of different kinds, and
    TooManyValuesError for arithmetic with many numbers.
    """
    domains = {variable.name: variable.domain for variable in first.variables}
    for variable in second.variables:
        domain = domains.get(variable.name, variable.domain)
        domains[variable.name] = _unite_domains(variable.name, domain, variable.domain)
    return _widen(first, domains), _widen(second, domains)


def _unite_domains(name: str, first: Domain, second: Domain) -> Domain:
    if first == second:
        return first
    if regions_of(first) or regions_of(second):
        united = unite_regions((first, second))
        if united is None:
            raise DomainError(name, (first, second))
        return united
    match first, second:
        case IntegerDomain(), IntegerDomain():
            return IntegerDomain(min(first.low, second.low), max(first.high, second.high))
        case EnumerationDomain(literals, ()), EnumerationDomain(other_literals, ()):
            return EnumerationDomain(tuple(dict.fromkeys((*literals, *other_literals))))
        case _:
            raise DomainError(name, (first, second))


def _widen(contract: Contract, domains: dict[str, Domain]) -> Contract:
    """Return the contract with other domains, and with its own domains as conjuncts."""
    ranges: dict[Owner, list[Conjunct]] = {owner: [] for owner in Owner}
    contract = split_regions(contract, domains)
    for variable in contract.variables:
        if domains[variable.name] != variable.domain:
            formula = _restrict_values(variable)
            text = f"'{variable.name}' has a value of its declared range."
            conjunct = Conjunct(formula, Class.SAFETY, variable.origin, text)
            ranges[variable.owner].append(conjunct)
    return replace(
        contract,
        variables=tuple(
            replace(variable, domain=domains[variable.name]) for variable in contract.variables
        ),
        assumptions=(*contract.assumptions, *ranges[Owner.ENVIRONMENT]),
        guarantees=(*contract.guarantees, *ranges[Owner.SYSTEM]),
    )


def _restrict_values(variable: Variable) -> f.Formula:
    value = f.var(variable.name)
    match variable.domain:
        case IntegerDomain(low, high):
            return f.both(
                f.compare(f.Op.GE, value, Const(low)), f.compare(f.Op.LE, value, Const(high))
            )
        case EnumerationDomain(literals):
            return f.either(*(f.eq(value, Const(literal)) for literal in literals))
        case _:
            return f.TRUE


# -- entailment ------------------------------------------------------------------------------------


class _Simplification:
    """Omits conjuncts that others entail, and saturates guarantees where that is necessary."""

    def __init__(self, contracts: Iterable[Contract], new_manager: ManagerFactory) -> None:
        self._search = RunSearch(contracts, new_manager)

    def entails(self, facts: Conjuncts, conjunct: Conjunct) -> bool:
        return self._search.find_violation(facts, conjunct) is None

    def drop_entailed(self, conjuncts: Conjuncts, facts: Conjuncts) -> Conjuncts:
        """Return the conjuncts that the facts do not entail."""
        return tuple(conjunct for conjunct in conjuncts if not self.entails(facts, conjunct))

    def saturate(self, contract: Contract, facts: Conjuncts) -> Conjuncts:
        """Return the saturated guarantees of a contract where the facts hold."""
        premises = self.drop_entailed(contract.assumptions, facts)
        if not premises:
            return contract.guarantees
        premise = f.both(*map(as_ltl, premises))
        condition = f"if the assumptions of '{contract.component}' hold"
        return tuple(
            replace(guarantee, formula=formula, class_=class_, text=f"{text} ({condition})")
            for guarantee in contract.guarantees
            for text in (guarantee.text or print_formula(as_ltl(guarantee)),)
            for class_, formula in classify(f.implies(premise, as_ltl(guarantee)))
        )

    def promise(self, contract: Contract, facts: Conjuncts) -> Conjuncts:
        """Return the saturated guarantees as premises: one conjunct if they need an implication.

        One implication needs one tableau, which is far smaller than one for each guarantee.
        """
        premises = self.drop_entailed(contract.assumptions, facts)
        if not premises:
            return contract.guarantees
        assumed, guaranteed = (
            f.both(*map(as_ltl, side)) for side in (premises, contract.guarantees)
        )
        return (Conjunct(f.implies(assumed, guaranteed), Class.OTHER, contract.origin),)


def _unite(*sides: Conjuncts) -> Conjuncts:
    """Return all conjuncts; of those with equal formulas only the first."""
    united: dict[tuple[Class, f.Formula], Conjunct] = {}
    for conjunct in (conjunct for side in sides for conjunct in side):
        united.setdefault((conjunct.class_, conjunct.formula), conjunct)
    return tuple(united.values())


# -- operations ------------------------------------------------------------------------------------


def divide(system: Contract, part: Contract, new_manager: ManagerFactory) -> Contract:
    """Return the quotient: the weakest contract by which a component completes *part* to *system*.

    The missing component reads the inputs of the system and the outputs of the part. It decides the
    other outputs of the system, and the inputs of the part that the system does not have. Raises
    DomainError, OwnerError, OutsideGr1Error, NotReducibleError, LimitError.
    """
    inputs = {variable.name for variable in system.variables if _is_input(variable)}
    for variable in part.variables:
        if variable.name in inputs and not _is_input(variable):
            reason = f"'{variable.name}' is an output of '{part.component}' "
            raise OwnerError(f"{reason}and an input of '{system.component}'")
    (system, part), history = share_history(align_domains(system, part))
    outputs = {variable.name for variable in part.variables if not _is_input(variable)}
    simplification = _Simplification((system, part, history), new_manager)
    assumptions = _unite(system.assumptions, simplification.saturate(part, system.assumptions))
    quotient = Contract(
        f"{system.component}_without_{_short_name(part)}",
        system.origin,
        _merge_variables((system, part), lambda name: name in inputs or name in outputs),
        assumptions,
        simplification.drop_entailed(_unite(part.assumptions, system.guarantees), assumptions),
    )
    return add_history(quotient, history)


def merge(first: Contract, second: Contract, new_manager: ManagerFactory) -> Contract:
    """Return the merging of two viewpoints: one component that satisfies both in both environments.

    Raises DomainError, OwnerError, OutsideGr1Error, NotReducibleError, LimitError.
    """
    check_owners(first, second)
    (first, second), history = share_history(align_domains(first, second))
    merged = _combine(
        first,
        second,
        _unite(first.assumptions, second.assumptions),
        _unite(first.guarantees, second.guarantees),
    )
    return add_history(merged, history)


def conjoin(first: Contract, second: Contract, new_manager: ManagerFactory) -> Contract:
    """Return the conjunction: the weakest contract that refines both.

    The environment satisfies the assumptions of one of them; then the component satisfies its
    guarantees. Raises DomainError, OwnerError, OutsideGr1Error, NotReducibleError, LimitError.
    """
    check_owners(first, second)
    (first, second), history = share_history(align_domains(first, second))
    simplification = _Simplification((first, second, history), new_manager)
    only_first = simplification.drop_entailed(first.assumptions, second.assumptions)
    only_second = simplification.drop_entailed(second.assumptions, first.assumptions)
    if not only_first:
        assumptions = first.assumptions
    elif not only_second:
        assumptions = second.assumptions
    else:
        assumptions = _disjoin(first.assumptions, second.assumptions)
    guarantees = (simplification.saturate(side, assumptions) for side in (first, second))
    return add_history(_combine(first, second, assumptions, _unite(*guarantees)), history)


def compose(first: Contract, second: Contract, new_manager: ManagerFactory) -> Contract:
    """Return the contract of two components that run together.

    The guarantees of each discharge assumptions of the other; the composition assumes the others.
    It may assume more than the weakest assumption of the theory, which would also admit
    environments in which a component violates its contract. Raises DomainError, OwnerError,
    OutsideGr1Error, NotReducibleError, LimitError.
    """
    outputs = {variable.name for variable in first.variables if not _is_input(variable)}
    for variable in second.variables:
        if variable.name in outputs and not _is_input(variable):
            names = f"'{first.component}' and of '{second.component}'"
            raise OwnerError(f"'{variable.name}' is an output of {names}")
    (first, second), history = share_history(align_domains(first, second))
    outputs |= {variable.name for variable in second.variables if not _is_input(variable)}
    simplification = _Simplification((first, second, history), new_manager)
    assumptions = _unite(first.assumptions, second.assumptions)
    for candidate in assumptions:
        rest = tuple(conjunct for conjunct in assumptions if conjunct != candidate)
        facts = (*rest, *simplification.promise(first, rest))
        facts = (*facts, *simplification.promise(second, facts))
        if simplification.entails(facts, candidate):
            assumptions = rest
    composition = replace(
        _combine(first, second, assumptions, _unite(first.guarantees, second.guarantees)),
        variables=_merge_variables((first, second), lambda name: name not in outputs),
    )
    return add_history(composition, history)


def _disjoin(first: Conjuncts, second: Conjuncts) -> Conjuncts:
    formula = f.either(f.both(*map(as_ltl, first)), f.both(*map(as_ltl, second)))
    text = "The environment satisfies the assumptions of one of the contracts."
    return tuple(Conjunct(part, class_, "", text) for class_, part in classify(formula))


def _combine(
    first: Contract, second: Contract, assumptions: Conjuncts, guarantees: Conjuncts
) -> Contract:
    owners = {variable.name: variable.owner for variable in (*second.variables, *first.variables)}
    return Contract(
        f"{first.component}_and_{_short_name(second)}",
        first.origin,
        _merge_variables((first, second), lambda name: owners[name] is Owner.ENVIRONMENT),
        assumptions,
        guarantees,
    )


def _merge_variables(
    contracts: Sequence[Contract], is_input: Callable[[str], bool]
) -> tuple[Variable, ...]:
    """Return the variables of aligned contracts, with inputs as *is_input* tells."""
    variables = {
        variable.name: variable for contract in contracts for variable in contract.variables
    }
    return tuple(
        replace(variable, owner=Owner.ENVIRONMENT if is_input(name) else Owner.SYSTEM)
        for name, variable in variables.items()
    )


def _is_input(variable: Variable) -> bool:
    return variable.owner is Owner.ENVIRONMENT


def _short_name(contract: Contract) -> str:
    return identifier(contract.component.rpartition(":")[2].rpartition(".")[2], "contract")
