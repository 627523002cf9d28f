"""Which element a name leads to: owned, inherited, imported, around, in the global scope."""

import pytest
from resolving import leads, resolved, told


def test_a_name_is_looked_up_from_inside_outwards():
    model = resolved("""
        package Plant {
            part def Gate;
            package Hall {
                part def Gate;
                part near : Gate;
                part far : Plant::Gate;
            }
        }
    """)
    assert leads(model, "Plant::Hall::near") == "Plant::Hall::Gate"
    assert leads(model, "Plant::Hall::far") == "Plant::Gate"


def test_the_global_scope_is_reached_from_everywhere_and_by_a_dollar():
    model = resolved(
        "package Doors { part def Gate; }",
        """
        package Plant {
            package Doors { part def Gate; }
            part a : Doors::Gate;
            part b : $::Doors::Gate;
        }
        """,
    )
    assert leads(model, "Plant::a") == "Plant::Doors::Gate"
    assert leads(model, "Plant::b") == "Doors::Gate"


def test_short_names_and_aliases_lead_to_the_same_element():
    model = resolved("""
        package Plant {
            part def <G> Gate;
            alias Door for Gate;
            part a : G;
            part b : Door;
        }
    """)
    assert leads(model, "Plant::a") == leads(model, "Plant::b") == "Plant::Gate"


def test_what_a_package_imports_is_known_in_it_and_only_public_imports_beyond():
    model = resolved("""
        package Doors { part def Gate; }
        package Shown { public import Doors::*; }
        package Hidden { private import Doors::*; part own : Gate; }
        package Plant { part a : Shown::Gate; }
    """)
    assert leads(model, "Hidden::own") == "Doors::Gate"
    assert leads(model, "Plant::a") == "Doors::Gate"
    assert told("""
        package Doors { part def Gate; }
        package Hidden { private import Doors::*; }
        package Plant { part a : Hidden::Gate; }
    """) == ["4: unknown name 'Hidden::Gate': 'Gate' is there by a private import only"]


def test_an_import_of_a_member_brings_one_name_a_recursive_one_all_below():
    model = resolved("""
        package Doors { part def Gate; package Old { part def Flap; } }
        package One { private import Doors::Gate; part a : Gate; }
        package All { private import Doors::**; part a : Gate; part b : Flap; }
    """)
    assert leads(model, "One::a") == "Doors::Gate"
    assert leads(model, "All::b") == "Doors::Old::Flap"


def test_import_all_brings_private_members_too():
    doors = "package Doors { private part def Gate; }"
    model = resolved(doors, "package Plant { private import all Doors::*; part a : Gate; }")
    assert leads(model, "Plant::a") == "Doors::Gate"
    assert told(doors, "package Plant { private import Doors::*; part a : Gate; }") == [
        "1: unknown name 'Gate': known: Plant, a"
    ]


def test_a_filter_keeps_out_what_has_not_the_metadata():
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
    assert leads(resolved(plant % "Gate"), "Checked::a") == "Plant::Gate"
    assert told(plant % "Table") == [
        "9: unknown name 'Table': 'Table' is in 'Plant', which is not imported here"
    ]


@pytest.mark.parametrize(
    ("condition", "kept"),
    [
        ('KerML::Element::name == "Gate"', {"Gate"}),
        ("KerML::Type::isAbstract", {"Table"}),
        ("not KerML::Type::isAbstract", {"Gate", "leaf"}),
        ("KerML::Feature::isComposite", set()),
        ("SysML::Usage::isVariation or KerML::Feature::isEnd", set()),
        ("@SysML::PartUsage and not KerML::Feature::isComposite", {"leaf"}),
        ("Plant::Rated::level > 1", {"Gate"}),
        ("Plant::Rated::level <= 1", {"Table"}),
        ("KerML::Element::qualifiedName != null", {"Gate", "Table", "leaf"}),
    ],
)
def test_a_filter_asks_what_elements_say_of_themselves(condition, kept):
    plant = """
        package Plant {
            metadata def Rated { attribute level : ScalarValues::Integer; }
            part def Gate { @Rated { level = 2; } }
            abstract part def Table { @Rated { level = 1; } }
            part leaf;
        }
    """
    uses = {"Gate": "part a : Gate;", "Table": "part a : Table;", "leaf": "part a :> leaf;"}
    seen = f"package Seen {{ private import Plant::*; filter {condition}; %s }}"
    assert {name for name, use in uses.items() if not told(plant, seen % use)} == kept


def test_what_features_a_feature_may_be_in_it():
    model = resolved(
        """
        class Car {
            member feature driver featured by Car_snapshots {
                member feature Car_snapshots subsets Occurrences::occurrences;
            }
        }
        """,
        language="kerml",
    )
    assert leads(model, "Car::driver", "TypeFeaturing") == "Car::driver::Car_snapshots"


def test_imports_in_a_circle_end():
    model = resolved("""
        package A { public import B::*; part def Gate; }
        package B { public import A::*; part def Flap; }
        package C { private import A::*; part a : Gate; part b : Flap; }
    """)
    assert leads(model, "C::b") == "B::Flap"


def test_private_members_are_not_seen_from_outside_and_protected_ones_by_heirs():
    model = resolved("""
        part def Gate { protected part motor; private part seal; part leaf; }
        part def Big :> Gate { part :>> motor; part :>> leaf; }
    """)
    assert leads(model, "Big::motor") == "Gate::motor"
    assert told("""
        part def Gate { protected part motor; private part seal; part leaf; }
        part def Big :> Gate { part :>> seal; }
        part def Other { part a :> Gate::motor; }
    """) == [
        "3: unknown name 'seal': 'seal' is private in 'Gate'",
        "4: unknown name 'Gate::motor': 'motor' is protected in 'Gate'",
    ]


def test_what_imports_a_library_name_may_call_it_by_that():
    model = resolved("package Plant { private import ScalarValues::Real; attribute a : Real; }")
    assert leads(model, "Plant::a") == "ScalarValues::Real"


def test_what_is_advised_is_neither_the_use_itself_nor_a_unit():
    assert told(
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
        "4: unknown name 'a': known: Cell, Plant, Tools, Use, grip",
        "4: unknown name 'N': known: Cell, Plant, Tools, Use, grip",
    ]
