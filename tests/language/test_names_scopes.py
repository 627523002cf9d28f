"""Lookup of names in scopes: owned, imported, enclosing and global members; filters."""

import pytest
from small_models import (
    DECLARE_OR_IMPORT,
    list_name_errors,
    load_library,
    parse_texts,
    resolve_texts,
    target_name,
)

from sysmlc.diagnostics import Sink
from sysmlc.language.names import resolve


def test_a_name_is_looked_up_in_the_innermost_namespace_first():
    model = resolve_texts("""
        package Plant {
            part def Gate;
            package Hall {
                part def Gate;
                part near : Gate;
                part far : Plant::Gate;
            }
        }
    """)
    assert target_name(model, "Plant::Hall::near") == "Plant::Hall::Gate"
    assert target_name(model, "Plant::Hall::far") == "Plant::Gate"


def test_a_dollar_starts_a_name_in_the_global_scope():
    model = resolve_texts(
        "package Doors { part def Gate; }",
        """
        package Plant {
            package Doors { part def Gate; }
            part a : Doors::Gate;
            part b : $::Doors::Gate;
        }
        """,
    )
    assert target_name(model, "Plant::a") == "Plant::Doors::Gate"
    assert target_name(model, "Plant::b") == "Doors::Gate"


def test_short_names_and_aliases_lead_to_the_same_element():
    model = resolve_texts("""
        package Plant {
            part def <G> Gate;
            alias Door for Gate;
            part a : G;
            part b : Door;
        }
    """)
    assert target_name(model, "Plant::a") == target_name(model, "Plant::b") == "Plant::Gate"


def test_only_public_imports_are_visible_outside_of_the_importing_package():
    model = resolve_texts("""
        package Doors { part def Gate; }
        package Shown { public import Doors::*; }
        package Hidden { private import Doors::*; part own : Gate; }
        package Plant { part a : Shown::Gate; }
    """)
    assert target_name(model, "Hidden::own") == "Doors::Gate"
    assert target_name(model, "Plant::a") == "Doors::Gate"
    assert list_name_errors("""
        package Doors { part def Gate; }
        package Hidden { private import Doors::*; }
        package Plant { part a : Hidden::Gate; }
    """) == ["4: unknown name 'Hidden::Gate': 'Gate' is there by a private import only"]


def test_a_recursive_import_imports_the_members_of_nested_packages():
    model = resolve_texts("""
        package Doors { part def Gate; package Old { part def Flap; } }
        package One { private import Doors::Gate; part a : Gate; }
        package All { private import Doors::**; part a : Gate; part b : Flap; }
    """)
    assert target_name(model, "One::a") == "Doors::Gate"
    assert target_name(model, "All::b") == "Doors::Old::Flap"


def test_import_all_imports_private_members():
    doors = "package Doors { private part def Gate; }"
    model = resolve_texts(doors, "package Plant { private import all Doors::*; part a : Gate; }")
    assert target_name(model, "Plant::a") == "Doors::Gate"
    assert list_name_errors(doors, "package Plant { private import Doors::*; part a : Gate; }") == [
        "1: unknown name 'Gate': 'Gate' is private in 'Doors'"
    ]


def test_a_filter_excludes_elements_without_the_metadata():
    plant = """
        package Plant {
            metadata def Safety { attribute level : ScalarValues::Integer; }
            part def Gate { @Safety { level = 2; } }
            part def Table;
        }
        package Checked {
            private import Plant::*[@Plant::Safety and Plant::Safety::level == 2];
            part a : %s;
        }
    """
    assert target_name(resolve_texts(plant % "Gate"), "Checked::a") == "Plant::Gate"
    assert list_name_errors(plant % "Table") == [
        "9: unknown name 'Table': 'Table' is in 'Plant', which is not imported here"
    ]


