"""What can be wrong with interactions (UML 2.5.1 clause 17)."""

from sysmlc.diagnostics import Severity, rule

MESSAGE_WITHOUT_LIFELINE = rule(
    "SM440",
    "message-without-lifeline",
    Severity.WARNING,
    "message '{message}' of '{interaction}' {problem}",
    help="tie the ends of the message to lifelines again, or delete it",
)
OPERANDS = rule(
    "SM441",
    "wrong-number-of-operands",
    Severity.WARNING,
    "fragment '{operator}' of '{interaction}' has {count} operands, but {wanted}",
    help="move the contents into one operand, or choose another operator",
)
ACROSS_OPERANDS = rule(
    "SM442",
    "message-across-fragments",
    Severity.WARNING,
    "message '{message}' of '{interaction}' is sent in one operand and received in another",
    help="move both ends of the message into the same operand",
)
AFTER_DESTRUCTION = rule(
    "SM443",
    "occurrence-after-destruction",
    Severity.WARNING,
    "something happens on lifeline '{lifeline}' of '{interaction}' after it was destroyed",
    help="move the destruction to the end of the lifeline",
)
RECEIVED_FIRST = rule(
    "SM444",
    "received-before-sent",
    Severity.WARNING,
    "message '{message}' of '{interaction}' is received before it is sent",
    help="move the message in the modelling tool, so that it orders the ends anew",
)
EXECUTION_BACKWARDS = rule(
    "SM445",
    "execution-ends-before-it-starts",
    Severity.WARNING,
    "execution '{execution}' of '{interaction}' ends before it starts",
    help="draw the execution again in the modelling tool",
)
NOT_OFFERED = rule(
    "SM446",
    "operation-not-offered",
    Severity.WARNING,
    "message '{message}' of '{interaction}' calls '{operation}', which '{type}' does not offer",
    help="add the operation to '{type}', or choose one of its operations for the message",
)
CREATED_LATE = rule(
    "SM447",
    "created-after-its-first-occurrence",
    Severity.WARNING,
    "message '{message}' of '{interaction}' creates lifeline '{lifeline}', on which something has "
    "happened before",
    help="move the message up, or choose another sort of message",
)
