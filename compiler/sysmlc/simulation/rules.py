"""Rules about scenarios (SM550 to SM556)."""

from sysmlc.diagnostics import Severity, rule

SYNTAX = rule(
    "SM550",
    "scenario-not-yaml",
    Severity.ERROR,
    "the scenario is not YAML: {problem}",
    why="A scenario is a YAML file with a component and steps.",
    help="mind the indentation, and put texts with special characters in quotes",
    wrong="component: [Gate",
    right="component: Gate\nsteps:\n  - {}\n",
)
SHAPE = rule(
    "SM551",
    "scenario-not-valid",
    Severity.ERROR,
    "{where} of the scenario: {problem}",
    why="Only what metamodels/sysmlc-scenario.schema.json describes is understood.",
    help="a scenario has a component, steps with inputs and expect, and perhaps a trace",
    wrong="component: Gate\n",
    right="component: Gate\nsteps:\n  - inputs: {done_read: true}\n",
)
COMPONENT = rule(
    "SM552",
    "unknown-component",
    Severity.ERROR,
    "there is no component '{name}' that can be simulated; known are: {known}",
    why="Components are activities with a token graph and state machines, by qualified name.",
    help="use one of the known names, or read the diagnostics of the model: they say why an "
    "activity or a state machine can't be played",
    wrong="component: Gat\nsteps:\n  - {}\n",
    right="component: Gate\nsteps:\n  - {}\n",
)
VARIABLE = rule(
    "SM553",
    "unknown-variable",
    Severity.ERROR,
    "'{component}' has no variable '{name}'{hint}",
    why="A value for a variable that does not exist would never be looked at.",
    help="the contract of the component lists its variables",
    wrong="component: Gate\nsteps:\n  - expect: {run_raed: true}\n",
    right="component: Gate\nsteps:\n  - expect: {run_read: true}\n",
)
VALUE = rule(
    "SM554",
    "value-outside-domain",
    Severity.ERROR,
    "{value} is no value of '{name}', which takes {domain}",
    why="The variable can never have this value.",
    help="use a value of the domain",
    wrong="component: Gate\nsteps:\n  - expect: {run_read: 2}\n",
    right="component: Gate\nsteps:\n  - expect: {run_read: true}\n",
)
NOT_INPUT = rule(
    "SM555",
    "output-as-input",
    Severity.ERROR,
    "'{name}' is decided by '{component}' and can't be an input",
    why="Only the environment's variables can be given; the others follow from the diagram.",
    help="write it under expect",
    wrong="component: Gate\nsteps:\n  - inputs: {run_read: true}\n",
    right="component: Gate\nsteps:\n  - inputs: {done_read: true}\n",
)
LONG_TRACE = rule(
    "SM556",
    "trace-longer-than-steps",
    Severity.ERROR,
    "the expected trace has {lines} entries, but there are only {steps} steps",
    why="Entries after the last step would never be compared.",
    help="add steps (a step may be empty: {{}}), or use repeat",
    wrong="component: Gate\nsteps:\n  - {}\ntrace:\n  - {}\n  - {}\n",
    right="component: Gate\nsteps:\n  - {}\n  - {}\ntrace:\n  - {}\n  - {}\n",
)
