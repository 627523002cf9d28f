"""What can be wrong with the names of a model."""

from sysmlc.diagnostics import Severity, rule

UNRESOLVED = rule(
    "SM205",
    "unresolved-name",
    Severity.ERROR,
    "'{name}' is not known here{inside}",
    help="{advice}",
)

CYCLE = rule(
    "SM206",
    "specialization-cycle",
    Severity.WARNING,
    "'{name}' specialises itself{through}",
    help="remove one specialisation of the circle",
)
NO_STANDARD_LIBRARY = rule(
    "SM207",
    "no-standard-library",
    Severity.WARNING,
    "the standard library of SysML v2 is not installed; the core that sysmlc bundles replaces it",
    help=(
        "if names of the library are missing, get the library's files from the SysML v2 release "
        "and name their folder with --library PATH or the environment variable SYSML_LIBRARY_PATH"
    ),
)
TOO_DEEP = rule(
    "SM208",
    "names-too-deep",
    Severity.ERROR,
    "what '{name}' leads to is behind too many other names",
    help="refer to the element itself",
)
TOO_CIRCULAR = rule(
    "SM240",
    "names-too-circular",
    Severity.ERROR,
    "'{name}' was looked for in 2,000 circles of names, and is given up",
    help="give the namesakes names of their own, or qualify what they specialise",
)
