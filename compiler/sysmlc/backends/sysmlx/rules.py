"""What the back end ``sysmlx`` cannot write."""

from sysmlc.diagnostics import Severity, rule

TOO_DEEP = rule(
    "SM748",
    "sysmlx-too-deep",
    Severity.ERROR,
    "'{name}' is nested more than {limit} levels deep: the model is not written as interchange",
    help="omit the back end sysmlx, or nest fewer elements in one another",
)
OWN_TEXT = rule(
    "SM749",
    "sysmlx-own-text",
    Severity.ERROR,
    "the SysML v2 text generated for '{name}' cannot be read (line {line}: {message}): "
    "the model is not written as interchange",
    help="--emit +sysml writes the text; please report it with the model, and omit sysmlx "
    "until then",
)
