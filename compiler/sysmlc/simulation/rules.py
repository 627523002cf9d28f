"""Rules about scenarios (SM550 to SM556)."""

from sysmlc.diagnostics import Severity, rule

SYNTAX = rule(
    "SM550",
    "scenario-not-yaml",
    Severity.ERROR,
    "the scenario is not YAML: {problem}",
    help="check the indentation, and put texts with special characters in quotes",
)
SHAPE = rule(
    "SM551",
    "scenario-not-valid",
    Severity.ERROR,
    "{where} of the scenario: {problem}",
    help="a scenario has a component, steps with inputs and expect, and perhaps a trace",
)
COMPONENT = rule(
    "SM552",
    "unknown-component",
    Severity.ERROR,
    "there is no component '{name}' that can be simulated; known are: {known}",
    help=(
        "use one of the known names, or read the diagnostics of the model: they explain "
        "why an activity or a state machine cannot be simulated"
    ),
)
VARIABLE = rule(
    "SM553",
    "unknown-variable",
    Severity.ERROR,
    "'{component}' has no variable '{name}'; {advice}",
    help="the contract of the component lists its variables",
)
VALUE = rule(
    "SM554",
    "value-outside-domain",
    Severity.ERROR,
    "{value} is not a value of '{name}', which takes {domain}",
    help="use a value of the domain",
)
NOT_INPUT = rule(
    "SM555",
    "output-as-input",
    Severity.ERROR,
    "'{name}' is decided by '{component}' and can't be an input",
    help="write it under expect",
)
LONG_TRACE = rule(
    "SM556",
    "trace-longer-than-steps",
    Severity.ERROR,
    "the expected trace has {lines} entries, but there are only {steps} steps",
    help="add steps (a step may be empty: {{}}), or use repeat",
)
