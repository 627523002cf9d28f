"""What the front end for SysML v2 reports."""

from sysmlc.diagnostics import Severity, rule

UNSUPPORTED = rule(
    "SM480",
    "v2-unsupported",
    Severity.WARNING,
    "{type} is not read ({count} in the unit, with all that they own)",
    help="the outputs do not contain it; 'sysmlc coverage' lists each element",
)
APPROXIMATED = rule(
    "SM481",
    "v2-approximated",
    Severity.INFO,
    "{said} is read as {written} ({count} in the unit)",
)
NOT_IN_GRAPH = rule(
    "SM482",
    "v2-refers-to-unread",
    Severity.WARNING,
    "'{edge}' leads to '{name}', a {type} that is not part of the graph",
)
NO_LIBRARY = rule(
    "SM484",
    "v2-no-library",
    Severity.ERROR,
    "the standard library '{path}' cannot be read: {problem}",
    help="give --library the folder or .kpar with the .sysml and .kerml files",
)
