"""Rules about contracts that are decided (SM530 to SM549, SM575 to SM579; lints have others)."""

from sysmlc.diagnostics import Severity, rule

OUTSIDE_GR1 = rule(
    "SM530",
    "conjunct-outside-gr1",
    Severity.ERROR,
    "'{formula}' of '{component}' is outside GR(1): {why}",
    help="say it with conditions of these three kinds, or with a variable that remembers",
)
LIMIT = rule(
    "SM531",
    "synthesis-limit",
    Severity.ERROR,
    "'{component}' is not decided: {reached} after {seconds} s, {doing}",
    help="give more (--time-limit, --memory-limit, --nodes), or decide the contracts of parts",
)
UNREALIZABLE = rule(
    "SM532",
    "contract-unrealizable",
    Severity.ERROR,
    "no system can keep the contract of '{component}'",
    help="promise less, or assume more of the environment",
)
NO_MACHINE = rule(
    "SM543",
    "machine-not-written",
    Severity.ERROR,
    "the contract of '{component}' can be kept, but no machine is written: {why}",
    help=(
        "give more (--time-limit, --memory-limit, --nodes), make ranges smaller, or synthesise "
        "parts"
    ),
)
NO_TIMER = rule(
    "SM575",
    "deadline-of-no-number",
    Severity.ERROR,
    "the contract of '{component}' has no number '{name}' whose bound could be looked for",
    help="name one of its numbers: {numbers}",
)
NO_DEADLINE = rule(
    "SM576",
    "no-deadline",
    Severity.ERROR,
    "'{component}' can promise no bound of {timers}: {most} is too little, too",
    help="give the timer a wider range, or assume more of the environment",
)