@pytest.mark.parametrize(
    ("condition", "imported_names"),
    [
        ('KerML::Element::name == "Gate"', {"Gate"}),
        ("KerML::Type::isAbstract", {"Table"}),
        ("not KerML::Type::isAbstract", {"Gate", "leaf"}),
        ("KerML::Feature::isComposite", set()),
        ("SysML::Usage::isVariation or KerML::Feature::isEnd", set()),
        ("@SysML::PartUsage and not KerML::Feature::isComposite", {"leaf"}),
        ("Plant::Rated::level > 1", {"Gate"}),
        ("Plant::Rated::level <= 1", {"Table"}),
        ("Plant::Rated::level < 2", {"Table"}),
        ("Plant::Rated::level >= 2", {"Gate"}),
        ("Plant::Rated::level === 2", {"Gate"}),
        ("Plant::Rated::level !== 2", {"Table", "leaf"}),
        ("Plant::Rated::level != 2", {"Table", "leaf"}),
        ("KerML::Type::isAbstract xor @SysML::PartUsage", {"Table", "leaf"}),
        ("KerML::Type::isAbstract | @SysML::PartUsage", {"Table", "leaf"}),
        ("KerML::Type::isAbstract & @SysML::PartUsage", set()),
        ("KerML::Type::isSufficient", set()),
        ("KerML::Feature::isConstant", set()),
        ("KerML::Feature::isDerived", set()),
        ("KerML::Feature::isOrdered", set()),
        ("KerML::Feature::isPortion", set()),
        ("KerML::Feature::isVariable", set()),
        ("SysML::OccurrenceUsage::isIndividual", set()),
        ("KerML::Element::qualifiedName != null", {"Gate", "Table", "leaf"}),
    ],
)
def test_a_filter_tests_attributes_of_elements_and_of_their_metadata(condition, imported_names):
    plant = """
        package Plant {
            metadata def Rated { attribute level : ScalarValues::Integer; }
            part def Gate { @Rated { level = 2; } }
            abstract part def Table { @Rated { level = 1; } }
            part leaf;
        }
    """
    uses = {"Gate": "part a : Gate;", "Table": "part a : Table;", "leaf": "part a :> leaf;"}
    importing = f"package Seen {{ private import Plant::*; filter {condition}; %s }}"
    resolved = {name for name, use in uses.items() if not list_name_errors(plant, importing % use)}
    assert resolved == imported_names


def test_the_featuring_type_of_a_feature_may_be_its_member():
    model = resolve_texts(
        """
        class Car {
            member feature driver featured by Car_snapshots {
                member feature Car_snapshots subsets Occurrences::occurrences;
            }
        }
        """,
        language="kerml",
    )
    assert target_name(model, "Car::driver", "TypeFeaturing") == "Car::driver::Car_snapshots"


def test_cyclic_imports_terminate():
    model = resolve_texts("""
        package A { public import B::*; part def Gate; }
        package B { public import A::*; part def Flap; }
        package C { private import A::*; part a : Gate; part b : Flap; }
    """)
    assert target_name(model, "C::b") == "B::Flap"


def test_private_members_are_invisible_and_protected_ones_visible_to_specialisations():
    model = resolve_texts("""
        part def Gate { protected part motor; private part seal; part leaf; }
        part def Big :> Gate { part :>> motor; part :>> leaf; }
    """)
    assert target_name(model, "Big::motor") == "Gate::motor"
    assert list_name_errors("""
        part def Gate { protected part motor; private part seal; part leaf; }
        part def Big :> Gate { part :>> seal; }
        part def Other { part a :> Gate::motor; }
    """) == [
        "3: unknown name 'seal': 'seal' is private in 'Gate'",
        "4: unknown name 'Gate::motor': 'motor' is protected in 'Gate'",
    ]


