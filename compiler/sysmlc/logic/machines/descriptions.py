"""Texts of the conjuncts in the contract of a state machine."""

from collections import Counter
from collections.abc import Mapping, Sequence

from sysmlc.ir.expressions import Expression, Name, dotted_name, print_expression, walk_tree
from sysmlc.logic.expressions.symbols import Scope, find_symbol
from sysmlc.logic.formula import TRUE, Const, Formula, const, rename_variables
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.machines.machine import (
    AfterTicks,
    Machine,
    Occurrence,
    OnChange,
    OnEvent,
    OnInput,
    Transition,
    Vertex,
)
from sysmlc.logic.machines.paths import Path
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.logic.region_formulas import print_worded, word_regions
from sysmlc.support.counts import count as count_nouns

CLOCK_RUNS = "'{clock}' counts the steps for which '{state}' has been active."
CLOCK_STOPS = "'{clock}' stops at the longest time that a transition waits for."
CLOCK_RESETS = "'{clock}' is 0 when '{state}' is entered and while it is not active."
UPDATES_MEMORY = "'{memory}' takes the value of '{region}' in the next step."
KEEPS_MEMORY = (
    "'{memory}' does not change while '{state}' is not active, so history can restore it."
)
INITIAL_ALTERNATIVES = "The initial transition takes one of the branches whose guards hold."


def name_transition(transition: Transition) -> str:
    """Return the name of the transition in diagnostics."""
    return f"transition '{transition.words}'"


def list_names(transitions: Sequence[Transition], vertices: Mapping[str, Vertex]) -> str:
    """Return the names of transitions from one state, as diagnostics list them.

    Transitions of the same name are told apart by their target and occurrences.
    """
    counts = Counter(transition.words for transition in transitions)
    return ", ".join(
        f"'{transition.words}'"
        if counts[transition.words] == 1
        else _qualify_name(transition, vertices[transition.target].literal)
        for transition in transitions
    )


def _qualify_name(transition: Transition, target: str) -> str:
    to = "" if transition.words.endswith(f" to {target}") else f" to '{target}'"
    reasons = " or ".join(map(_describe_occurrence, transition.occurrences)) or "it is complete"
    return f"'{transition.words}'{to} (when {reasons})"


def describe_transition(
    machine: Machine,
    transition: Transition,
    path: Path,
    condition: Formula,
    preempting: Sequence[Transition] = (),
) -> str:
    """Describe what happens when the transition is taken on *path*.

    *condition* distinguishes the path from the others; *preempting* are the transitions
    that preempt this one.
    """
    source = "' and '".join(machine.vertices[source_id].literal for source_id in transition.sources)
    reasons = " or ".join(_describe_occurrence(occurrence) for occurrence in transition.occurrences)
    when = reasons or (
        f"'{source}' are complete" if transition.join_partners else f"'{source}' is complete"
    )
    guards = [] if transition.guard is None else [_print_guard(transition.guard, machine.scope)]
    branch_conditions = [] if condition == TRUE else [_print_condition(machine, condition)]
    conditions = " and ".join([when, *guards, *branch_conditions])
    preempting_names = " or ".join(dict.fromkeys(name_transition(other) for other in preempting))
    unless = f", unless {preempting_names} is taken instead" if preempting_names else ""
    return (
        f"In '{source}', when {conditions}{unless}: {_describe_outcome(machine, transition, path)}."
    )


def name_occurrence(occurrence: Occurrence) -> str:
    """Return the name of what a transition waits for in diagnostics."""
    match occurrence:
        case OnEvent(None):
            return "any event"
        case OnEvent(literal):
            return f"event '{literal}'"
        case AfterTicks(count):
            return f"time event 'after {count_nouns(count, 'step')}'"
        case OnChange(_, condition):
            return f"change event '{_print_expression(condition)}'"
        case OnInput(variable):
            return f"event '{variable}'"


