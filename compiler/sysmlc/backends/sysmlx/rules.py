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
OWN_TEXT = rule(
    "SM749",
    "sysmlx-own-text",
    Severity.ERROR,
    "the text that says '{name}' in SysML v2 cannot be read (line {line}: {message}): the model is "
    "not written as interchange",
    why="Another model than one of SysML v2 becomes its text first. That the text is wrong is a "
    "fault of sysmlc, not of the model.",
    help="--emit +sysml writes the text; report it with the model, and leave sysmlx out meanwhile",
    wrong="a model with a construct that the writer of text says in a wrong way",
    right="a model of which the text can be read",
)
