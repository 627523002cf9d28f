"""Diagnostics about names: the examples of the rules, their advice and their locations."""

import pytest
from small_models import DECLARE_OR_IMPORT, list_name_errors, load_library, parse_texts

from sysmlc.diagnostics import Place, Sink
from sysmlc.language.names import CYCLE, HIDDEN, NO_STANDARD_LIBRARY, TOO_DEEP, resolve
from sysmlc.language.names.unresolved import UNRESOLVED
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node, locate
from sysmlc.sources import Source


def list_codes(text):
    sink = Sink()
    resolve(parse_texts(text), load_library(), sink)
    return {diagnostic.rule.code for diagnostic in sink}


@pytest.mark.parametrize(
    ("rule", "code"),
    [
        (UNRESOLVED, "SM205"),
        (CYCLE, "SM206"),
        (NO_STANDARD_LIBRARY, "SM207"),
        (HIDDEN, "SM241"),
    ],
)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule, code):
    assert rule.code == code
    assert code in list_codes(rule.read_page().wrong)
    assert code not in list_codes(rule.read_page().right)


def test_a_chain_of_thousands_of_aliases_is_reported():
    aliases = [f"alias A{number} for A{number + 1};" for number in range(8000)]
    codes = list_codes("\n".join([*aliases, "part def A8000;", "part gate : A0;"]))
    assert codes == {"SM208", "SM205"}
    assert TOO_DEEP.code == "SM208"
    assert list_codes("\n".join([*aliases[-1:], "part def A8000;", "part gate : A7999;"])) == set()


def test_packages_that_import_each_other_in_many_ways_terminate():
    count = 60
    packages = [
        f"package P{n} {{ public import P{(7 * n + 1) % count}::*; "
        f"public import P{(3 * n + 2) % count}::*; public import P{(5 * n + 3) % count}::*; }}"
        for n in range(count)
    ]
    assert list_codes("\n".join([*packages, "part a : P0::X;"])) == {"SM205"}


def test_the_help_about_a_missing_package_asks_for_its_file():
    sink = Sink()
    resolve(parse_texts("package P { private import Elsewhere::*; }"), load_library(), sink)
    assert [diagnostic.help for diagnostic in sink] == [
        "give the file that has it as an input too, or the folder of all files"
    ]


def test_the_help_about_a_library_name_says_which_package_to_import():
    assert list_name_errors("""
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
        f"7: unknown name 'b': {DECLARE_OR_IMPORT}",
        f"8: unknown name 'A': {DECLARE_OR_IMPORT}",
    ]


def test_only_close_names_of_the_needed_kind_are_suggested():
    assert list_name_errors("""
        package Plant {
            part def Tank { attribute fillLevel; attribute fault1; }
            metadata def OpcUaMethod;
            item def tankk;
            part a : Tankk { attribute :>> levelFill; }
            part b : TANK;
            part c { @OpcUaConnection; }
            attribute mass = 5 [SI::kgg];
            ref d = a.fault2;
        }
    """) == [
        "6: unknown name 'Tankk': did you mean 'tankk'?",
        "7: unknown name 'TANK': did you mean 'Tank'?",
        f"8: unknown name 'OpcUaConnection': {DECLARE_OR_IMPORT}",
        "9: unknown name 'SI::kgg': did you mean 'kg'?",
    ]


def test_a_definition_where_a_usage_is_needed_is_used_with_its_keyword():
    model = """
        package Plant {{
            requirement def Clean; use case def Fill;
            part cell {{ satisfy {}; }}
            use case run {{ include {}; }}
        }}
    """
    needed = "a usage or feature is needed here; write"
    assert list_name_errors(model.format("Clean", "Fill")) == [
        "4: unknown name 'Clean': 'Clean' is a requirement definition, "
        f"{needed} 'requirement : Clean'",
        f"5: unknown name 'Fill': 'Fill' is a use case definition, {needed} 'use case : Fill'",
    ]
    assert list_name_errors(model.format("requirement : Clean", "use case : Fill")) == []


def test_the_advice_about_a_member_of_another_element_names_that_element():
    assert list_name_errors("""
        package Plant {
            enum def Colour { red; green; }
            part def Tank { attribute fillLevel; attribute fault1; }
            part tank : Tank; part full :> tank { attribute :>> levelFill; attribute :>> volume; }
            ref fault = tank.fault2;
            attribute colour = Colour::blue;
            attribute unit = SI::tonneForce;
            part pump : Pumps::Pump;
            part vessel : Plantt::Tank;
        }
    """) == [
        "5: unknown name 'levelFill': did you mean 'fillLevel'?",
        "5: unknown name 'volume': only an inherited feature can be redefined: "
        "declare it in a general type",
        "6: unknown name 'fault2' in 'tank': declare it in 'Tank', which has: fault1, fillLevel",
        "7: unknown name 'Colour::blue': declare it in 'Colour', which has: green, red",
        "8: unknown name 'SI::tonneForce': 'SI' of the library has no such name",
        f"9: unknown name 'Pumps::Pump': {DECLARE_OR_IMPORT}",
        "10: unknown name 'Plantt::Tank': did you mean 'Plant'?",
    ]


def test_namesakes_that_specialise_members_of_one_another_are_reported():
    """Each leads to all the others, so there are too many paths to try all of them."""
    codes = list_codes("\n".join(["part def A :> A::B;"] * 40))
    assert codes == {"SM205", "SM240"}
    assert list_codes("\n".join(["part def A :> A::B;"] * 2)) == {"SM205"}


def text_at_diagnostics(text, *, mark=b""):
    """Return the rest of the file from the location of each diagnostic."""
    data = mark + text.encode()
    sink, source = Sink({"SM207": None}), Source("plant.sysml", data)
    resolve([parse(text, "plant.sysml", "sysml", sink, source)], load_library(), sink)
    return [data[diagnostic.subject.place.offset :].decode() for diagnostic in sink]


def test_a_byte_order_mark_and_wide_characters_do_not_shift_locations():
    text, mark = "package 'Käse' { part cut : Knife; }", b"\xef\xbb\xbf"
    assert text_at_diagnostics(text) == ["Knife; }"]
    assert text_at_diagnostics(text, mark=mark) == ["Knife; }"]


def test_names_with_escaped_quotes_do_not_shift_locations():
    robot = r"part def Robot { part 'robot\'s arm' : Robot; }"
    use = r"part robot : Robot; part tool = robot.'robot\'s arm'.tool;"
    assert text_at_diagnostics(robot + use) == ["tool;"]


def test_a_location_in_an_interchange_file_is_the_ordinal_of_its_element():
    assert locate(Document("plant.sysmlx", "sysml", Node("Namespace")), 7) == Place(
        "plant.sysmlx", ordinal=7
    )
