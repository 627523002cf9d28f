"""Rules about the process of a command: its limits, and crashes."""

from sysmlc.diagnostics import Severity, rule

TIME_LIMIT = rule(
    "SM904",
    "time-limit",
    Severity.ERROR,
    "the command did not end within {seconds} s",
    why="Models come from others too, and no model may occupy a build server forever. The command "
    "was ended; files that were not yet written stay as they were.",
    help="give more time (--time-limit, 0 for no limit), or fewer or smaller models; "
    "'time-limit' in sysmlc.toml can only shorten the time",
    wrong="sysmlc plant.uml --time-limit 0.01",
    right="sysmlc plant.uml --time-limit 600",
)
MEMORY_LIMIT = rule(
    "SM905",
    "memory-limit",
    Severity.ERROR,
    "{limit} not enough for this command",
    why="Models come from others too, and no model may use up the memory of a build server. The "
    "command was ended; files that were not yet written stay as they were.",
    help="give more memory (--memory-limit, 0 for no limit), or fewer or smaller models; "
    "'memory-limit' in sysmlc.toml can only lower the limit",
    wrong="sysmlc plant.uml --memory-limit 0.01",
    right="sysmlc plant.uml --memory-limit 16",
)
CRASH = rule(
    "SM906",
    "crash",
    Severity.ERROR,
    "the command was ended by {signal}",
    why="A library that is written in C crashed, or the system ended the command. Systems that "
    "are short of memory do so with SIGKILL; libraries crash when they reach the memory limit.",
    help="try a lower --memory-limit after SIGKILL and a higher one after other signals; if that "
    "does not help, please report it with the command and the model",
    wrong="sysmlc synth plant.uml --memory-limit 0.1, where CUDD does not survive the limit",
    right="sysmlc synth plant.uml --memory-limit 8",
)
