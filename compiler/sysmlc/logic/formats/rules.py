"""Rules about files of contracts and specifications (SM580 to SM589) and about recorded runs.

Recorded runs have SM591 to SM594.
"""

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
WEIGHT = rule(
    "SM589",
    "contract-weight",
    Severity.WARNING,
    "the weight is not used: it ranks controllers, and does not change whether one exists",
)


# -- recorded runs -----------------------------------------------------------------------------

RECORDED_RUN_FAULT = rule(
    "SM591",
    "recorded-run-fault",
    Severity.ERROR,
    "the recorded run cannot be read: {fault}",
    help="a run is a CSV file with names in its first line, or a JSON list of objects",
)
GUARANTEE_BROKEN_BY_RUN = rule(
    "SM592",
    "run-breaks-guarantee",
    Severity.ERROR,
    "step {step} ({location}) breaks a guarantee of '{component}': {text}",
    help="correct the component or the model; the guarantee is {formula}",
)
ASSUMPTION_BROKEN_BY_RUN = rule(
    "SM593",
    "run-breaks-assumption",
    Severity.WARNING,
    "step {step} ({location}) breaks an assumption of '{component}', which guarantees nothing "
    "from then on: {text}",
    help="record a run in which the environment keeps the assumption, or assume less: {formula}",
)
VARIABLES_NOT_RECORDED = rule(
    "SM594",
    "variables-not-recorded",
    Severity.WARNING,
    "'{file}' has no values for {names}: {skipped} of {total} of '{component}' skipped",
    help="record these variables, too",
)
