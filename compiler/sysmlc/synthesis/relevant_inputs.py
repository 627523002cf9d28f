"""Inputs that never change in a run, and on whose values the run nevertheless depends."""

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Contract, Domain, Owner
from sysmlc.logic.evaluate import find_violation
from sysmlc.synthesis.algebra.fair_systems import Trace

_MAX_VALUATIONS = 64
"""Combinations of input values that are tried; with more of them an input counts as relevant."""


def find_relevant_inputs(trace: Trace, behaviour: Contract) -> frozenset[str]:
    """Return constant inputs without whose values the run would not be one of the behaviour.

    The inputs are freed in turn. Those that stay free may have any value, all together: the run
    satisfies each conjunct all the same.
    """
    constant_inputs = {
        variable.name: variable.domain
        for variable in behaviour.variables
        if variable.owner is Owner.ENVIRONMENT
        and variable.name in trace.steps[0]
        and len({step.get(variable.name) for step in trace.steps}) == 1
    }
    free: dict[str, Domain] = {}
    for name, domain in constant_inputs.items():
        if _may_vary(trace, behaviour, name, {**free, name: domain}):
            free[name] = domain
    return frozenset(constant_inputs.keys() - free.keys())


def _may_vary(trace: Trace, behaviour: Contract, name: str, free: dict[str, Domain]) -> bool:
    """Whether the run satisfies all conjuncts about an input whatever the free inputs are."""
    known = set(trace.steps[0])
    for conjunct in (*behaviour.guarantees, *behaviour.assumptions):
        read = f.variable_names(conjunct.formula)
        if name not in read or not read <= known:
            continue
        varied = {input: domain for input, domain in free.items() if input in read}
        if domains.count(varied) > _MAX_VALUATIONS:
            return False
        for values in domains.valuations(varied):
            steps = [{**step, **values} for step in trace.steps]
            if find_violation(conjunct, steps, trace.loop) is not None:
                return False
    return True
