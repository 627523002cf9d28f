"""What the back end ``sysmlx`` cannot write."""

from sysmlc.diagnostics import Severity, rule

TOO_DEEP = rule(
    "SM748",
    "sysmlx-too-deep",
    Severity.ERROR,
    "'{name}' is nested more than {limit} levels deep: the model is not written as interchange",
    why="Another model than one of SysML v2 becomes its text first, which is read up to there.",
    help="leave the back end sysmlx out, or let fewer elements own one another",
    wrong="201 packages, each in the one before",
    right="20 packages, each in the one before",
)
