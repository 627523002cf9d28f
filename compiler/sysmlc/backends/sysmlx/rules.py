"""What the back end ``sysmlx`` cannot write."""

from sysmlc.diagnostics import Severity, rule

TOO_DEEP = rule(
    "SM748",
    "sysmlx-too-deep",
    Severity.ERROR,
    "'{name}' is nested more than {limit} levels deep: the model is not written as interchange",
    help="leave the back end sysmlx out, or let fewer elements own one another",
)
OWN_TEXT = rule(
    "SM749",
    "sysmlx-own-text",
    Severity.ERROR,
    "the text that says '{name}' in SysML v2 cannot be read (line {line}: {message}): the model is "
    "not written as interchange",
    help="--emit +sysml writes the text; report it with the model, and leave sysmlx out meanwhile",
)
