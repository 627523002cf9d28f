"""Filters, exposed elements, imports and locales: each token of them is compared."""

import pytest

from frontends.sysml.reading_v2 import read
from sysmlc.ir.compare import compare

MODEL = """
package Plant {
    metadata def Safety { attribute isMandatory : ScalarValues::Boolean; }
    package Tanks { part tank { @Safety; } doc locale "en_US" /* Tanks */ }
    package Safe { public import Tanks::**[@Safety]; filter (as Safety).isMandatory; }
    view plan { expose Tanks::**[@Safety]; filter @SysML::PartUsage; }
    constraint def Limit { in level; out excess; }
}
"""


def test_filters_and_exposed_elements_are_texts():
    reading = read(MODEL)
    assert reading.find_element("Plant::Safe").attrs["filters"] == ("(as Safety).isMandatory",)
    plan = reading.find_element("Plant::plan").attrs
    assert plan["filters"] == ("@SysML::PartUsage",)
    assert plan["exposed"] == ("Tanks::**[@Safety]",)


@pytest.mark.parametrize(
    ("before", "after", "change"),
    [
        ("en_US", "de_DE", "comment: Tanks (locale en_US) => Tanks (locale de_DE)"),
        ("(as Safety)", "not (as Safety)", "filters: (as Safety) => not (as Safety)"),
        ("PartUsage", "ItemUsage", "filters: @SysML::PartUsage => @SysML::ItemUsage"),
        ("out excess", "inout excess", "direction: out => inout"),
        ("expose Tanks::**[", "expose Tanks::*[", "exposed: Tanks::**[ => Tanks::*["),
        ("out excess", "in excess", "direction: out => "),
    ],
)
def test_a_changed_token_is_one_difference(before, after, change):
    (difference,) = compare(read(MODEL).graph, read(MODEL.replace(before, after)).graph)
    texts = (difference.before, difference.after)
    old, _, new = change.partition(": ")[2].partition(" => ")
    assert difference.aspect == change.partition(":")[0]
    assert all(part in text for part, text in zip((old, new), texts, strict=True))


@pytest.mark.parametrize(
    "replacement", ["Tanks::*[@Safety]", "Tanks::**[not @Safety]", "Tanks::**"]
)
def test_an_import_keeps_its_form_and_its_filter(replacement):
    changed = MODEL.replace("import Tanks::**[@Safety]", f"import {replacement}")
    (difference,) = compare(read(MODEL).graph, read(changed).graph)
    assert difference.aspect == "import"


def test_the_same_model_has_no_difference():
    assert compare(read(MODEL).graph, read(MODEL.replace("Tanks */", "Tanks  */")).graph) == []
