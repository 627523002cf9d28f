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
    SM200 SM201 SM202 SM203 SM204 SM211 SM212 SM213 SM214 SM246 SM247 SM301 SM312 SM314 SM318
    SM400 SM401 SM402 SM404 SM460 SM469
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


_CAPABILITY = "dependency from <service> to <machine> {{ @Capability {{ duration = 9 [SI::s]; }} }}"
_LOOP = "write 'decide d {{ @Loop {{ maxIterations = 3; }} }}' for the decision"

WORDINGS = {
    "SM300": Wording("", "say what flows through the ports, such as 'in item part : Part;'"),
    "SM303": Wording(
        "port '{port}' has multiplicity {multiplicity}, so that nothing has it",
        "remove the port, or allow at least one",
    ),
    "SM310": Wording(
        "flow '{flow}' {way} port '{port}', whose direction is {direction}",
        "reverse the flow, or conjugate the type of the port (~)",
    ),
    "SM311": Wording(
        "flow '{flow}' conveys '{item}', which port '{port}' does not pass",
        "declare an item of type '{item}' in the port definition, or convey what it passes",
    ),
    "SM315": Wording(
        "connection '{connector}' joins {first} '{one}' with {second} '{other}'",
        "conjugate the type of one of the ports (~), choose another type for it, or connect "
        "another port",
    ),
    "SM316": Wording(
        "connection '{connector}' joins '{one}' of type '{type}' with '{other}' of type "
        "'{other_type}'",
        "type both ports by the same port definition, one of them conjugated (~)",
    ),
    "SM317": Wording(
        "connection '{connector}' carries physical items ({physical}) and information "
        "({information})",
        "write one connection for the material or energy and one for the information",
    ),
    "SM347": Wording(
        "connection '{connector}' joins '{one}' with '{other}', but nothing that leaves one of "
        "them can enter the other",
        "conjugate the type of one of the ports (~), or choose another type for it",
    ),
    "SM410": Wording(
        "attribute '{name}' has no range; {range} is assumed",
        "write 'assert constraint {{ {name} >= {low} and {name} <= {high} }}'",
    ),
    "SM412": Wording(
        "{what} '{text}' reads '{name}', which is no feature of {context} itself; the contract "
        "treats the condition as an input",
        "pass the value to {context}, by an attribute or a signal, for a contract about it",
    ),
    "SM414": Wording("", "correct the value or the range of the attribute"),
    "SM420": Wording(
        "", "remove it, write it with other states and transitions, or do without a contract"
    ),
    "SM421": Wording(
        "state '{owner}' has substates, but no entry transition to the first of them",
        "write 'entry; then <substate>;' into the state",
    ),
    "SM424": Wording(
        "'{vertex}' leads back to itself without a state between", "put a state into the cycle"
    ),
    "SM426": Wording(
        "'{first}' and '{second}' of parallel states can both assign '{variable}' in one step; the "
        "component gets no contract",
        "assign it in one of the states only, or on different events",
    ),
    "SM427": Wording(
        "'{first}' leaves a parallel state while {others} can be taken in another of its states; "
        "the component gets no contract",
        "let the transition start at the parallel state, or use another event",
    ),
    "SM428": Wording(
        "", "test the value before the assignment, or give the attribute a wider range"
    ),
    "SM431": Wording("", "let the transition end at a state that it may reach"),
    "SM433": Wording(
        "default value '{default}' of attribute '{name}' is not in {domain}",
        "correct the default value or the range",
    ),
    "SM450": Wording(
        "action '{activity}' has no first step: a succession leads to each of its steps",
        "write 'first start then <step>;'",
    ),
    "SM451": Wording(
        "action '{activity}' starts with several actions at once: {actions}",
        "write 'first <action> then <action>;' if only one of them is meant to start",
    ),
    "SM454": Wording(
        "{flow} may get a second token while it still holds one; the action gets no contract",
        "bring parallel branches together in a 'join'",
    ),
    "SM455": Wording(
        "action '{activity}' has too many markings to search (at most {limit}); whether each "
        "succession holds at most one token was not decided, so that it gets no contract",
        "move steps into actions of their own, or raise the limit (option max_markings of the "
        "pass activities)",
    ),
    "SM458": Wording(
        "", "use attributes of the action, or of the part that performs it, for a contract"
    ),
    "SM464": Wording(
        "parameter '{pin}' of {node} gets no value; it is taken as available",
        "bind the parameter, or let a flow lead to it",
    ),
    "SM466": Wording(
        "action '{activity}' never finishes",
        "let a succession lead to 'done' if it is meant to end",
    ),
    "SM468": Wording("", "put a 'decide' before the succession and say what happens else"),
    "SM472": Wording("", "let the succession lead to a 'merge' after 'start', or delete it"),
    "SM479": Wording(
        "loops and conditions of action '{activity}' are nested more than {limit} deep; it gets no "
        "contract",
        "move what is inside into actions of their own, or raise the limit (option max_depth of "
        "the pass activities)",
    ),
    "SM483": Wording(
        "", "to choose another level, set it in [recipe.levels] or specialise RecipeLevels"
    ),
    "SM486": Wording(
        "action '{activity}' does not order its steps; it gets no contract",
        "order the steps with 'first <step> then <step>;'",
    ),
    "SM502": Wording(
        "",
        "let '{component}' exhibit a state or perform an action, or move the formula to a "
        "component that does",
    ),
    "SM504": Wording(
        "",
        "let its transitions lead to, or from, states in different states of one parallel state, "
        "without guards and triggers",
    ),
    "SM520": Wording("", "give the attributes smaller ranges"),
    "SM526": Wording("", "connect the parts, or name them in the flow"),
    "SM545": Wording("", "correct the name, or declare an attribute of that name"),
    "SM601": Wording(
        "", "let '{missing}' specialise RecipeLevels::Machine, or relate '{user}' to a machine"
    ),
    "SM604": Wording(
        "",
        "let a 'decide' leave the cycle; join all branches of a fork, and merge those of a "
        "'decide'",
    ),
    "SM605": Wording(
        "", "write guards that exclude one another, and 'else': if ok then a; else b;"
    ),
    "SM606": Wording(
        "",
        "declare an attribute of that name in the action, with a value when it is read before it "
        "is set",
    ),
    "SM607": Wording("", f"write '{_CAPABILITY}' for each service, or for the task"),
    "SM609": Wording(
        "",
        "correct the duration of a function, or of @Capability of the dependency from '{service}' "
        "to '{machine}'",
    ),
    "SM614": Wording(
        "", "let it specialise its level of RecipeLevels, so that the model states it"
    ),
    "SM615": Wording("", "write loops and choices with 'decide' and 'merge'"),
    "SM619": Wording(
        "'{element}' is not refined, and the action '{other}' has the same name",
        "to refine it, type the step by the action: action step : {other};",
    ),
    "SM620": Wording("", _LOOP),
    "SM621": Wording("", "perform tasks in the action: action step : SomeTask;"),
    "SM622": Wording(
        "'{tag}' of {stereotype} on '{element}' is '{value}', but must be {expected}; it is "
        "ignored",
        "correct the value",
    ),
    "SM642": Wording("", f"{_LOOP}, or state the missing duration"),
    "SM643": Wording(
        "'{tag}' of {stereotype} on '{element}' is '{value}', but {problem}", "{advice}"
    ),
    "SM644": Wording(
        "'{tag}' of {stereotype} on '{element}' is '{value}': the size of unit '{unit}' is "
        "unknown, and the value is ignored",
        "write the value in a usual unit, such as 9 [SI::s] or 2 [SI::kW], or give the unit a "
        "unitConversion whose conversionFactor is a number",
    ),
    "SM652": Wording(
        "'{tag}' of {stereotype} on '{element}' is '{value}', more than {limit}{unit}, the largest "
        "number that recipes store exactly",
        "correct the value, or leave it out if there is no limit",
    ),
    "SM653": Wording(
        "'{low}' of {stereotype} on '{element}' is {minimum}, more than '{high}', which is "
        "{maximum}",
        "exchange the two values, or correct one of them",
    ),
    "SM649": Wording("", "correct maxIterations of @Loop, or the guards"),
    "SM650": Wording("", "correct the duration of @Capability of the task or of a service"),
    "SM651": Wording("", f"state its duration at the service, or write '{_CAPABILITY}'"),
    "SM715": Wording("", "write 'satisfy <requirement> by <part>;'"),
    "SM716": Wording("", "write 'objective {{ verify <requirement>; }}' into a verification"),
}
"""Texts of shared rules in the words of SysML v2, which has no initial nodes, pins and regions."""


def adapt_shared_rules(documents: Sequence[Document], sink: Sink) -> None:
    """Give the shared rules the severities and texts of SysML v2 in these documents."""
    paths = [document.path for document in documents]
    sink.set_file_severities(paths, SEVERITIES)
    sink.set_file_wordings(paths, WORDINGS)
