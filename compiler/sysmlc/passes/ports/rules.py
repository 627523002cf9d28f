"""What can be wrong with ports and multiplicities."""

from sysmlc.diagnostics import Severity, rule

UNDIRECTED_PORTS = rule(
    "SM300",
    "undirected-ports",
    Severity.INFO,
    "ports of '{block}' without a direction ({count}): {ports}",
    why="Neither flow properties, operations nor item flows say which side of these ports "
    "decides, so contracts treat what passes there as an input and diagrams draw no arrow.",
    help="give the ports' types flow properties with a direction, or draw item flows",
    wrong="""\
Class data "Data"
Class gate "Gate"
  Port gate.in "in"
    -> typed-by data
""",
    right="""\
Class data "Data"
  FlowProperty data.id "id" direction="in"
Class gate "Gate"
  Port gate.in "in"
    -> typed-by data
""",
)
UNTYPED_PORT = rule(
    "SM301",
    "untyped-port",
    Severity.WARNING,
    "port '{port}' has no type",
    why="Without a type nothing is known of what passes through the port.",
    help="type the port with an interface block, a block or a value type",
    wrong="""\
Class gate "Gate"
  Port gate.in "in"
""",
    right="""\
Class data "Data"
Class device "Device"
  Port device.in "in"
    -> typed-by data
Class gate "Gate"
  -> specializes device
  Port gate.in "in"
    -> redefines device.in
""",
)
BAD_MULTIPLICITY = rule(
    "SM302",
    "bad-multiplicity",
    Severity.ERROR,
    "multiplicity {multiplicity} of '{feature}' allows no number of values",
    why="The upper bound of a multiplicity is at least its lower bound (UML 2.5.1 clause 7.5.3).",
    help="make the upper bound at least as large as the lower one",
    wrong="""\
Class gate "Gate"
  Property gate.motors "motors" multiplicity="2..1"
""",
    right="""\
Class gate "Gate"
  Property gate.motors "motors" multiplicity="2..2"
""",
)
EMPTY_MULTIPLICITY = rule(
    "SM303",
    "empty-multiplicity",
    Severity.WARNING,
    "port '{port}' has multiplicity {multiplicity}, so no block has it",
    why="A port that never exists cannot be connected.",
    help="remove the port, or allow at least one",
    wrong="""\
Class data "Data"
Class gate "Gate"
  Port gate.in "in" multiplicity="0" direction="in"
    -> typed-by data
""",
    right="""\
Class data "Data"
Class gate "Gate"
  Port gate.in "in" multiplicity="0..1" direction="in"
    -> typed-by data
""",
)
