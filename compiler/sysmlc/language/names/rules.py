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
