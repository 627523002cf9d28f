"""Counter-strategies as PlantUML diagrams: what the environment does, and a run."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from sysmlc.logic.contract import Contract, Variable
from sysmlc.logic.printing import print_literal
from sysmlc.support.plantuml_text import label
from sysmlc.synthesis.counter.machine import Counter, Row, State, example
from sysmlc.synthesis.witness import Party, as_formula, sequence

MOST_SHOWN = 12
"""States up to which a diagram can be read."""
_MOST_LINES = 4
"""Conditions that an arrow tells one by one."""


def run(counter: Counter, contract: Contract) -> str:
    """A run in which the component does what it may, and fails, as a sequence diagram."""
    title, trace = [f"{label(contract.component)}", "cannot keep its contract"], example(counter)
    if trace.loop < len(trace.steps):
        some = "not kept" if len(counter.missed) == 1 else "not all kept"
        title += [f"{some}: {label(as_formula(one))}" for one in counter.missed]
    return sequence("\\n".join(title), trace, (Party(contract.component, contract),))


def diagram(counter: Counter, contract: Contract) -> str:
    """The environment as a state diagram: in a state what it gives, on an arrow what is answered.

    Inputs that are the same in all states are told once.
    """
    same = _same([state.given for state in counter.states])
    lines = [
        "@startuml",
        f"title what makes {label(contract.component)} fail",
        "hide empty description",
    ]
    if same:
        lines += [
            "note as same",
            f"  always {_pairs(counter.inputs, counter.states[0].given, same)}",
        ]
        lines += ["end note"]
    varying = [at for at in range(len(counter.inputs)) if at not in same]
    for number, state in enumerate(counter.states):
        given = _pairs(counter.inputs, state.given, varying)
        ending = "" if state.moves else "\\n<b>no answer is left</b>"
        lines.append(f'state "{label(given or "wait")}{ending}" as S{number}')
    lines.append("[*] --> S0")
    for number, state in enumerate(counter.states):
        for place, words in _arrows(state, counter.outputs):
            answers = "\\n".join(map(label, words))
            lines.append(f"S{number} --> S{place} : {answers}")
    return "\n".join((*lines, "@enduml", ""))


def _arrows(state: State, outputs: Sequence[Variable]) -> Iterator[tuple[int, list[str]]]:
    """The next states, each with the answers that lead there."""
    if len(state.moves) == 1:
        ((row, place),) = state.moves.items()
        yield place, [f"only {_pairs(outputs, row, range(len(row)))}"]
        return
    for place, rows in by_next(state).items():
        others = [row for row, other in state.moves.items() if other != place]
        words = [" ".join(one) or "any answer" for one in _conditions(rows, others, outputs)]
        yield place, words if len(words) <= _MOST_LINES else [*words[: _MOST_LINES - 1], "or more"]


def by_next(state: State) -> Mapping[int, list[Row]]:
    found: dict[int, list[Row]] = {}
    for row, place in state.moves.items():
        found.setdefault(place, []).append(row)
    return found


def _conditions(
    rows: Sequence[Row], others: Sequence[Row], variables: Sequence[Variable]
) -> Iterator[list[str]]:
    """What rows have in common and none of the others has, in as few words as is simple."""
    for row, kept in told(rows, others):
        yield [f"{variables[at].name}={print_literal(row[at])}" for at in kept]


def told(rows: Sequence[Row], others: Sequence[Row]) -> Iterator[tuple[Row, list[int]]]:
    """Rows with the places that tell them from all others; each stands for all that agree there."""
    left = list(rows)
    while left:
        row, kept = left[0], list(range(len(left[0])))
        for place in list(kept):
            fewer = [one for one in kept if one != place]
            if not any(_agree(row, other, fewer) for other in others):
                kept = fewer
        yield row, kept
        left = [one for one in left if not _agree(row, one, kept)]


def _agree(one: Row, other: Row, places: Iterable[int]) -> bool:
    return all(one[place] == other[place] for place in places)


def _same(rows: Sequence[Row]) -> list[int]:
    """The places at which all rows agree; none when there is one row."""
    if len(rows) < 2:
        return []
    return [at for at in range(len(rows[0])) if all(row[at] == rows[0][at] for row in rows)]


def _pairs(variables: Sequence[Variable], row: Row, places: Iterable[int]) -> str:
    return ", ".join(f"{variables[at].name}={print_literal(row[at])}" for at in places)
