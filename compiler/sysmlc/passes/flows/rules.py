"""What can be wrong with connectors and item flows."""

from sysmlc.diagnostics import Severity, rule

_STATION = """\
Class pallet "Pallet"
Class track "Track"
  FlowProperty track.p "p" direction="in"
    -> typed-by pallet
Class gate "Gate"
  Port gate.in "in"
    -> typed-by track
  Port gate.out "out" conjugated=true
    -> typed-by track
Class line "Line"
  Property line.a "a" aggregation="composite"
    -> typed-by gate
  Property line.b "b" aggregation="composite"
    -> typed-by gate
"""
_LIT_STATION = "lamp".join(_STATION.rsplit("gate", 1))


def _connector(*roles: str) -> str:
    ends = "".join(
        f"""\
    ConnectorEnd e{number}
      -> role gate.{role}
      -> path line.{part}
"""
        for number, (part, role) in enumerate(zip("ab", roles, strict=True))
    )
    return f"""\
  Connector c "c"
    -> end e0 e1
{ends}"""


_FLOW = """\
ItemFlow f "f"
  -> flow-source gate.{source}
  -> flow-target gate.{target}
  -> realizing c
  -> conveys {item}
"""

FLOW_AGAINST_PORT = rule(
    "SM310",
    "flow-against-port",
    Severity.WARNING,
    "item flow '{flow}' {way} port '{port}', whose direction is {direction}",
    why="The port's type says that items pass the other way, so it is unclear which block "
    "provides them.",
    help="turn the item flow round, or conjugate the port",
    wrong=_STATION
    + _connector("out", "in")
    + _FLOW.format(source="in", target="out", item="pallet"),
    right=_STATION
    + _connector("out", "in")
    + _FLOW.format(source="out", target="in", item="pallet"),
)
FLOW_ITEM = rule(
    "SM311",
    "flow-item",
    Severity.WARNING,
    "item flow '{flow}' conveys '{item}', which port '{port}' does not pass",
    why="What flows over a connector must fit flow properties of the ports at both of its ends "
    "(SysML 1.6 clause 9.3.2.5).",
    help="add a flow property of type '{item}' to the port's type, or convey what it passes",
    wrong="""\
Class oil "Oil"
"""
    + _STATION
    + _connector("out", "in")
    + _FLOW.format(source="out", target="in", item="oil"),
    right="""\
Class heavy "Heavy pallet"
  -> specializes pallet
"""
    + _STATION
    + _connector("out", "in")
    + _FLOW.format(source="out", target="in", item="heavy"),
)
FLOW_WITHOUT_END = rule(
    "SM312",
    "flow-without-end",
    Severity.ERROR,
    "item flow '{flow}' has no {end}",
    why="It is not known between which elements the items flow.",
    help="draw the item flow between two ports or parts",
    wrong=_STATION
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> conveys pallet
""",
    right=_STATION
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target gate.in
  -> conveys pallet
""",
)
FLOW_BESIDE_CONNECTOR = rule(
    "SM313",
    "flow-beside-connector",
    Severity.WARNING,
    "item flow '{flow}' runs over connector '{connector}', which does not join '{end}'",
    why="The connector that realises an item flow has the flow's source and target, or the parts "
    "that own them, at its ends (SysML 1.6 clause 9.3.2.5).",
    help="draw the item flow over the connector between its source and its target",
    wrong=_STATION
    + """\
  Property line.spare "spare"
    -> typed-by pallet
"""
    + _connector("out", "in")
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target line.spare
  -> realizing c
  -> conveys pallet
""",
    right=_STATION
    + _connector("out", "in")
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target line.b
  -> realizing c
  -> conveys pallet
""",
)
FLOW_OF_NOTHING = rule(
    "SM314",
    "flow-of-nothing",
    Severity.INFO,
    "item flow '{flow}' does not say what it conveys",
    why="Its domain and the types at its ends cannot be checked.",
    help="name the block, value type or signal that flows",
    wrong=_STATION
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target gate.in
""",
    right=_STATION
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target gate.in
  -> conveys pallet
""",
)
CONNECTOR_DIRECTIONS = rule(
    "SM315",
    "connector-directions",
    Severity.WARNING,
    "connector '{connector}' joins {first} '{one}' with {second} '{other}'",
    why="Between two parts one port gives what the other takes; between a block and its part "
    "both pass it the same way (SysML 1.6 clause 9.3.2.4).",
    help="conjugate one of the ports, or connect another one",
    wrong=_STATION + _connector("in", "in"),
    right=_STATION + _connector("out", "in"),
)
CONNECTOR_TYPES = rule(
    "SM316",
    "connector-types",
    Severity.WARNING,
    "connector '{connector}' joins '{one}' of type '{type}' with '{other}' of type '{other_type}'",
    why="Neither type specialises the other, they have no general type in common, and no flow "
    "property of the one fits one of the other: nothing can pass.",
    help="type both ports with the same interface block, one of them conjugated",
    wrong="""\
Class plug "Plug"
  FlowProperty plug.u "u" direction="in"
    -> typed-by track
Class lamp "Lamp"
  Port lamp.in "in"
    -> typed-by plug
"""
    + _LIT_STATION
    + _connector("out", "in").replace("gate.in", "lamp.in"),
    right="""\
Class rail "Rail"
  FlowProperty rail.p "p" direction="in"
    -> typed-by pallet
Class lamp "Lamp"
  Port lamp.in "in"
    -> typed-by rail
"""
    + _LIT_STATION
    + _connector("out", "in").replace("gate.in", "lamp.in"),
)
MIXED_DOMAINS = rule(
    "SM317",
    "mixed-domains",
    Severity.WARNING,
    "connector '{connector}' carries physical items ({physical}) and information ({information})",
    why="A pipe, shaft or track is no data line: recipes treat the two differently.",
    help="draw one connector for the material or energy and one for the information",
    wrong="""\
Class pallet "Pallet" domain="physical"
Signal ready "Ready" domain="information"
Class gate "Gate"
  Port gate.in "in" direction="in"
    -> typed-by pallet
  Port gate.out "out" direction="out"
    -> typed-by pallet
Class line "Line"
  Property line.a "a"
    -> typed-by gate
  Property line.b "b"
    -> typed-by gate
"""
    + _connector("out", "in")
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target gate.in
  -> realizing c
  -> conveys pallet ready
""",
    right="""\
Class pallet "Pallet" domain="physical"
Class heavy "Heavy pallet"
  -> specializes pallet
Class gate "Gate"
  Port gate.in "in" direction="in"
    -> typed-by pallet
  Port gate.out "out" direction="out"
    -> typed-by pallet
Class line "Line"
  Property line.a "a"
    -> typed-by gate
  Property line.b "b"
    -> typed-by gate
"""
    + _connector("out", "in")
    + """\
ItemFlow f "f"
  -> flow-source gate.out
  -> flow-target gate.in
  -> realizing c
  -> conveys pallet heavy
""",
)
