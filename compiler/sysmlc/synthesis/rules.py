"""Rules about contracts that are decided (SM530 to SM549, SM575 to SM579; lints have others)."""

from sysmlc.diagnostics import Severity, rule

_LAMP = (
    '{"variables": {"go": {"owner": "env", "type": "bool"},'
    ' "lamp": {"owner": "sys", "type": "bool"}},\n '
)
_TIMER = (
    '{"variables": {"due": {"owner": "env", "type": "bool"},'
    ' "late": {"owner": "sys", "type": [0, 3]}},\n '
    '"guarantees": {"safety": ["due & late!=3 -> late\'=late+1", "due & late=3 -> late\'=3"'
)

OUTSIDE_GR1 = rule(
    "SM530",
    "conjunct-outside-gr1",
    Severity.ERROR,
    "'{formula}' of '{component}' is outside GR(1): {why}",
    why="Controllers are made of contracts in GR(1): conditions for the start, for every step with "
    "the next one, and for what happens again and again. Assumptions are about what the "
    "environment decides: inputs at the start, next inputs in every step.",
    help="say it with conditions of these three kinds, or with a variable that remembers",
    wrong=_LAMP + '"assumptions": {"init": ["!lamp"]}}',
    right=_LAMP + '"guarantees": {"init": ["!lamp"]}}',
)
LIMIT = rule(
    "SM531",
    "synthesis-limit",
    Severity.ERROR,
    "'{component}' is not decided: {reached} after {seconds} s, {doing}",
    why="Whether a contract can be kept takes time and memory that grow with the ranges and the "
    "number of its variables, sometimes without measure.",
    help="give more (--time-limit, --memory-limit, --nodes), or decide the contracts of parts",
    wrong="sysmlc synth large.contract.json --realizable --nodes 10",
    right="sysmlc synth large.contract.json --realizable",
)
UNREALIZABLE = rule(
    "SM532",
    "contract-unrealizable",
    Severity.ERROR,
    "no system can keep the contract of '{component}'",
    why="Whatever the system does, the environment can keep its promises and make one of the "
    "guarantees fail.",
    help="promise less, or assume more of the environment",
    wrong=_LAMP + '"guarantees": {"safety": ["lamp <-> go\'"]}}',
    right=_LAMP + '"guarantees": {"safety": ["lamp\' <-> go\'"]}}',
)
NO_MACHINE = rule(
    "SM543",
    "machine-not-written",
    Severity.ERROR,
    "the contract of '{component}' can be kept, but no machine is written: {why}",
    why="A machine lists what is done for every input in every state; ranges and goals multiply. "
    "It is checked against its contract first, and is not written when the check fails.",
    help="give more (--time-limit, --memory-limit, --nodes), make ranges smaller, or synthesise "
    "parts",
    wrong="sysmlc synth wide.contract.json -o out --nodes 1000",
    right="sysmlc synth wide.contract.json -o out",
)
NO_TIMER = rule(
    "SM575",
    "deadline-of-no-number",
    Severity.ERROR,
    "the contract of '{component}' has no number '{name}' whose bound could be looked for",
    why="A deadline is the smallest bound that can be promised of a number with a range, a timer "
    "that counts the steps since something was asked for.",
    help="name one of its numbers: {numbers}",
    wrong=_TIMER + "]}}",
    right=_TIMER + ', "!due -> late\'=0"]}, "assumptions": {"safety": ["due -> !due\'"]}}',
)
NO_DEADLINE = rule(
    "SM576",
    "no-deadline",
    Severity.ERROR,
    "'{component}' can promise no bound of {timers}: {most} is too little, too",
    why="Whatever the system does, the environment can make the timer run to the end of its range. "
    "That a timer stops there promises nothing.",
    help="give the timer a wider range, or assume more of the environment",
    wrong=_TIMER + "]}}",
    right=_TIMER + ', "!due -> late\'=0"]}, "assumptions": {"safety": ["due -> !due\'"]}}',
)
