"""Check that contracts can be derived from all constructs of a state machine.

The check runs before the machine is read, so that a diagnostic names every unsupported construct.
"""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, list_items

NOT_DERIVED = rule(
    "SM420",
    "construct-not-derived",
    Severity.WARNING,
    "{what} of state machine '{machine}' is not derived; the component gets no contract",
    help="remove it, draw it with other states and pseudostates, or do without a contract",
)


JOIN_BESIDE = rule(
    "SM507",
    "join-beside-completion",
    Severity.WARNING,
    "'{state}' of state machine '{machine}' completes along '{other}' before its join can wait; "
    "the component gets no contract",
    help=(
        "give one of the two transitions a trigger or a guard behind a choice, or join a state "
        "that only waits"
    ),
)
NO_INITIAL = rule(
    "SM421",
    "region-without-initial",
    Severity.ERROR,
    "region '{region}' of '{owner}' {fault}",
    help="give the region one initial pseudostate with one transition to its first state",
)
DANGLING = rule(
    "SM423",
    "transition-without-end",
    Severity.ERROR,
    "transition '{transition}' has no {end}",
)

_SUPPORTED_PSEUDOSTATES = frozenset(
    [
        *("initial", "choice", "junction", "fork", "join", "shallow-history", "deep-history"),
        *("entry-point", "exit-point", "connection-point"),
    ]
)
_REDEFINABLE = frozenset([Kind.STATE_MACHINE, Kind.REGION, Kind.STATE, Kind.TRANSITION])


def is_supported(graph: Graph, machine: Element, sink: Sink) -> bool:
    """Whether a contract can be derived from the machine; report unsupported constructs."""
    elements = [
        element for owner in collect_submachines(graph, machine) for element in graph.subtree(owner)
    ]
    descriptions = (
        (element, _describe_unsupported(graph, element) or _describe_recursion(graph, element))
        for element in elements
    )
    unsupported = [(element, description) for element, description in descriptions if description]
    broken = [element for element in elements if _is_broken(graph, machine, element, sink)]
    for element, description in unsupported:
        # The finding about a region that cannot start counts its initial pseudostates.
        if element.subkind != "initial" or graph.owner(element) not in broken:
            sink.report(NOT_DERIVED, graph.subject(element), what=description, machine=machine.name)
    return not unsupported and not broken


def collect_submachines(graph: Graph, machine: Element) -> list[Element]:
    """Return the machine and the submachines of its states, transitively."""
    # The loop also visits the machines that its body appends. Each is appended once, so that a
    # submachine that contains itself does not loop; ``_describe_recursion`` reports it.
    machines = [machine]
    for member in machines:
        for element in graph.subtree(member):
            submachine = find_submachine(graph, element)
            if submachine is not None and submachine not in machines:
                machines.append(submachine)
    return machines


def find_submachine(graph: Graph, state: Element) -> Element | None:
    """Return the state machine that *state* uses, if the model defines it."""
    if state.kind is not Kind.STATE:
        return None
    machine = graph.target(state, Edge.CALLS)
    if machine is None or machine.kind is not Kind.STATE_MACHINE or machine.attrs.get("external"):
        return None
    return machine


def list_behaviours(graph: Graph, element: Element, edge: Edge) -> list[Element]:
    """Return the entry, do or exit behaviours, or effects, of a machine, state or transition.

    The behaviours of a submachine go before those of the state that uses it.
    """
    submachine = find_submachine(graph, element)
    inner = [] if submachine is None else graph.targets(submachine, edge)
    return [*inner, *graph.targets(element, edge)]


def _describe_recursion(graph: Graph, state: Element) -> str:
    """Describe a submachine state whose submachine contains the state; "" for other elements."""
    submachine = find_submachine(graph, state)
    if submachine is None or submachine not in _enclosing_machines(graph, state):
        return ""
    return f"submachine state '{state.name}', in which '{submachine.name}' contains itself,"


def _enclosing_machines(graph: Graph, state: Element) -> list[Element]:
    """Return the state machines that contain *state*, directly or through submachine states."""
    machines: list[Element] = []
    states = [state]
    for user in states:
        for machine in graph.ancestors(user):
            if machine.kind is Kind.STATE_MACHINE and machine not in machines:
                machines.append(machine)
                states += (s for s in graph.sources(machine, Edge.CALLS) if s.kind is Kind.STATE)
    return machines


def _describe_unsupported(graph: Graph, element: Element) -> str:
    """Describe an element that prevents a contract; return an empty text for supported elements."""
    if element.kind is Kind.PSEUDOSTATE:
        return _describe_unsupported_pseudostate(graph, element)
    if element.kind in _REDEFINABLE and _starts_redefinition(graph, element):
        return f"the redefinition or extension by '{element.name or element.kind}'"
    if element.kind is not Kind.STATE:
        return ""
    if any(child.kind is Kind.TRIGGER for child in graph.owned(element)):
        return f"the deferral of events in state '{element.name}'"
    is_submachine = "submachine" in element.attrs or any(
        target.kind is Kind.STATE_MACHINE
        for edge in (Edge.CALLS, Edge.TYPED_BY, Edge.REFERENCES)
        for target in graph.targets(element, edge)
    )
    is_readable = find_submachine(graph, element) is not None
    return f"submachine state '{element.name}'" if is_submachine and not is_readable else ""


