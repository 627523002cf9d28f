"""Values of expressions for the reference interpreter, straight from what is written.

Independent of ``elaborate`` and ``evaluate``, which the derivation uses.
"""

from collections.abc import Callable, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic.contract import IntegerDomain
from sysmlc.logic.expressions.expression import (
    Binary,
    Conditional,
    Expression,
    Member,
    Name,
    Unary,
    name_of,
)
from sysmlc.logic.expressions.expression import Literal as Written
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


def value_of(machine: Machine, expression: Expression, store: Mapping[str, Literal]) -> Literal:
    """Value of an expression with these values of the variables.

    Integers divide towards zero; x / 0 is 0 and x % 0 is x.
    """
    match expression:
        case Written(value):
            return value if isinstance(value, bool | int | str) else 0
        case Name() | Member():
            return _named(machine, expression, store)
        case Unary(op, operand):
            inner = value_of(machine, operand, store)
            return not inner if op == "not" else int(inner) * (-1 if op == "-" else 1)
        case Conditional(condition, then, otherwise):
            branch = then if value_of(machine, condition, store) else otherwise
            return value_of(machine, branch, store)
        case Binary(op, left, right):
            return _OPERATIONS[op](value_of(machine, left, store), value_of(machine, right, store))
        case _:
            raise TypeError(f"{expression} has no finite value")


def _named(machine: Machine, name: Name | Member, store: Mapping[str, Literal]) -> Literal:
    written = name_of(name) or ""
    symbol = machine.scope(written)
    match None if symbol is None else symbol.formula:
        case Var(variable):
            return store[variable]
        case Const(value):
            return value
        case _:
            return written.replace(".", "::").rpartition("::")[2]


def _quotient(left: int, right: int) -> int:
    if right == 0:
        return 0
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
    "/": _quotient,
    "%": lambda a, b: a - b * _quotient(a, b),
}


class Run(Struct, frozen=True):
    """How far the reaction has come; ``store`` has the values reached, regions included."""

    store: Mapping[str, Literal]
    raised: frozenset[str] = frozenset()
    picked: Mapping[str, str] = field(default_factory=dict)
    left: frozenset[str] = frozenset()
    opened: tuple[str, ...] = ()
    """States that were entered and may have regions that nothing has started yet."""
    seen: Mapping[str, Literal] = field(default_factory=dict)
    """The values that guards read."""

    def put(self, name: str, value: Literal) -> "Run":
        return replace(self, store={**self.store, name: value})

    def pick(self, name: str, literal: str) -> "Run":
        return replace(self, picked={**self.picked, name: literal})


def take(machine: Machine, now: Mapping[str, Literal], first: Transition) -> list[Run]:
    """All ways to take a transition that leaves a state; none when a guard on the way is false."""
    begun = replace(Run(now), seen=now)
    runs = _follow(machine, begun, now, first)
    return [after for run in runs for after in fill(machine, run, now)]


def _follow(
    machine: Machine, run: Run, past: Mapping[str, Literal] | None, one: Transition
) -> list[Run]:
    """The ways to take a transition and all that it leads on to; none when a guard is false.

    ``past`` is the step in which the reaction began, None at the start of the machine.
    """
    source = machine.vertices[one.source]
    if source.kind == "choice":
        run = replace(run, seen=run.store)
    if one.guard is not None and not value_of(machine, one.guard, run.seen):
        return []
    if source.pick:
        run = run.pick(source.pick, one.literal)
    region = machine.main_region(one)
    if region and not machine.is_split(source.id):
        run = _leave(machine, run, region)
    for each in (one, *one.also):
        run = _act(machine, run, each.effect)
    if not region:
        return [run]
    return _arrive(machine, _open(machine, run, region, one.target), past, one.target)


def _arrive(machine: Machine, run: Run, past: Mapping[str, Literal] | None, id: str) -> list[Run]:
    vertex, following = machine.vertices[id], machine.outgoing.get(id, ())
    if vertex.is_stable:
        return [_enter(machine, run, vertex)]
    if vertex.kind in HISTORIES:
        return _restore(machine, run, past, vertex)
    if not machine.is_split(id):
        return [after for one in following for after in _follow(machine, run, past, one)]
    runs = [run]
    for one in following:
        runs = [after for each in runs for after in _follow(machine, each, past, one)]
    return runs


