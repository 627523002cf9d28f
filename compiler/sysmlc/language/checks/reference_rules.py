"""Constraints of the specification about what usages reference and redefine."""

from sysmlc.diagnostics import Severity, rule

OTHER_KIND = rule(
    "SM236",
    "references-other-kind",
    Severity.ERROR,
    "'{name}' is {found}, and {wanted} is needed here",
    help="reference {wanted}",
)
PART_OF_PORT = rule(
    "SM237",
    "part-of-port",
    Severity.ERROR,
    "'{name}' is a part of the port '{owner}'",
    help="write 'ref' before it, or give it a direction",
)
OTHER_DIRECTION = rule(
    "SM238",
    "other-direction",
    Severity.ERROR,
    "'{name}' has another direction where it is defined, in '{owner}'",
    help="use the same direction, or none",
)
INDIVIDUAL = rule(
    "SM239",
    "individual-types",
    Severity.ERROR,
    "the individual '{name}' has {count} individual definitions and must have one",
    help="type it by one 'individual def'",
)
