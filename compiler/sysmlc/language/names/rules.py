"""What can be wrong with the names of a model."""

from sysmlc.diagnostics import Severity, rule

UNRESOLVED = rule(
    "SM205",
    "unresolved-name",
    Severity.ERROR,
    "'{name}' is not known here{inside}",
    why="A name is looked up in the namespaces around its use, in what they inherit and import, "
    "and among the packages of the model and the library (KerML 1.0, 8.2.3.5). Nothing there has "
    "this name, so the element that uses it is incomplete.",
    help="{advice}",
    wrong="""\
package Plant {
    part def Gate;
    part entrance : Gat;
}
""",
    right="""\
package Plant {
    part def Gate;
    part entrance : Gate;
}
""",
)

CYCLE = rule(
    "SM206",
    "specialization-cycle",
    Severity.WARNING,
    "'{name}' specialises itself{through}",
    why="Everything in a circle of specialisations has the same instances (KerML 1.0, 8.3.3.1.10), "
    "so each of them inherits all of the others. That is allowed, and hardly ever meant.",
    help="remove one specialisation of the circle",
    wrong="""\
package Plant {
    part def Gate :> Door;
    part def Door :> Gate;
}
""",
    right="""\
package Plant {
    part def Gate :> Door;
    part def Door;
}
""",
)
NO_STANDARD_LIBRARY = rule(
    "SM207",
    "no-standard-library",
    Severity.WARNING,
    "the standard library of SysML v2 is not installed; the core that sysmlc bundles replaces it",
    why="Types, units and functions come from the standard library. It is part of the distribution "
    "'sysml', which is installed with sysmlc, except on platforms where that distribution comes "
    "without its library files (Linux on ARM, musl). The bundled core has only the names that "
    "production models use, and how they specialise each other.",
    help="if names of the library are missing, get the library's files from the SysML v2 release "
    "and name their folder with --library PATH or the environment variable SYSML_LIBRARY_PATH",
    wrong="""\
package Plant {
    private import ScalarValues::Real;
    attribute speed : Real;
}
""",
    right="""\
package Plant {
    attribute speed;
}
""",
)
TOO_DEEP = rule(
    "SM208",
    "names-too-deep",
    Severity.ERROR,
    "what '{name}' leads to is behind too many other names",
    why="A name may lead to a name that leads to a name. Thousands of them in a row, as a program "
    "may write them, are not followed.",
    help="refer to the element itself",
    wrong="""\
alias A0 for A1;
alias A1 for A2;
...
alias A7999 for A8000;
part def A8000;
part gate : A0;
""",
    right="""\
alias A7999 for A8000;
part def A8000;
part gate : A7999;
""",
)
TOO_CIRCULAR = rule(
    "SM240",
    "names-too-circular",
    Severity.ERROR,
    "'{name}' was looked for in 2,000 circles of names, and is given up",
    why="A name may be inherited or imported from what is itself looked up by name. Where "
    "namesakes specialise what lies in one another there are more ways to a name than can be "
    "tried, so that it may be there and is not found.",
    help="give the namesakes names of their own, or qualify what they specialise",
    wrong="""\
part def A :> A::B;
part def A :> A::B;
...
part def A :> A::B;
""",
    right="""\
part def A1 :> A::B;
part def A { part def B; }
""",
)
