"""Rules about the structure and the references of AutomationML files."""

from sysmlc.diagnostics import Severity, rule

MISSING_CLASS = rule(
    "SM130",
    "missing-class",
    Severity.ERROR,
    "{element} refers to the {family} '{path}', which does not exist",
    help="correct the path, or add the class to its library",
)
MISSING_CLASS_LIBRARY = rule(
    "SM131",
    "missing-class-library",
    Severity.WARNING,
    "the library '{library}' is not in the file; {count} to classes of it",
    help=(
        "add the library to the file, or declare the file that has it as ExternalReference with an "
        "alias and write <alias>@{library}/... in the paths"
    ),
)
MISSING_FILE = rule(
    "SM132",
    "missing-external-file",
    Severity.WARNING,
    "the file '{file}' is not part of the compile unit; {count} to classes of it",
    help=(
        "put the file where the ExternalReference says, or correct its path; a file outside "
        "of the folder of the model is read when it is a further input"
    ),
)
UNDECLARED_ALIAS = rule(
    "SM133",
    "undeclared-alias",
    Severity.ERROR,
    "{element} uses the alias '{alias}', which no ExternalReference declares",
    help="declare it: <ExternalReference Path='...' Alias='{alias}'/>",
)
LIBRARY_FAULT = rule(
    "SM149",
    "fault-in-standard-library",
    Severity.WARNING,
    "{element} of the standard library '{library}' refers to '{path}', {problem}",
    help="download the library again from its publisher, with the libraries that it references",
)
CLASS_CYCLE = rule(
    "SM134",
    "class-cycle",
    Severity.ERROR,
    "the class '{element}' specialises itself: {cycle}",
    help="remove one of the base class references",
)
DANGLING_LINK = rule(
    "SM135",
    "dangling-link",
    Severity.ERROR,
    "link '{element}': its side {side} refers to '{reference}', and {problem}",
    help="connect it again in the modelling tool",
)
OPEN_LINK = rule(
    "SM136",
    "open-link",
    Severity.INFO,
    "link '{element}' has no side {side}",
)
REPEATED_ID = rule(
    "SM137",
    "repeated-aml-id",
    Severity.WARNING,
    "the ID '{id}' of '{element}' is used by another element too",
    help="give one of them another ID",
)
MIRROR_WITHOUT_MASTER = rule(
    "SM138",
    "mirror-without-master",
    Severity.ERROR,
    "'{element}' is a mirror of '{reference}', which does not exist",
    help="restore the element, or remove its mirror",
)
MIRROR_CYCLE = rule(
    "SM143",
    "mirror-cycle",
    Severity.ERROR,
    "'{element}' is a mirror of itself, through '{reference}'",
    help="let one of them refer to a system unit class, or to nothing",
)
UNSUPPORTED = rule(
    "SM139",
    "unsupported-caex-element",
    Severity.WARNING,
    "{count} '{tag}' not read",
)
ELEMENT_ORDER = rule(
    "SM140",
    "element-order",
    Severity.WARNING,
    "'{tag}' of '{element}' comes after '{before}', against the schema of CAEX ({count})",
    help="write the file again with a tool that follows the schema",
)
NO_MODEL = rule(
    "SM141",
    "empty-caex-file",
    Severity.WARNING,
    "'{file}' contains no library and no hierarchy",
)
ONLY_LIBRARIES = rule(
    "SM158",
    "only-caex-libraries",
    Severity.INFO,
    "'{file}' contains only libraries; without an instance hierarchy there is no plant to compile",
    help="name the file with the plant, too",
)
MALFORMED = rule(
    "SM142",
    "malformed-caex-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    help="export the plant again from the engineering tool",
)
MAPPING_OF_NOTHING = rule(
    "SM144",
    "mapping-of-nothing",
    Severity.ERROR,
    "a mapping object of '{element}' names '{feature}', which does not exist",
    help="correct the name, or remove the mapping",
)
INEXACT_ID = rule(
    "SM145",
    "inexact-id",
    Severity.INFO,
    "'{element}' refers to '{id}', but the ID is written '{meant}'",
    help="write the ID in the same way in both places",
)
MISSING_ID = rule(
    "SM146",
    "element-without-id",
    Severity.INFO,
    "'{element}' has no ID{more}",
    help="let the engineering tool give IDs",
)
UNKNOWN_UNIT = rule(
    "SM147",
    "unknown-unit",
    Severity.WARNING,
    "the unit '{unit}' of '{element}'{more} {problem}",
    help="write its symbol or UN/ECE code; symbols are those of ISO 80000, such as "
    "'m/s' or 'm^3/h'",
)
