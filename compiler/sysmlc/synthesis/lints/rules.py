"""Rules about suspicious contracts (SM533 to SM542); the explanations are contracts in JSON."""

from sysmlc.diagnostics import Severity, rule


def _contract(assumed: str, promised: str, moved: str = '"bool"') -> str:
    return (
        '{"variables": {"go": {"owner": "env", "type": "bool"},'
        f' "lamp": {{"owner": "sys", "type": {moved}}}}},\n'
        f' "assumptions": {{{assumed}}},\n "guarantees": {{{promised}}}}}'
    )


_SHOWS = '"safety": ["lamp\' <-> go\'"]'
_ANSWERS = '"safety": ["lamp\' -> go\'"], "liveness": ["lamp"]'

NO_ENVIRONMENT = rule(
    "SM533",
    "assumptions-unsatisfiable",
    Severity.ERROR,
    "no environment keeps the assumptions of '{component}'",
    why="Then everything keeps the contract, and it says nothing.",
    help="weaken the assumptions; together they allow no run",
    wrong=_contract('"safety": ["go\'"], "liveness": ["!go"]', _SHOWS),
    right=_contract('"liveness": ["!go"]', _SHOWS),
)
DEADLOCK = rule(
    "SM534",
    "environment-deadlock",
    Severity.WARNING,
    "the environment of '{component}' can come to where its assumptions leave it no next step: "
    "{said}",
    why="From there on nothing is promised any more, though both sides have done what they may.",
    help="say the assumption of the next step (x' instead of x): the state is never reached then",
    wrong=_contract('"safety": ["lamp & go -> !go\' & go\'"]', _SHOWS),
    right=_contract('"safety": ["lamp & go -> !go\'"]', _SHOWS),
)
NOT_SEPARATED = rule(
    "SM535",
    "not-well-separated",
    Severity.WARNING,
    "'{component}' can force its environment to break the assumptions{said}",
    why="It could do so, keeping what it promises for every step, instead of bringing about what "
    "it promises again and again (after Klein and Pnueli 2010).",
    help="assume only what the environment can keep whatever the component may do",
    wrong=_contract('"safety": ["go\' <-> lamp"], "liveness": ["go"]', '"liveness": ["lamp"]'),
    right=_contract('"liveness": ["go"]', _SHOWS),
)
NO_FRAME = rule(
    "SM536",
    "output-without-frame",
    Severity.WARNING,
    "nothing says what becomes of output '{name}' of '{component}' {said}",
    why="Where nothing is said every value may follow: the component may jump to its target.",
    help="say when it stays as it is ({name}'={name})",
    wrong=_contract("", '"safety": ["go & lamp<5 -> lamp\'=lamp+1"]', "[0, 5]"),
    right=_contract(
        "", '"safety": ["go & lamp<5 -> lamp\'=lamp+1", "!go | lamp=5 -> lamp\'=lamp"]', "[0, 5]"
    ),
)
WRONG_OWNER = rule(
    "SM537",
    "decided-by-the-other",
    Severity.WARNING,
    "'{component}' {name} '{formula}', which {said} decides alone",
    why="A component can only promise what it decides, and assume what others decide.",
    help="move it to the other side of the contract, or change who owns the variables",
    wrong=_contract("", '"safety": ["lamp\' <-> go\'", "lamp -> !go\'"]'),
    right=_contract('"safety": ["lamp -> !go\'"]', _SHOWS),
)
NO_FAIRNESS = rule(
    "SM538",
    "fairness-missing",
    Severity.WARNING,
    "'{component}' could keep its contract if its environment did not wait for ever{said}",
    why="What is promised again and again may need what the environment does again and again.",
    help="add a liveness assumption",
    wrong=_contract("", _ANSWERS),
    right=_contract('"liveness": ["go"]', _ANSWERS),
)
INITIAL_INPUT = rule(
    "SM539",
    "initial-guarantee-over-input",
    Severity.INFO,
    "the initial guarantee '{formula}' of '{component}' speaks of inputs",
    why="The component answers the first inputs here; tools that let it begin refuse the contract.",
    help="say what outputs start with, and what inputs start with as an assumption",
    wrong=_contract("", f'"init": ["lamp <-> go"], {_SHOWS}'),
    right=_contract("", f'"init": ["!lamp"], {_SHOWS}'),
)
NEXT_IN_LIVENESS = rule(
    "SM540",
    "next-inside-liveness",
    Severity.ERROR,
    "'{formula}' of '{component}' speaks of the next step in what recurs",
    why="GR(1) asks for states that recur, not for steps.",
    help="let a variable remember: m' <-> (what holds now), and ask for m again and again",
    wrong=_contract("", f'{_SHOWS}, "liveness": ["go -> lamp\'"]'),
    right=_contract("", f'{_SHOWS}, "liveness": ["go -> lamp"]'),
)
IDLE = rule(
    "SM541",
    "vacuous-win",
    Severity.WARNING,
    "'{component}' keeps its contract without ever doing anything",
    why="A contract that asks for something again and again should not be kept by waiting.",
    help="promise something that only an action brings about",
    wrong=_contract("", '"safety": ["go -> lamp\' | !lamp\'"], "liveness": ["lamp -> lamp"]'),
    right=_contract('"liveness": ["go", "!go"]', _SHOWS + ', "liveness": ["lamp", "!lamp"]'),
)
NEEDLESS = rule(
    "SM542",
    "fairness-not-needed",
    Severity.WARNING,
    "'{component}' brings about what it promises although nothing that is assumed recurs",
    why="What the environment is asked to do again and again should be what the component waits "
    "for; else it may report success without any cause.",
    help="tie what is promised to what is assumed, or leave the assumption out",
    wrong=_contract('"liveness": ["go"]', '"liveness": ["lamp", "!lamp"]'),
    right=_contract('"liveness": ["go", "!go"]', _SHOWS + ', "liveness": ["lamp", "!lamp"]'),
)