def _starts_redefinition(graph: Graph, element: Element) -> bool:
    """Whether the element redefines another one, and no element around it does."""
    return bool(graph.targets(element, Edge.REDEFINES)) and not any(
        graph.targets(owner, Edge.REDEFINES)
        for owner in graph.ancestors(element)
        if owner.kind in _REDEFINABLE
    )


def _describe_unsupported_pseudostate(graph: Graph, element: Element) -> str:
    if element.subkind not in _SUPPORTED_PSEUDOSTATES:
        name = f" '{element.name}'" if element.name else ""
        return f"{element.subkind or 'unknown'} pseudostate{name}"
    if element.subkind == "connection-point" and len(graph.targets(element, Edge.REFERENCES)) != 1:
        return f"the connection point '{element.name}' that stands for no one point"
    region = graph.owner(element)
    is_second = region is not None and find_initial(graph, region) not in (None, element)
    if element.subkind == "initial" and is_second:
        return f"the second initial pseudostate '{element.name}'"
    return ""


def _is_broken(graph: Graph, machine: Element, element: Element, sink: Sink) -> bool:
    """Whether the element lacks a mandatory part, and report it.

    A region of the machine needs an initial pseudostate, and a transition needs both ends.
    """
    if element.kind is Kind.REGION:
        fault = _explain_bad_start(graph, machine, element)
        if fault:
            report_bad_start(graph, element, fault, sink)
        return bool(fault)
    if element.kind is not Kind.TRANSITION:
        return False
    ends = {
        "source": graph.target(element, Edge.FLOW_SOURCE),
        "target": graph.target(element, Edge.FLOW_TARGET),
    }
    # References to missing elements were reported when they were resolved.
    reported = list_items(element.attrs.get("unresolved"))
    for end, vertex in ends.items():
        if vertex is None and f"flow-{end}" not in reported:
            name = element.name or "<Transition>"
            sink.report(DANGLING, graph.subject(element), transition=name, end=end)
    return None in ends.values()


def _explain_bad_start(graph: Graph, machine: Element, region: Element) -> str:
    """Return why the region cannot start, or an empty text.

    Nested regions without initial pseudostate are correct unless a transition enters them by
    default, which ``well_formedness`` decides for the complete machine.
    """
    initial = find_initial(graph, region)
    starts = [] if initial is None else graph.sources(initial, Edge.FLOW_SOURCE)
    if len(starts) > 1:
        initials = _count_initials(graph, region)
        return f"has {initials} with {len(starts)} outgoing transitions; UML allows one"
    has_states = any(v.kind in (Kind.STATE, Kind.FINAL_STATE) for v in graph.owned(region))
    # A region that extends another one has the initial pseudostate of that one (14.3.3.1).
    is_extension = bool(graph.targets(region, Edge.REDEFINES))
    if starts or is_extension or not has_states or graph.owner(region) is not machine:
        return ""
    return f"{describe_missing_start(graph, region)}, but the machine starts there"


def describe_missing_start(graph: Graph, region: Element) -> str:
    """Describe what a region without initial transition lacks."""
    if find_initial(graph, region) is None:
        return "has no initial pseudostate"
    return f"has {_count_initials(graph, region)} without outgoing transition"


def _count_initials(graph: Graph, region: Element) -> str:
    number = sum(vertex.subkind == "initial" for vertex in graph.owned(region))
    return "an initial pseudostate" if number == 1 else f"{number} initial pseudostates, the first"


def report_bad_start(graph: Graph, region: Element, fault: str, sink: Sink) -> None:
    """Report a region that cannot start."""
    owner = graph.owner(region) or region
    name = region.name or "<Region>"
    sink.report(NO_INITIAL, graph.subject(region), region=name, owner=owner.name, fault=fault)


def find_initial(graph: Graph, region: Element) -> Element | None:
    """Return the first initial pseudostate of *region*, or the entry point that replaces it.

    A region of a machine without initial pseudostate starts at the machine's only entry point, if
    that leads into this region and no other.
    """
    owned = graph.owned(region)
    initial = next((vertex for vertex in owned if vertex.subkind == "initial"), None)
    owner = graph.owner(region)
    if initial is not None or owner is None or owner.kind is not Kind.STATE_MACHINE:
        return initial
    points = [point for point in graph.owned(owner) if point.subkind == "entry-point"]
    starts = graph.sources(points[0], Edge.FLOW_SOURCE) if len(points) == 1 else []
    return points[0] if [graph.owner(start) for start in starts] == [region] else None
