"""Random blocks whose Integers have no ranges and whose guards compare a Real.

``ExploredBlock`` plays a block with Integers from -20 to 40. It shares no code with the compiler.
"""

from itertools import product

LEVELS = range(-20, 41)
TEMPERATURES = (5.0, 12.0, 15.0, 18.0, 20.0)
EVENTS = ("none", "Go", "Stop")
STATES = ("A", "B", "C")
COMPARISONS = {
    "<": lambda left, right: left < right,
    "<=": lambda left, right: left <= right,
    ">": lambda left, right: left > right,
    ">=": lambda left, right: left >= right,
}
REQUIRED = [f"G !(state={state})" for state in STATES]
REQUIRED += ["G (count <= 2)", "G (count >= 0)", "G (count <= 15)", "G (state=B -> X (state=B))"]


def make_block(random):
    """Return random transitions: source, event, guard, increment of ``count``, and target."""
    return [
        (
            random.choice(STATES),
            random.choice(EVENTS[1:]),
            _make_guard(random),
            random.choice((0, 0, 1, 3, -1)),
            random.choice(STATES),
        )
        for _ in range(random.randint(2, 5))
    ]


def _make_guard(random):
    kind = random.choice(("", "", "level", "level", "count", "temp", "temp"))
    if not kind:
        return None
    limits = (12.0, 18.0) if kind == "temp" else (-1, 0, 0, 2, 2, 15, 15)
    return kind, random.choice(list(COMPARISONS)), random.choice(limits)


def write_block(block):
    """Return the model of a block with its requirements R0, R1 and so on."""
    lines = [
        "package P {",
        "private import ScalarValues::*;",
        "item def Go;",
        "item def Stop;",
        "part def B {",
        "attribute temp : Real;",
        "in attribute level : Integer;",
        "attribute count : Integer := 0;",
        "exhibit state M {",
        "entry; then A;",
        *(f"state {state};" for state in STATES),
    ]
    for source, event, guard, step, target in block:
        condition = f" if {' '.join(map(str, guard))}" if guard else ""
        effect = f" do assign count := count + {step}" if step > 0 else ""
        effect = f" do assign count := count - {-step}" if step < 0 else effect
        lines.append(f"transition first {source} accept {event}{condition}{effect} then {target};")
    lines.append("} }")
    for number, formula in enumerate(REQUIRED):
        lines.append(f"requirement def R{number} {{ subject it : B;")
        lines.append(f'require constraint {{ language "ltl" /* {formula} */ }} }}')
    return "\n".join((*lines, "}"))


class ExploredBlock:
    """The states that a block reaches while both Integers stay in ranges, and its steps."""

    def __init__(self, block, level, count):
        self.block = block
        self.steps = set()
        self.reached = {("A", 0)}
        worklist = [("A", 0)]
        while worklist:
            state, value = worklist.pop()
            for inputs in product(EVENTS, level, TEMPERATURES):
                for after in self.list_successors(state, value, *inputs):
                    self.steps.add(((state, value), after))
                    if after[1] in count and after not in self.reached:
                        self.reached.add(after)
                        worklist.append(after)

    def list_successors(self, state, count, event, level, temp):
        """Return the states after one step; several enabled transitions are a choice."""
        values = {"level": level, "count": count, "temp": temp}
        enabled = [
            (target, count + step)
            for source, trigger, guard, step, target in self.block
            if (source, trigger) == (state, event)
            and (guard is None or COMPARISONS[guard[1]](values[guard[0]], guard[2]))
        ]
        return enabled or [(state, count)]

    def violates(self, formula):
        """Whether a run violates one of the required formulas."""
        if formula.startswith("G !"):
            return any(state == formula[-2] for state, _ in self.reached)
        if formula.startswith("G (state"):
            return any(before[0] == "B" != after[0] for before, after in self.steps)
        _, relation, limit = formula[3:-1].split()
        return any(not COMPARISONS[relation](count, int(limit)) for _, count in self.reached)
