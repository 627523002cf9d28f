"""Rules about the text of an overlay, whatever its model."""

from sysmlc.diagnostics import Severity, rule

SYNTAX = rule(
    "SM320",
    "overlay-syntax",
    Severity.ERROR,
    "the overlay cannot be read: {problem}",
    help="an overlay is one YAML document in UTF-8 without tags",
)
SHAPE = rule(
    "SM321",
    "overlay-shape",
    Severity.ERROR,
    "in the overlay {where}: {problem}",
    help="metamodels/sysmlc-overlay.schema.json has every entry; editors can check it too",
)
UNKNOWN_KEY = rule(
    "SM322",
    "overlay-unknown-key",
    Severity.ERROR,
    "in the overlay {where}: unknown key '{key}'",
    help="{advice}",
)
KEY_TWICE = rule(
    "SM323",
    "overlay-key-twice",
    Severity.ERROR,
    "in the overlay {where}: the key '{key}' occurs twice",
    help="merge the two entries, or rename one of them",
)
