"""What can be wrong with a text in KerML or SysML v2 before its names are looked at."""

from sysmlc.diagnostics import Severity, rule

SYNTAX = rule(
    "SM190",
    "v2-syntax",
    Severity.ERROR,
    "{found} stands where {expected} is expected",
    why="What cannot be read is missing in the outputs; what stands around it is read all the same.",
    help="{advice}",
    wrong="part def Cell { port in : ; }",
    right="part def Cell { port input; }",
)
