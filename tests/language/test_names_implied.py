"""Specialisations that the language implies although the text does not state them."""

from small_models import find_element, list_implied_relations, resolve_texts, target_name

from sysmlc.language.names.implied_relations import implied_relations


def test_definitions_and_usages_specialise_the_library_base_of_their_metaclass():
    model = resolve_texts("""
        part def Gate;
        part entrance;
        action def Open;
        port def Power;
        attribute def Speed;
        requirement def Safe;
    """)
    assert list_implied_relations(model, "Gate") == ["Subclassification Parts::Part"]
    assert list_implied_relations(model, "entrance") == ["Subsetting Parts::parts"]
    assert list_implied_relations(model, "Open") == ["Subclassification Actions::Action"]
    assert list_implied_relations(model, "Power") == ["Subclassification Ports::Port"]
    assert list_implied_relations(model, "Speed") == ["Subclassification Base::DataValue"]
    assert list_implied_relations(model, "Safe") == [
        "Subclassification Requirements::RequirementCheck"
    ]


def test_a_base_that_a_general_already_specialises_is_not_implied_again():
    model = resolve_texts("""
        part def Gate;
        part def Big :> Gate;
        part entrance : Big;
    """)
    assert list_implied_relations(model, "Big") == []
    assert model.specializes(find_element(model, "Big"), "Parts::Part")
    assert list_implied_relations(model, "entrance") == ["Subsetting Parts::parts"]


def test_the_base_of_a_usage_depends_on_its_owner():
    model = resolve_texts("""
        part def Plant {
            part gate;
            port power;
            action open { action turn; perform action push; }
            exhibit state running { state on; }
            attribute speed;
            ref part other;
        }
    """)
    assert list_implied_relations(model, "Plant::gate") == ["Subsetting Items::Item::subparts"]
    assert list_implied_relations(model, "Plant::power") == ["Subsetting Parts::Part::ownedPorts"]
    assert list_implied_relations(model, "Plant::open") == ["Subsetting Parts::Part::ownedActions"]
    assert list_implied_relations(model, "Plant::open::turn") == [
        "Subsetting Actions::Action::subactions"
    ]
    assert "Subsetting Parts::Part::exhibitedStates" in list_implied_relations(
        model, "Plant::running"
    )
    assert list_implied_relations(model, "Plant::running::on") == [
        "Subsetting States::StateAction::substates"
    ]
    assert list_implied_relations(model, "Plant::speed") == ["Subsetting Base::dataValues"]
    assert list_implied_relations(model, "Plant::other") == ["Subsetting Parts::parts"]


def test_snapshots_and_time_slices_are_those_of_their_occurrence():
    model = resolve_texts("""
        occurrence def Drive { snapshot arrival; timeslice overtaking; }
        snapshot now;
        timeslice today;
    """)
    bases = {"Drive::arrival": "snapshots", "now": "snapshots"}
    bases |= {"Drive::overtaking": "timeSlices", "today": "timeSlices"}
    for name, base in bases.items():
        relation = f"Subsetting Occurrences::Occurrence::{base}"
        assert relation in list_implied_relations(model, name), name


def test_connections_of_two_ends_are_binary_and_their_ends_redefine_by_position():
    model = resolve_texts("""
        part a;
        part b;
        part c;
        connection two connect a to b;
        connection three connect (a, b, c);
        interface plug connect a to b;
        connection def Wire { end part from1; end part to1; }
    """)
    assert list_implied_relations(model, "two") == ["Subsetting Connections::binaryConnections"]
    assert list_implied_relations(model, "three") == ["Subsetting Connections::connections"]
    assert list_implied_relations(model, "plug") == ["Subsetting Interfaces::binaryInterfaces"]
    assert "Redefinition Connections::BinaryConnection::source" in list_implied_relations(
        model, "Wire::from1"
    )
    assert "Redefinition Connections::BinaryConnection::target" in list_implied_relations(
        model, "Wire::to1"
    )


