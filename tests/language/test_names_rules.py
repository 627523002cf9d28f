"""The examples of the rules about names: the wrong model has the finding, the right one has not."""

import pytest
from resolving import documents, library, told

from sysmlc.diagnostics import Sink
from sysmlc.language.names import resolve
from sysmlc.language.names.resolution import CYCLE, NO_STANDARD_LIBRARY, TOO_DEEP
from sysmlc.language.names.unresolved import UNRESOLVED


def codes(text):
    sink = Sink()
    resolve(documents(text), library(), sink)
    return {found.rule.code for found in sink}


@pytest.mark.parametrize(
    ("rule", "code"),
    [(UNRESOLVED, "SM205"), (CYCLE, "SM206"), (NO_STANDARD_LIBRARY, "SM207")],
)
def test_the_wrong_model_has_the_finding_and_the_right_one_nearly(rule, code):
    assert rule.code == code
    assert code in codes(rule.read_page().wrong)
    assert code not in codes(rule.read_page().right)


def test_names_behind_thousands_of_names_are_told():
    aliases = [f"alias A{number} for A{number + 1};" for number in range(8000)]
    found = codes("\n".join([*aliases, "part def A8000;", "part gate : A0;"]))
    assert found == {"SM208", "SM205"}
    assert TOO_DEEP.code == "SM208"
    assert codes("\n".join([*aliases[-1:], "part def A8000;", "part gate : A7999;"])) == set()


def test_imports_of_each_other_in_all_ways_end():
    count = 60
    packages = [
        f"package P{n} {{ public import P{(7 * n + 1) % count}::*; "
        f"public import P{(3 * n + 2) % count}::*; public import P{(5 * n + 3) % count}::*; }}"
        for n in range(count)
    ]
    assert codes("\n".join([*packages, "part a : P0::X;"])) == {"SM205"}


def test_an_import_of_what_no_input_has_asks_for_its_file():
    sink = Sink()
    resolve(documents("package P { private import Elsewhere::*; }"), library(), sink)
    assert [found.help for found in sink] == [
        "give the file that has it as an input too, or the folder of all files"
    ]


def test_what_is_in_the_library_is_said_with_the_package_to_import():
    assert told("""
        package Plant {
            private import ScalarValues;
            attribute way = 5 [km];
            attribute mass : MassValue;
            attribute count : Real;
            attribute a = b;
            part x : A;
        }
    """) == [
        "4: unknown name 'km': 'km' is in 'SI', which is not imported here",
        "5: unknown name 'MassValue': 'MassValue' is in 'ISQ', which is not imported here",
        "6: unknown name 'Real': 'Real' is in 'ScalarValues': import ScalarValues::*, not it alone",
        "7: unknown name 'b': known: Plant, a, count, mass, way, x",
        "8: unknown name 'A': did you mean 'a'?",
    ]


def test_namesakes_that_specialise_what_lies_in_all_of_them_are_told():
    """Each leads to all the others: there are more ways through them than can be tried."""
    found = codes("\n".join(["part def A :> A::B;"] * 40))
    assert found == {"SM205", "SM240"}
    assert codes("\n".join(["part def A :> A::B;"] * 2)) == {"SM205"}
