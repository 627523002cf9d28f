"""Rules of reading KerML and SysML v2 from interchange files."""

from sysmlc.diagnostics import Severity, rule

UNKNOWN_METACLASS = rule(
    "SM163",
    "unknown-metaclass",
    Severity.WARNING,
    "'{kind}' is not a metaclass of SysML 2.0: the element is omitted with everything that it owns",
    help="export the model again for SysML 2.0 (https://www.omg.org/spec/SysML/20250201)",
)
UNKNOWN_FEATURE = rule(
    "SM164",
    "unknown-feature",
    Severity.WARNING,
    "'{feature}' of '{element}' is not a feature of {kind}: it is ignored",
    help="correct the spelling of the name by the metamodel",
)
DANGLING = rule(
    "SM165",
    "dangling-interchange-reference",
    Severity.ERROR,
    "'{feature}' of '{element}' refers to the id '{id}', which does not exist in {file}",
    help="export all files of the model again, together",
)
MALFORMED = rule(
    "SM750",
    "malformed-interchange",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    help="export the model again",
)
REPEATED_ID = rule(
    "SM751",
    "repeated-interchange-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements",
    help="export the model again, or give one of them another id",
)
BAD_VALUE = rule(
    "SM756",
    "bad-interchange-value",
    Severity.ERROR,
    "'{feature}' of '{element}' is '{value}', which is not a valid {type}",
    help="write a value of the type that the metamodel specifies",
)
NO_MODEL = rule(
    "SM757",
    "no-interchange-model",
    Severity.ERROR,
    "'{file}' contains no model of SysML 2.0: its root is '{root}'",
    help="check that this is the right file",
)
CHECKSUM = rule(
    "SM168",
    "wrong-checksum",
    Severity.ERROR,
    "'{file}' differs from the file that was packed into project '{project}': its "
    "{algorithm} is {found}, expected {expected}",
    help="get the archive again from its source, or pack it again with its tool",
)
UNRESOLVED_USAGE = rule(
    "SM169",
    "unresolved-usage",
    Severity.WARNING,
    "project '{project}' uses '{resource}'{constraint}, {problem}",
    help="give the archive or folder of the used project as a further input or as --library",
)
BAD_PROJECT = rule(
    "SM752",
    "bad-project-information",
    Severity.ERROR,
    "'{file}' does not describe a project: {problem}",
    help="pack the archive again with its tool",
)
MISSING_FILE = rule(
    "SM753",
    "missing-project-file",
    Severity.ERROR,
    "project '{project}' names the file '{file}', which it does not have",
    help="get the archive again, or pack it anew with its tool",
)
UNLISTED_FILE = rule(
    "SM754",
    "unlisted-project-file",
    Severity.WARNING,
    "project '{project}' has no checksum for '{file}'",
    help="pack the archive again with its tool",
)
UNKNOWN_ALGORITHM = rule(
    "SM755",
    "unknown-checksum-algorithm",
    Severity.WARNING,
    "the checksum of '{file}' is not checked: the algorithm {algorithm} is not supported",
    help="pack the archive with SHA256",
)
UNWRITTEN_REFERENCE = rule(
    "SM758",
    "unwritten-reference",
    Severity.WARNING,
    "'{name}' of '{element}' is not in the interchange file, because the name is not resolved",
    help="correct the name: another message reports it",
)
UNWRITABLE_TEXT = rule(
    "SM759",
    "unwritable-text",
    Severity.WARNING,
    "the '{feature}' of '{element}' contains characters that XML does not allow: they are replaced",
    help="remove the control characters",
)
