"""Constraints of the specification about what usages reference and redefine."""

from sysmlc.diagnostics import Severity, rule

OTHER_KIND = rule(
    "SM236",
    "references-other-kind",
    Severity.ERROR,
    "'{name}' is {found}, and {wanted} is needed here",
    why="What is performed is an action, exhibited a state, included a use case, and what happens "
    "an occurrence (SysML 2.0, the constraints validate...Reference).",
    help="reference {wanted}",
    wrong="part def Plant { action gate; exhibit gate; }\n",
    right="part def Plant { state gate; exhibit gate; }\n",
)
PART_OF_PORT = rule(
    "SM237",
    "part-of-port",
    Severity.ERROR,
    "'{name}' is a part of the port '{owner}'",
    why="Ports have no parts but ports (SysML 2.0, validatePortDefinitionOwnedUsagesNotComposite).",
    help="write 'ref' before it, or give it a direction",
    wrong="port def Plug { part pin; }\n",
    right="port def Plug { ref part pin; }\n",
)
OTHER_DIRECTION = rule(
    "SM238",
    "other-direction",
    Severity.ERROR,
    "'{name}' has another direction where it is defined, in '{owner}'",
    why="Who relies on the general feature gives and takes in its direction (KerML 1.0, "
    "validateRedefinitionDirectionConformance).",
    help="use the same direction, or none",
    wrong="port def Plug { in item current; }\nport plug : Plug { out item :>> current; }\n",
    right="port def Plug { in item current; }\nport plug : Plug { in item :>> current; }\n",
)
INDIVIDUAL = rule(
    "SM239",
    "individual-types",
    Severity.ERROR,
    "the individual '{name}' has {count} individual definitions and must have one",
    why="An individual usage is of the one individual that its definition says (SysML 2.0, "
    "validateOccurrenceUsageIndividualUsage).",
    help="type it by one 'individual def'",
    wrong="part def Gate;\nindividual part gate : Gate;\n",
    right="individual part def Gate;\nindividual part gate : Gate;\n",
)
