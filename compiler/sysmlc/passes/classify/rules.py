"""What can be wrong with stereotypes and the relations of requirements."""

from sysmlc.diagnostics import Severity, rule

LOOK_ALIKE = rule(
    "SM210",
    "stereotype-by-name",
    Severity.INFO,
    "stereotype {stereotype} is taken for SysML's {known} because of its name (applied: {count})",
    help="give the profile as a further input, and let the stereotype specialise SysML's {known}",
)
UNKNOWN_STEREOTYPE = rule(
    "SM211",
    "unknown-stereotype",
    Severity.INFO,
    "no profile of the compile unit defines stereotype {stereotype} (applied: {count})",
    help="give the file of the profile as a further input",
)
NO_REQUIREMENT = rule(
    "SM212",
    "no-requirement",
    Severity.WARNING,
    "a «{relation}» relation leads to '{element}', which is no requirement",
    help="turn the arrow round, or apply «Requirement» to '{element}'",
)

OPTIONAL_WITH_VALUE = rule(
    "SM216",
    "optional-with-value",
    Severity.WARNING,
    "parameter '{parameter}' is «optional», but its multiplicity asks for a value",
    help="give the parameter the multiplicity 0..1, or remove «optional»",
)
