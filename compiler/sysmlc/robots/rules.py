"""Rules about floors, robots and missions as they are drawn (SM564 to SM569, SM577)."""

from sysmlc.diagnostics import Severity, rule
from sysmlc.robots.samples import another, hall, ordered, placed

_ONE = placed("r1", "robot", 0, 0)
_DOCK = placed("dock", "target", 1, 2)
_SHELF = placed("shelf", "target", 0, 2)
_RACK = placed("rack", "target", 1, 1)

OFF_FLOOR = rule(
    "SM564",
    "place-off-floor",
    Severity.ERROR,
    "'{name}' is in row {row}, column {column}, which the floor '{floor}' does not have",
    why="Robots, obstacles and targets have a cell of the floor; rows and columns are counted "
    "from 0 in the upper left corner.",
    help="rows are 0 to {rows}, columns 0 to {columns}",
    wrong=hall(placed("r1", "robot", 0, 3)),
    right=hall(placed("r1", "robot", 0, 2)),
)
CELL_TAKEN = rule(
    "SM565",
    "cell-taken",
    Severity.ERROR,
    "'{name}' is in the cell of '{other}' (row {row}, column {column})",
    why="Two robots are never in one cell, and no robot is in that of an obstacle; two targets "
    "in one cell are one target.",
    help="give it another row or column",
    wrong=hall(_ONE, placed("r2", "robot", 0, 0)),
    right=hall(_ONE, placed("r2", "robot", 0, 1)),
)
NO_NUMBER = rule(
    "SM566",
    "floor-number",
    Severity.ERROR,
    "'{attribute}' of '{name}' {problem}",
    why="Contracts of a floor are made of its numbers: rows and columns, cells, deadlines.",
    help="give the attribute a whole number as its value",
    wrong=hall(_ONE, placed("pillar", "obstacle", 1, None)),
    right=hall(_ONE, placed("pillar", "obstacle", 1, 0)),
)
CIRCULAR_ORDER = rule(
    "SM567",
    "targets-wait-for-one-another",
    Severity.ERROR,
    "target '{name}' would have to be reached before itself: {circle}",
    why="What is 'Before' and 'Carry' is a partial order of the targets.",
    help="remove one of these connections",
    wrong=hall(
        _ONE, targets=(_DOCK, _SHELF), orders=ordered("dock", "shelf") + ordered("shelf", "dock")
    ),
    right=hall(_ONE, targets=(_DOCK, _SHELF), orders=ordered("dock", "shelf")),
)
CARRIED_TWICE = rule(
    "SM568",
    "carried-twice",
    Severity.ERROR,
    "a robot would have to go on {way} '{name}' {there} both '{one}' and '{other}'",
    why="'Carry' says that a robot goes from one target to the next without another between them.",
    help="use 'Before' for one of them",
    wrong=hall(
        _ONE,
        targets=(_DOCK, _SHELF, _RACK),
        orders=ordered("dock", "shelf", "carry") + ordered("dock", "rack", "carry"),
    ),
    right=hall(
        _ONE,
        targets=(_DOCK, _SHELF, _RACK),
        orders=ordered("dock", "shelf", "carry") + ordered("dock", "rack"),
    ),
)
OUT_OF_REACH = rule(
    "SM569",
    "target-out-of-reach",
    Severity.ERROR,
    "no robot can reach target '{name}': obstacles are on every way",
    why="The mission could never be done.",
    help="move the target or an obstacle",
    wrong=hall(
        _ONE,
        placed("o1", "obstacle", 0, 1),
        placed("o2", "obstacle", 1, 1),
        targets=(_DOCK,),
    ),
    right=hall(_ONE, placed("o1", "obstacle", 0, 1), targets=(_DOCK,)),
)
SAME_FLOOR = rule(
    "SM577",
    "floors-of-one-name",
    Severity.ERROR,
    "there is another floor '{name}': this one is not studied",
    why="Contracts, controllers and reports are called like their floor.",
    help="give one of the floors another name",
    wrong=hall(_ONE) + another("Hall"),
    right=hall(_ONE) + another("Other hall"),
)
