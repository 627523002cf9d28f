"""What requirement tables show to be open."""

from sysmlc.diagnostics import Severity, rule

UNSATISFIED = rule(
    "SM715",
    "unsatisfied-requirement",
    Severity.INFO,
    "nothing satisfies requirement '{requirement}'",
    help="draw «satisfy» from the block or behaviour to the requirement",
)
UNVERIFIED = rule(
    "SM716",
    "unverified-requirement",
    Severity.INFO,
    "nothing verifies requirement '{requirement}'",
    help="draw «verify» from a test case to the requirement",
)
BAD_TEMPLATE = rule(
    "SM717",
    "bad-requirement-template",
    Severity.ERROR,
    "the template requirements.md.j2 cannot be used: {fault}",
    help="compare it with templates/reqtable of sysmlc",
)
