"""Rules about overlays that do not fit their model.

The examples of these rules are about a plant in which block Gate has the parts st (a Stopper with
the ports p_sIn and p_sOut) and sw (a Switch with p_swIn); the connector l1 joins st.p_sOut and
sw.p_swIn, and the activity Handle of gate.uml calls getIn.
"""

from sysmlc.diagnostics import Severity, rule

NO_MATCH = rule(
    "SM324",
    "overlay-no-match",
    Severity.ERROR,
    "the model has no {sort} '{word}'",
    help="{advice}",
)
BY_PATH = rule(
    "SM325",
    "overlay-by-path",
    Severity.INFO,
    "no element has the id '{id}' any more; '{path}' is used instead",
    help="if that is the intended element, write '{new}' as the key",
)
AMBIGUOUS = rule(
    "SM326",
    "overlay-ambiguous",
    Severity.ERROR,
    "'{word}' means more than one {sort}: {listed}",
    help="write the id",
)
WRONG_SORT = rule(
    "SM327",
    "overlay-wrong-kind",
    Severity.ERROR,
    "'{word}' is a {kind} and not a {sort}",
    help="name a {sort}, or move the entry to where it belongs",
)
UNKNOWN_END = rule(
    "SM328",
    "flow-onto-nothing",
    Severity.ERROR,
    "the connector has no end '{end}'; its ends are {listed}",
    help="{advice}",
)
AMBIGUOUS_END = rule(
    "SM329",
    "flow-end-unclear",
    Severity.ERROR,
    "'{end}' may be either end of the connector: {listed}",
    help="write part and port, such as 'st/p_sOut'",
)
MISSING_FLOW_END = rule(
    "SM330",
    "flow-without-two-ends",
    Severity.ERROR,
    "the flow of '{item}' does not run between two ends of connector '{connector}'",
    help="name the two ends by 'from' and 'to'",
)
NO_DOMAIN = rule(
    "SM331",
    "item-without-domain",
    Severity.WARNING,
    "item type '{item}' has no domain",
    help="say 'domain: physical' or 'domain: information'",
)
NAMESAKE = rule(
    "SM332",
    "item-namesake",
    Severity.INFO,
    "'{item}' is added as a new item type, although the model has '{other}'",
    help="if it is the same, write '{other}' as the key and wherever the item flows",
)
OPERATION_TWICE = rule(
    "SM333",
    "operation-twice",
    Severity.ERROR,
    "block '{block}' has an operation '{operation}' with other parameters already",
    help="rename the new operation, or give it the parameters of the existing one",
)
FEATURE_TWICE = rule(
    "SM334",
    "value-twice",
    Severity.ERROR,
    "block '{block}' has '{feature}' already{where}",
    help="rename the value, or remove it from the overlay",
)
INVALID_VALUE = rule(
    "SM637",
    "overlay-value-not-of-type",
    Severity.ERROR,
    "the default {value} of '{feature}' is not a valid {type}",
    help=(
        "write true or false for a Boolean, digits for a number, a literal of the enumeration, "
        "and quotes around a text that looks like a number"
    ),
)
BEHAVIOR_TAKEN = rule(
    "SM335",
    "behavior-taken",
    Severity.ERROR,
    "'{behavior}' is already the behaviour of '{holder}'",
    help="let each operation and block have a behaviour of its own",
)
NO_OPERATION = rule(
    "SM336",
    "call-without-operation",
    Severity.ERROR,
    "action '{action}' calls no operation: neither '{block}' nor a part of it has one of this name",
    help="add the operation to a block, or name one under 'calls'; {advice}",
)
SEVERAL_OPERATIONS = rule(
    "SM337",
    "call-of-several-operations",
    Severity.ERROR,
    "action '{action}' may call {listed}",
    help="name the intended operation under 'calls' of the block",
)
NO_ACTION = rule(
    "SM338",
    "overlay-call-unused",
    Severity.WARNING,
    "no behaviour of the block has a call operation action '{action}'",
    help="{advice}",
)
CONTRADICTION = rule(
    "SM339",
    "overlay-contradicts-model",
    Severity.WARNING,
    "the overlay gives '{name}' the {what} {new}, the model {old}",
    help="correct the overlay, or the model",
)
OTHER_PATH = rule(
    "SM340",
    "overlay-id-and-path-differ",
    Severity.WARNING,
    "the id '{id}' now belongs to '{meant}', not to '{path}'",
    help="correct the id or the path, whichever is out of date",
)
