"""Reactions of the reference interpreter: how one transition is taken.

Expressions are evaluated as they are written, independently of ``elaboration`` and ``evaluate``:
these two belong to the derivation that the interpreter checks. Only numbers whose values are
regions are compared and assigned with their formulas.
"""

from collections.abc import Callable, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.ir.expressions import (
    Binary,
    Conditional,
    Expression,
    Member,
    Name,
    Unary,
    last_name,
    name_of,
)
from sysmlc.ir.expressions import Literal as LiteralExpression
from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.domains import regions_of
from sysmlc.logic.evaluate import is_true, value_of
from sysmlc.logic.expressions.elaboration import elaborate_value
from sysmlc.logic.expressions.linear import COMPARISONS
from sysmlc.logic.expressions.number_formulas import compare_regions
from sysmlc.logic.expressions.symbols import find_symbol
from sysmlc.logic.formula import Const, Literal, Var
from sysmlc.logic.machines.machine import (
    HISTORIES,
    INACTIVE,
    Action,
    Assign,
    Machine,
    Raise,
    Region,
    Transition,
    Vertex,
)


def evaluate_expression(
    machine: Machine, expression: Expression, store: Mapping[str, Literal]
) -> Literal:
    """Return the value of an expression for the values in *store*.

    Integers divide towards zero; x / 0 is 0 and x % 0 is x.
    """
    match expression:
        case LiteralExpression(value):
            return value if isinstance(value, bool | int | str) else 0
        case Name() | Member():
            return _evaluate_name(machine, expression, store)
        case Unary(op, operand):
            value = evaluate_expression(machine, operand, store)
            return not value if op == "not" else int(value) * (-1 if op == "-" else 1)
        case Conditional(condition, then, otherwise):
            branch = then if evaluate_expression(machine, condition, store) else otherwise
            return evaluate_expression(machine, branch, store)
        case Binary(op, left, right):
            truth = compare_regions(expression, machine.scope) if op in COMPARISONS else None
            if truth is not None:
                return is_true(truth, store)
            return _OPERATIONS[op](
                evaluate_expression(machine, left, store),
                evaluate_expression(machine, right, store),
            )
        case _:
            raise TypeError(f"{expression} has no finite value")


def _evaluate_name(machine: Machine, name: Name | Member, store: Mapping[str, Literal]) -> Literal:
    symbol = find_symbol(name, machine.scope)
    match None if symbol is None else symbol.formula:
        case Var(variable):
            return store[variable]
        case Const(value):
            return value
        case _:
            return last_name(name_of(name) or "")


