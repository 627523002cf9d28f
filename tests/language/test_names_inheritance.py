"""Members that a feature inherits from types and from other features; effective names."""

from small_models import find_element, list_name_errors, resolve_texts, target_name


def test_a_feature_has_the_members_of_its_type():
    model = resolve_texts("""
        part def Gate { part motor; }
        part entrance : Gate;
        part drive :> entrance.motor;
    """)
    assert target_name(model, "drive") == "Gate::motor"


def test_a_redefinition_is_looked_up_in_the_types_of_its_owner_and_not_in_the_owner():
    model = resolve_texts("""
        part def Gate { part motor; }
        part def Big :> Gate { part motor :>> motor; }
        part def Twice :> Big { part :>> motor; }
    """)
    assert target_name(model, "Big::motor") == "Gate::motor"
    assert target_name(model, "Twice::motor") == "Big::motor"


def test_a_redefining_feature_of_another_name_hides_the_redefined_one():
    assert list_name_errors("""
        part def Gate { part motor; }
        part def Big :> Gate { part drive :>> motor; }
        part a :> Big::motor;
    """) == ["4: unknown name 'Big::motor': declare it in 'Big', which has: drive"]


def test_a_nameless_feature_has_the_name_of_the_feature_it_redefines_or_references():
    model = resolve_texts("""
        action def Drill;
        part def Machine { action drill : Drill; part spindle; }
        part mill : Machine {
            part :>> spindle { part tool; }
            perform Machine::drill;
        }
        part a :> mill.spindle.tool;
        action b :> mill.drill;
    """)
    assert target_name(model, "a") == "mill::spindle::tool"
    assert target_name(model, "b") == "mill::drill"


def test_the_most_specific_of_two_inherited_members_is_found():
    model = resolve_texts("""
        part def Machine { part motor; }
        part def Mill :> Machine { part motor :>> Machine::motor; }
        part def Cell :> Machine, Mill { part :>> motor; }
    """)
    assert target_name(model, "Cell::motor") == "Mill::motor"


def test_each_name_of_a_chain_is_looked_up_in_the_feature_before_it():
    model = resolve_texts("""
        part def Motor { attribute speed : ScalarValues::Real; }
        part def Gate { part motor : Motor; }
        part hall { part gate : Gate; }
        attribute a :> hall.gate.motor.speed;
    """)
    assert target_name(model, "a") == "Motor::speed"


def test_a_conjugated_port_has_the_members_of_the_port():
    model = resolve_texts("""
        port def Power { in item current; }
        part def Machine { port plug : ~Power; }
        part mill : Machine;
        item a :> mill.plug.current;
    """)
    assert target_name(model, "Machine::plug") == "Power"
    assert target_name(model, "a") == "Power::current"


def test_a_nameless_parameter_has_the_name_of_the_parameter_at_its_position():
    model = resolve_texts("""
        action def Drill { in item part1; out item hole; }
        action work {
            action drill : Drill { in item; out item result; }
            action a :> drill;
            flow from drill.part1 to next.x;
            action next { in item x; }
        }
    """)
    assert model.name(find_element(model, "work::drill").members[0]) == "part1"
    result = find_element(model, "work::drill::result")
    assert model.qualified_name(model.generals(result)[0]) == "Drill::hole"


def test_the_accepted_item_of_a_transition_is_visible_in_its_guard():
    model = resolve_texts("""
        item def Stop { attribute urgent : ScalarValues::Boolean; }
        state def Running {
            state on;
            state off;
            transition first on accept stop : Stop if stop.urgent then off;
        }
    """)
    node = next(
        node
        for document in model.documents
        for node in document.root.walk()
        if node.kind == "FeatureChainExpression"
    )
    assert model.qualified_name(node.relations[0].reference.target) == "Stop::urgent"


def test_a_loop_variable_has_the_members_of_the_collection_elements():
    resolve_texts("""
        part def Pallet { attribute number : ScalarValues::Integer; }
        part def Belt { part pallets : Pallet[0..*]; }
        action work {
            in part belt : Belt;
            for p in belt.pallets { action a { in x = p.number; } }
        }
    """)


def test_a_value_gives_its_members_to_a_feature_without_a_type():
    resolve_texts("""
        part def Motor { attribute speed : ScalarValues::Real; }
        part hall { part motor : Motor; }
        part drive = hall.motor;
        attribute a = drive.speed;
    """)


def test_a_named_argument_is_looked_up_in_the_parameters_of_the_called_element():
    resolve_texts("""
        calc def Time { in distance; in speed; return : ScalarValues::Real; }
        attribute t = Time(speed = 2, distance = 4);
        attribute def Point { attribute x; attribute y; }
        attribute p = new Point(y = 1, x = 2);
    """)
    assert list_name_errors("""
        calc def Time { in distance; return : ScalarValues::Real; }
        attribute t = Time(distanc = 4);
    """) == ["3: unknown name 'distanc': did you mean 'distance'?"]


def test_results_of_functions_bodies_and_casts_have_members():
    resolve_texts("""
        private import ControlFunctions::*;
        private import SequenceFunctions::*;
        part def Pallet { attribute full : ScalarValues::Boolean; part def Slot; }
        part def Belt { part pallets : Pallet[0..*]; }
        part belt : Belt {
            attribute some = pallets->exists {in p : Pallet; p.full};
            attribute head = pallets#(1).full;
            attribute chosen = pallets.?{in p : Pallet; p.full}.full;
            attribute cast = (pallets as Pallet).full;
            attribute number = size(pallets);
        }
    """)


def test_a_cycle_of_specialisations_is_reported_and_lookup_terminates():
    assert list_name_errors("""
        part def Gate :> Door { part a; }
        part def Door :> Gate { part b :> a; }
        part c : Door { part :>> b; part :>> a; }
    """) == ["2: 'Gate' specialises itself through 'Door': remove one specialisation of the cycle"]
    itself = "'Gate' specialises itself: remove one specialisation of the cycle"
    assert list_name_errors("part def Gate :> Gate; part gate : Gate;") == [f"1: {itself}"]
    assert list_name_errors("part gate : Gate; part def Gate :> Gate;") == [f"1: {itself}"]
    assert (
        list_name_errors("""
        part def Gate :> Door { part a; }
        part def Door { part b; }
    """)
        == []
    )
