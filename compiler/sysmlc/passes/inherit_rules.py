"""What can be wrong with generalization, redefinition and subsetting."""

from sysmlc.diagnostics import Severity, rule

GENERALIZATION_CYCLE = rule(
    "SM200",
    "generalization-cycle",
    Severity.ERROR,
    "'{element}' specialises itself: {cycle}",
    why="A classifier cannot be more special than itself (UML 2.5.1 clause 9.9.4), so what it "
    "inherits is not defined.",
    help="remove one generalization of the circle",
    wrong="""\
Class a "Gate"
  -> specializes b
Class b "Slow gate"
  -> specializes a
""",
    right="""\
Class a "Gate"
Class b "Slow gate"
  -> specializes a
""",
)
GENERALIZATION_KIND = rule(
    "SM201",
    "generalization-kind",
    Severity.WARNING,
    "{kind} '{element}' specialises {general_kind} '{general}'",
    why="A classifier specialises classifiers of its own kind (UML 2.5.1 clause 9.9.4, "
    "maySpecializeType).",
    help="use a realization, or make both the same kind of element",
    wrong="""\
Class a "Gate"
  -> specializes b
DataType b "Position"
""",
    right="""\
Component a "Gate"
  -> specializes b
Class b "Position"
""",
)
REDEFINES_STRANGER = rule(
    "SM202",
    "redefines-stranger",
    Severity.WARNING,
    "'{element}' {relation} '{other}', which it does not inherit",
    why="Only inherited features can be redefined or subsetted from outside (UML 2.5.1 clause "
    "9.9.17), so the feature is kept beside the other one.",
    help="add the generalization that is missing, or remove the relation",
    wrong="""\
Class gate "Gate"
  Property gate.motor "motor"
Class slow "Slow gate"
  Property slow.motor "motor"
    -> redefines gate.motor
""",
    right="""\
Class gate "Gate"
  Property gate.motor "motor"
Class slow "Slow gate"
  -> specializes gate
  Property slow.motor "motor"
    -> redefines gate.motor
""",
)
TYPE_NOT_NARROWER = rule(
    "SM203",
    "type-not-narrower",
    Severity.WARNING,
    "'{element}' {relation} '{other}' but its type '{type}' is no kind of '{other_type}'",
    why="Whoever uses the general feature relies on its type (UML 2.5.1 clause 9.9.17, "
    "isConsistentWith).",
    help="let '{type}' specialise '{other_type}'",
    wrong="""\
Class motor "Motor"
Class valve "Valve"
Class gate "Gate"
  Property gate.drive "drive"
    -> typed-by motor
Class slow "Slow gate"
  -> specializes gate
  Property slow.drive "drive"
    -> typed-by valve
    -> redefines gate.drive
""",
    right="""\
Class motor "Motor"
Class servo "Servo"
  -> specializes motor
Class gate "Gate"
  Property gate.drive "drive"
    -> typed-by motor
Class slow "Slow gate"
  -> specializes gate
  Property slow.drive "drive"
    -> typed-by servo
    -> redefines gate.drive
""",
)
MULTIPLICITY_WIDER = rule(
    "SM204",
    "multiplicity-wider",
    Severity.WARNING,
    "'{element}' with multiplicity {multiplicity} {relation} '{other}' with {other_multiplicity}",
    why="A redefining or subsetting feature cannot allow more values than the general one "
    "(UML 2.5.1 clause 9.9.17).",
    help="narrow the multiplicity of '{element}'",
    wrong="""\
Class gate "Gate"
  Property gate.motor "motor" multiplicity="0..2"
Class slow "Slow gate"
  -> specializes gate
  Property slow.motor "motor" multiplicity="0..*"
    -> redefines gate.motor
""",
    right="""\
Class gate "Gate"
  Property gate.motor "motor" multiplicity="0..2"
Class slow "Slow gate"
  -> specializes gate
  Property slow.motor "motor"
    -> redefines gate.motor
""",
)
