"""Structure of SysML v2 in the graph: definitions, usages, ports, connections, values."""

import pytest
from reading_v2 import read, read_classified

PLANT = """
package Plant {
    private import ScalarValues::*;
    part def Pallet;
    port def Transfer { out item pallet : Pallet; }
    part def Gate {
        attribute width : Real = 0.5;
        attribute names : String[0..*] ordered nonunique;
        port inlet : ~Transfer;
        port leave : Transfer;
    }
    part def Cell {
        part east : Gate;
        part second : Gate[1..2];
        ref part spare : Gate[0..1];
        interface link connect east.leave to second.inlet;
        flow of Pallet from east.leave.pallet to second.inlet.pallet;
    }
}
"""


def test_definitions_and_usages_have_the_kinds_and_roles_of_blocks():
    reading = read_classified(PLANT)
    roles = {
        name: (
            str(reading.find_element(f"Plant::{name}").kind),
            reading.find_element(f"Plant::{name}").role,
        )
        for name in ("Gate", "Transfer", "Cell::east", "Cell::spare", "Gate::width", "Gate::inlet")
    }
    assert roles == {
        "Gate": ("Class", "block"),
        "Transfer": ("Class", "interface block"),
        "Cell::east": ("Property", "part"),
        "Cell::spare": ("Property", "reference"),
        "Gate::width": ("Property", "value"),
        "Gate::inlet": ("Port", "proxy port"),
    }
    assert reading.list_codes() == []


def test_multiplicities_flags_and_values_are_attributes():
    reading = read(PLANT)
    names = reading.find_element("Plant::Gate::names").attrs
    assert (names["multiplicity"], names["ordered"], names["unique"]) == ("*", True, False)
    assert reading.find_element("Plant::Cell::second").attrs["multiplicity"] == "1..2"
    assert "multiplicity" not in reading.find_element("Plant::Cell::east").attrs
    assert reading.find_element("Plant::Gate::width").attrs["default"] == 0.5


def test_conjugated_ports_are_typed_by_the_original():
    reading = read_classified(PLANT)
    inlet = reading.find_element("Plant::Gate::inlet")
    assert (inlet.attrs["conjugated"], inlet.attrs["direction"]) == (True, "in")
    assert reading.list_targets("Plant::Gate::inlet", "typed-by") == ["Plant::Transfer"]


def test_connections_have_ends_with_paths_and_flows_run_along_them():
    reading = read(PLANT)
    link = reading.graph.owned(reading.find_element("Plant::Cell::link"))
    ends = [
        [target.name for edge in ("path", "role") for target in reading.graph.targets(end, edge)]
        for end in link
    ]
    assert ends == [["east", "leave"], ["second", "inlet"]]
    flow = "Plant::Cell::<ItemFlow>"
    assert reading.list_targets(flow, "conveys") == ["Plant::Pallet"]
    assert reading.list_targets(flow, "realizing") == ["Plant::Cell::link"]
    assert reading.list_targets(flow, "flow-source") == ["Plant::Gate::leave"]


def test_ids_are_those_of_qualified_names_wherever_they_stand_in_the_file():
    plain, with_comment = read(PLANT), read("// a comment\n" + PLANT)
    assert [e.id for e in plain.graph] == [e.id for e in with_comment.graph]
    assert (
        plain.find_element("Plant::Gate").ordinal + 13
        == with_comment.find_element("Plant::Gate").ordinal
    )


def test_places_are_bytes_of_the_names():
    text = "package 'Käse' { part def Gate; }"
    gate = read(text).find_element("Käse::Gate")
    assert text.encode()[gate.ordinal :].startswith(b"Gate")


def test_redefinitions_have_the_name_and_the_type_of_what_they_redefine():
    reading = read("""
package P {
    part def A { attribute mass : ScalarValues::Real; }
    part def B :> A { attribute :>> mass = 3.5; }
}""")
    assert reading.list_targets("P::B::mass", "redefines") == ["P::A::mass"]
    assert reading.list_targets("P::B::mass", "typed-by") == ["Real"]
    assert reading.list_targets("P::B", "specializes") == ["P::A"]


def test_a_usage_with_members_of_its_own_is_typed_by_a_class_made_for_it():
    reading = read("""
package P {
    part def Engine { attribute power : ScalarValues::Real; }
    part def Car { part engine : Engine { attribute :>> power = 90.0; part filter; } }
}""")
    class_ = reading.find_element("P::Car::engine", "Class")
    assert class_.attrs["property_specific"] is True
    assert reading.list_targets("P::Car::engine", "typed-by", "Property") == ["P::Car::engine"]
    assert reading.list_targets("P::Car::engine", "specializes", "Class") == ["P::Engine"]
    assert reading.list_owned("P::Car::engine", "Class") == ["Property power", "Property filter"]


def test_usages_in_packages_are_instances_when_they_only_give_values():
    reading = read("""
package P {
    part def Gate { attribute width : ScalarValues::Real; }
    part east : Gate { :>> width = 0.8; }
    part line { part gate : Gate; part second : Gate; connect gate to second; }
}""")
    assert str(reading.find_element("P::east").kind) == "Instance"
    assert reading.list_targets("P::east", "instance-of") == ["P::Gate"]
    slot = reading.find_element("P::east::width")
    assert (str(slot.kind), slot.attrs["value"]) == ("Slot", 0.8)
    line = reading.find_element("P::line")
    assert (str(line.kind), line.attrs["usage"]) == ("Class", True)
    assert reading.list_owned("P::line")[2] == "Connector"


