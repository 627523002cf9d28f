"""What a component has to read in the same step in which it answers."""

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.synthesis.algebra.fair import Runs
from sysmlc.synthesis.algebra.systems import Universe
from sysmlc.synthesis.manager import Node


def read_at_once(contract: Contract, universe: Universe) -> set[str]:
    """The inputs whose value in a step has a say in what the outputs may be in the same step.

    They are named by an initial guarantee or with a prime, or are tied to outputs by what lets a
    run go on. Raises OutsideGr1Error, LimitError.
    """
    inputs = {one.name for one in contract.variables if one.owner is Owner.ENVIRONMENT}
    return inputs & (_written(contract) | _tied(contract, universe))


def _written(contract: Contract) -> set[str]:
    """Variables of initial guarantees, and those of the step that a guarantee is about."""
    return {
        one.name
        for conjunct in contract.guarantees
        for one in f.variables(conjunct.formula)
        if conjunct.class_ is Class.INIT or one.primed
    }


def _tied(contract: Contract, universe: Universe) -> set[str]:
    """Variables of the states from which the guarantees allow to go on for ever."""
    outputs = {one.name for one in contract.variables if one.owner is Owner.SYSTEM}
    steps = [one for one in contract.guarantees if one.class_ is Class.SAFETY]
    going = Runs(universe.system(steps)).endless
    names = {one.name for one in contract.variables if _is_restricted(one.name, going, universe)}
    return names if names & outputs else set()


def _is_restricted(name: str, states: Node, universe: Universe) -> bool:
    """Whether not every value of the variable does as well."""
    symbols = universe.symbols
    any_value = universe.manager.exist(symbols.bits(name), states) & symbols.domain(name)
    return any_value != states
