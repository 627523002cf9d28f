"""Rules about blocks with parts: what parts assume of one another, promise together, and lose."""

from sysmlc.diagnostics import Severity, rule

OPEN = rule(
    "SM595",
    "part-assumption-open",
    Severity.ERROR,
    "part '{part}' of '{component}' assumes '{formula}', which nothing around it promises{said}",
    help=(
        "let another part promise it, let the block assume it, or let the part do without it; the "
        "run shows what happens"
    ),
)
CIRCLE = rule(
    "SM596",
    "parts-wait-for-one-another",
    Severity.WARNING,
    "part '{part}' of '{component}' assumes '{formula}', kept by others only after it{said}",
    help="let one of the parts begin: promise it without that assumption",
)
BREAK = rule(
    "SM597",
    "parts-break-whole",
    Severity.ERROR,
    "the parts of '{component}' together do not keep '{formula}'{said}",
    help="let a part promise more, or the block less; the run shows what happens",
)
CONTRADICT = rule(
    "SM548",
    "parts-contradict",
    Severity.ERROR,
    "there is no run in which all parts of '{component}' keep what they promise",
    help="change one of the promises, or what joins the parts",
)
LOST = rule(
    "SM506",
    "sent-in-one-step",
    Severity.WARNING,
    "in '{component}' two things are sent in one step, and one of them is lost{said}",
    help="let one wait until the other was taken; the run shows how it comes about",
)
NOT_COMPOSED = rule(
    "SM598",
    "parts-not-composed",
    Severity.WARNING,
    "the parts of '{component}' are not put together: {reason}",
    help="give more time (--question-limit), or say it in the patterns that are known",
)
