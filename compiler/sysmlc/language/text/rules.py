"""What can be wrong with a text in KerML or SysML v2 before its names are looked at."""

from sysmlc.diagnostics import Severity, rule

_READ_ON = "what stands around it is read all the same."

SYNTAX = rule(
    "SM190",
    "v2-syntax",
    Severity.ERROR,
    "{found} stands where {expected} is expected",
    why=f"What cannot be read is missing in the outputs; {_READ_ON}",
    help="{advice}",
    wrong="part def Cell { port : ; }",
    right="part def Cell { port : Input; }",
)
MISSING = rule(
    "SM191",
    "v2-missing",
    Severity.ERROR,
    "{missing} is missing after {before}",
    why="Without it what follows would be read as a part of what stands before.",
    help="{advice}",
    wrong="part def Cell {\n    part arm : Robot\n    part tool;\n}",
    right="part def Cell {\n    part arm : Robot;\n    part tool;\n}",
)
KEYWORD = rule(
    "SM192",
    "v2-keyword-as-name",
    Severity.ERROR,
    "'{word}' is a keyword of {language} and stands where a name is expected",
    why="Keywords are reserved: a name must not be one of them (KerML 8.2.2.6, SysML 8.2.2.1.2).",
    help="written '{word}' in single quotes it is a name, here and wherever it is used",
    wrong="part def Cell { port action; }",
    right="part def Cell { port 'action'; }",
)
UNCLOSED = rule(
    "SM193",
    "v2-unclosed",
    Severity.ERROR,
    "{what} is never closed",
    why="What it should end is not known, so that the rest may be read otherwise than it is meant.",
    help="{advice}",
    wrong="part def Cell { part arm;",
    right="part def Cell { part arm; }",
)
CHARACTER = rule(
    "SM194",
    "v2-character",
    Severity.ERROR,
    "{what}",
    why="Names without quotes have the letters a to z, digits and '_'; of other characters only "
    "the symbols of the language stand outside of names, texts and comments (KerML 8.2.2).",
    help="{advice}",
    wrong="part def Zelle { part Größe; }",
    right="part def Zelle { part 'Größe'; }",
)
PLACE = rule(
    "SM195",
    "v2-not-here",
    Severity.ERROR,
    "{what} stands {here}, where none may stand",
    why="What it means is said of its owner, and this owner has no such thing.",
    help="it belongs into the bodies of {where}",
    wrong="part def Cell { subject cell : Cell; }",
    right="requirement def Safe { subject cell : Cell; } part def Cell;",
)
PREFIX = rule(
    "SM196",
    "v2-prefix",
    Severity.ERROR,
    "{problem}",
    why="The words before a declaration have one order and each a meaning for some declarations "
    "only, so that all tools read the same (SysML 8.2.2.6.2, KerML 8.2.4.3.1).",
    help="{advice}",
    wrong="part def Cell { abstract in item tray; }",
    right="part def Cell { in abstract item tray; }",
)
VISIBILITY = rule(
    "SM197",
    "v2-import-visibility",
    Severity.ERROR,
    "the import does not say who sees what it imports",
    why="Imported names become names of this namespace, so the standard asks to say for whom.",
    help="write private import, for this namespace alone, or public import, to pass the names on",
    wrong="package Cell { import ScalarValues::*; }",
    right="package Cell { private import ScalarValues::*; }",
)
DEEP = rule(
    "SM198",
    "v2-too-deep",
    Severity.ERROR,
    "this is nested more than {limit} levels deep and is not read",
    why="No model that a person wrote is so deep; tools that read it would stop without a word.",
    wrong="201 parts, each in the body of the one before",
    right="200 parts, each in the body of the one before",
)
COMBINATION = rule(
    "SM199",
    "v2-combination",
    Severity.ERROR,
    "{problem}",
    why="Each kind of usage has its own words to say what it connects or does.",
    help="{advice}",
    wrong="part def Cell { part belt connect a to b; }",
    right="part def Cell { connection belt connect a to b; }",
)