def test_the_private_part_of_a_name_is_named():
    """A name of an imported package, the start of a qualified name, and a name behind a dot."""
    assert list_name_errors("""
        package Lib { private part def Shy; private package Inner { part def Deep; }
            part def Open { private attribute secret; } }
        package User { private import Lib::*;
            part a : Shy;
            part b : Lib::Inner::Deep;
            part c : Inner::Deep;
            part d : Open;
            attribute e = d.secret;
            part f : Missing; }
    """) == [
        "5: unknown name 'Shy': 'Shy' is private in 'Lib'",
        "6: unknown name 'Lib::Inner::Deep': 'Inner' is private in 'Lib'",
        "7: unknown name 'Inner::Deep': 'Inner' is private in 'Lib'",
        "9: unknown name 'secret' in 'd': 'secret' is private in 'Open'",
        "10: unknown name 'Missing': declare it, import the package that has it, or give its file "
        "as an input too",
    ]


def test_an_imported_library_element_is_visible_by_its_simple_name():
    model = resolve_texts(
        "package Plant { private import ScalarValues::Real; attribute a : Real; }"
    )
    assert target_name(model, "Plant::a") == "ScalarValues::Real"


def test_advice_names_neither_the_unknown_use_itself_nor_a_unit():
    assert list_name_errors(
        """\
        package Plant {
            perform grip;
            private package Use { attribute mass = 5 [SI::N]; }
            part def Cell { connect a to N; }
        }
        package Tools { action grip; }
        """
    ) == [
        "2: unknown name 'grip': 'grip' is in 'Tools', which is not imported here",
        f"4: unknown name 'a': {DECLARE_OR_IMPORT}",
        f"4: unknown name 'N': {DECLARE_OR_IMPORT}",
    ]


FILTERED = """
package Marks {{
    metadata def Safe {{ attribute level : ScalarValues::Integer; }}
    part def Two {{ @Safe {{ level = 2; }} part inner {{ @Safe {{ level = 5; }} }} }}
    part def Plain;
}}
package User {{ {0} }}
"""


@pytest.mark.parametrize(
    ("imports", "unknown"),
    [
        ("private import Marks::*;", []),
        ("private import Marks::*[@Marks::Safe];", ["Plain"]),
        ("private import Marks::*[@Marks::Safe and Marks::Safe::level > 3];", ["Two", "Plain"]),
        ("private import Marks::**[@Marks::Safe and Marks::Safe::level > 3];", ["Two", "Plain"]),
        ("private import Marks::*; filter @Marks::Safe;", ["Plain"]),
    ],
)
def test_a_filter_excludes_elements_that_do_not_satisfy_its_condition(imports, unknown):
    errors = list_name_errors(FILTERED.format(f"{imports} part two : Two; part plain : Plain;"))
    assert [error.split("'")[1] for error in errors] == unknown


@pytest.mark.parametrize(("level", "unknown"), [(3, []), (6, ["inner"])])
def test_a_recursive_import_filters_nested_elements_too(level, unknown):
    imports = f"private import Marks::**[@Marks::Safe and Marks::Safe::level > {level}];"
    errors = list_name_errors(FILTERED.format(f"{imports} part mine :> inner;"))
    assert [error.split("'")[1] for error in errors] == unknown


def test_advice_names_elements_of_the_kind_that_is_needed():
    assert list_name_errors(
        """\
        package Plant {
            part tank : Tankk;
            part def Tank { attribute level; }
            part spare : Tank { attribute full redefines levl; }
            bind tnk.level = spare.level;
        }
        """
    ) == [
        "2: unknown name 'Tankk': did you mean 'Tank'?",
        "4: unknown name 'levl': did you mean 'level'?",
        "5: unknown name 'tnk': did you mean 'tank'?",
    ]


def test_advice_names_units_and_what_imported_packages_pass_on():
    assert list_name_errors(
        """\
        package Plant {
            private import ISQ::*;
            attribute load : MasValue = 4 [kgg];
            attribute limit : ISQ::MasValue;
        }
        """
    ) == [
        "3: unknown name 'MasValue': did you mean 'MassValue'?",
        "3: unknown name 'kgg': did you mean 'kg'?",
        "4: unknown name 'ISQ::MasValue': did you mean 'MassValue'?",
    ]


