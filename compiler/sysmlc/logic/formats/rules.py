"""Rules about files of contracts and specifications (SM580-SM589)."""

from sysmlc.diagnostics import Severity, rule

UNKNOWN_FORM = rule(
    "SM580",
    "contract-form-unknown",
    Severity.ERROR,
    "the format of '{file}' is unknown; known contract formats: {forms}",
    help="give the file the extension of its format",
)
NOT_UNDERSTOOD = rule(
    "SM581",
    "contract-text-fault",
    Severity.ERROR,
    "the {form} text is not understood: {reason}",
)
WRONG_SHAPE = rule(
    "SM582",
    "contract-shape",
    Severity.ERROR,
    "{what}",
)
WRONG_FORMULA = rule(
    "SM583",
    "contract-formula-fault",
    Severity.ERROR,
    "the formula among the {section} is not understood: {reason}",
)
DECLARED_TWICE = rule(
    "SM584",
    "contract-name-twice",
    Severity.ERROR,
    "'{name}' is declared twice",
)
OUTSIDE = rule(
    "SM585",
    "contract-part-outside",
    Severity.ERROR,
    "{what} is not in the supported part of {form}",
)
WRONG_CLASS = rule(
    "SM586",
    "contract-class-fault",
    Severity.ERROR,
    "'{formula}' cannot be among the {section}: {reason}",
)
OWNER_NOT_SAID = rule(
    "SM587",
    "contract-owner-not-said",
    Severity.WARNING,
    "the file declares {names} neither as input nor as output; all are treated as outputs",
    help="add lines '.inputs a b' and '.outputs c d' below the formula",
)
NOT_STRICT = rule(
    "SM588",
    "contract-not-strict",
    Severity.INFO,
    "the semantics '{semantics}' is read as strict implication, as in games of GR(1)",
    help="write SEMANTICS: Mealy,Strict",
)
