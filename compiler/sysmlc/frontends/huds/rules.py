"""Rules of reading MTIP files."""

from sysmlc.diagnostics import Severity, rule

MALFORMED = rule(
    "SM185",
    "malformed-mtip-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    why="The file is damaged, or it asks for something that safe reading refuses. Nothing of it "
    "is in the graph, because half a model gives wrong outputs.",
    help="export the model again",
    wrong="<packet><data></packet>",
    right="<packet><data></data></packet>",
)
UNSUPPORTED = rule(
    "SM181",
    "unsupported-mtip-type",
    Severity.WARNING,
    "{count} elements of type '{type}' not read",
    why="The type has a meaning that this front end does not know, so outputs do not reflect it. "
    "coverage.json counts such elements; --strict-input makes them errors.",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
    wrong="<data>...<type>sysml.DurationInterval</type></data>",
    right="<data>...<type>sysml.Block</type></data>",
)
OWNERLESS = rule(
    "SM182",
    "mtip-owner-not-read",
    Severity.WARNING,
    "{count} elements of type '{type}' not read, because their owners are not",
    why="MTIP leaves out elements of types that it does not know, and some types are not read "
    "here; what they own hangs in the air.",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
    wrong="<hasParent><type>null.null</type><id>_gone</id></hasParent>",
    right="<hasParent><type>sysml.Package</type><id>_a</id></hasParent>",
)
LOOSE_END = rule(
    "SM184",
    "mtip-end-not-read",
    Severity.WARNING,
    "{count} elements of type '{type}' lead from or to nodes that are not read",
    why="MTIP leaves out nodes of types that it does not know, and what they own; what a behaviour "
    "means without them cannot be told.",
    help="save the model as .mdzip or .xml in Cameo: these are read more completely",
    wrong="<supplier><type>null.null</type><id>_gone</id></supplier>",
    right="<supplier><type>sysml.InitialNode</type><id>_a</id></supplier>",
)
REPEATED = rule(
    "SM183",
    "repeated-mtip-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements of '{file}'",
    why="A relation to it could mean either. Only the first is read.",
    help="export the model again",
    wrong="<data>...<id><cameo>_a</cameo></id>...</data><data>...<id><cameo>_a</cameo></id>...</data>",
    right="<data>...<id><cameo>_a</cameo></id>...</data><data>...<id><cameo>_b</cameo></id>...</data>",
)
