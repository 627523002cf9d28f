"""Rules about texts in KerML or SysML v2 that need no name resolution."""

from sysmlc.diagnostics import Severity, rule

SYNTAX = rule(
    "SM190",
    "v2-syntax",
    Severity.ERROR,
    "unexpected {found}; expected {expected}",
    help="{advice}",
)
MISSING = rule(
    "SM191",
    "v2-missing",
    Severity.ERROR,
    "{missing} is missing after {before}",
    help="{advice}",
)
KEYWORD = rule(
    "SM192",
    "v2-keyword-as-name",
    Severity.ERROR,
    "'{word}' is a keyword of {language}; expected a name",
    help="to use it as a name, write '{word}' in single quotes, here and wherever it is used",
)
UNCLOSED = rule(
    "SM193",
    "v2-unclosed",
    Severity.ERROR,
    "{what} is never closed",
    help="{advice}",
)
CHARACTER = rule(
    "SM194",
    "v2-character",
    Severity.ERROR,
    "{what}",
    help="{advice}",
)
PLACE = rule(
    "SM195",
    "v2-not-here",
    Severity.ERROR,
    "{what} is not allowed {here}",
    help="it belongs in the bodies of {where}",
)
PREFIX = rule(
    "SM196",
    "v2-prefix",
    Severity.ERROR,
    "{problem}",
    help="{advice}",
)
VISIBILITY = rule(
    "SM197",
    "v2-import-visibility",
    Severity.WARNING,
    "the import has no visibility and is read as 'public import'",
    help="write 'private import' to use the names in this namespace only, or let "
    "'sysmlc format --fix' write 'public import'",
)
DEEP = rule(
    "SM198",
    "v2-too-deep",
    Severity.ERROR,
    "this is nested more than {limit} levels deep and is not read",
)
COMBINATION = rule(
    "SM199",
    "v2-combination",
    Severity.ERROR,
    "{problem}",
    help="{advice}",
)
