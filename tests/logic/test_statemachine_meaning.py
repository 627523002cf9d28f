"""Derived contracts against the interpreter: the formulas allow exactly the steps it makes.

The interpreter (``machines.interpreter``) runs the drawing and reads no formula. Of its traces
every conjunct must hold; and of every trace that differs from one of them in one variable of one
step the formulas must say what the interpreter says: legal when the changed step is among
those that may follow, else violated. No mutation is exempt.
"""

from itertools import pairwise

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from machines import machines, rich_machines

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.logic import domains
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import find_violation
from sysmlc.logic.machines import interpreter as step
from sysmlc.logic.machines.derivation import derive_contract
from sysmlc.logic.machines.reader import read_machine

STEPS = 7


def _derived(graph, element):
    sink = Sink()
    machine = read_machine(graph, element, sink)
    assume(machine is not None)
    contract = derive_contract(graph, machine, "P::C", sink)
    assume(contract is not None)
    return machine, contract


def _inputs(data, machine):
    return {
        v.name: data.draw(st.sampled_from(domains.values(v.domain)))
        for v in step.list_inputs(machine)
    }


def _trace(data, machine):
    starts = step.initial_steps(machine, _inputs(data, machine))
    assume(starts)
    trace = [data.draw(st.sampled_from(starts))]
    while len(trace) < STEPS:
        trace.append(
            data.draw(st.sampled_from(step.next_steps(machine, trace[-1], _inputs(data, machine))))
        )
    return trace


def _breaks(contract, trace, *classes):
    return [
        c
        for c in contract.guarantees
        if c.class_ in classes and find_violation(c, trace) is not None
    ]


def _mutations(machine, valuation):
    for variable in machine.variables:
        for value in domains.values(variable.domain):
            if value != valuation[variable.name]:
                yield {**valuation, variable.name: value}


def _inputs_in(machine, valuation):
    return {v.name: valuation[v.name] for v in step.list_inputs(machine)}


_quiet = settings(
    max_examples=examples(30),
    deadline=None,
    suppress_health_check=[
        HealthCheck.filter_too_much,
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
    ],
)


@pytest.mark.long
@given(st.one_of(machines(), rich_machines()), st.data())
@_quiet
def test_formulas_allow_exactly_the_steps_of_the_interpreter(model, data):
    machine, contract = _derived(*model)
    trace = _trace(data, machine)
    assert _breaks(contract, trace, Class.INIT, Class.SAFETY) == []
    for now, following in pairwise(trace):
        for mutant in _mutations(machine, following):
            legal = mutant in step.next_steps(machine, now, _inputs_in(machine, mutant))
            broken = _breaks(contract, [now, mutant], Class.SAFETY)
            assert legal == (not broken), (now, mutant, broken)


@given(st.one_of(machines(), rich_machines()), st.data())
@_quiet
def test_formulas_allow_exactly_the_first_steps_of_the_interpreter(model, data):
    machine, contract = _derived(*model)
    first = _trace(data, machine)[0]
    for mutant in [first, *_mutations(machine, first)]:
        legal = mutant in step.initial_steps(machine, _inputs_in(machine, mutant))
        broken = _breaks(contract, [mutant], Class.INIT, Class.SAFETY)
        assert legal == (not broken), (mutant, broken)
