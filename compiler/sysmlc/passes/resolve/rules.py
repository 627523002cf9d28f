"""What can be wrong with references."""

from sysmlc.diagnostics import Severity, rule

BROKEN_REFERENCE = rule(
    "SM150",
    "broken-reference",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to '{target}', which does not exist",
    help="restore the element in the modelling tool, or remove what refers to it",
)
BROKEN_ID = rule(
    "SM151",
    "broken-id",
    Severity.ERROR,
    "'{relation}' of '{element}' names '{target}', which does not exist",
    help="restore the element in the modelling tool, or remove what refers to it",
)
MANY_BROKEN = rule(
    "SM166",
    "broken-references",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to '{target}' and {others} more that do not exist",
    help="restore the elements in the modelling tool, or remove what refers to them",
)
SEVERAL_TARGETS = rule(
    "SM167",
    "several-targets",
    Severity.ERROR,
    "'{relation}' of '{element}' leads to {count} elements, but a flow has only one; "
    "the first counts",
    help="draw one flow for each, with a fork or a decision before them",
)
MISSING_LIBRARY = rule(
    "SM152",
    "missing-library",
    Severity.WARNING,
    "'{library}' is not part of the compile unit; what it holds ({count}) is known by name only",
    help="give the file '{library}' as a further input",
)
UNKNOWN_IN_LIBRARY = rule(
    "SM153",
    "unknown-in-library",
    Severity.WARNING,
    "'{library}' is known to sysmlc without reading it, but {count} of what the model takes from "
    "it is not",
    help="choose the type again in the modelling tool, or give the file as a further input",
)
