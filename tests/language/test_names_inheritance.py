"""Members that come from types, from subsetted and redefined features; effective names."""

from resolving import element, leads, resolved, told


def test_a_feature_has_the_members_of_its_type():
    model = resolved("""
        part def Gate { part motor; }
        part entrance : Gate;
        part drive :> entrance.motor;
    """)
    assert leads(model, "drive") == "Gate::motor"


def test_a_redefinition_is_looked_up_in_what_the_owner_inherits_not_in_the_owner():
    model = resolved("""
        part def Gate { part motor; }
        part def Big :> Gate { part motor :>> motor; }
        part def Twice :> Big { part :>> motor; }
    """)
    assert leads(model, "Big::motor") == "Gate::motor"
    assert leads(model, "Twice::motor") == "Big::motor"


def test_what_is_redefined_is_hidden_by_a_feature_of_another_name():
    assert told("""
        part def Gate { part motor; }
        part def Big :> Gate { part drive :>> motor; }
        part a :> Big::motor;
    """) == ["4: unknown name 'Big::motor': known: drive"]


def test_a_feature_without_a_name_has_that_of_what_it_redefines_or_references():
    model = resolved("""
        action def Drill;
        part def Machine { action drill : Drill; part spindle; }
        part mill : Machine {
            part :>> spindle { part tool; }
            perform Machine::drill;
        }
        part a :> mill.spindle.tool;
        action b :> mill.drill;
    """)
    assert leads(model, "a") == "mill::spindle::tool"
    assert leads(model, "b") == "mill::drill"


def test_of_two_inherited_members_the_more_special_one_is_found():
    model = resolved("""
        part def Machine { part motor; }
        part def Mill :> Machine { part motor :>> Machine::motor; }
        part def Cell :> Machine, Mill { part :>> motor; }
    """)
    assert leads(model, "Cell::motor") == "Mill::motor"


def test_each_link_of_a_chain_is_looked_up_in_what_the_one_before_has():
    model = resolved("""
        part def Motor { attribute speed : ScalarValues::Real; }
        part def Gate { part motor : Motor; }
        part hall { part gate : Gate; }
        attribute a :> hall.gate.motor.speed;
    """)
    assert leads(model, "a") == "Motor::speed"


def test_a_conjugated_port_has_the_members_of_the_port():
    model = resolved("""
        port def Power { in item current; }
        part def Machine { port plug : ~Power; }
        part mill : Machine;
        item a :> mill.plug.current;
    """)
    assert leads(model, "Machine::plug") == "Power"
    assert leads(model, "a") == "Power::current"


def test_parameters_redefine_by_position_so_a_nameless_one_has_the_name_of_the_general():
    model = resolved("""
        action def Drill { in item part1; out item hole; }
        action work {
            action drill : Drill { in item; out item result; }
            action a :> drill;
            flow from drill.part1 to next.x;
            action next { in item x; }
        }
    """)
    assert model.name(element(model, "work::drill").members[0]) == "part1"
    result = element(model, "work::drill::result")
    assert model.qualified_name(model.generals(result)[0]) == "Drill::hole"


def test_what_a_transition_accepts_is_known_in_its_guard_and_effect():
    model = resolved("""
        item def Stop { attribute urgent : ScalarValues::Boolean; }
        state def Running {
            state on;
            state off;
            transition first on accept stop : Stop if stop.urgent then off;
        }
    """)
    node = next(
        n for d in model.documents for n in d.root.walk() if n.kind == "FeatureChainExpression"
    )
    assert model.qualified_name(node.relations[0].reference.target) == "Stop::urgent"


def test_a_loop_variable_has_the_members_of_what_is_looped_over():
    resolved("""
        part def Pallet { attribute number : ScalarValues::Integer; }
        part def Belt { part pallets : Pallet[0..*]; }
        action work {
            in part belt : Belt;
            for p in belt.pallets { action a { in x = p.number; } }
        }
    """)


def test_a_value_gives_its_members_to_a_feature_without_a_type():
    resolved("""
        part def Motor { attribute speed : ScalarValues::Real; }
        part hall { part motor : Motor; }
        part drive = hall.motor;
        attribute a = drive.speed;
    """)


def test_arguments_are_named_by_the_parameters_of_what_is_called():
    resolved("""
        calc def Time { in distance; in speed; return : ScalarValues::Real; }
        attribute t = Time(speed = 2, distance = 4);
        attribute def Point { attribute x; attribute y; }
        attribute p = new Point(y = 1, x = 2);
    """)
    assert told("""
        calc def Time { in distance; return : ScalarValues::Real; }
        attribute t = Time(distanc = 4);
    """) == ["3: unknown name 'distanc': did you mean 'distance'?"]


def test_functions_bodies_and_casts_give_results_with_members():
    resolved("""
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


def test_elements_that_specialise_themselves_are_told_and_nothing_hangs():
    assert told("""
        part def Gate :> Door { part a; }
        part def Door :> Gate { part b :> a; }
        part c : Door { part :>> b; part :>> a; }
    """) == ["2: 'Gate' specialises itself through 'Door': remove one specialisation of the cycle"]
    itself = "'Gate' specialises itself: remove one specialisation of the cycle"
    assert told("part def Gate :> Gate; part gate : Gate;") == [f"1: {itself}"]
    assert told("part gate : Gate; part def Gate :> Gate;") == [f"1: {itself}"]
    assert (
        told("""
        part def Gate :> Door { part a; }
        part def Door { part b; }
    """)
        == []
    )
