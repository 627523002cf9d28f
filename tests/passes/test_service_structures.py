"""A structure of KerML may specialise a behaviour with conditions: it is no service."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import parse_text
from sysmlc.logic.services.conditions import iter_services

MODEL = """\
Package p "P"
  Activity a "A"
    Parameter a.x "x" direction="in"
      -> typed-by b
    Constraint a.c "c" subkind="precondition" body="x" language=""
  {kind} s "S"
    -> specializes a
  DataType b "Boolean"
"""


def found(kind):
    return list(iter_services(parse_text(MODEL.format(kind=kind)), (0, 15), Sink()))


def test_a_structure_is_no_service_and_an_action_is_one():
    assert len(found("Class")) == 1
    assert len(found("Activity")) == 2
