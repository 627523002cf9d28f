"""Names that members inherit from the standard library hide equal names of outer namespaces."""

import pytest
from library_names import format_member_names
from sysml_texts import lines_of, refine
from toolkit_comparison import compare

from sysmlc.backends.sysml.library import BASES, MEMBER_NAMES_FILE, list_inherited_names
from sysmlc.support import resources

MODEL = """\
Package p "Plant"
  Class sh "{part}" role="block"
  Class fo "{item}" role="block"
  Class c "Cell" role="block"
    Property a "a" role="part" aggregation="composite"
      -> typed-by sh
    Activity w "work"
      Parameter x "x" direction="in"
        -> typed-by fo
"""


def test_the_shipped_names_are_those_of_the_standard_library():
    assert resources.read_text("metamodels", MEMBER_NAMES_FILE) == format_member_names()


@pytest.mark.parametrize("keyword", sorted(BASES))
def test_definitions_have_the_names_of_their_usages(keyword):
    assert "self" in list_inherited_names("attribute")
    names = list_inherited_names(keyword)
    assert names == list_inherited_names(f"{keyword} def") | {"that"} != {"that"}


@pytest.mark.parametrize(
    ("part", "item"),
    [
        ("shape", "forks"),
        pytest.param("ownedStates", "self", marks=pytest.mark.long),
        pytest.param("start", "joins", marks=pytest.mark.long),
    ],
)
def test_a_block_with_an_inherited_name_is_referred_to_with_its_package(part, item):
    text = MODEL.format(part=part, item=item)
    assert {f"part a : Plant::{part};", f"in item x : Plant::{item};"} <= {*lines_of(text)}
    complaints, differences, _ = compare(refine(text))
    assert (complaints, differences) == ([], [])


def test_other_names_are_not_qualified():
    lines = lines_of(MODEL.format(part="Arm", item="forces"))
    assert {"part a : Arm;", "in item x : forces;"} <= {*lines}
