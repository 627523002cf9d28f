"""Random parts that send signals to one another, and an interpreter that reads no contract.

Each part has a state machine, an outlet and an inlet. A connector leads from an outlet to an inlet.
A signal that the reaction of a step sends is the event of the receiver in the next step.
"""

from collections.abc import Iterator
from itertools import product
from random import Random

from msgspec import Struct

PARTS = ("p0", "p1", "p2")
SIGNALS = ("E0", "E1")
STATES = ("S0", "S1")


class Move(Struct, frozen=True):
    """A transition; the event Go comes from outside, and ``sent`` is a signal or empty."""

    source: str
    target: str
    event: str
    sent: str


class Line(Struct, frozen=True):
    """Parts with their transitions, and the connectors from senders to receivers."""

    moves: dict[str, tuple[Move, ...]]
    connectors: tuple[tuple[str, str], ...]

    def list_events(self, part: str) -> list[str]:
        """Return the events that a part accepts."""
        return sorted({move.event for move in self.moves[part]})


def make_line(random: Random) -> Line:
    """Return random parts; a part accepts Go and, if it is connected, all signals."""
    pairs = [(left, right) for left in PARTS for right in PARTS if left != right]
    connectors = tuple(pair for pair in pairs if random.random() < 0.5)
    line = Line(dict.fromkeys(PARTS, ()), connectors)
    for part in PARTS:
        sent = tuple(
            Move(random.choice(STATES), random.choice(STATES), "Go", signal)
            for signal in SIGNALS
            if random.random() < 0.7
        )
        line.moves[part] = sent or (Move("S0", "S1", "Go", ""),)
    for part in PARTS:
        is_connected = any(receiver == part for _, receiver in connectors)
        accepted = list(SIGNALS) if is_connected else []
        sent = sorted({move.sent for move in line.moves[part]} - {""})
        for signal in accepted:
            answer = random.choice(("", "", *sent))
            move = Move(random.choice(STATES), random.choice(STATES), signal, answer)
            line.moves[part] += (move,)
    return line


# -- text --------------------------------------------------------------------------------------


def write_line(line: Line) -> str:
    """Return the parts as SysML v2."""
    lines = ["package P {", "item def Go; item def E0; item def E1;"]
    lines += ["port def Chute { out item one : E0; out item two : E1; }", "part def B {"]
    for part in PARTS:
        lines += [f"part {part} {{", "port outlet : Chute; port inlet : ~Chute;"]
        lines += ["exhibit state M {", "entry; then S0;", *(f"state {state};" for state in STATES)]
        lines += [_write_move(move) for move in line.moves[part]]
        lines += ["}", "}"]
    lines += [f"connect {left}.outlet to {right}.inlet;" for left, right in line.connectors]
    return "\n".join([*lines, "}", "}", ""])


def _write_move(move: Move) -> str:
    port = "" if move.event == "Go" else " via inlet"
    effect = f" do send new {move.sent}() via outlet" if move.sent else ""
    return f"transition first {move.source} accept {move.event}{port}{effect} then {move.target};"


# -- runs --------------------------------------------------------------------------------------


class State(Struct, frozen=True):
    """The state of each part, and the signals that it has just sent."""

    states: tuple[str, ...]
    sent: tuple[str, ...]


def list_inputs(line: Line, state: State) -> Iterator[tuple[str, ...]]:
    """Yield the events that may occur: one for each part."""
    options = []
    for part in PARTS:
        arriving = [
            signal
            for sender, signal in zip(PARTS, state.sent, strict=True)
            if (sender, part) in line.connectors and signal in line.list_events(part)
        ]
        options.append(sorted(set(arriving)) or ["none", "Go"])
    yield from product(*options)


def list_successors(line: Line, state: State, events: tuple[str, ...]) -> Iterator[State]:
    """Yield the states that may follow; several transitions of one state are a choice."""
    options = []
    for part, now, event in zip(PARTS, state.states, events, strict=True):
        moves = [m for m in line.moves[part] if m.source == now and m.event == event]
        options.append([(move.target, move.sent) for move in moves] or [(now, "")])
    for row in product(*options):
        yield State(tuple(target for target, _ in row), tuple(sent for _, sent in row))


def observe(state: State, events: tuple[str, ...]) -> frozenset:
    """Return what is true in a step."""
    rows = zip(PARTS, state.states, events, strict=True)
    return frozenset(
        fact
        for part, now, event in rows
        for fact in (f"{part}.state={now}", f"{part}.event={event}")
    )


def list_lost_signals(line: Line, state: State) -> set[str]:
    """Return the parts to which several others send a signal that they accept."""
    counts = dict.fromkeys(PARTS, 0)
    for sender, receiver in line.connectors:
        signal = state.sent[PARTS.index(sender)]
        counts[receiver] += signal in line.list_events(receiver)
    return {part for part, count in counts.items() if count > 1}


def list_observed_steps(line: Line) -> tuple[set[tuple[frozenset, frozenset]], set[str]]:
    """Return the pairs of observations of successive steps, and the parts that lose signals."""
    first = State(("S0",) * len(PARTS), ("",) * len(PARTS))
    seen, worklist, pairs = {first}, [first], set()
    losing: set[str] = set()
    while worklist:
        state = worklist.pop()
        losing |= list_lost_signals(line, state)
        for events in list_inputs(line, state):
            for after in list_successors(line, state, events):
                if after not in seen:
                    seen.add(after)
                    worklist.append(after)
                pairs |= {
                    (observe(state, events), observe(after, inputs))
                    for inputs in list_inputs(line, after)
                }
    return pairs, losing
