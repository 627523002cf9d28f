"""Rules of reading MTIP files."""

from sysmlc.diagnostics import Severity, rule

MALFORMED = rule(
    "SM185",
    "malformed-mtip-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    help="export the model again",
)
UNSUPPORTED = rule(
    "SM181",
    "unsupported-mtip-type",
    Severity.WARNING,
    "{count} elements of type '{type}' not read",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
)
OWNERLESS = rule(
    "SM182",
    "mtip-owner-not-read",
    Severity.WARNING,
    "{count} elements of type '{type}' not read, because their owners are not",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
)
LOOSE_END = rule(
    "SM184",
    "mtip-end-not-read",
    Severity.WARNING,
    "{count} elements of type '{type}' lead from or to nodes that are not read",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
)
REPEATED = rule(
    "SM183",
    "repeated-mtip-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements of '{file}'",
    help="export the model again",
)
