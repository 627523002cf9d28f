"""What the front end for SysML v2 reports."""

from sysmlc.diagnostics import Severity, rule

UNSUPPORTED = rule(
    "SM480",
    "v2-unsupported",
    Severity.WARNING,
    "{type} is not read ({count} in the unit, with all that they own)",
    why="The graph that contracts, recipes and diagrams are made of has no such element yet.",
    help="the outputs are made without it; 'sysmlc coverage' lists each one",
    wrong="package P {\n    rendering def Table;\n}\n",
    right="package P {\n    view def Table;\n}\n",
)
APPROXIMATED = rule(
    "SM481",
    "v2-approximated",
    Severity.INFO,
    "{said} is read as {written} ({count} in the unit)",
    why="The graph has no element that means quite the same; the rest of the meaning is lost.",
    wrong="package P {\n    requirement r;\n    part p;\n    not satisfy r by p;\n}\n",
    right="package P {\n    requirement r;\n    part p;\n    satisfy r by p;\n}\n",
)
NOT_IN_GRAPH = rule(
    "SM482",
    "v2-refers-to-unread",
    Severity.WARNING,
    "'{edge}' leads to '{name}', a {type} that has no place in the graph",
    why="The reference is right, but what it leads to is not read, so that nothing can follow it.",
    wrong="package P {\n    rendering def Table;\n    part def Gate;\n"
    "    dependency from Gate to Table;\n}\n",
    right="package P {\n    part def Wall;\n    part def Gate;\n"
    "    dependency from Gate to Wall;\n}\n",
)
NO_LIBRARY = rule(
    "SM484",
    "v2-no-library",
    Severity.ERROR,
    "the standard library '{path}' cannot be read: {problem}",
    why="Names such as ScalarValues::Real are those of the standard library; without it the "
    "small core of sysmlc serves, and what it has not is not found.",
    help="give --library the folder or .kpar with the .sysml and .kerml files",
    wrong="sysmlc model.sysml --library nowhere/",
    right="sysmlc model.sysml",
)
