"""What elements specialise though their text does not say so."""

from resolving import element, implied, leads, resolved

from sysmlc.language.names.implied_relations import implied_relations


def test_definitions_and_usages_have_the_bases_of_their_metaclass():
    model = resolved("""
        part def Gate;
        part entrance;
        action def Open;
        port def Power;
        attribute def Speed;
        requirement def Safe;
    """)
    assert implied(model, "Gate") == ["Subclassification Parts::Part"]
    assert implied(model, "entrance") == ["Subsetting Parts::parts"]
    assert implied(model, "Open") == ["Subclassification Actions::Action"]
    assert implied(model, "Power") == ["Subclassification Ports::Port"]
    assert implied(model, "Speed") == ["Subclassification Base::DataValue"]
    assert implied(model, "Safe") == ["Subclassification Requirements::RequirementCheck"]


def test_what_a_general_already_specialises_is_not_said_again():
    model = resolved("""
        part def Gate;
        part def Big :> Gate;
        part entrance : Big;
    """)
    assert implied(model, "Big") == []
    assert model.specializes(element(model, "Big"), "Parts::Part")
    assert implied(model, "entrance") == ["Subsetting Parts::parts"]


def test_where_a_usage_is_decides_what_it_specialises():
    model = resolved("""
        part def Plant {
            part gate;
            port power;
            action open { action turn; perform action push; }
            exhibit state running { state on; }
            attribute speed;
            ref part other;
        }
    """)
    assert implied(model, "Plant::gate") == ["Subsetting Items::Item::subparts"]
    assert implied(model, "Plant::power") == ["Subsetting Parts::Part::ownedPorts"]
    assert implied(model, "Plant::open") == ["Subsetting Parts::Part::ownedActions"]
    assert implied(model, "Plant::open::turn") == ["Subsetting Actions::Action::subactions"]
    assert "Subsetting Parts::Part::exhibitedStates" in implied(model, "Plant::running")
    assert implied(model, "Plant::running::on") == ["Subsetting States::StateAction::substates"]
    assert implied(model, "Plant::speed") == ["Subsetting Base::dataValues"]
    assert implied(model, "Plant::other") == ["Subsetting Parts::parts"]


def test_connections_of_two_ends_are_binary_and_their_ends_redefine_by_position():
    model = resolved("""
        part a;
        part b;
        part c;
        connection two connect a to b;
        connection three connect (a, b, c);
        interface plug connect a to b;
        connection def Wire { end part from1; end part to1; }
    """)
    assert implied(model, "two") == ["Subsetting Connections::binaryConnections"]
    assert implied(model, "three") == ["Subsetting Connections::connections"]
    assert implied(model, "plug") == ["Subsetting Interfaces::binaryInterfaces"]
    assert "Redefinition Connections::BinaryConnection::source" in implied(model, "Wire::from1")
    assert "Redefinition Connections::BinaryConnection::target" in implied(model, "Wire::to1")


def test_parameters_results_subjects_and_objectives_redefine_those_of_the_general():
    model = resolved("""
        action def Drill { in workpiece; out hole; }
        action drill : Drill { in w; out h; }
        calc def Time { return : ScalarValues::Real; }
        calc def Longer :> Time { return seconds : ScalarValues::Real; }
        requirement def Safe { subject plant; }
        requirement safe : Safe { subject ours; }
        case def Study { objective found; }
        case study : Study { objective ours; }
    """)
    assert implied(model, "drill::w")[0] == "Redefinition Drill::workpiece"
    assert implied(model, "drill::h")[0] == "Redefinition Drill::hole"
    assert implied(model, "Longer::seconds")[0] == "Redefinition Time::result"
    assert implied(model, "safe::ours")[0] == "Redefinition Safe::plant"
    assert implied(model, "study::ours")[0] == "Redefinition Study::found"


def test_a_written_redefinition_leaves_no_room_for_one_by_position():
    model = resolved("""
        action def Drill { in workpiece; in tool; }
        action drill : Drill { in bit :>> tool; }
    """)
    assert [line for line in implied(model, "drill::bit") if "Redefinition" in line] == []
    assert leads(model, "drill::bit") == "Drill::tool"