def _leave(machine: Machine, run: Run, region: str) -> Run:
    """Leave what is active in a region, innermost first."""
    for vertex in active_in(machine, run.store, region):
        for inner in vertex.regions:
            run = _leave(machine, run, inner)
        run = _act(machine, run, vertex.exit)
        still = tuple(one for one in run.opened if one != vertex.id)
        run = replace(run, left=run.left | {vertex.id}, opened=still)
    return run.put(machine.regions[region].variable, INACTIVE)


def active_in(machine: Machine, store: Mapping[str, Literal], region: str) -> list[Vertex]:
    """The vertex that a region is in; none when it is inactive."""
    literal = store[machine.regions[region].variable]
    inside = [one for one in machine.vertices.values() if one.region == region]
    return [one for one in inside if one.is_stable and one.literal == literal]


def _open(machine: Machine, run: Run, region: str, target: str) -> Run:
    """Enter the states of the region that contain the target, outermost first."""
    for id in reversed(machine.above(target)):
        if region in machine.around(id) and not is_active(machine, run.store, id):
            run = _enter(machine, run, machine.vertices[id])
    return run


def _enter(machine: Machine, run: Run, state: Vertex) -> Run:
    run = run.put(machine.regions[state.region].variable, state.literal)
    return replace(_act(machine, run, state.entry), opened=(*run.opened, state.id))


def fill(machine: Machine, run: Run, past: Mapping[str, Literal] | None) -> list[Run]:
    """Start the regions of entered states to which no way led, those of inner states first."""
    for id in reversed(run.opened):
        for region in machine.vertices[id].regions:
            if run.store[machine.regions[region].variable] == INACTIVE:
                runs = begin(machine, run, past, region)
                return [after for one in runs for after in fill(machine, one, past)]
    return [run]


def begin(machine: Machine, run: Run, past: Mapping[str, Literal] | None, region: str) -> list[Run]:
    """Start a region with its initial transition."""
    outgoing = machine.outgoing[machine.regions[region].initial]
    begun = replace(run, seen=run.store)
    return [after for one in outgoing for after in _follow(machine, begun, past, one)]


def _restore(
    machine: Machine, run: Run, past: Mapping[str, Literal] | None, history: Vertex
) -> list[Run]:
    last = [] if past is None else _remembered(machine, past, history.region)
    if last and last[0].kind == "state":
        return [_again(machine, run, past or {}, last[0], history.kind == "deep-history")]
    following = machine.outgoing.get(history.id, ())
    if not following:
        return begin(machine, run, past, history.region)
    return [after for one in following for after in _follow(machine, run, past, one)]


def _remembered(machine: Machine, past: Mapping[str, Literal], region: str) -> list[Vertex]:
    last = last_of(past, machine.regions[region])
    inside = [one for one in machine.vertices.values() if one.region == region]
    return [one for one in inside if one.is_stable and one.literal == last]


def _again(
    machine: Machine, run: Run, past: Mapping[str, Literal], state: Vertex, is_deep: bool
) -> Run:
    run = _enter(machine, run, state)
    for inner in state.regions if is_deep else ():
        for last in _remembered(machine, past, inner):
            run = _again(machine, run, past, last, is_deep)
    return run


def _act(machine: Machine, run: Run, actions: tuple[Action, ...]) -> Run:
    for action in actions:
        match action:
            case Raise(output):
                run = replace(run, raised=run.raised | {output})
            case Assign(variable, expression):
                value = value_of(machine, expression, run.store)
                domain = machine.variable(variable).domain
                if isinstance(domain, IntegerDomain):
                    value = bounded(int(value), domain)
                run = run.put(variable, value)
    return run


def bounded(value: int, domain: IntegerDomain) -> int:
    """The value, or the bound of the domain beyond which it is."""
    return max(domain.low, min(domain.high, value))


def is_active(machine: Machine, store: Mapping[str, Literal], vertex: str) -> bool:
    """Whether the vertex is the state of its region."""
    one = machine.vertices[vertex]
    return store[machine.regions[one.region].variable] == one.literal and one.is_stable


def last_of(now: Mapping[str, Literal], region: Region) -> Literal:
    """What the region is now, or was when it was last active."""
    literal = now[region.variable]
    return literal if literal != INACTIVE or not region.memory else now[region.memory]
