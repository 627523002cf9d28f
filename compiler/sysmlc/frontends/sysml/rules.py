"""Rules of the front end for SysML v2, and severities of shared rules in SysML v2 text."""

from collections.abc import Sequence

from sysmlc.diagnostics import Severity, Sink, Wording, rule
from sysmlc.language.tree import Document

UNSUPPORTED = rule(
    "SM480",
    "v2-unsupported",
    Severity.WARNING,
    "{type} is not read ({count} in the unit, with all that they own)",
    help="the outputs do not contain it; 'sysmlc coverage' lists each element",
)
APPROXIMATED = rule(
    "SM481",
    "v2-approximated",
    Severity.INFO,
    "{loss} ({count} in the unit)",
    help="'sysmlc coverage' lists each element",
)
NOT_IN_GRAPH = rule(
    "SM482",
    "v2-refers-to-unread",
    Severity.WARNING,
    "the reference to '{name}' is lost: {type} is not read",
    help="the outputs do not contain it; 'sysmlc coverage' lists the elements that are not read",
)
NO_LIBRARY = rule(
    "SM484",
    "v2-no-library",
    Severity.ERROR,
    "the standard library '{path}' cannot be read: {problem}",
    help="give --library the folder or .kpar with the .sysml and .kerml files",
)

_CHECKED_BY_LANGUAGE = """
    SM200 SM201 SM202 SM203 SM204 SM211 SM212 SM213 SM214 SM301 SM312 SM314 SM318 SM400 SM401 SM402
    SM404 SM460 SM469
"""
"""Rules for SysML v1 that do not apply to SysML v2 text.

The checks of the language report faults of names, specialisation, types and relations by rules of
their own. Requirements need no short name, ports no type and flows no payload. An action without
steps is complete. A usage has the parameters that it does not repeat; SM248 and SM249 report
surplus arguments and parameters. An action may subset any action. A redefinition has all of its
types. A flow need not state its ends, and SM482 reports the ends of successions that are not part
of the graph.
"""
_WEAKER_CONTRACT = "SM412 SM413 SM414 SM415 SM421"
"""Rules for constructs that are valid SysML v2 but lose part of the contract.

The language resolves names and types of expressions, values need not be finite, and a state with
substates needs no entry transition.
"""

SEVERITIES: dict[str, Severity | None] = {
    **dict.fromkeys(_CHECKED_BY_LANGUAGE.split(), None),
    **dict.fromkeys(_WEAKER_CONTRACT.split(), Severity.WARNING),
    # Actions without successions are correct SysML v2: their order is not stated.
    "SM486": Severity.INFO,
}


WORDINGS = {
    "SM300": Wording("", "say what flows through the ports, such as 'in item part : Part;'"),
    "SM310": Wording(
        "flow '{flow}' {way} port '{port}', whose direction is {direction}",
        "reverse the flow, or conjugate the type of the port (~)",
    ),
    "SM410": Wording(
        "",
        "write 'assert constraint {{ {name} >= {low} and {name} <= {high} }}'",
    ),
    "SM412": Wording(
        "{what} '{text}' reads '{name}', which is not a property of {context} itself; the contract "
        "treats the condition as an input",
        "pass the value to {context}, by a property or a signal, for a contract about it",
    ),
    "SM421": Wording(
        "state '{owner}' has substates, but no entry transition to the first of them",
        "write 'entry; then <substate>;' into the state",
    ),
    "SM450": Wording(
        "action '{activity}' has no first step: a succession leads to each of its steps",
        "write 'first start then <step>;'",
    ),
    "SM451": Wording(
        "action '{activity}' starts with several actions at once: {actions}",
        "write 'first <action> then <action>;' if only one of them is meant to start",
    ),
    "SM458": Wording(
        "", "use properties of the action, or of the part that performs it, for a contract"
    ),
    "SM464": Wording(
        "parameter '{pin}' of {node} gets no value; it is taken as available",
        "bind the parameter, or let a flow lead to it",
    ),
    "SM466": Wording(
        "action '{activity}' never finishes",
        "let a succession lead to 'done' if it is meant to end",
    ),
    "SM486": Wording(
        "action '{activity}' does not order its steps; it gets no contract",
        "order the steps with 'first <step> then <step>;'",
    ),
}
"""Texts of shared rules in the words of SysML v2, which has no initial nodes, pins and regions."""


def adapt_shared_rules(documents: Sequence[Document], sink: Sink) -> None:
    """Give the shared rules the severities and texts of SysML v2 in these documents."""
    paths = [document.path for document in documents]
    sink.set_file_severities(paths, SEVERITIES)
    sink.set_file_wordings(paths, WORDINGS)