def test_control_nodes_and_special_actions_have_their_own_bases():
    model = resolved("""
        item def Call;
        action work {
            first start;
            then merge again;
            then accept c : Call;
            then send new Call() to other;
            then decide choice;
            if true then again;
            else other;
            action other;
            while true { action a; }
        }
    """)
    assert implied(model, "work::again") == ["Subsetting Actions::Action::merges"]
    assert implied(model, "work::choice") == ["Subsetting Actions::Action::decisions"]
    kinds = {member.kind: member for member in element(model, "work").members}
    lines = {
        kind: [str(r.reference) for r in implied_relations(model, kinds[kind])]
        for kind in ("AcceptActionUsage", "SendActionUsage", "WhileLoopActionUsage")
    }
    assert lines["AcceptActionUsage"] == ["Actions::Action::acceptSubactions"]
    assert lines["SendActionUsage"] == ["Actions::Action::sendSubactions"]
    assert lines["WhileLoopActionUsage"] == ["Actions::Action::whileLoops"]


def test_semantic_metadata_gives_its_base_type():
    model = resolved("""
        part def Machine;
        part machines : Machine[0..*];
        metadata def machine :> Metaobjects::SemanticMetadata {
            :>> baseType = machines meta Base::Anything;
        }
        #machine part mill;
        #machine part def Lathe;
        #machine press { attribute power; }
    """)
    assert implied(model, "mill") == ["Subsetting machines"]
    assert implied(model, "Lathe") == ["Subclassification Machine"]
    assert model.specializes(element(model, "press"), element(model, "Machine"))


def test_constraints_of_requirements_are_assumptions_or_required():
    model = resolved("""
        requirement def Safe {
            assume constraint closed { true }
            require constraint slow { true }
        }
    """)
    assumed = "Subsetting Requirements::RequirementCheck::assumptions"
    assert implied(model, "Safe::closed") == [assumed]
    required = "Subsetting Requirements::RequirementCheck::constraints"
    assert implied(model, "Safe::slow") == [required]


def test_kerml_classifiers_and_features_have_bases_too():
    model = resolved(
        """
        class Gate;
        struct Plant { composite feature gate : Gate; }
        behavior Open { step turn; }
        datatype Speed;
        feature speed : Speed;
        assoc Wire { end feature a : Gate; end feature b : Gate; }
        """,
        language="kerml",
    )
    assert implied(model, "Gate") == ["Subclassification Occurrences::Occurrence"]
    assert implied(model, "Plant") == ["Subclassification Objects::Object"]
    assert implied(model, "Open") == ["Subclassification Performances::Performance"]
    assert implied(model, "Open::turn") == [
        "Subsetting Performances::Performance::enclosedPerformances"
    ]
    assert implied(model, "Wire") == ["Subclassification Links::BinaryLink"]


def test_features_specialise_what_all_of_their_types_have():
    model = resolved(
        """
        class Gate;
        struct Plant;
        datatype Speed;
        feature gate : Gate;
        feature plant : Plant;
        feature speed : Speed;
        class Yard { composite feature gate : Gate; composite feature plant : Plant; }
        struct Site {
            composite feature gate : Gate;
            composite feature plant : Plant;
            portion feature morning : Site;
            feature other : Plant;
            feature same : Plant subsets other;
        }
        feature site : Site { composite feature hall : Plant; }
        """,
        language="kerml",
    )
    said = {
        "gate": ["Occurrences::occurrences"],
        "plant": ["Objects::objects"],
        "speed": ["Base::dataValues"],
        "Yard::gate": ["Occurrences::Occurrence::suboccurrences"],
        "Yard::plant": ["Objects::objects", "Occurrences::Occurrence::suboccurrences"],
        "Site::gate": ["Occurrences::Occurrence::suboccurrences"],
        "Site::plant": ["Objects::Object::subobjects"],
        "Site::morning": ["Objects::objects", "Occurrences::Occurrence::portions"],
        "Site::other": ["Objects::objects"],
        "Site::same": [],
        "site::hall": ["Objects::Object::subobjects"],
    }
    made = {name: sorted(implied(model, name)) for name in said}
    assert made == {name: [f"Subsetting {one}" for one in ones] for name, ones in said.items()}


def test_references_specialise_what_all_of_their_types_have():
    model = resolved("""
        part def Gate;
        attribute def Speed;
        part def Plant { ref gate : Gate; ref speed : Speed; in start : Speed; }
    """)
    assert implied(model, "Plant::gate") == ["Subsetting Objects::objects"]
    assert implied(model, "Plant::speed") == ["Subsetting Base::dataValues"]
    assert implied(model, "Plant::start") == ["Subsetting Base::dataValues"]
