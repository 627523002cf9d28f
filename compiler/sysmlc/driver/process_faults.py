"""Rules about the process of a command: its limits, and crashes."""

from sysmlc.diagnostics import Severity, rule

TIME_LIMIT = rule(
    "SM904",
    "time-limit",
    Severity.ERROR,
    "the command did not end within {seconds} s",
    help=(
        "give more time (--time-limit, 0 for no limit), or fewer or smaller models; "
        "'time-limit' in sysmlc.toml can only shorten the time"
    ),
)
MEMORY_LIMIT = rule(
    "SM905",
    "memory-limit",
    Severity.ERROR,
    "{limit} not enough for this command",
    help=(
        "give more memory (--memory-limit, 0 for no limit), or fewer or smaller models; "
        "'memory-limit' in sysmlc.toml can only lower the limit"
    ),
)
CRASH = rule(
    "SM906",
    "crash",
    Severity.ERROR,
    "the command was ended by {signal}",
    help=(
        "try a lower --memory-limit after SIGKILL and a higher one after other signals; if that "
        "does not help, please report it with the command and the model"
    ),
)
