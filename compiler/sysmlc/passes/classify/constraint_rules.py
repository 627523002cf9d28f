"""What can be wrong with constraint properties and what is bound to them."""

from sysmlc.diagnostics import Severity, rule

_LAW = """\
Class law "Law" role="constraint block"
  Property law.f "f" role="constraint parameter"
  Property law.m "m" role="constraint parameter"
"""
_CRANE = """\
Class crane "Crane" role="block"
  Property crane.mass "mass" role="value"
  Property crane.force "force" role="value"
  Property crane.law "law" role="constraint property" aggregation="composite"
"""
_TYPED = "    -> typed-by law\n"


def _binding(name: str, value: str, parameter: str) -> str:
    return f"""\
  Connector {name} "" role="binding connector"
    -> end {name}.1 {name}.2
    ConnectorEnd {name}.1
      -> role {value}
    ConnectorEnd {name}.2
      -> path crane.law
      -> role {parameter}
"""


_BOUND = _binding("k", "crane.mass", "law.m")
_BOTH = _BOUND + _binding("j", "crane.force", "law.f")
_UNITS = """\
DataType kilogram "Mass" role="value type"
  -> references kg
DataType tonne "Load" role="value type"
  -> references t
Instance kg "kilogram" role="unit"
Instance t "tonne" role="unit"
"""
_WEIGHED = """\
Class crane "Crane" role="block"
  Property crane.mass "mass" role="value"
    -> typed-by kilogram
  Property crane.load "load" role="value"
    -> typed-by {type}
  Connector k "" role="binding connector"
    -> end k.1 k.2
    ConnectorEnd k.1
      -> role crane.mass
    ConnectorEnd k.2
      -> role crane.load
"""

NO_CONSTRAINT_BLOCK = rule(
    "SM217",
    "constraint-without-block",
    Severity.WARNING,
    "constraint property '{property}' is typed by no constraint block",
    why="Constraint properties are usages of constraint blocks (SysML 1.6 clause 10.3.2.1); "
    "without one nothing is constrained.",
    help="type '{property}' by a constraint block",
    wrong=_CRANE,
    right=_LAW + _CRANE + _TYPED + _BOTH,
)
UNBOUND_PARAMETER = rule(
    "SM218",
    "unbound-parameter",
    Severity.INFO,
    "nothing is bound to parameters of constraint '{property}': {parameters}",
    why="What a constraint says of a parameter holds for nothing in the block as long as the "
    "parameter is not bound.",
    help="bind a value property or another parameter to each",
    wrong=_LAW + _CRANE + _TYPED + _BOUND,
    right=_LAW + _CRANE + _TYPED + _BOTH,
)
UNITS_DIFFER = rule(
    "SM219",
    "bound-units-differ",
    Severity.WARNING,
    "'{one}' in {unit} is bound to '{other}' in {other_unit}",
    why="A binding says that the two values are equal (SysML 1.6 clause 8.3.2.3), but the same "
    "number means different quantities in different units.",
    help="give both the same value type, or bind them through a constraint that converts",
    wrong=_UNITS + _WEIGHED.format(type="tonne"),
    right=_UNITS + _WEIGHED.format(type="kilogram"),
)