def _describe_occurrence(occurrence: Occurrence) -> str:
    match occurrence:
        case OnEvent(None):
            return "any event occurs"
        case OnEvent(literal):
            return f"'{literal}' occurs"
        case AfterTicks(count):
            passed = "has passed" if count == 1 else "have passed"
            return f"{count_nouns(count, 'step')} {passed} since it was entered"
        case OnChange(memory, condition, is_immediate):
            from_start = " or is true from the start" if is_immediate and memory else ""
            verb = "is" if is_immediate and not memory else "becomes"
            return f"'{_print_expression(condition)}' {verb} true{from_start}"
        case OnInput(variable):
            return f"'{variable}' is reported"


def _print_guard(guard: Expression, scope: Scope) -> str:
    """Return a guard, and the values of the constants that it names."""
    values: dict[str, str] = {}
    for node in walk_tree(guard):
        symbol = find_symbol(node, scope) if isinstance(node, Name) else None
        value = symbol.formula if symbol is not None else None
        # An enumeration literal is its own value.
        is_own = isinstance(node, Name) and value == const(identifier(node.path[-1], "literal"))
        if isinstance(node, Name) and isinstance(value, Const) and not is_own:
            values[print_expression(node)] = _print_value(value)
    constants = ", ".join(f"{name} = {value}" for name, value in values.items())
    return f"[{_print_expression(guard)}]" + (f" ({constants})" if constants else "")


def _print_expression(expression: Expression) -> str:
    return dotted_name(expression) or print_expression(expression)


def _print_condition(machine: Machine, condition: Formula) -> str:
    worded = word_regions(condition, machine.variables)
    return print_formula(rename_variables(worded, machine.wordings))


def _describe_outcome(machine: Machine, transition: Transition, path: Path) -> str:
    parts = [_describe_next_state(machine, transition, path)]
    parts += [f"'{name}' becomes {_print_value(value)}" for name, value in path.values.items()]
    parts += [f"'{name}' is done" for name in path.raised]
    return ", ".join(part for part in parts if part) or "nothing else happens"


def _describe_next_state(machine: Machine, transition: Transition, path: Path) -> str:
    literals = [literal for literal in path.entered.values() if literal != "inactive"]
    if transition.kind == "internal":
        return "the state does not change"
    source = machine.vertices[transition.source].literal
    if literals == [source]:
        return f"'{source}' is exited and entered again"
    return "the next state is " + " with ".join(f"'{literal}'" for literal in literals)


def _print_value(value: Formula) -> str:
    return print_literal(value.value) if isinstance(value, Const) else print_formula(value)


def describe_branches(transition: Transition) -> str:
    """Describe that a transition through a choice takes one of the open branches."""
    return f"Transition '{transition.words}' takes one of the branches whose guards hold."


def describe_choice(machine: Machine, state: Vertex) -> str:
    """Describe that a state with competing transitions takes one of them."""
    names = ", ".join(f"'{transition.words}'" for transition in machine.outgoing[state.id])
    return f"When several of {names} can be taken, '{state.pick}' selects the one that is taken."


def describe_start(machine: Machine, formula: Formula) -> str:
    """Describe one condition on the first step."""
    return f"At the start: {_print_condition(machine, formula)}."


def describe_frame(machine: Machine, name: str) -> str:
    """Describe the frame condition of a variable."""
    if name in machine.outputs:
        return f"'{name}' is done only by transitions and states that refer to it."
    if any(vertex.pick == name for vertex in machine.vertices.values()):
        return f"'{name}' is none unless a choice was made."
    return f"'{machine.wordings.get(name, name)}' does not change unless a transition changes it."


def describe_memory(machine: Machine, name: str, truth: Formula, state: Vertex | None) -> str:
    """Describe a memory: it stores whether a condition was true in the previous step.

    With a *state*, it stores this only for the steps of the present stay in the state.
    """
    condition = print_worded(truth, machine.variables)
    text = f"'{name}' is true if {condition} held in the previous step"
    return f"{text}, and '{state.literal}' has remained active since." if state else f"{text}."


def describe_do_behaviour(state: Vertex) -> str:
    """Describe when the do behaviour of a state runs."""
    return f"'{state.do}' runs exactly while '{state.literal}' is active."


def describe_end(state: Vertex) -> str:
    """Describe the assumption that a do behaviour ends."""
    return f"'{state.do}' does not run for ever: '{state.done}' is reported again and again."
