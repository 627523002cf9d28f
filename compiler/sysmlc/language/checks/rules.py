"""Constraints of the specification about the types of usages and about members of a kind."""

from sysmlc.diagnostics import Severity, rule

TYPED_BY = rule(
    "SM221",
    "usage-type",
    Severity.ERROR,
    "{usage} must be typed by {wanted}, and '{type}' is {found}",
    help="use {wanted} as the type",
)
ONE_TYPE = rule(
    "SM222",
    "usage-one-type",
    Severity.ERROR,
    "{usage} must be typed by one definition, and has {types}",
    help="keep one of them, or let one specialise the other",
)
ONLY_ONE = rule(
    "SM223",
    "only-one",
    Severity.ERROR,
    "'{owner}' may have one {role} only",
    help="keep the first one, or redefine it",
)
SUBJECT_FIRST = rule(
    "SM224",
    "subject-first",
    Severity.ERROR,
    "the subject of '{owner}' must be its first parameter",
    help="move the subject before the other parameters",
)
NOT_ACCESSIBLE = rule(
    "SM225",
    "feature-not-accessible",
    Severity.ERROR,
    "'{name}' is a feature of '{owner}', and nothing around here is one",
    help="use dot notation: the part, a dot, '{name}'",
)
