"""What can be wrong between an overlay and its model.

The small overlays below are about a plant in which block Gate has the parts st (a Stopper with
the ports p_sIn and p_sOut) and sw (a Switch with p_swIn); the connector l1 joins st.p_sOut and
sw.p_swIn, and the activity Handle of gate.uml calls getIn.
"""

from sysmlc.diagnostics import Severity, rule

_ITEMS = "overlay: 1\nitems:\n  MiniPallet: {domain: physical}\n"
_FLOW = _ITEMS + "connectors:\n  Plant/Gate/l1:\n    flows:\n    - "
_BLOCKS = "overlay: 1\nblocks:\n  Plant/Gate:\n"
_GETS_IN = "  Plant/Switch:\n    operations: {getIn: }\n"

NO_MATCH = rule(
    "SM324",
    "overlay-no-match",
    Severity.ERROR,
    "the model has no {sort} '{word}'",
    why="The model may have been exported anew since the overlay was written. What the entry says "
    "is in no output.",
    help="{advice}",
    wrong=_FLOW.replace("l1", "l7") + "{item: MiniPallet, to: sw}\n",
    right=_FLOW + "{item: MiniPallet, to: sw}\n",
)
BY_PATH = rule(
    "SM325",
    "overlay-by-path",
    Severity.INFO,
    "nothing has the id '{id}' any more; '{path}' is taken instead",
    why="Tools give new ids in a new export. The path still leads to one element, which may be "
    "another one than before.",
    help="if it is the right one, write '{new}' as the key",
    wrong=_FLOW.replace("Plant/Gate/l1:", "old-id:\n    path: Plant/Gate/l1")
    + "{item: MiniPallet, to: sw}\n",
    right=_FLOW + "{item: MiniPallet, to: sw}\n",
)
AMBIGUOUS = rule(
    "SM326",
    "overlay-ambiguous",
    Severity.ERROR,
    "'{word}' means more than one {sort}: {listed}",
    why="Elements beside one another may have the same name; which one is meant is not guessed.",
    help="write the id",
    wrong=_FLOW.replace("l1", "twin") + "{item: MiniPallet, to: sw}\n",
    right=_FLOW + "{item: MiniPallet, to: sw}\n",
)
WRONG_SORT = rule(
    "SM327",
    "overlay-wrong-kind",
    Severity.ERROR,
    "'{word}' is a {kind}, no {sort}",
    why="Entries of an overlay say things that only elements of one kind can have.",
    help="name a {sort}, or put the entry where it belongs",
    wrong=_FLOW.replace("Gate/l1", "Gate/st") + "{item: MiniPallet, to: sw}\n",
    right=_FLOW + "{item: MiniPallet, to: sw}\n",
)
ONTO_NOTHING = rule(
    "SM328",
    "flow-onto-nothing",
    Severity.ERROR,
    "the connector has no end '{end}'; its ends are {listed}",
    why="Nothing can flow to or from where the connector does not lead.",
    help="{advice}",
    wrong=_FLOW + "{item: MiniPallet, to: rf}\n",
    right=_FLOW + "{item: MiniPallet, to: sw/p_swIn}\n",
)
END_OF_BOTH = rule(
    "SM329",
    "flow-end-unclear",
    Severity.ERROR,
    "'{end}' may be either end of the connector: {listed}",
    why="The way of the flow is what the entry is for.",
    help="write part and port: 'st/p_sOut'",
    wrong=_FLOW.replace("l1", "loop") + "{item: MiniPallet, to: st}\n",
    right=_FLOW.replace("l1", "loop") + "{item: MiniPallet, to: st/p_sIn}\n",
)
NO_TWO_ENDS = rule(
    "SM330",
    "flow-without-two-ends",
    Severity.ERROR,
    "the flow of '{item}' does not run between two ends of connector '{connector}'",
    why="A flow has an end where it starts and another one to which it runs.",
    help="name the two ends by 'from' and 'to'",
    wrong=_FLOW + "{item: MiniPallet, from: st, to: st}\n",
    right=_FLOW + "{item: MiniPallet, from: st, to: sw}\n",
)
NO_DOMAIN = rule(
    "SM331",
    "item-without-domain",
    Severity.WARNING,
    "item type '{item}' has no domain",
    why="Whether a thing or data flows decides which channel can carry it, so neither the "
    "connectors nor the recipes are checked for it (thesis 3.4.1).",
    help="say 'domain: physical' or 'domain: information'",
    wrong=_FLOW.replace(" {domain: physical}", "") + "{item: MiniPallet, to: sw}\n",
    right=_FLOW + "{item: MiniPallet, to: sw}\n",
)
NAMESAKE = rule(
    "SM332",
    "item-namesake",
    Severity.INFO,
    "'{item}' becomes a new item type, though the model has '{other}'",
    why="Equal names are no connection: the model may mean something else by it.",
    help="if it is the same, write '{other}' as the key and where the item flows",
    wrong=_ITEMS.replace("MiniPallet", "Tag"),
    right=_ITEMS.replace("MiniPallet", "Plant/Tag"),
)
OPERATION_TWICE = rule(
    "SM333",
    "operation-twice",
    Severity.ERROR,
    "block '{block}' has an operation '{operation}' with other parameters already",
    why="A call by this name would mean either of the two.",
    help="name the new operation otherwise, or give it the parameters that the block's has",
    wrong=_BLOCKS + "    operations: {open: {parameters: [{name: angle}]}}\n",
    right=_BLOCKS + "    operations: {open: {parameters: []}}\n",
)
FEATURE_TWICE = rule(
    "SM334",
    "value-twice",
    Severity.ERROR,
    "block '{block}' has '{feature}' already{where}",
    why="Guards and bodies that name it would mean either of the two.",
    help="name the value otherwise, or leave it to the model",
    wrong=_BLOCKS + "    values: {st: }\n",
    right=_BLOCKS + "    values: {bayIsFree: {type: Boolean}}\n",
)
UNFIT_VALUE = rule(
    "SM637",
    "overlay-value-not-of-type",
    Severity.ERROR,
    "the default {value} of '{feature}' is no {type}",
    why="Guards that compare the value would hold always or never.",
    help="write true or false for a Boolean, digits for a number, a literal of the enumeration, "
    "and quotes around a text that looks like a number",
    wrong=_BLOCKS + "    values: {bayIsFree: {type: Boolean, default: 1}}\n",
    right=_BLOCKS + "    values: {bayIsFree: {type: Boolean, default: true}}\n",
)
BEHAVIOR_TAKEN = rule(
    "SM335",
    "behavior-taken",
    Severity.ERROR,
    "'{behavior}' is the behaviour of '{holder}' already",
    why="A behaviour has one owner and implements one operation, and a block has one classifier "
    "behaviour (UML 2.5.1 clause 13.2.3).",
    help="let each operation and block have a behaviour of its own",
    wrong=_BLOCKS
    + "    behavior: gate.uml#Gate::Handle\n    operations:\n"
    + "      start: {method: gate.uml#Gate::Handle}\n"
    + _GETS_IN,
    right=_BLOCKS + "    behavior: gate.uml#Gate::Handle\n" + _GETS_IN,
)
CALL_OF_NONE = rule(
    "SM336",
    "call-without-operation",
    Severity.ERROR,
    "action '{action}' calls no operation: neither '{block}' nor a part of it has one of this name",
    why="Nobody carries out what the action asks for, so that its contract would promise nothing.",
    help="add the operation to a block, or name one under 'calls'; {advice}",
    wrong=_BLOCKS + "    behavior: gate.uml#Gate::Handle\n",
    right=_BLOCKS + "    behavior: gate.uml#Gate::Handle\n" + _GETS_IN,
)
CALL_OF_SEVERAL = rule(
    "SM337",
    "call-of-several-operations",
    Severity.ERROR,
    "action '{action}' may call {listed}",
    why="Each of these operations is visible in the block under this name.",
    help="say under 'calls' of the block which one is meant",
    wrong=_BLOCKS
    + "    behavior: gate.uml#Gate::Handle\n"
    + _GETS_IN
    + _GETS_IN.replace("Switch", "Stopper"),
    right=_BLOCKS
    + "    behavior: gate.uml#Gate::Handle\n    calls: {getIn: sw/getIn}\n"
    + _GETS_IN
    + _GETS_IN.replace("Switch", "Stopper"),
)
NO_ACTION = rule(
    "SM338",
    "overlay-call-unused",
    Severity.WARNING,
    "no behaviour of the block has a call operation action '{action}'",
    why="The entry has no effect; perhaps the action has been renamed.",
    help="{advice}",
    wrong=_BLOCKS
    + "    behavior: gate.uml#Gate::Handle\n    calls: {getInn: sw/getIn}\n"
    + _GETS_IN,
    right=_BLOCKS
    + "    behavior: gate.uml#Gate::Handle\n    calls: {getIn: sw/getIn}\n"
    + _GETS_IN,
)
OTHER_WISE = rule(
    "SM339",
    "overlay-contradicts-model",
    Severity.WARNING,
    "the overlay gives '{name}' the {what} {new}, the model {old}",
    why="One of the two is out of date. What the overlay says counts.",
    help="correct the overlay, or the model",
    wrong="overlay: 1\nports:\n  Plant/Switch/p_swIn: {direction: out}\n",
    right="overlay: 1\nports:\n  Plant/Switch/p_swIn: {direction: in}\n",
)
OTHER_PATH = rule(
    "SM340",
    "overlay-id-and-path-differ",
    Severity.WARNING,
    "the id '{id}' is that of '{meant}' now, not of '{path}'",
    why="The id counts; but tools that count ids give one to another element in a new export, and "
    "what the entry says may be said of the wrong one.",
    help="correct the id or the path: whichever is out of date",
    wrong="overlay: 1\nports:\n  s-in: {path: Plant/Stopper/p_sOut, direction: in}\n",
    right="overlay: 1\nports:\n  s-in: {path: Plant/Stopper/p_sIn, direction: in}\n",
)
