"""Rules about decisions, syntheses and lints of contracts (SM527 to SM543, SM575 and SM576)."""

from sysmlc.diagnostics import Severity, rule

OUTSIDE_GR1 = rule(
    "SM530",
    "conjunct-outside-gr1",
    Severity.ERROR,
    "'{formula}' of '{component}' is outside GR(1): {why}",
    help="express it with conditions of these three kinds, or with a variable that stores the past",
)
LIMIT = rule(
    "SM531",
    "synthesis-limit",
    Severity.ERROR,
    "'{component}' is undecided: {reached} after {seconds} s, {doing}",
    help="raise a limit (--time-limit, --memory-limit, --nodes), or decide the contracts of parts",
)
UNREALIZABLE = rule(
    "SM532",
    "contract-unrealizable",
    Severity.ERROR,
    "no system can satisfy the contract of '{component}'{within}",
    help="weaken the guarantees, or assume more of the environment",
)
NO_MACHINE = rule(
    "SM543",
    "machine-not-written",
    Severity.ERROR,
    "the contract of '{component}' is realizable, but no controller is written: {why}",
    help=(
        "raise a limit (--time-limit, --memory-limit, --nodes), make ranges smaller, or "
        "synthesise parts"
    ),
)
NO_TIMER = rule(
    "SM575",
    "deadline-of-no-number",
    Severity.ERROR,
    "the contract of '{component}' has no numeric variable '{name}' to find a bound for",
    help="name one of its numeric variables: {numbers}",
)
NO_DEADLINE = rule(
    "SM576",
    "no-deadline",
    Severity.ERROR,
    "'{component}' can guarantee no bound for {timers}: even {most} is too small",
    help="give the timer a wider range, or assume more of the environment",
)


# -- lints -------------------------------------------------------------------------------------

NO_ENVIRONMENT = rule(
    "SM533",
    "assumptions-unsatisfiable",
    Severity.ERROR,
    "the assumptions of '{component}' are unsatisfiable{within}",
    help="weaken the assumptions; no run satisfies all of them",
)
DEADLOCK = rule(
    "SM534",
    "environment-deadlock",
    Severity.WARNING,
    "the environment of '{component}' can reach a state in which its assumptions allow "
    "no next step: {detail}{within}",
    help="write the assumption about the next step (x' instead of x), so that the state is "
    "never reached",
)
NOT_SEPARATED = rule(
    "SM535",
    "not-well-separated",
    Severity.WARNING,
    "'{component}' can force its environment to violate the assumptions{detail}{within}",
    help="assume only what the environment can satisfy whatever the component does",
)
NO_FRAME = rule(
    "SM536",
    "output-without-frame",
    Severity.WARNING,
    "output '{name}' of '{component}' may change freely {detail}{within}",
    help="add a guarantee for the steps in which it stays unchanged ({name}'={name})",
)
WRONG_OWNER = rule(
    "SM537",
    "decided-by-the-other",
    Severity.WARNING,
    "'{component}' {name} '{formula}', {detail} decides alone",
    help="move it to the other side of the contract, or change the owner of the variables",
)
NO_FAIRNESS = rule(
    "SM538",
    "fairness-missing",
    Severity.WARNING,
    "'{component}' could satisfy its contract if its environment did not wait forever{detail}"
    "{within}",
    help="add a liveness assumption",
)
INITIAL_INPUT = rule(
    "SM539",
    "initial-guarantee-over-input",
    Severity.INFO,
    "the initial guarantee '{formula}' of '{component}' refers to inputs",
    help="guarantee the initial values of outputs, and state those of inputs as an assumption",
)
NEXT_IN_LIVENESS = rule(
    "SM540",
    "next-inside-liveness",
    Severity.ERROR,
    "'{formula}' of '{component}' refers to the next step inside a liveness formula",
    help="store the condition in a variable (m' <-> condition), and require m infinitely often",
)
IDLE = rule(
    "SM541",
    "vacuous-win",
    Severity.WARNING,
    "'{component}' satisfies its contract without ever acting{within}",
    help="guarantee something that only an action achieves",
)
NEEDLESS = rule(
    "SM542",
    "fairness-not-needed",
    Severity.WARNING,
    "'{component}' satisfies its liveness guarantees without the fairness assumptions{within}",
    help="relate the guarantees to the assumptions, or remove the assumptions",
)

VACUOUS = rule(
    "SM557",
    "requirement-says-nothing",
    Severity.WARNING,
    "'{component}' satisfies '{formula}'{context} vacuously: {reason}",
    help="correct the condition, or the states and events that the requirement names",
)
CONFLICT = rule(
    "SM558",
    "conflicting-writes",
    Severity.WARNING,
    "two behaviours of '{component}' give '{variable}' different values in one step{condition}",
    help="let the behaviours exclude one another, or let only one of them assign it",
)
UNREACHABLE = rule(
    "SM559",
    "never-active",
    Severity.WARNING,
    "no run of '{component}' reaches '{name}'{within}",
    help="correct the way to it, remove it, or require that it is never reached",
)


# -- two contracts -----------------------------------------------------------------------------

GUARANTEES_LESS = rule(
    "SM527",
    "refinement-guarantees-less",
    Severity.ERROR,
    "'{concrete}' does not guarantee '{formula}', which '{abstract}' guarantees{context}",
    help="let the concrete contract guarantee it; the run shows how it is violated",
)
ASSUMES_MORE = rule(
    "SM528",
    "refinement-assumes-more",
    Severity.ERROR,
    "'{concrete}' assumes '{formula}', which the assumptions of '{abstract}' do not imply{context}",
    help="assume less, or let the abstract contract assume it, too; the run shows an environment",
)
DEPENDS = rule(
    "SM547",
    "depends-on-unread-condition",
    Severity.WARNING,
    "it is not decided whether {question}: {reason}",
    help="use values that have a formula: Booleans, enumerations, or Integers with a range",
)
NOT_COMPARABLE = rule(
    "SM529",
    "contracts-not-comparable",
    Severity.ERROR,
    "'{first}' and '{second}' cannot be {work}: {reason}",
    help="shared variables need the same direction and type; a question may need more time "
    "(--question-limit)",
)
NEVER_TAKEN = rule(
    "SM517",
    "transition-never-taken",
    Severity.WARNING,
    "no run of '{component}' takes {name}, although runs reach its source{within}",
    help="correct its guard or trigger, or what comes first; or remove the transition",
)
NEVER_ACCEPTED = rule(
    "SM516",
    "event-never-accepted",
    Severity.INFO,
    "no run of '{component}' accepts {name}, although runs wait for it{within}",
    help="let a part send it, or correct the guard or what is taken before; or remove the trigger",
)
GUARD_NEVER_HOLDS = rule(
    "SM518",
    "guard-never-holds",
    Severity.INFO,
    "guard '{name}' never holds in '{component}' when a run reaches it{within}",
    help="correct the guard or what it reads, or remove the flow",
)
NEVER_CHANGED = rule(
    "SM519",
    "feature-never-changes",
    Severity.INFO,
    "'{name}' of '{component}' is assigned, but no run changes its value{within}",
    help="correct the assignments, or make it a constant",
)
