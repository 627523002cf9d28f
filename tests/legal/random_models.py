"""Small random models of UML and SysML v1 that the standards allow."""

from random import Random

from legal import actions, activities, concepts, connections, interactions, machines, structure
from legal.draft import Draft

TOPICS = (
    structure.add_packages,
    structure.add_features,
    structure.add_defaults,
    structure.add_associations,
    structure.add_generalisations,
    structure.add_value_types,
    structure.add_operations,
    connections.add_ports,
    connections.add_nested_connector,
    connections.add_constraint_block,
    connections.add_collaboration,
    connections.add_information_flows,
    concepts.add_requirements,
    concepts.add_use_cases,
    concepts.add_instances,
    concepts.add_deployment,
    concepts.add_templates,
    concepts.add_dependencies,
    concepts.add_profile,
    concepts.add_views,
    machines.add_composite_state,
    machines.add_orthogonal_state,
    machines.add_histories,
    machines.add_branches,
    machines.add_entry_and_exit_points,
    machines.add_submachine,
    machines.add_protocol,
    machines.add_extended_machine,
    activities.add_control,
    activities.add_object_flows,
    activities.add_decision_on_objects,
    activities.add_partitions,
    activities.add_interruption,
    activities.add_structured_nodes,
    activities.add_expansion,
    actions.add_calls,
    actions.add_signals,
    actions.add_call_events,
    actions.add_features,
    actions.add_objects,
    actions.add_links,
    actions.add_variables,
    interactions.add_messages,
    interactions.add_fragments,
    interactions.add_uses,
    interactions.add_times,
)


def draw_model(random: Random) -> bytes:
    """Return a model of one to four random topics, as Papyrus saves it."""
    draft = Draft(random)
    for add_topic in random.sample(TOPICS, random.randint(1, 4)):
        add_topic(draft)
    draft.document.apply_sysml()
    return draft.document.as_bytes()
