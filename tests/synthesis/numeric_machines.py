"""Random blocks in SysML v2 with a state machine whose guards compare numbers.

All numbers of a machine are multiples of its ``unit``, and are counted in it.
"""

import operator
from collections.abc import Callable, Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from random import Random

from msgspec import Struct
from msgspec.structs import replace

RESOLUTION = 24
"""Values of features are counted in this fraction of the unit."""
COMPARISONS: dict[str, Callable[[int, int], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
SHAPES = ("G p", "G (p -> X q)", "F p", "G F p", "G (p -> F q)")
EVENTS = ("E0", "E1")


class Feature(Struct, frozen=True):
    """A number of the block: ``kind`` is input, constant or attribute.

    A constant without a value has any value, but the same one in all steps. Effects assign
    attributes only.
    """

    name: str
    kind: str = "input"
    value: int | None = None
    is_integer: bool = False

    @property
    def is_constant(self) -> bool:
        """Whether the feature has the same value in all steps."""
        return self.kind == "constant"

    @property
    def is_known(self) -> bool:
        """Whether the feature is a constant with a value."""
        return self.is_constant and self.value is not None


class Literal(Struct, frozen=True):
    """A comparison of ``sum(factor * feature)`` with a bound."""

    terms: tuple[tuple[str, int], ...]
    comparison: str
    bound: int

    def is_true(self, values: Mapping[str, int] | Mapping[str, Fraction]) -> bool:
        """Whether the comparison holds for these values."""
        total = sum(factor * values[name] for name, factor in self.terms)
        return COMPARISONS[self.comparison](total, self.bound * RESOLUTION)


class InState(Struct, frozen=True):
    """The condition that the machine is in a state."""

    state: str


class Not(Struct, frozen=True):
    """The negation of a condition."""

    operand: "Condition"


class Pair(Struct, frozen=True):
    """The conjunction (``and``) or disjunction (``or``) of two conditions."""

    word: str
    left: "Condition"
    right: "Condition"


Condition = Literal | InState | Not | Pair


class Move(Struct, frozen=True):
    """A transition: with an ``event``, a change condition ``when``, or by completion.

    The effect assigns to a feature a number, or the sum of its value and a number.
    """

    source: str
    target: str
    guard: Condition | None = None
    event: str = ""
    when: Condition | None = None
    effect: tuple[str, int] | None = None
    is_sum: bool = False


class Machine(Struct, frozen=True):
    """A block with a state machine, which starts in the first state."""

    features: tuple[Feature, ...]
    states: tuple[str, ...]
    moves: tuple[Move, ...]
    constraints: tuple[Condition, ...] = ()
    unit: Fraction = Fraction(1)


class Requirement(Struct, frozen=True):
    """A formula with one of the ``SHAPES`` about conditions p and q."""

    shape: str
    p: Condition
    q: Condition


def list_literals(conditions: Iterable[Condition | None]) -> list[Literal]:
    """Return the literals of conditions, each once."""
    literals: dict[Literal, None] = {}
    worklist = list(conditions)
    while worklist:
        match worklist.pop():
            case Literal() as literal:
                literals[literal] = None
            case Not(operand):
                worklist.append(operand)
            case Pair(_, left, right):
                worklist += left, right
    return list(literals)


# -- text --------------------------------------------------------------------------------------


def write_machine(machine: Machine, requirements: Iterable[Requirement]) -> str:
    """Return the block as SysML v2 text, and requirements R0, R1 and so on about it."""
    unit = machine.unit
    lines = ["package P {", "private import ScalarValues::*;", "item def E0; item def E1;"]
    lines += ["part def B {", *(_write_feature(feature, unit) for feature in machine.features)]
    for condition in machine.constraints:
        lines.append(f"assert constraint {{ {write_condition(condition, unit)} }}")
    lines += ["exhibit state M {", f"entry; then {machine.states[0]};"]
    lines += [f"state {state};" for state in machine.states]
    lines += [*(_write_move(move, unit) for move in machine.moves), "}", "}"]
    for number, requirement in enumerate(requirements):
        constraint = f'language "ltl" /* {write_requirement(requirement, unit)} */'
        lines.append(
            f"requirement def R{number} "
            f"{{ subject it : B; require constraint c {{ {constraint} }} }}"
        )
    return "\n".join([*lines, "}", ""])


def write_requirement(requirement: Requirement, unit: Fraction) -> str:
    """Return the formula of a requirement."""
    texts = {"p": requirement.p, "q": requirement.q}
    return "".join(
        write_condition(texts[sign], unit) if sign in texts else sign for sign in requirement.shape
    )


def write_condition(condition: Condition, unit: Fraction) -> str:
    """Return the text of a condition, in a spelling that guards and formulas share."""
    match condition:
        case Literal(terms, comparison, bound):
            right = _write_number(bound, unit)
            if len(terms) == 2 and terms[1][1] == -1 and (not bound or comparison in "<>="):
                # Authors write "x < y + 2" as well as "x - y <= 2".
                right = _write_sum(terms[1][0], bound, unit) if bound else terms[1][0]
                terms = terms[:1]
            return f"({_write_terms(terms)} {comparison} {right})"
        case InState(state):
            return f"(state={state})"
        case Not(operand):
            return f"(not {write_condition(operand, unit)})"
        case Pair(word, left, right):
            return f"({write_condition(left, unit)} {word} {write_condition(right, unit)})"


def _write_terms(terms: Iterable[tuple[str, int]]) -> str:
    text = ""
    for name, factor in terms:
        sign = "-" if factor < 0 else "+" if text else ""
        separator = " " if text else ""
        number = "" if abs(factor) == 1 else f"{abs(factor)} * "
        text += f"{separator}{sign}{separator}{number}{name}"
    return text


def _write_sum(name: str, number: int, unit: Fraction) -> str:
    return f"{name} {'-' if number < 0 else '+'} {_write_number(abs(number), unit)}"


def _write_number(number: int, unit: Fraction) -> str:
    exact = number * unit
    return f"{Decimal(exact.numerator) / Decimal(exact.denominator):f}"


def _write_feature(feature: Feature, unit: Fraction) -> str:
    keyword = {"input": "in ", "constant": "constant ", "attribute": ""}[feature.kind]
    sign = ":=" if feature.kind == "attribute" else "="
    value = "" if feature.value is None else f" {sign} {_write_number(feature.value, unit)}"
    type_ = "Integer" if feature.is_integer else "Real"
    return f"{keyword}attribute {feature.name} : {type_}{value};"


def _write_move(move: Move, unit: Fraction) -> str:
    event = f" accept {move.event}" if move.event else ""
    when = f" accept when {write_condition(move.when, unit)}" if move.when else ""
    guard = f" if {write_condition(move.guard, unit)}" if move.guard else ""
    effect = ""
    if move.effect:
        name, number = move.effect
        value = _write_sum(name, number, unit) if move.is_sum else _write_number(number, unit)
        effect = f" do assign {name} := {value}"
    return f"transition first {move.source}{event}{when}{guard}{effect} then {move.target};"


# -- random machines ---------------------------------------------------------------------------


UNITS = (Fraction(1), Fraction(1, 2), Fraction(1, 10), Fraction(5, 2), Fraction(18))


def make_machine(random: Random) -> Machine:
    """Return a random machine whose transitions assign nothing."""
    names = random.sample("xyz", random.choice((1, 1, 2, 2, 2, 3)))
    features = [Feature(name) for name in sorted(names)]
    if len(features) < 3 and random.random() < 0.5:
        value = random.choice((None, random.randint(-2, 3)))
        features.append(Feature("k", "constant", value))
    literals = [_make_literal(random, features) for _ in range(random.randint(2, 4))]
    constraint = _make_literal(random, features)
    has_constraint = constraint.comparison != "!=" and random.random() < 0.3
    states, moves = _make_moves(random, literals)
    constraints = (constraint,) if has_constraint else ()
    return Machine(tuple(features), states, moves, constraints, random.choice(UNITS))


def make_assigning_machine(random: Random) -> Machine:
    """Return a random machine that assigns numbers to an attribute."""
    features = [Feature("v", "attribute", random.randint(-1, 2))]
    if random.random() < 0.6:
        features.append(Feature("x"))
    if random.random() < 0.3:
        features.append(Feature("k", "constant", random.randint(-1, 2)))
    literals = [_make_literal(random, features[:1])]
    literals += [_make_literal(random, features) for _ in range(random.randint(1, 3))]
    states, moves = _make_moves(random, literals)
    # Without sums, the attribute has only the values that are assigned.
    has_sums = random.random() < 0.6
    assigning: list[Move] = []
    for move in moves:
        # An attribute that nothing assigns would be an input.
        if not assigning or random.random() < 0.6:
            is_sum = has_sums and random.random() < 0.8
            number = random.choice((1, 1, 2, -1)) if is_sum else random.randint(-1, 3)
            move = replace(move, effect=("v", number), is_sum=is_sum)
        assigning.append(move)
    return Machine(tuple(features), states, tuple(assigning), (), random.choice(UNITS))


def make_requirements(random: Random, machine: Machine, count: int) -> list[Requirement]:
    """Return random requirements about a machine; some name numbers that the machine does not.

    Half of them are likely to hold: they state the effect of a transition.
    """
    literals = list_machine_literals(machine)
    literals += [_make_literal(random, list(machine.features)) for _ in range(2)]
    requirements = []
    for _ in range(count):
        shape = random.choice(SHAPES)
        p, q = (_make_condition(random, literals, machine.states) for _ in "pq")
        if random.random() < 0.5:
            shape = random.choice(SHAPES[1::3])
            move = random.choice(machine.moves)
            condition = move.when or move.guard or p
            p, q = Pair("and", InState(move.source), condition), InState(move.target)
            if random.random() < 0.5:
                q = Pair("or", q, InState(random.choice(machine.states)))
        requirements.append(Requirement(shape, p, q))
    return requirements


def list_machine_literals(machine: Machine) -> list[Literal]:
    """Return the literals of guards, change conditions and constraints."""
    conditions = [condition for move in machine.moves for condition in (move.guard, move.when)]
    return list_literals([*conditions, *machine.constraints])


def _make_literal(random: Random, features: list[Feature]) -> Literal:
    inputs = [feature.name for feature in features if feature.kind != "constant"]
    # Three features that are compared with each other have more cells; a grid has to find them.
    widest = 1 if len(features) > 2 else 3
    comparison = random.choice(("<", "<=", ">", ">=", "<", "<=", ">", ">=", "==", "!="))
    bound = random.randint(-1, widest)
    name = random.choice(inputs)
    others = [feature.name for feature in features if feature.name != name]
    if not others or random.random() < 0.5:
        factor = random.choice((1, 1, 1, 2)) if len(features) < 3 else 1
        return Literal(((name, factor),), comparison, bound)
    signs = random.choice(((1, -1), (1, -1), (-1, 1), (1, 1))[: 3 if len(features) > 2 else 4])
    terms = tuple(zip((name, random.choice(others)), signs, strict=True))
    return Literal(terms, comparison, random.choice((0, bound)))


def _make_condition(
    random: Random, literals: list[Literal], states: tuple[str, ...] = ()
) -> Condition:
    """Return a condition of one or two literals; one of them may be about *states* instead."""
    operands: list[Condition] = random.sample(literals, min(len(literals), 2))
    if states and random.random() < 0.6:
        operands.insert(0, InState(random.choice(states)))
    operands = [Not(item) if random.random() < 0.25 else item for item in operands]
    if len(operands) == 1 or random.random() < 0.5:
        return operands[0]
    return Pair(random.choice(("and", "and", "or")), *operands[:2])


def _make_moves(
    random: Random, literals: list[Literal]
) -> tuple[tuple[str, ...], tuple[Move, ...]]:
    """Return states and transitions; a state is entered from one before it."""
    states = tuple("ABCD"[: random.randint(2, 4)])
    ends = [(random.choice(states[:number]), states[number]) for number in range(1, len(states))]
    ends += [(random.choice(states), random.choice(states)) for _ in range(random.randint(1, 4))]
    moves = [_make_move(random, source, target, literals) for source, target in ends]
    return states, tuple(dict.fromkeys(moves))


def _make_move(random: Random, source: str, target: str, literals: list[Literal]) -> Move:
    condition = _make_condition(random, literals)
    kind = random.random()
    if kind < 0.55:
        return Move(source, target, condition)
    guard = condition if random.random() < 0.7 else None
    if kind < 0.8:
        return Move(source, target, guard, random.choice(EVENTS))
    change = _make_condition(random, literals)
    return Move(source, target, guard if random.random() < 0.3 else None, when=change)