def _divide(left: int, right: int) -> int:
    if right == 0:
        return 0
    # Python's // rounds down; contracts divide towards zero.
    sign = 1 if (left < 0) == (right < 0) else -1
    return sign * (abs(left) // abs(right))


_OPERATIONS: dict[str, Callable[..., Literal]] = {
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "xor": lambda a, b: a != b,
    "implies": lambda a, b: not a or b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _divide,
    "%": lambda a, b: a - b * _divide(a, b),
}


class Reaction(Struct, frozen=True):
    """A reaction in progress; ``store`` has the current values, including region variables."""

    store: Mapping[str, Literal]
    raised: frozenset[str] = frozenset()
    picked: Mapping[str, str] = field(default_factory=dict)
    left_states: frozenset[str] = frozenset()
    opened: tuple[str, ...] = ()
    """Entered states, outermost first; some of their regions may not have started yet."""
    guard_values: Mapping[str, Literal] = field(default_factory=dict)
    """The values that guards read."""
    assigned: frozenset[str] = frozenset()
    """The variables to which an effect, entry or exit has assigned a value, the same or another."""

    def with_value(self, name: str, value: Literal) -> "Reaction":
        """Return the reaction with a new value."""
        return replace(self, store={**self.store, name: value})


def take_transition(
    machine: Machine,
    now: Mapping[str, Literal],
    first: Transition,
    written: Mapping[str, Literal],
) -> list[Reaction]:
    """Return the possible reactions of a transition that leaves a state.

    There are none if a guard is false, and several if the path leads through open choices. Effects
    read the values in *written*, which actions that end in this step have assigned; so do the
    guards of a completion transition if its do behaviour ends in this step.
    """
    endings = (machine.vertices[source].ending for source in first.sources)
    is_end = not first.occurrences and any(now[name] for name in endings if name)
    after = {**now, **written}
    start = replace(Reaction(after), guard_values=after if is_end else now)
    runs = _follow(machine, start, now, first)
    return [after for run in runs for after in start_open_regions(machine, run, now)]


def _follow(
    machine: Machine, run: Reaction, past: Mapping[str, Literal] | None, transition: Transition
) -> list[Reaction]:
    """Return the reactions after a transition and the transitions behind its pseudostates.

    There is none if a guard is false. *past* is the valuation in which the reaction began, or None
    at the start of the machine.
    """
    source = machine.vertices[transition.source]
    # A choice is dynamic (UML 2.5.1, 14.2.3.7): guards behind it read the values reached there.
    if source.kind == "choice":
        run = replace(run, guard_values=run.store)
    if transition.guard is not None and not evaluate_expression(
        machine, transition.guard, run.guard_values
    ):
        return []
    if source.pick:
        run = replace(run, picked={**run.picked, source.pick: transition.literal})
    region = machine.find_main_region(transition)
    if region and not machine.has_concurrent_exits(source.id):
        run = _leave_region(machine, run, region)
    for segment in (transition, *transition.join_partners):
        run = run_actions(machine, run, segment.effect)
    if not region:
        return [run]
    return _arrive(
        machine,
        _enter_outer_states(machine, run, region, transition.target),
        past,
        transition.target,
    )


def _arrive(
    machine: Machine, run: Reaction, past: Mapping[str, Literal] | None, id: str
) -> list[Reaction]:
    vertex, outgoing = machine.vertices[id], machine.outgoing.get(id, ())
    if vertex.is_stable:
        return [_enter_state(machine, run, vertex)]
    if vertex.kind in HISTORIES:
        return _restore_history(machine, run, past, vertex)
    if not machine.has_concurrent_exits(id):
        return [
            after for transition in outgoing for after in _follow(machine, run, past, transition)
        ]
    runs = [run]
    for transition in outgoing:
        runs = [after for branch in runs for after in _follow(machine, branch, past, transition)]
    return runs


def _leave_region(machine: Machine, run: Reaction, region: str) -> Reaction:
    """Leave the active states of a region, innermost first."""
    for vertex in find_active_vertices(machine, run.store, region):
        for inner in vertex.regions:
            run = _leave_region(machine, run, inner)
        run = run_actions(machine, run, vertex.exit)
        opened = tuple(id for id in run.opened if id != vertex.id)
        run = replace(run, left_states=run.left_states | {vertex.id}, opened=opened)
    return run.with_value(machine.regions[region].variable, INACTIVE)


def find_active_vertices(
    machine: Machine, store: Mapping[str, Literal], region: str
) -> list[Vertex]:
    """Return the vertex that is active in a region; none if the region is inactive."""
    return _list_vertices(machine, region, store[machine.regions[region].variable])


def _list_vertices(machine: Machine, region: str, literal: Literal) -> list[Vertex]:
    vertices = [vertex for vertex in machine.vertices.values() if vertex.region == region]
    return [vertex for vertex in vertices if vertex.is_stable and vertex.literal == literal]


def _enter_outer_states(machine: Machine, run: Reaction, region: str, target: str) -> Reaction:
    """Enter the states in *region* that contain the target, outermost first."""
    for id in reversed(machine.list_enclosing_states(target)):
        if region in machine.list_enclosing_regions(id) and not is_active(machine, run.store, id):
            run = _enter_state(machine, run, machine.vertices[id])
    return run


def _enter_state(machine: Machine, run: Reaction, state: Vertex) -> Reaction:
    run = run.with_value(machine.regions[state.region].variable, state.literal)
    return replace(run_actions(machine, run, state.entry), opened=(*run.opened, state.id))


def start_open_regions(
    machine: Machine, run: Reaction, past: Mapping[str, Literal] | None
) -> list[Reaction]:
    """Start the inactive regions of the entered states, innermost states first."""
    for id in reversed(run.opened):
        for region in machine.vertices[id].regions:
            if run.store[machine.regions[region].variable] == INACTIVE:
                runs = start_region(machine, run, past, region)
                return [
                    after
                    for started in runs
                    for after in start_open_regions(machine, started, past)
                ]
    return [run]


def start_region(
    machine: Machine, run: Reaction, past: Mapping[str, Literal] | None, region: str
) -> list[Reaction]:
    """Start a region with its initial transition.

    A region without one is never entered by default (``well_formedness``).
    """
    outgoing = machine.outgoing.get(machine.regions[region].initial, ())
    start = replace(run, guard_values=run.store)
    return [after for transition in outgoing for after in _follow(machine, start, past, transition)]


def _restore_history(
    machine: Machine, run: Reaction, past: Mapping[str, Literal] | None, history: Vertex
) -> list[Reaction]:
    """Enter the last active state of the region of a history pseudostate.

    Without such a state, take the transition of the pseudostate or start the region.
    """
    last = [] if past is None else _last_active_vertices(machine, past, history.region)
    if last and last[0].kind == "state":
        return [_reenter(machine, run, past or {}, last[0], history.kind == "deep-history")]
    outgoing = machine.outgoing.get(history.id, ())
    if not outgoing:
        return start_region(machine, run, past, history.region)
    return [after for transition in outgoing for after in _follow(machine, run, past, transition)]


def _last_active_vertices(
    machine: Machine, past: Mapping[str, Literal], region: str
) -> list[Vertex]:
    """Return the active vertex of a region, or the last active vertex of an inactive region."""
    return _list_vertices(machine, region, last_literal(past, machine.regions[region]))


def _reenter(
    machine: Machine, run: Reaction, past: Mapping[str, Literal], state: Vertex, is_deep: bool
) -> Reaction:
    """Enter *state* again; deep history restores its inner regions too."""
    run = _enter_state(machine, run, state)
    if is_deep:
        for inner in state.regions:
            for last in _last_active_vertices(machine, past, inner):
                run = _reenter(machine, run, past, last, is_deep)
    return run


def run_actions(machine: Machine, run: Reaction, actions: tuple[Action, ...]) -> Reaction:
    for action in actions:
        match action:
            case Raise(output):
                run = replace(run, raised=run.raised | {output})
            case Assign(variable, expression):
                domain = machine.find_variable(variable).domain
                if regions_of(domain) is not None:
                    cases = elaborate_value(expression, machine.scope, domain).cases
                    fitting = (case for case in cases if is_true(case.condition, run.store))
                    value = value_of(next(fitting).value, run.store)
                else:
                    value = evaluate_expression(machine, expression, run.store)
                if isinstance(domain, IntegerDomain):
                    value = clamp(int(value), domain)
                run = run.with_value(variable, value)
                run = replace(run, assigned=run.assigned | {variable})
    return run


def clamp(value: int, domain: IntegerDomain) -> int:
    """Return the value, clamped to the domain."""
    return max(domain.low, min(domain.high, value))


def is_active(machine: Machine, store: Mapping[str, Literal], vertex: str) -> bool:
    """Whether the vertex is the active state of its region."""
    state = machine.vertices[vertex]
    return store[machine.regions[state.region].variable] == state.literal and state.is_stable


def last_literal(now: Mapping[str, Literal], region: Region) -> Literal:
    """Return the literal of the active state, or of the last active state of an inactive region."""
    literal = now[region.variable]
    return literal if literal != INACTIVE or not region.memory else now[region.memory]