def read_slot(value):
    return read(f"""
package P {{
    part def Row;
    part def Table {{ part rows : Row[*]; }}
    part left : Row;
    part middle : Row;
    part right : Row;
    part table : Table {{ :>> rows = {value}; }}
}}""")


def test_a_sequence_of_instances_in_a_slot_refers_to_each_of_them_in_order():
    reading = read_slot("(right, left, middle)")
    rows = reading.graph.targets(reading.find_element("P::table::rows"), "references")
    assert [row.name for row in rows] == ["right", "left", "middle"]
    assert reading.find_element("P::table::rows").attrs == {}


@pytest.mark.parametrize("value", ["(left, left)", "(left, middle.rows)", "left + middle"])
def test_a_slot_with_other_values_has_the_text_of_the_expression(value):
    slot = read_slot(value).find_element("P::table::rows")
    assert slot.attrs["value_language"] == ""
    assert "left" in slot.attrs["value"]


def test_enumerations_and_values_that_name_their_literals():
    reading = read("""
package P {
    enum def Colour { red; blue; }
    part def A { attribute c : Colour = Colour::blue; }
}""")
    assert reading.list_owned("P::Colour") == ["EnumerationLiteral red", "EnumerationLiteral blue"]
    attrs = reading.find_element("P::A::c").attrs
    assert (attrs["default"], attrs["default_instance"]) == (
        "blue",
        reading.find_element("P::Colour::blue").id,
    )


@pytest.mark.parametrize(
    ("value", "literals"),
    [("Colour::red", ["red"]), ("(Colour::blue, Colour::red)", ["blue", "red"])],
)
def test_a_slot_refers_to_the_literals_of_an_enumeration_as_in_xmi(value, literals):
    reading = read(f"""
package P {{
    enum def Colour {{ red; blue; }}
    part def A {{ attribute c : Colour[*]; }}
    part a : A {{ :>> c = {value}; }}
}}""")
    slot = reading.find_element("P::a::c")
    assert [target.name for target in reading.graph.targets(slot, "references")] == literals
    assert slot.attrs == {}


def test_value_types_of_quantities_have_unit_and_quantity_kind():
    reading = read("""
package P { attribute def Mass :> ISQ::MassValue { attribute :>> mRef = SI::kg; } }
""")
    mass = reading.graph.targets(reading.find_element("P::Mass"), "references")
    assert [(str(one.kind), one.name, one.attrs.get("symbol")) for one in mass] == [
        ("Unit", "kilogram", "kg"),
        ("QuantityKind", "mass", None),
    ]


def test_bindings_constraints_and_dependencies():
    reading = read("""
package P {
    part def A {
        attribute x : ScalarValues::Integer;
        attribute y : ScalarValues::Integer;
        bind x = y;
        assert constraint small { x <= 3 and not (y > 2) }
    }
    part def B;
    dependency uses from A to B;
}""")
    assert reading.find_element("P::A::<Connector>").role == "binding connector"
    assert reading.find_element("P::A::small").attrs["body"] == "x <= 3 and not (y > 2)"
    assert reading.list_targets("P::uses", "client") == ["P::A"]
    assert reading.list_targets("P::uses", "supplier") == ["P::B"]


def test_metadata_is_an_applied_stereotype_with_its_values():
    reading = read(
        """
package P {
    metadata def Cell { attribute speed : ScalarValues::Integer; attribute of : Anything; }
    part def Gate { @Cell { speed = 2; } }
}""".replace("attribute of : Anything; ", "")
    )
    applied = reading.find_element("P::Gate::Cell")
    assert applied.attrs["tag.speed"] == "2"
    assert reading.list_targets("P::Gate::Cell", "subject") == ["P::Gate"]
    assert reading.list_targets("P::Gate::Cell", "instance-of") == ["P::Cell"]


NODES = 34
"""Nodes of the tree of PLANT; the import of the library is the external one."""


def test_every_node_has_one_verdict():
    reading = read(PLANT)
    assert reading.count_verdicts() == {"elements": NODES, "mapped": NODES - 1, "external": 1}


def test_an_end_of_an_association_has_the_multiplicity_with_which_it_is_crossed():
    reading = read("part def A; part def B; connection def R { end a : A; end [0..3] part b : B; }")
    assert reading.list_owned("R") == ["Property a", "Property b"]
    assert reading.find_element("R::b").attrs["multiplicity"] == "0..3"
    assert reading.list_targets("R::b", "typed-by") == ["B"]


def test_an_import_without_visibility_passes_names_on_with_a_warning():
    reading = read("""
package Units { attribute def Mass; }
package Old { import Units::*; }
package Model { private import Old::*; part def Tank { attribute load : Mass; } }""")
    assert reading.list_codes() == ["SM197"]
    assert reading.list_targets("Model::Tank::load", "typed-by") == ["Units::Mass"]


def test_a_private_import_passes_no_names_on():
    reading = read("""
package Units { attribute def Mass; }
package New { private import Units::*; }
package Model { private import New::*; part def Tank { attribute load : Mass; } }""")
    assert reading.list_codes() == ["SM205"]
