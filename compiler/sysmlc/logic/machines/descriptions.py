"""What the conjuncts of a state machine's contract say, in the modeller's words."""

from collections.abc import Sequence

from sysmlc.logic.expressions.expression import Expression, dotted, print_expression
from sysmlc.logic.formula import TRUE, Const, Formula
from sysmlc.logic.machines.machine import (
    AfterTicks,
    Machine,
    Occurrence,
    OnEvent,
    OnRise,
    Transition,
    Vertex,
    WhenTold,
)
from sysmlc.logic.machines.paths import Path
from sysmlc.logic.printing import print_formula, print_literal

CLOCK_RUNS = "'{clock}' counts the steps that '{state}' has been active."
CLOCK_STOPS = "'{clock}' stops counting when no transition waits for more."
CLOCK_RESETS = "'{clock}' is 0 when '{state}' is entered and while it is not active."
REMEMBERS = "'{memory}' says what '{region}' was, one step later."
KEEPS = "'{memory}' keeps what it says while '{state}' is not active: history leads back to it."
INITIAL_WAYS = "The initial transition is taken on one of the ways that are open."


def name_transition(one: Transition) -> str:
    """The transition as diagnostics name it."""
    return f"transition '{one.words}'"


def transition(
    machine: Machine, one: Transition, path: Path, way: Formula, first: Sequence[Transition] = ()
) -> str:
    """What taking the transition on this path means; ``way`` is what tells it from others,
    ``first`` are transitions that are taken instead where they can be.
    """
    source = "' and '".join(machine.vertices[each].literal for each in one.sources)
    reasons = " or ".join(_occurrence(each) for each in one.occurrences)
    when = reasons or (f"'{source}' are complete" if one.also else f"'{source}' is complete")
    guard = [] if one.guard is None else [f"[{_shown(one.guard)}]"]
    chosen = [] if way == TRUE else [print_formula(way)]
    conditions = " and ".join([when, *guard, *chosen])
    names = " or ".join(dict.fromkeys(name_transition(each) for each in first))
    unless = f", unless {names} goes first" if names else ""
    return f"In '{source}', when {conditions}{unless}: {_outcome(machine, one, path)}."


def _occurrence(occurrence: Occurrence) -> str:
    match occurrence:
        case OnEvent(None):
            return "any event occurs"
        case OnEvent(literal):
            return f"'{literal}' occurs"
        case AfterTicks(count):
            return f"{count} step{'s' * (count != 1)} have passed since it was entered"
        case OnRise(_, condition):
            return f"'{_shown(condition)}' becomes true"
        case WhenTold(variable):
            return f"'{variable}' is reported"


def _shown(expression: Expression) -> str:
    return dotted(expression) or print_expression(expression)


def _outcome(machine: Machine, one: Transition, path: Path) -> str:
    parts = [_next_state(machine, one, path)]
    parts += [f"'{name}' becomes {_value(value)}" for name, value in path.values.items()]
    parts += [f"'{name}' is done" for name in path.raised]
    return ", ".join(part for part in parts if part) or "nothing else happens"


def _next_state(machine: Machine, one: Transition, path: Path) -> str:
    reached = [literal for literal in path.entered.values() if literal != "inactive"]
    if one.kind == "internal":
        return "the state stays"
    source = machine.vertices[one.source].literal
    if reached == [source]:
        return f"'{source}' is left and entered again"
    return "the next state is " + " with ".join(f"'{literal}'" for literal in reached)


def _value(value: Formula) -> str:
    return print_literal(value.value) if isinstance(value, Const) else print_formula(value)


def some_way(one: Transition) -> str:
    """A transition that passes a choice takes one of its open branches."""
    return f"Transition '{one.words}' takes one of the branches that are open."


def choice(machine: Machine, state: Vertex) -> str:
    """A state with competing transitions takes one of them."""
    named = ", ".join(f"'{one.words}'" for one in machine.outgoing[state.id])
    return f"When several of {named} can be taken, '{state.pick}' says which one is."


def initial(formula: Formula) -> str:
    """One fact about the first step."""
    return f"At the start: {print_formula(formula)}."


def frame(machine: Machine, name: str) -> str:
    """What happens to a variable when no transition touches it."""
    if name in machine.outputs:
        return f"'{name}' is done only by the transitions and states that name it."
    if any(vertex.pick == name for vertex in machine.vertices.values()):
        return f"'{name}' is none when no choice was made."
    return f"'{name}' changes only by transitions that change it."


def memory(name: str, truth: Formula) -> str:
    """A memory holds a condition of the step before."""
    return f"'{name}' says whether {print_formula(truth)} held in the step before."


def activity(state: Vertex) -> str:
    """The do behaviour of a state."""
    return f"'{state.do}' is done exactly while '{state.literal}' is active."


def ends(state: Vertex) -> str:
    """The assumption that a do behaviour ends."""
    return f"'{state.do}' does not go on for ever: '{state.done}' is reported again and again."
