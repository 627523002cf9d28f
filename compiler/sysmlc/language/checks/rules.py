"""Constraints of the specification about the types of usages and about members of a kind."""

from sysmlc.diagnostics import Severity, rule

TYPED_BY = rule(
    "SM221",
    "usage-type",
    Severity.ERROR,
    "{usage} must be typed by {wanted}, and '{type}' is {found}",
    why="A usage is of the kind of its definitions (SysML 2.0, 8.3.6.4 and the constraints "
    "validate...Type of each usage): what a value of it is must be said by a definition of that "
    "kind.",
    help="use {wanted} as the type",
    wrong="""\
package Plant {
    part def Gate;
    action open : Gate;
}
""",
    right="""\
package Plant {
    action def Gate;
    action open : Gate;
}
""",
)
ONE_TYPE = rule(
    "SM222",
    "usage-one-type",
    Severity.ERROR,
    "{usage} must be typed by one definition, and has {types}",
    why="A calculation, constraint, requirement, case, view, rendering, metadata or enumeration "
    "usage has exactly one definition (SysML 2.0, the constraints validate...Type).",
    help="keep one of them, or let one specialise the other",
    wrong="""\
package Plant {
    calc def Time;
    calc def Cost;
    calc both : Time, Cost;
}
""",
    right="""\
package Plant {
    calc def Time;
    calc def Cost :> Time;
    calc both : Time, Cost;
}
""",
)
ONLY_ONE = rule(
    "SM223",
    "only-one",
    Severity.ERROR,
    "'{owner}' may have one {role} only",
    why="A requirement or case has one subject, a case one objective, a calculation one result, a "
    "state one entry, one do and one exit action, a view one rendering (SysML 2.0, 8.3.20 to "
    "8.3.26).",
    help="keep the first one, or redefine it",
    wrong="""\
package Plant {
    state def Running {
        entry action start1;
        entry action start2;
    }
}
""",
    right="""\
package Plant {
    state def Running {
        entry action start1;
        exit action start2;
    }
}
""",
)
SUBJECT_FIRST = rule(
    "SM224",
    "subject-first",
    Severity.ERROR,
    "the subject of '{owner}' must be its first parameter",
    why="What a requirement or case is about is bound to its first parameter (SysML 2.0, "
    "validateRequirementDefinitionSubjectParameterPosition and alike).",
    help="move the subject before the other parameters",
    wrong="""\
package Plant {
    case def Study {
        in attribute speed;
        subject plant;
    }
}
""",
    right="""\
package Plant {
    case def Study {
        subject plant;
        in attribute speed;
    }
}
""",
)
NOT_ACCESSIBLE = rule(
    "SM225",
    "feature-not-accessible",
    Severity.ERROR,
    "'{name}' is a feature of '{owner}', and nothing around here is one",
    why="A feature has values only in what has it (KerML 1.0, validateSubsettingFeaturingTypes, "
    "validateConnectorRelatedFeatures): from outside it is reached by a dot from a part of that "
    "kind.",
    help="use dot notation: the part, a dot, '{name}'",
    wrong="""\
package Plant {
    part def Motor { port shaft; }
    part def Gate {
        part motor : Motor;
        port axle;
        connect Motor::shaft to axle;
    }
}
""",
    right="""\
package Plant {
    part def Motor { port shaft; }
    part def Gate {
        part motor : Motor;
        port axle;
        connect motor.shaft to axle;
    }
}
""",
)
