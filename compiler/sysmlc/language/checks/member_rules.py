"""Constraints of the specification about what may be a member of what."""

from sysmlc.diagnostics import Severity, rule

VARIANT_ELSEWHERE = rule(
    "SM226",
    "variant-elsewhere",
    Severity.ERROR,
    "'{name}' is a variant, and '{owner}' is no variation",
    help="write 'variation' before '{owner}', or leave 'variant' out",
)
NO_VARIANT = rule(
    "SM227",
    "variation-member",
    Severity.ERROR,
    "'{name}' is a member of the variation '{owner}' and no variant",
    help="write 'variant' before '{name}'",
)
VARIATION_OF_VARIATION = rule(
    "SM228",
    "variation-of-variation",
    Severity.ERROR,
    "the variation '{name}' specialises another variation",
    help="specialise what is no variation",
)
VERIFY_ELSEWHERE = rule(
    "SM229",
    "verify-elsewhere",
    Severity.ERROR,
    "'{owner}' is not the objective of a verification, so it cannot verify '{name}'",
    help="move 'verify' into the objective of a verification case",
)
PARALLEL = rule(
    "SM230",
    "parallel-succession",
    Severity.ERROR,
    "'{owner}' is parallel: its states have no order",
    help="remove 'parallel', or the succession or transition",
)
PORTION_ELSEWHERE = rule(
    "SM231",
    "portion-elsewhere",
    Severity.ERROR,
    "'{name}' is a portion of no occurrence",
    help="move it into an occurrence, item or part",
)
END_NO_PORT = rule(
    "SM232",
    "interface-end-no-port",
    Severity.ERROR,
    "'{name}' is an end of the interface '{owner}' and no port",
    help="make it a port, or use a connection",
)
TOO_MANY_ENDS = rule(
    "SM233",
    "flow-ends",
    Severity.ERROR,
    "'{name}' is the third end of the flow '{owner}'",
    help="keep two ends",
)
ABSTRACT_METADATA = rule(
    "SM234",
    "abstract-metadata",
    Severity.ERROR,
    "metadata '{name}' has an abstract type",
    help="use a metadata definition that is not abstract",
)
ENUMERATION_AND_MORE = rule(
    "SM235",
    "enumeration-and-more",
    Severity.ERROR,
    "attribute '{name}' has an enumeration and another type",
    help="keep one type",
)
