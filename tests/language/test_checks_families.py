"""Constraints about subsets, types made of others, bounds, conditions, metadata, ends, results."""

import pytest
from resolving import documents, library

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.language.checks import check, families
from sysmlc.language.metaclasses import ALL_GENERALS
from sysmlc.language.names import resolve

KERML = {
    *("SM251", "SM252", "SM254", "SM255", "SM256", "SM257", "SM258", "SM266", "SM267"),
    *("SM285", "SM286", "SM287", "SM288"),
}
"""Rules about what SysML has no notation for: their examples are in KerML."""
SYSML = {
    *("SM250", "SM259", "SM260", "SM261", "SM262", "SM263", "SM264", "SM265", "SM268", "SM269"),
    *("SM270", "SM271", "SM272", "SM273", "SM276", "SM277", "SM278", "SM279"),
    *("SM280", "SM281", "SM282", "SM283"),
}


def codes(text, language="sysml"):
    sink = Sink()
    check(resolve(documents(text, language=language), library(), sink), sink)
    return {one.rule.code for one in sink} - {"SM207"}


def found(text, language="sysml"):
    sink = Sink({"SM207": None})
    check(resolve(documents(text, language=language), library(), sink), sink)
    return [one.message for one in sink]


def test_every_rule_of_the_families_has_examples_here():
    assert families.BY_KIND
    ours = {code for code in catalogue() if "SM250" <= code <= "SM299"}
    assert ours == KERML | SYSML


@pytest.mark.parametrize("code", sorted(KERML | SYSML))
def test_the_wrong_model_has_it_and_the_right_one_has_nothing(code):
    language = "kerml" if code in KERML else "sysml"
    rule = catalogue()[code]
    assert codes(rule.wrong, language) == {code}
    assert codes(rule.right, language) == set()


def test_metadata_is_for_what_its_definition_says():
    assert found("""
        metadata def Safe { ref :>> annotatedElement : SysML::ActionUsage; }
        metadata def Tested :> Safe;
        action open { @Safe; }
        state opening { @Tested; }
        part gate { @Tested; }
        part fence;
        metadata Safe about fence;
    """) == [
        "metadata 'Tested' is not for a part",
        "metadata 'Safe' is not for a part",
    ]


def test_the_core_has_every_metaclass_that_metadata_may_be_for():
    model = resolve(documents("part gate;"), library(), Sink())
    missing = [kind for kind in ALL_GENERALS if model.find(f"SysML::{kind}") is None]
    assert missing == []
