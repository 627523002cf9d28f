"""What can be wrong with an overlay before a model is looked at."""

from sysmlc.diagnostics import Severity, rule

_RIGHT = "overlay: 1\nitems:\n  MiniPallet: {domain: physical}\n"

SYNTAX = rule(
    "SM320",
    "overlay-syntax",
    Severity.ERROR,
    "the overlay cannot be read: {problem}",
    why="What an overlay adds would be missing in the outputs, so nothing of a broken one is used.",
    help="an overlay is one YAML document in UTF-8 without tags",
    wrong="overlay: 1\nitems: [",
    right=_RIGHT,
)
SHAPE = rule(
    "SM321",
    "overlay-shape",
    Severity.ERROR,
    "in the overlay {where}: {problem}",
    why="An entry that is understood in part would add something else than its author meant, so "
    "nothing of the overlay is used.",
    help="metamodels/sysmlc-overlay.schema.json has every entry; editors can check it too",
    wrong="overlay: 1\nitems:\n  MiniPallet: {domain: digital}\n",
    right=_RIGHT,
)
UNKNOWN_KEY = rule(
    "SM322",
    "overlay-unknown-key",
    Severity.ERROR,
    "in the overlay {where}: there is no '{key}'",
    why="A misspelt word would be passed over, and what it says be lost.",
    help="{advice}",
    wrong="overlay: 1\nitem:\n  MiniPallet: {domain: physical}\n",
    right=_RIGHT,
)
KEY_TWICE = rule(
    "SM323",
    "overlay-key-twice",
    Severity.ERROR,
    "in the overlay {where}: '{key}' stands there twice",
    why="YAML has no order of keys, so that it is unclear which entry counts; an operation that "
    "is named twice is one of them.",
    help="put both entries together, or name one of them otherwise",
    wrong="overlay: 1\nitems:\n  MiniPallet: {domain: physical}\n  MiniPallet: {}\n",
    right=_RIGHT,
)
