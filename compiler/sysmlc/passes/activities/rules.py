"""Rules about activities (SM450 to SM479), each with a small model that has it and one that nearly
has it.
"""

from sysmlc.diagnostics import Severity
from sysmlc.passes.activities.sketch import activity_rule as _rule

NO_START = _rule(
    "SM450",
    "activity-without-start",
    Severity.WARNING,
    "activity '{activity}' can't start: it has no initial node, no input parameter and no action "
    "without incoming flows",
    "Without a node that gets the first token nothing in the activity ever happens, so it has no "
    "contract.",
    "add an initial node with a flow to the first action",
    "merge m\naction work\nm -> work\nwork -> m",
    "initial i\nmerge m\naction work\ni -> m\nm -> work\nwork -> m",
)
STARTED_BY_ACTIONS = _rule(
    "SM451",
    "start-without-initial-node",
    Severity.INFO,
    "activity '{activity}' has no initial node; it starts with {actions}",
    "UML 2.5.1, 15.2.3: actions without incoming flows start at once when their activity starts.",
    "add an initial node if only one of them is meant to start",
    "action work\nfinal end\nwork -> end",
    "initial i\naction work\nfinal end\ni -> work\nwork -> end",
)
UNREACHABLE = _rule(
    "SM452",
    "unreachable-activity-node",
    Severity.WARNING,
    "no token ever reaches {node}",
    "No path of flows leads to it from where the activity starts. It is kept, and stays idle.",
    "connect it, or delete it",
    "initial i\naction work\naction lost\nfinal end\nmerge m\ni -> work\nwork -> end\n"
    "m -> lost\nlost -> m",
    "initial i\naction work\naction found\nfinal end\ni -> work\nwork -> found\nfound -> end",
)
NEVER_FIRES = _rule(
    "SM453",
    "node-waits-forever",
    Severity.WARNING,
    "{node} waits forever: its incoming flows never all hold a token",
    "A join, and an action with several incoming flows, waits for all of them; flows that come "
    "from alternative branches never bring their tokens together.",
    "bring alternative branches together in a merge node instead",
    "initial i\ndecision d\naction x\naction y\naction z\ni -> d\nd -> x [ok]\nd -> y [else]\n"
    "x -> z\ny -> z",
    "initial i\ndecision d\naction x\naction y\nmerge m\naction z\ni -> d\nd -> x [ok]\n"
    "d -> y [else]\nx -> m\ny -> m\nm -> z",
)
UNSAFE = _rule(
    "SM454",
    "flow-with-two-tokens",
    Severity.WARNING,
    "{flow} may get a second token while it still holds one; the activity gets no contract",
    "Contracts have one Boolean for each flow. Two tokens at one place usually mean that parallel "
    "branches run into a merge node, or that something is asked for faster than it is done.",
    "bring parallel branches together in a join node",
    "initial i\nfork k\naction x\naction y\nmerge m\naction z\ni -> k\nk -> x\nk -> y\nx -> m\n"
    "y -> m\nm -> z",
    "initial i\nfork k\naction x\naction y\njoin j\naction z\ni -> k\nk -> x\nk -> y\nx -> j\n"
    "y -> j\nj -> z",
)
TOO_LARGE = _rule(
    "SM455",
    "activity-too-large-to-check",
    Severity.WARNING,
    "activity '{activity}' has more than {limit} markings; whether each flow holds at most one "
    "token was not decided, so it gets no contract",
    "The check searches all distributions of tokens after it has removed series and parallel "
    "parts. (The wrong model below is over a limit of three markings.)",
    "move parts of the activity into activities of their own, or raise the limit "
    "(option max_markings of the pass activities)",
    "initial i\nfork k\naction x\naction y\ni -> k\nk -> x\nk -> y",
    "initial i\naction x\naction y\ni -> x\nx -> y",
)
MISSING_BRANCH = _rule(
    "SM456",
    "decision-without-else",
    Severity.WARNING,
    "{node} has no branch for the case that none of its guards holds ({guards}); the token "
    "waits there",
    "When no guard holds, the token stays until one does (UML 2.5.1, 15.3.3.6). The contract "
    "assumes that this happens sooner or later.",
    "give one of the branches the guard else",
    "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [ok]\nd -> y [bad]",
    "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [ok]\nd -> y [else]",
)
OVERLAP = _rule(
    "SM457",
    "overlapping-branches",
    Severity.WARNING,
    "several branches of {node} may be open at the same time: {branches}",
    "UML leaves open which of the open branches is taken. The contract allows each of them.",
    "make the guards exclude each other, or give one of the branches the guard else",
    "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x\nd -> y",
    "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [ok]\nd -> y [else]",
)
UNREADABLE = _rule(
    "SM458",
    "guard-in-plain-words",
    Severity.WARNING,
    "{what} '{text}' is not an expression over known properties ({reason}); it becomes the input "
    "{variable}",
    "What it depends on isn't known, so the environment decides it freely.",
    "write it as an expression over properties of the block, for example 'angle > 90'",
    "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [is it ok?]\nd -> y [else]",
    "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x [true]\nd -> y [else]",
)
WEIGHT = _rule(
    "SM459",
    "weighted-flow",
    Severity.WARNING,
    "{flow} has the weight {weight}; the activity gets no contract",
    "A flow with a weight waits for several tokens, but contracts have one Boolean for each flow.",
    "model the repetition as a loop",
    "initial i\naction x\ni -> x weight=2",
    "initial i\naction x\ni -> x",
)
LOOSE_FLOW = _rule(
    "SM460",
    "activity-flow-without-end",
    Severity.ERROR,
    "{flow} has no {end}",
    "A flow leads from one node to another (UML 2.5.1, 15.2.3).",
    "connect both ends of the flow, or delete it",
    "initial i\naction x\ni -> x\nx -> nothing",
    "initial i\naction x\nfinal end\ni -> x\nx -> end",
)
OPEN_PIN = _rule(
    "SM464",
    "pin-without-flow",
    Severity.INFO,
    "nothing flows into pin '{pin}' of {node}; it is taken as always filled",
    "By UML the action would never start (UML 2.5.1, 16.2.3). Tools add such pins to calls by "
    "themselves.",
    "connect the pin, or delete it",
    "initial i\naction x\n  pin p\ni -> x",
    "action w\naction x\n  pin p\nw -> p",
)
TWO_IN_ONE = _rule(
    "SM465",
    "control-node-with-two-jobs",
    Severity.INFO,
    "{node} is drawn with {drawn}; it is taken as {meaning}",
    "UML asks for one symbol each: decisions have one incoming, merges and joins one outgoing and "
    "forks one incoming flow (UML 2.5.1, 15.7).",
    "draw two control nodes",
    "initial i\nmerge m\naction x\nfinal end\ni -> m\nm -> x\nm -> end\nx -> m",
    "initial i\nmerge m\naction x\ni -> m\nm -> x\nx -> m",
)
ENDLESS = _rule(
    "SM466",
    "activity-never-finishes",
    Severity.INFO,
    "activity '{activity}' never finishes",
    "No run reaches an activity final node or uses up all tokens. Its contract promises that its "
    "loops go on instead.",
    "add a way to an activity final node if it is meant to end",
    "initial i\nmerge m\naction x\ni -> m\nm -> x\nx -> m",
    "initial i\naction x\nfinal end\ni -> x\nx -> end",
)
JOIN_SPEC = _rule(
    "SM467",
    "join-with-specification",
    Severity.WARNING,
    "{node} has the join specification '{text}'; the activity gets no contract",
    "Only joins that wait for all their incoming flows are understood.",
    "use a join without a specification, or a merge",
    "initial i\nfork k\nor-join j\naction x\ni -> k\nk -> j\nk -> j\nj -> x",
    "initial i\nfork k\njoin j\naction x\ni -> k\nk -> j\nk -> j\nj -> x",
)
WAITING_GUARD = _rule(
    "SM468",
    "guard-outside-decision",
    Severity.INFO,
    "the guard '{text}' is on {flow}, which does not leave a decision; the token waits until "
    "it holds",
    "fUML looks at guards only after decision nodes; UML lets the token wait.",
    "put a decision node before the flow and say what happens else",
    "initial i\naction x\naction y\ni -> x\nx -> y [true]",
    "initial i\naction x\naction y\ni -> x\nx -> y",
)
EMPTY = _rule(
    "SM469",
    "activity-without-nodes",
    Severity.INFO,
    "activity '{activity}' has no nodes",
    "There is nothing to derive a contract from.",
    "draw it, or give it a body",
    "",
    "initial i\naction x\ni -> x",
)
SHARED_EVENT = _rule(
    "SM470",
    "event-with-two-takers",
    Severity.INFO,
    "{nodes} wait for the same event '{event}'; one occurrence ends both when both wait",
    "By UML only one of them takes the occurrence. This makes a difference only when both can "
    "wait at the same time.",
    "give the two events different signals",
    "initial i\naccept go\n  on-pallet t\naccept again\n  on-pallet u\ni -> go\ngo -> again",
    "initial i\naccept go\n  on-pallet t\naccept again\n  on-tool u\ni -> go\ngo -> again",
)
GROUPING = _rule(
    "SM471",
    "structured-node-as-group",
    Severity.WARNING,
    "{node} has no flows of its own, but flows lead into it again; it is taken as a mere group",
    "A structured node starts and ends as a whole. Taken at its word it would start once, with "
    "the activity, and do nothing when flows from outside come back to it.",
    "lead the flows to the structured node itself, or use a partition to group actions",
    "initial i\nmerge m\nstructured s\n  action x\n  action z\naction y\ni -> m\nm -> x\n"
    "x -> z\nz -> y\ny -> m",
    "initial i\nstructured s\n  action x\nfinal end\ni -> x\nx -> end",
)
ODD_END = _rule(
    "SM472",
    "flow-into-initial-or-from-final-node",
    Severity.WARNING,
    "{node} has {flows}, which no token passes",
    "Tokens start at initial nodes and end at final nodes (UML 2.5.1, 15.3.3).",
    "lead the flow to a merge node after the initial node, or delete it",
    "initial i\naction x\ni -> x\nx -> i",
    "initial i\nmerge m\naction x\ni -> m\nm -> x\nx -> m",
)
LOOSE_NODES = _rule(
    "SM473",
    "action-outside-test-and-body",
    Severity.WARNING,
    "{node} is a {kind} node with actions that are in none of its tests and bodies; the activity "
    "gets no contract",
    "The tests, bodies and the set-up of a loop or conditional node hold all its actions between "
    "them (UML 2.5.1, 16.11.4); when the others would run is not defined.",
    "add the action to the body, or move it out of the node",
    "initial i\nloop l\n  action work\n  action more\ni -> l",
    "initial i\nloop l\n  action work\ni -> l",
)
NO_HANDLER_BODY = _rule(
    "SM474",
    "exception-handler-without-body",
    Severity.WARNING,
    "{node} has an exception handler without a body in the activity; the handler is left out",
    "The body of a handler is what runs instead of the rest of the protected node "
    "(UML 2.5.1, 15.5.3).",
    "draw the body beside the protected node, and connect it to the handler",
    "initial i\nprotected work\ni -> work",
    "initial i\nprotected work\naction repair\ni -> work",
)
UNCAUGHT = _rule(
    "SM475",
    "exception-without-handler",
    Severity.INFO,
    "no handler in the activity catches what {node} may raise; it ends the activity",
    "An exception ends everything around it up to a node with a handler "
    "(UML 2.5.1, 15.5.3); what calls the activity may have one.",
    "add a handler to the action, or to a structured node around it",
    "initial i\nraise stop\ni -> stop",
    "initial i\naction stop\ni -> stop",
)
OTHER_VALUES = _rule(
    "SM476",
    "decision-drops-other-values",
    Severity.INFO,
    "{node} has branches for the values {guards} only; a token with another value ends there",
    "The value of a token never changes, so that waiting for a branch to open would be in vain. "
    "fUML 1.5, 8.10.3 drops such tokens.",
    "give one of the branches the guard else if the others matter",
    'initial i\nquestion d\naction x\ni -> d\nd -> x guard="1" guard_literal=true',
    "initial i\nquestion d\naction x\naction y\ni -> d\n"
    'd -> x guard="true" guard_literal=true\nd -> y guard="false" guard_literal=true',
)
AT_ONCE = _rule(
    "SM477",
    "elements-taken-at-once",
    Severity.INFO,
    "{node} takes the elements of its collection in {mode}; it is one step for all of them",
    "Contracts have one Boolean for each flow, so that what is inside stands for all elements at "
    "once, as if there were one of them.",
    "make the region iterative if the order of the elements matters",
    "initial i\nexpansion e\n  action x\ni -> e",
    "initial i\niteration e\n  action x\ni -> e",
)
STAYS_INSIDE = _rule(
    "SM478",
    "interrupting-flow-stays-inside",
    Severity.WARNING,
    "{flow} interrupts a region that it does not leave; it is taken as a plain flow",
    "An interrupting flow starts in its region and ends outside (UML 2.5.1, 15.7.15); the token on "
    "it would be lost as well.",
    "lead it out of the region, or let it interrupt nothing",
    'initial i\ninterruptible r\n  action x\n  action y\ni -> x\nx -> y interrupts="r"',
    'initial i\ninterruptible r\n  action x\naction y\ni -> x\nx -> y interrupts="r"',
)
TOO_DEEP = _rule(
    "SM479",
    "structured-nodes-nested-too-deep",
    Severity.WARNING,
    "structured nodes of activity '{activity}' are nested more than {limit} deep; it gets no "
    "contract",
    "Nobody draws such an activity; the limit keeps spoilt files from using up all time. (The "
    "wrong model below is over a limit of one.)",
    "move what is inside into activities of their own, or raise the limit (option max_depth of the "
    "pass activities)",
    "initial i\nstructured s\n  structured t\n    action x\ni -> s",
    "initial i\nstructured s\n  action x\ni -> s",
)
