"""An action that assigns to a name that nobody has is told; what is known by any name is not."""

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.passes import pipeline
from sysmlc.passes.activities.assignments import UNKNOWN_TARGET as UNKNOWN

MODEL = """\
Package p "Plant"
  Class g "Machine" role="block"
    Property s "speed"
      -> typed-by real
  Class t "Tray" role="block"
    Property x "empty"
      -> typed-by bool
  Class c "Cell" role="block"
    -> specializes g
    Property n "full"
      -> typed-by bool
    Property y "tray"
      -> typed-by t
    Activity a "work"
      Parameter q "count" direction="in"
      Control i subkind="initial"
      Action w "fill" subkind="opaque" body="{body}"
      Control e subkind="final"
      ControlFlow iw
        -> flow-source i
        -> flow-target w
      ControlFlow we
        -> flow-source w
        -> flow-target e
  DataType bool "Boolean"
  DataType real "Real"
"""


def told(body):
    graph, sink = parse_text(MODEL.replace("{body}", body)), Sink()
    pipeline.run(graph, sink)
    return [diagnostic.message for diagnostic in sink if diagnostic.rule is UNKNOWN]


def test_a_misspelt_name_is_told_with_the_one_that_was_meant():
    assert told("ful := true") == [
        "action 'fill' assigns to 'ful', but neither 'work' nor an element that contains it "
        "has such a feature; "
        "did you mean 'full'?"
    ]


@pytest.mark.parametrize(
    "body",
    ["full := true", "speed := 2.5", "count := 1", "tray.empty := false", "self.full := true"],
)
def test_features_of_the_block_of_its_generals_and_of_parts_and_parameters_are_known(body):
    assert told(body) == []


def test_what_a_write_action_refers_to_is_no_name():
    writing = MODEL.replace('subkind="opaque" body="{body}"', 'subkind="write"\n        -> calls x')
    graph, sink = parse_text(writing), Sink()
    pipeline.run(graph, sink)
    assert not [diagnostic for diagnostic in sink if diagnostic.rule is UNKNOWN]
