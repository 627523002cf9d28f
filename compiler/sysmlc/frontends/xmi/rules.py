"""Rules of reading XMI."""

from sysmlc.diagnostics import Severity, rule

MALFORMED = rule(
    "SM100",
    "malformed-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    help="open and save the model again in the modelling tool",
)
NO_MODEL = rule(
    "SM110",
    "no-known-content",
    Severity.ERROR,
    "'{file}' looks like UML in XMI, but nothing in it is known to sysmlc",
    help="check with which tool and version it was exported; UML 2 in XMI 2.1 and later is read",
)
UNSUPPORTED = rule(
    "SM111",
    "unsupported-element",
    Severity.WARNING,
    "{count} of type '{type}' not read ({number} with all that they contain)",
)
REPEATED_ID = rule(
    "SM112",
    "repeated-id",
    Severity.ERROR,
    "the id '{id}' is used by two elements of '{file}'",
    help="give one of them another xmi:id, or save the model again",
)
MISSING_PART = rule(
    "SM119",
    "missing-part",
    Severity.WARNING,
    "'{owner}' contains '{href}', {problem}",
    help="give the file as a further input; or load and save the whole model in the modelling tool",
)
LONG_LIST = rule(
    "SM128",
    "long-list",
    Severity.ERROR,
    "'{feature}' lists {count} ids; those after the first {most} are left out",
    help="look whether the file is what you think",
)
MANY_ATTRIBUTES = rule(
    "SM129",
    "many-attributes",
    Severity.ERROR,
    "'{element}' has {count} attributes; those after the first {most} are left out",
    help="look whether the file is what you think",
)
BAD_BOUND = rule(
    "SM117",
    "bad-bound",
    Severity.ERROR,
    "multiplicity {multiplicity} of '{element}' has a bound that is no natural number",
    help="write a number, or * as upper bound",
)
STRAY_TEXT = rule(
    "SM123",
    "stray-text",
    Severity.WARNING,
    "'{element}' has a text '{feature}', which is no feature of UML",
    help="look whether the name is spelt as UML does; else remove it",
)
UNKNOWN_ATTRIBUTE = rule(
    "SM124",
    "unknown-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others} is known neither to UML nor to XMI",
    help="look whether the name is spelt as UML does; else remove it",
)
MISPLACED_ATTRIBUTE = rule(
    "SM154",
    "misplaced-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others} belongs to other elements of UML than "
    "{metaclass}",
    help="look whether the type of the element is meant, and remove the attribute if it is",
)
UNKNOWN_VALUE = rule(
    "SM126",
    "unknown-value",
    Severity.WARNING,
    "'{attribute}' of '{element}'{others} is '{value}', which is none of {known}",
    help="choose the value again in the modelling tool",
)
UNKNOWN_TAG = rule(
    "SM125",
    "unknown-tag",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' on '{element}'{others} is none of SysML",
    help=(
        "look whether the name is spelt as SysML does; else keep the value in a stereotype of "
        "your own"
    ),
)
DANGLING_OPPOSITE = rule(
    "SM116",
    "dangling-opposite",
    Severity.WARNING,
    "'{feature}' of '{element}' names '{target}'{others} not exist",
    help="look whether something is missing; else save the model again in the modelling tool",
)
DANGLING_FEATURE = rule(
    "SM120",
    "dangling-feature",
    Severity.ERROR,
    "'{feature}' of '{element}' names '{target}'{others} not exist",
    help="restore what it names in the modelling tool, or remove the reference",
)
BASELESS = rule(
    "SM113",
    "stereotype-without-element",
    Severity.WARNING,
    "stereotype '{stereotype}' is applied {times} to nothing that is in the model",
    help="remove the application, or apply the stereotype again",
)
APPROXIMATED = rule(
    "SM114",
    "approximated-element",
    Severity.INFO,
    "{count} of type '{type}' read without {lost}",
)
LOST_TAG = rule(
    "SM118",
    "tag-names-missing-element",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' names '{target}', which does not exist",
    help="choose the value again in the modelling tool, or remove it",
)
BROKEN_SNAPSHOT = rule(
    "SM115",
    "broken-snapshot",
    Severity.WARNING,
    "the snapshot '{file}' of a used project cannot be read: {problem}",
    help="open the project in the modelling tool with its used projects at hand, and save it",
)

UNKNOWN_IN_LIBRARY = rule(
    "SM155",
    "unknown-library-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others}, taken from '{library}', is known neither to "
    "UML nor to MagicDraw",
    help="open the project in the modelling tool with its used projects at hand, and save it",
)
