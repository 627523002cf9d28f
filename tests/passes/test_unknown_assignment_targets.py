"""Report actions that assign to a name that is not a feature of the block (SM545)."""

import pytest
from pass_runs import list_messages, run_all

from sysmlc.analyses.activities.assignments import UNKNOWN_TARGET

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


def list_unknown_targets(body):
    return list_messages(run_all(MODEL.replace("{body}", body))[1], UNKNOWN_TARGET.code)


def test_a_misspelt_name_is_reported_with_the_nearest_name():
    assert list_unknown_targets("ful := true") == [
        "action 'fill' assigns to 'ful', but neither 'work' nor an element that contains it "
        "has such a feature; "
        "did you mean 'full'?"
    ]


@pytest.mark.parametrize(
    "body",
    ["full := true", "speed := 2.5", "count := 1", "tray.empty := false", "self.full := true"],
)
def test_features_of_the_block_its_generals_its_parts_and_parameters_are_valid_targets(body):
    assert list_unknown_targets(body) == []


def test_the_feature_that_a_write_action_refers_to_is_not_looked_up_by_name():
    text = MODEL.replace('subkind="opaque" body="{body}"', 'subkind="write"\n        -> calls x')
    assert list_messages(run_all(text)[1], UNKNOWN_TARGET.code) == []
