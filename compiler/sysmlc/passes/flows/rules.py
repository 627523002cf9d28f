"""What can be wrong with connectors and item flows."""

from sysmlc.diagnostics import Severity, rule

FLOW_AGAINST_PORT = rule(
    "SM310",
    "flow-against-port",
    Severity.WARNING,
    "item flow '{flow}' {way} port '{port}', whose direction is {direction}",
    help="turn the item flow round, or conjugate the port",
)
FLOW_ITEM = rule(
    "SM311",
    "flow-item",
    Severity.WARNING,
    "item flow '{flow}' conveys '{item}', which port '{port}' does not pass",
    help="add a flow property of type '{item}' to the port's type, or convey what it passes",
)
FLOW_WITHOUT_END = rule(
    "SM312",
    "flow-without-end",
    Severity.ERROR,
    "item flow '{flow}' has no {end}",
    help="draw the item flow between two ports or parts",
)
FLOW_BESIDE_CONNECTOR = rule(
    "SM313",
    "flow-beside-connector",
    Severity.WARNING,
    "item flow '{flow}' runs over connector '{connector}', which does not join '{end}'",
    help="draw the item flow over the connector between its source and its target",
)
FLOW_OF_NOTHING = rule(
    "SM314",
    "flow-of-nothing",
    Severity.INFO,
    "item flow '{flow}' does not say what it conveys",
    help="name the block, value type or signal that flows",
)
CONNECTOR_DIRECTIONS = rule(
    "SM315",
    "connector-directions",
    Severity.WARNING,
    "connector '{connector}' joins {first} '{one}' with {second} '{other}'",
    help="conjugate one of the ports, or connect another one",
)
CONNECTOR_TYPES = rule(
    "SM316",
    "connector-types",
    Severity.WARNING,
    "connector '{connector}' joins '{one}' of type '{type}' with '{other}' of type '{other_type}'",
    help="type both ports with the same interface block, one of them conjugated",
)
MIXED_DOMAINS = rule(
    "SM317",
    "mixed-domains",
    Severity.WARNING,
    "connector '{connector}' carries physical items ({physical}) and information ({information})",
    help="draw one connector for the material or energy and one for the information",
)
