"""The contract of a state machine allows exactly the steps of the reference interpreter.

The interpreter (``machines.interpreter``) executes the state machine and reads no formula. Every
guarantee must hold in its traces. When one variable of one step is changed, the guarantees must
hold exactly if the changed step is among the steps that the interpreter can take.
"""

from itertools import pairwise

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from random_state_machines import machines, rich_machines

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.logic import domains
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import find_violation
from sysmlc.logic.machines import interpreter
from sysmlc.logic.machines.derivation import derive_contract
from sysmlc.logic.machines.machine import OnChange
from sysmlc.logic.machines.reaction import evaluate_expression, is_active
from sysmlc.logic.machines.reader import read_machine

STEPS = 7


def derive(graph, element):
    """Return the state machine of an element and its contract."""
    sink = Sink()
    machine = read_machine(graph, element, sink)
    assume(machine is not None)
    contract = derive_contract(graph, machine, "P::C", sink)
    assume(contract is not None)
    return machine, contract


def draw_inputs(data, machine):
    return {
        variable.name: data.draw(st.sampled_from(domains.values(variable.domain)))
        for variable in interpreter.list_inputs(machine)
    }


def draw_trace(data, machine):
    initial_steps = interpreter.initial_steps(machine, draw_inputs(data, machine))
    assume(initial_steps)
    trace = [data.draw(st.sampled_from(initial_steps))]
    while len(trace) < STEPS:
        trace.append(
            data.draw(
                st.sampled_from(
                    interpreter.next_steps(machine, trace[-1], draw_inputs(data, machine))
                )
            )
        )
    return trace


def list_violated(contract, trace, *classes):
    """Return the guarantees of some classes that a trace violates."""
    return [
        conjunct
        for conjunct in contract.guarantees
        if conjunct.class_ in classes and find_violation(conjunct, trace) is not None
    ]


def check_conditions_without_memory(machine, now):
    """A change trigger has no memory only if its condition always ends the state."""
    for transition in machine.list_transitions():
        for occurrence in transition.occurrences:
            if (
                isinstance(occurrence, OnChange)
                and not occurrence.memory
                and is_active(machine, now, transition.source)
                and evaluate_expression(machine, occurrence.condition, now)
            ):
                reactions = interpreter.list_reactions(machine, now, {})
                assert all(transition.source in reaction.left_states for reaction in reactions)


def iter_mutations(machine, valuation):
    """Yield the valuations that differ in one variable."""
    for variable in machine.variables:
        for value in domains.values(variable.domain):
            if value != valuation[variable.name]:
                yield {**valuation, variable.name: value}


def select_inputs(machine, valuation):
    return {
        variable.name: valuation[variable.name] for variable in interpreter.list_inputs(machine)
    }


SETTINGS = settings(
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
@SETTINGS
def test_the_guarantees_allow_exactly_the_steps_of_the_interpreter(model, data):
    machine, contract = derive(*model)
    trace = draw_trace(data, machine)
    assert list_violated(contract, trace, Class.INIT, Class.SAFETY) == []
    for before, after in pairwise(trace):
        check_conditions_without_memory(machine, before)
        for mutation in iter_mutations(machine, after):
            is_possible = mutation in interpreter.next_steps(
                machine, before, select_inputs(machine, mutation)
            )
            violated = list_violated(contract, [before, mutation], Class.SAFETY)
            assert is_possible == (not violated), (before, mutation, violated)


@given(st.one_of(machines(), rich_machines()), st.data())
@SETTINGS
def test_the_guarantees_allow_exactly_the_initial_steps_of_the_interpreter(model, data):
    machine, contract = derive(*model)
    first = draw_trace(data, machine)[0]
    for mutation in [first, *iter_mutations(machine, first)]:
        is_possible = mutation in interpreter.initial_steps(
            machine, select_inputs(machine, mutation)
        )
        violated = list_violated(contract, [mutation], Class.INIT, Class.SAFETY)
        assert is_possible == (not violated), (mutation, violated)