TYPE_NAMED_LIKE_ITS_PACKAGE = """
    package Plant {
        part def Plant { part pump : Pump; }
        part def Pump;
        package Tools { part def Drill; }
    }
    package Use {
        private import Plant::*;
        part a : Plant::Pump;
        part b : Plant::Tools::Drill;
        part c : Plant;
        package Inner { private import Plant::Tools::*; part d : Drill; }
    }
"""


def test_an_imported_type_does_not_hide_the_package_of_the_same_name():
    documents = parse_texts(TYPE_NAMED_LIKE_ITS_PACKAGE)
    sink = Sink()
    model = resolve(documents, load_library(), sink)
    assert target_name(model, "Use::a") == "Plant::Pump"
    assert target_name(model, "Use::b") == "Plant::Tools::Drill"
    assert target_name(model, "Use::c") == "Plant::Plant"
    assert target_name(model, "Use::Inner::d") == "Plant::Tools::Drill"
    assert [(d.rule.code, d.message) for d in sink if d.rule.code != "SM207"] == [
        (
            "SM241",
            "'Plant::Pump' is found although the nearest 'Plant' has no 'Pump' "
            "(2 more such names in this file)",
        )
    ]


def test_a_name_that_no_meaning_of_its_first_part_has_is_unknown():
    text = TYPE_NAMED_LIKE_ITS_PACKAGE.replace("part c : Plant;", "part c : Plant::Valve;")
    assert [error for error in list_name_errors(text) if "unknown" in error] == [
        "11: unknown name 'Plant::Valve': declare it in 'Plant'"
    ]


def test_a_declared_namespace_hides_those_further_outside():
    assert list_name_errors("""
        package Doors { part def Gate; }
        package Plant {
            package Doors { part def Flap; }
            part a : Doors::Gate;
        }
    """) == ["5: unknown name 'Doors::Gate': declare it in 'Doors', which has: Flap"]


@pytest.mark.parametrize("import_", ["Motors::**", "Motors::*::**"])
def test_a_recursive_import_finds_a_type_below_a_package_of_the_same_name(import_):
    model = resolve_texts(f"""
        package Motors {{ package Motor {{ package Parts {{ part def Motor; }} }} }}
        package Use {{ private import {import_}; part a : Motor; part b : Motor::Parts::Motor; }}
    """)
    for part in ("a", "b"):
        assert target_name(model, f"Use::{part}") == "Motors::Motor::Parts::Motor"


def test_recursive_imports_may_form_a_cycle():
    model = resolve_texts("""
        package Line {
            package Left { public import Right::**; package Deep { part def Gate; } }
            package Right { public import Left::**; package Deep { part def Flap; } }
            package Use {
                public import Line::**;
                part a : Gate;
                part b : Flap;
                part c : Left::Flap;
            }
        }
    """)
    assert target_name(model, "Line::Use::a") == "Line::Left::Deep::Gate"
    assert target_name(model, "Line::Use::b") == "Line::Right::Deep::Flap"
    assert target_name(model, "Line::Use::c") == "Line::Right::Deep::Flap"


def test_a_package_that_two_files_declare_is_one_finding():
    """SM243 is an info: both files are read."""
    files = (
        "package Films { package Phase1 { part def Robot; } }",
        "package Films { package Phase1 { part def Crane; } }",
        """
        package Use {
            private import Films::Phase1::Robot;
            private import Films::Phase1::Crane;
            part r : Robot;
            part c : Crane;
        }
        """,
    )
    assert list_name_errors(*files) == [
        "1: '1.sysml', '2.sysml' declare a package 'Films' each; its members are looked up in all "
        "of them: declare a package in one file, or give the packages different names"
    ]
