"""What requirement tables show to be open."""

from sysmlc.diagnostics import Severity, rule

_REQUIREMENT = 'Class r "No jam" role="requirement" req_id="R1"\n'
_SATISFIED = _REQUIREMENT + 'Class gate "Gate" role="block"\n  -> satisfies r\n'
_VERIFIED = _SATISFIED + 'Activity t "Test jams" role="test case"\n  -> verifies r\n'

UNSATISFIED = rule(
    "SM715",
    "unsatisfied-requirement",
    Severity.INFO,
    "nothing satisfies requirement '{requirement}'",
    why="Neither it nor one derived from it has a «satisfy» relation, nor have all requirements "
    "inside it, so that the table leaves open who answers for it.",
    help="draw «satisfy» from the block or behaviour to the requirement",
    wrong=_REQUIREMENT,
    right=_VERIFIED,
)
UNVERIFIED = rule(
    "SM716",
    "unverified-requirement",
    Severity.INFO,
    "nothing verifies requirement '{requirement}'",
    why="Neither it nor one derived from it has a «verify» relation, nor have all requirements "
    "inside it, so that nothing shows that it is kept.",
    help="draw «verify» from a test case to the requirement",
    wrong=_SATISFIED,
    right=_VERIFIED,
)
BAD_TEMPLATE = rule(
    "SM717",
    "bad-requirement-template",
    Severity.ERROR,
    "the template requirements.md.j2 cannot be used: {fault}",
    why="A template of yours replaces the shipped one of the same name; it has a fault.",
    help="compare it with templates/reqtable of sysmlc",
    wrong="{{ page.titel }}",
    right="{{ page.title }}",
)
