"""Rules of reading XMI."""

from sysmlc.diagnostics import Severity, rule

MALFORMED = rule(
    "SM100",
    "malformed-file",
    Severity.ERROR,
    "'{file}' cannot be read: {problem}",
    help="open and save the model again in the modelling tool",
)
ANY_EVENT_WITH_NAME = rule(
    "SM101",
    "any-event-with-name",
    Severity.INFO,
    "the any-receive event '{event}' is read as the event of that name",
    help="let the trigger refer to a signal, or delete the name if any message is meant",
)
NO_MODEL = rule(
    "SM110",
    "no-known-content",
    Severity.ERROR,
    "'{file}' looks like UML in XMI, but sysmlc recognises none of its content",
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
    "'{feature}' lists {count} ids; those after the first {most} are ignored",
    help="check that this is the right file",
)
MANY_ATTRIBUTES = rule(
    "SM129",
    "many-attributes",
    Severity.ERROR,
    "'{element}' has {count} attributes; those after the first {most} are ignored",
    help="check that this is the right file",
)
BAD_BOUND = rule(
    "SM117",
    "bad-bound",
    Severity.ERROR,
    "multiplicity {multiplicity} of '{element}' has a bound that is not a natural number",
    help="write a number, or * as upper bound",
)
STRAY_TEXT = rule(
    "SM123",
    "stray-text",
    Severity.WARNING,
    "'{element}' has a text '{feature}', which is not a feature of UML",
    help="correct the spelling of the name, or remove the text",
)
UNKNOWN_ATTRIBUTE = rule(
    "SM124",
    "unknown-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others} is defined neither by UML nor by XMI",
    help="correct the spelling of the name, or remove the attribute",
)
MISPLACED_ATTRIBUTE = rule(
    "SM154",
    "misplaced-attribute",
    Severity.WARNING,
    "attribute '{attribute}' of '{element}'{others} is not an attribute of {metaclass} in UML",
    help="correct the type of the element, or remove the attribute",
)
UNKNOWN_VALUE = rule(
    "SM126",
    "unknown-value",
    Severity.WARNING,
    "'{attribute}' of '{element}'{others} is '{value}', which is not one of {known}",
    help="choose the value again in the modelling tool",
)
UNKNOWN_TAG = rule(
    "SM125",
    "unknown-tag",
    Severity.WARNING,
    "tag '{tag}' of stereotype '{stereotype}' on '{element}'{others} is not defined by SysML",
    help=("correct the spelling of the name, or store the value in a stereotype of your own"),
)
DANGLING_OPPOSITE = rule(
    "SM116",
    "dangling-opposite",
    Severity.WARNING,
    "'{feature}' of '{element}' names '{target}'{others} not exist",
    help="add the missing element or file, or save the model again in the modelling tool",
)
DANGLING_FEATURE = rule(
    "SM120",
    "dangling-feature",
    Severity.ERROR,
    "'{feature}' of '{element}' names '{target}'{others} not exist",
    help="restore the missing element in the modelling tool, or remove the reference",
)
BASELESS = rule(
    "SM113",
    "stereotype-without-element",
    Severity.WARNING,
    "stereotype '{stereotype}' is applied {times} to elements that are not in the model",
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
    "attribute '{attribute}' of '{element}'{others}, taken from '{library}', "
    "is defined neither by UML nor by MagicDraw",
    help="open the project in the modelling tool with its used projects at hand, and save it",
)
