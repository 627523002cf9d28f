"""Rules about activities (SM450 to SM479, SM486 and SM489)."""

from sysmlc.diagnostics import Severity, rule

NO_START = rule(
    "SM450",
    "activity-without-start",
    Severity.WARNING,
    "activity '{activity}' cannot start: it has no initial node, no input parameter and no action "
    "without incoming flows",
    help="add an initial node with a flow to the first action",
)
STARTED_BY_ACTIONS = rule(
    "SM451",
    "start-without-initial-node",
    Severity.INFO,
    "activity '{activity}' has no initial node; it starts with {actions}",
    help="add an initial node if only one of them is meant to start",
)
UNREACHABLE = rule(
    "SM452",
    "unreachable-activity-node",
    Severity.WARNING,
    "no token ever reaches {node}",
    help="let a flow or an exception lead to it, or delete it",
)
RAISE_ADVICE = "action '{action}' always raises an exception: lead the flow from another node"
"""Advice on UNREACHABLE for the nodes after a raise action."""
NEVER_FIRES = rule(
    "SM453",
    "node-waits-forever",
    Severity.WARNING,
    "{node} waits forever: its incoming flows never all hold a token",
    help="bring alternative branches together in a merge node instead",
)
UNSAFE = rule(
    "SM454",
    "flow-with-two-tokens",
    Severity.WARNING,
    "{flow} may get a second token while it still holds one; the activity gets no contract",
    help="bring parallel branches together in a join node",
)
LISTENING_ADVICE = (
    "{action} accepts again and again, because no flow leads to it: lead a flow from an initial "
    "node to it, and a flow back from the last action if it accepts again"
)
"""Advice on UNSAFE for the flows after an accept action without incoming flows."""
BUFFER_ADVICE = "let the values arrive one after the other; a contract has one Boolean for the node"
"""Advice on UNSAFE for object nodes."""
TOO_LARGE = rule(
    "SM455",
    "activity-too-large-to-check",
    Severity.WARNING,
    "activity '{activity}' has too many markings to search (at most {limit}); whether each flow "
    "holds at most one token was not decided, so it gets no contract",
    help=(
        "move parts of the activity into activities of their own, or raise the limit "
        "(option max_markings in [passes.activities])"
    ),
)
MISSING_BRANCH = rule(
    "SM456",
    "decision-without-else",
    Severity.WARNING,
    "{node} has no branch for the case that none of its guards holds ({guards}); the token "
    "waits there",
    help="add a branch with the guard else, or guards for the other cases",
)
OVERLAP = rule(
    "SM457",
    "overlapping-branches",
    Severity.WARNING,
    "several branches of {node} may be open at the same time: {branches}",
    help="make the guards exclude each other, or give one of the branches the guard else",
)
FORK_ADVICE = "add a fork if all flows are meant to be taken, or a decision with guards"
"""Advice on OVERLAP for several flows that leave an initial node, a merge or a pin."""
UNREADABLE = rule(
    "SM458",
    "guard-in-plain-words",
    Severity.WARNING,
    "{condition} has no formula: {reason}; it becomes {treatment}",
    help="write it as an expression over properties of the block, for example 'angle > 90'",
)
WEIGHT = rule(
    "SM459",
    "weighted-flow",
    Severity.WARNING,
    "{flow} has the weight {weight}; the activity gets no contract",
    help="model the repetition as a loop",
)
MISSING_FLOW_END = rule(
    "SM460",
    "activity-flow-without-end",
    Severity.ERROR,
    "{flow} has no {end}",
    help="connect both ends of the flow, or delete it",
)
OPEN_PIN = rule(
    "SM464",
    "pin-without-flow",
    Severity.INFO,
    "nothing flows into pin '{pin}' of {node}; it is taken as always filled",
    help="connect the pin, or delete it",
)
COMBINED_CONTROL_NODE = rule(
    "SM465",
    "control-node-with-two-jobs",
    Severity.INFO,
    "{node} is drawn with {drawn}; it is taken as {meaning}",
    help="draw two control nodes",
)
NEVER_FINISHES = rule(
    "SM466",
    "activity-never-finishes",
    Severity.INFO,
    "activity '{activity}' never finishes",
    help="add a way to an activity final node if it is meant to end",
)
JOIN_SPEC = rule(
    "SM467",
    "join-with-specification",
    Severity.WARNING,
    "{node} has the join specification '{text}'; the activity gets no contract",
    help="use a join without a specification, or a merge",
)
WAITING_GUARD = rule(
    "SM468",
    "guard-outside-decision",
    Severity.INFO,
    "{guard} is on {flow}, which does not leave a decision; the token waits until it holds",
    help="put a decision node before the flow and say what happens else",
)
EMPTY = rule(
    "SM469",
    "activity-without-nodes",
    Severity.INFO,
    "activity '{activity}' {fault}; it gets no contract",
    help="draw actions in it if it needs a contract",
)
SHARED_EVENT = rule(
    "SM470",
    "event-with-two-takers",
    Severity.INFO,
    "{nodes} wait for the same event '{event}'; one occurrence ends both when both wait",
    help="give the two events different signals",
)
GROUPING = rule(
    "SM471",
    "structured-node-as-group",
    Severity.WARNING,
    "{node} has no flows of its own, but flows lead into it again; it is taken as a mere group",
    help="lead the flows to the structured node itself, or use a partition to group actions",
)
MISPLACED_FLOW = rule(
    "SM472",
    "flow-into-initial-or-from-final-node",
    Severity.WARNING,
    "{node} has {flows}, which no token passes",
    help="lead the flow to a merge node after the initial node, or delete it",
)
UNLISTED_ACTIONS = rule(
    "SM473",
    "action-outside-test-and-body",
    Severity.WARNING,
    "{node} is a {kind} node with actions that are in none of its tests and bodies; the activity "
    "gets no contract",
    help="add the action to the body, or move it out of the node",
)
NO_HANDLER_BODY = rule(
    "SM474",
    "exception-handler-without-body",
    Severity.WARNING,
    "{node} has an exception handler without a body in the activity; the handler is ignored",
    help="draw the body beside the protected node, and connect it to the handler",
)
UNCAUGHT = rule(
    "SM475",
    "exception-without-handler",
    Severity.INFO,
    "no handler in the activity catches what {node} may raise; it ends the activity",
    help="add a handler to the action, or to a structured node around it",
)
OTHER_VALUES = rule(
    "SM476",
    "decision-drops-other-values",
    Severity.INFO,
    "{node} has no branch for values other than {guards}; a token with another value ends there",
    help="add a branch with the guard else if the other values matter",
)
PARALLEL_EXPANSION = rule(
    "SM477",
    "elements-taken-at-once",
    Severity.INFO,
    "{node} takes the elements of its collection in {mode}; it is one step for all of them",
    help="make the region iterative if the order of the elements matters",
)
STAYS_INSIDE = rule(
    "SM478",
    "interrupting-flow-stays-inside",
    Severity.WARNING,
    "{flow} interrupts a region that it does not leave; it is taken as a plain flow",
    help="lead it out of the region, or let it interrupt nothing",
)
TOO_DEEP = rule(
    "SM479",
    "structured-nodes-nested-too-deep",
    Severity.WARNING,
    "structured nodes of activity '{activity}' are nested more than {limit} deep; it gets no "
    "contract",
    help=(
        "move what is inside into activities of their own, or raise the limit (option "
        "max_depth of passes.activities)"
    ),
)
SELECTION = rule(
    "SM489",
    "selection-not-read",
    Severity.WARNING,
    "{node} has a {behaviour}, which the contract does not read: every object passes, with any "
    "value",
    help="do it in an action before, and decide by its result",
)
UNORDERED = rule(
    "SM486",
    "activity-without-flows",
    Severity.WARNING,
    "activity '{activity}' has nodes but no flows, so that nothing orders them; it gets no "
    "contract",
    help=(
        "connect the nodes with flows; if all actions start at once, lead a flow to each of them "
        "from a fork"
    ),
)
