"""Rules about floors, robots and missions of a model (SM564 to SM569, SM577)."""

from sysmlc.diagnostics import Severity, rule

OFF_FLOOR = rule(
    "SM564",
    "place-off-floor",
    Severity.ERROR,
    "'{name}' is in row {row}, column {column}, which the floor '{floor}' does not have",
    help="rows are 0 to {rows}, columns 0 to {columns}",
)
CELL_TAKEN = rule(
    "SM565",
    "cell-taken",
    Severity.ERROR,
    "'{name}' is in the cell of '{other}' (row {row}, column {column})",
    help="give it another row or column",
)
NO_NUMBER = rule(
    "SM566",
    "floor-number",
    Severity.ERROR,
    "'{attribute}' of '{name}' {problem}",
    help="give the attribute a whole number as its value",
)
CIRCULAR_ORDER = rule(
    "SM567",
    "targets-wait-for-one-another",
    Severity.ERROR,
    "target '{name}' would have to be reached before itself: {circle}",
    help="remove one of these connections",
)
CARRIED_TWICE = rule(
    "SM568",
    "carried-twice",
    Severity.ERROR,
    "'Carry' connections send a robot {way} '{name}' {there} both '{one}' and '{other}'",
    help="use 'Before' for one of them",
)
OUT_OF_REACH = rule(
    "SM569",
    "target-out-of-reach",
    Severity.ERROR,
    "no robot can reach target '{name}': obstacles are on every way",
    help="move the target or an obstacle",
)
SAME_FLOOR = rule(
    "SM577",
    "floors-of-one-name",
    Severity.ERROR,
    "there is another floor '{name}': this one is not studied",
    help="give one of the floors another name",
)
