"""What can be wrong with stereotypes and the relations of requirements."""

from sysmlc.diagnostics import Severity, rule

LOOK_ALIKE = rule(
    "SM210",
    "stereotype-by-name",
    Severity.INFO,
    "stereotype {stereotype} is taken for SysML's {known} because of its name (applied: {count})",
    why="No profile of the compile unit says that the stereotype specialises SysML's, so only "
    "its name tells what it means.",
    help="give the profile as a further input, and let the stereotype specialise SysML's {known}",
    wrong="""\
Class gate "Gate"
  Port gate.in "in"
    Application a stereotype="FullPort" namespace="http://example.org/plant"
      -> subject gate.in
""",
    right="""\
Class gate "Gate"
  Port gate.in "in"
    Application a stereotype="FullPort" namespace="http://example.org/plant"
      -> subject gate.in
Profile plant "plant" uri="http://example.org/plant"
  Stereotype plant.full "FullPort"
    -> specializes full
Profile sysml "SysML"
  Stereotype full "FullPort"
""",
)
UNKNOWN_STEREOTYPE = rule(
    "SM211",
    "unknown-stereotype",
    Severity.INFO,
    "no profile of the compile unit defines stereotype {stereotype} (applied: {count})",
    why="What the stereotype specialises is unknown, so the elements that have it count as plain "
    "UML. SysML's own namespaces have no other stereotypes than those of docs/ir.md.",
    help="give the file of the profile as a further input",
    wrong="""\
Class gate "Gate"
  Application a stereotype="Station" namespace="http://example.org/plant"
    -> subject gate
""",
    right="""\
Class gate "Gate"
  Application a stereotype="Station" namespace="http://example.org/plant"
    -> subject gate
Profile plant "plant" uri="http://example.org/plant"
  Stereotype plant.station "Station"
""",
)
NO_REQUIREMENT = rule(
    "SM212",
    "no-requirement",
    Severity.WARNING,
    "a «{relation}» relation leads to '{element}', which is no requirement",
    why="The relations satisfy, derive, verify and copy lead to requirements (SysML 1.6 clause "
    "16.3.2), so this one gives no contract a subject.",
    help="turn the arrow round, or apply «Requirement» to '{element}'",
    wrong="""\
Class gate "Gate"
Class r "No jam"
Dependency d subkind="abstraction"
  -> client r
  -> supplier gate
  Application a stereotype="Satisfy" namespace="http://www.omg.org/spec/SysML/20150709/SysML"
    -> subject d
""",
    right="""\
Class gate "Gate"
Class r "No jam"
  Application q stereotype="Requirement" namespace="http://www.omg.org/spec/SysML/20150709/SysML"
    -> subject r
Dependency d subkind="abstraction"
  -> client gate
  -> supplier r
  Application a stereotype="Satisfy" namespace="http://www.omg.org/spec/SysML/20150709/SysML"
    -> subject d
""",
)

_PARAMETER = """\
Activity weigh "Weigh"
  Parameter p "tare" direction="in"{multiplicity}
    Application o stereotype="Optional" namespace="http://www.omg.org/spec/SysML/20150709/SysML"
      -> subject p
"""
OPTIONAL_WITH_VALUE = rule(
    "SM216",
    "optional-with-value",
    Severity.WARNING,
    "parameter '{parameter}' is «optional», but its multiplicity asks for a value",
    why="An optional parameter has lower multiplicity zero (SysML 1.6 clause 11.3.2.6); by the "
    "multiplicity, which counts here, the activity waits for a value.",
    help="give the parameter the multiplicity 0..1, or remove «optional»",
    wrong=_PARAMETER.format(multiplicity=""),
    right=_PARAMETER.format(multiplicity=' multiplicity="0..1"'),
)