def test_parameters_results_subjects_and_objectives_redefine_those_of_the_general_element():
    model = resolve_texts("""
        action def Drill { in workpiece; out hole; }
        action drill : Drill { in w; out h; }
        calc def Time { return : ScalarValues::Real; }
        calc def Longer :> Time { return seconds : ScalarValues::Real; }
        requirement def Safe { subject plant; }
        requirement safe : Safe { subject ours; }
        case def Study { objective found; }
        case study : Study { objective ours; }
    """)
    assert list_implied_relations(model, "drill::w")[0] == "Redefinition Drill::workpiece"
    assert list_implied_relations(model, "drill::h")[0] == "Redefinition Drill::hole"
    assert list_implied_relations(model, "Longer::seconds")[0] == "Redefinition Time::result"
    assert list_implied_relations(model, "safe::ours")[0] == "Redefinition Safe::plant"
    assert list_implied_relations(model, "study::ours")[0] == "Redefinition Study::found"


def test_an_explicit_redefinition_replaces_the_one_by_position():
    model = resolve_texts("""
        action def Drill { in workpiece; in tool; }
        action drill : Drill { in bit :>> tool; }
    """)
    assert [
        line for line in list_implied_relations(model, "drill::bit") if "Redefinition" in line
    ] == []
    assert target_name(model, "drill::bit") == "Drill::tool"


def test_control_nodes_and_special_actions_have_their_own_bases():
    model = resolve_texts("""
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
    assert list_implied_relations(model, "work::again") == ["Subsetting Actions::Action::merges"]
    assert list_implied_relations(model, "work::choice") == [
        "Subsetting Actions::Action::decisions"
    ]
    members = {member.kind: member for member in find_element(model, "work").members}
    targets = {
        kind: [str(relation.reference) for relation in implied_relations(model, members[kind])]
        for kind in ("AcceptActionUsage", "SendActionUsage", "WhileLoopActionUsage")
    }
    assert targets["AcceptActionUsage"] == ["Actions::Action::acceptSubactions"]
    assert targets["SendActionUsage"] == ["Actions::Action::sendSubactions"]
    assert targets["WhileLoopActionUsage"] == ["Actions::Action::whileLoops"]


def test_semantic_metadata_implies_its_base_type():
    model = resolve_texts("""
        part def Machine;
        part machines : Machine[0..*];
        metadata def machine :> Metaobjects::SemanticMetadata {
            :>> baseType = machines meta Base::Anything;
        }
        #machine part mill;
        #machine part def Lathe;
        #machine press { attribute power; }
    """)
    assert list_implied_relations(model, "mill") == ["Subsetting machines"]
    assert list_implied_relations(model, "Lathe") == ["Subclassification Machine"]
    assert model.specializes(find_element(model, "press"), find_element(model, "Machine"))


def test_constraints_of_requirements_subset_assumptions_or_required_constraints():
    model = resolve_texts("""
        requirement def Safe {
            assume constraint closed { true }
            require constraint slow { true }
        }
    """)
    assumed = "Subsetting Requirements::RequirementCheck::assumptions"
    assert list_implied_relations(model, "Safe::closed") == [assumed]
    required = "Subsetting Requirements::RequirementCheck::constraints"
    assert list_implied_relations(model, "Safe::slow") == [required]


def test_kerml_classifiers_and_features_have_bases_too():
    model = resolve_texts(
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
    assert list_implied_relations(model, "Gate") == ["Subclassification Occurrences::Occurrence"]
    assert list_implied_relations(model, "Plant") == ["Subclassification Objects::Object"]
    assert list_implied_relations(model, "Open") == ["Subclassification Performances::Performance"]
    assert list_implied_relations(model, "Open::turn") == [
        "Subsetting Performances::Performance::enclosedPerformances"
    ]
    assert list_implied_relations(model, "Wire") == ["Subclassification Links::BinaryLink"]


def test_features_subset_the_library_features_of_their_types():
    model = resolve_texts(
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
    expected = {
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
    for name, targets in expected.items():
        subsettings = [f"Subsetting {target}" for target in targets]
        assert sorted(list_implied_relations(model, name)) == subsettings, name


def test_references_subset_the_library_features_of_their_types():
    model = resolve_texts("""
        part def Gate;
        attribute def Speed;
        part def Plant { ref gate : Gate; ref speed : Speed; in start : Speed; }
    """)
    assert list_implied_relations(model, "Plant::gate") == ["Subsetting Objects::objects"]
    assert list_implied_relations(model, "Plant::speed") == ["Subsetting Base::dataValues"]
    assert list_implied_relations(model, "Plant::start") == ["Subsetting Base::dataValues"]
