"""What of a state machine can be derived at all; the rest is named before anything is read."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind

NOT_DERIVED = rule(
    "SM420",
    "construct-not-derived",
    Severity.WARNING,
    "{what} of state machine '{machine}' is not derived; the component gets no contract",
    help="draw it with states and pseudostates, or leave the machine without contract",
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
    "region '{region}' of '{owner}' has no initial pseudostate with one transition",
    help="add an initial pseudostate and a transition from it",
)
DANGLING = rule(
    "SM423",
    "transition-without-end",
    Severity.ERROR,
    "transition '{transition}' has no {end}",
)

_PSEUDO = frozenset(
    [
        *("initial", "choice", "junction", "fork", "join", "shallow-history", "deep-history"),
        *("entry-point", "exit-point", "connection-point"),
    ]
)
_REDEFINABLE = frozenset([Kind.STATE_MACHINE, Kind.REGION, Kind.STATE, Kind.TRANSITION])


def is_supported(graph: Graph, machine: Element, sink: Sink) -> bool:
    """Whether all of the machine can be derived; what cannot is reported."""
    drawn = [one for each in _with_submachines(graph, machine) for one in graph.subtree(each)]
    missing = [
        (element, what)
        for element in drawn
        for what in [_unsupported(graph, element) or _endless(graph, element)]
        if what
    ]
    for element, what in missing:
        sink.report(NOT_DERIVED, graph.subject(element), what=what, machine=machine.name)
    broken = [_is_broken(graph, element, sink) for element in drawn]
    return not missing and not any(broken)


def _with_submachines(graph: Graph, machine: Element) -> list[Element]:
    """The machine and all that states of it are, at whatever depth."""
    found = [machine]
    for one in found:
        for each in graph.subtree(one):
            called = submachine_of(graph, each)
            if called is not None and called not in found:
                found.append(called)
    return found


def submachine_of(graph: Graph, state: Element) -> Element | None:
    """The state machine that a state is, when it is one that is drawn here."""
    if state.kind is not Kind.STATE:
        return None
    called = graph.target(state, Edge.CALLS)
    is_drawn = called is not None and called.kind is Kind.STATE_MACHINE
    return called if is_drawn and called is not None and not called.attrs.get("external") else None


def _endless(graph: Graph, state: Element) -> str:
    """A submachine state of a machine that is in itself again."""
    called = submachine_of(graph, state)
    if called is None or called not in _callers(graph, state):
        return ""
    return f"submachine state '{state.name}', in which '{called.name}' contains itself,"


def _callers(graph: Graph, state: Element) -> list[Element]:
    """The state machines around a state, and those of the states that are them."""
    found = [one for one in graph.ancestors(state) if one.kind is Kind.STATE_MACHINE]
    for one in found:
        for user in graph.sources(one, Edge.CALLS):
            above = [up for up in graph.ancestors(user) if up.kind is Kind.STATE_MACHINE]
            found += (up for up in above if user.kind is Kind.STATE and up not in found)
    return found


def _unsupported(graph: Graph, element: Element) -> str:
    if element.kind is Kind.PSEUDOSTATE:
        return _unsupported_pseudostate(graph, element)
    if element.kind in _REDEFINABLE and graph.targets(element, Edge.REDEFINES):
        return f"the redefinition or extension by '{element.name or element.kind}'"
    if element.kind is not Kind.STATE:
        return ""
    if any(one.kind is Kind.TRIGGER for one in graph.owned(element)):
        return f"the deferral of events in state '{element.name}'"
    is_submachine = "submachine" in element.attrs or any(
        target.kind is Kind.STATE_MACHINE
        for edge in (Edge.CALLS, Edge.TYPED_BY, Edge.REFERENCES)
        for target in graph.targets(element, edge)
    )
    is_known = submachine_of(graph, element) is not None
    return f"submachine state '{element.name}'" if is_submachine and not is_known else ""


def _unsupported_pseudostate(graph: Graph, element: Element) -> str:
    if element.subkind not in _PSEUDO:
        return f"{element.subkind or 'pseudostate'} pseudostate '{element.name}'"
    if element.subkind == "connection-point" and len(graph.targets(element, Edge.REFERENCES)) != 1:
        return f"the connection point '{element.name}' that stands for no one point"
    region = graph.owner(element)
    is_second = region is not None and initial_of(graph, region) not in (None, element)
    if element.subkind == "initial" and is_second:
        return f"the second initial pseudostate '{element.name}'"
    return ""


def _is_broken(graph: Graph, element: Element, sink: Sink) -> bool:
    if element.kind is Kind.REGION:
        return _lacks_initial(graph, element, sink)
    if element.kind is not Kind.TRANSITION:
        return False
    ends = {
        "source": graph.target(element, Edge.FLOW_SOURCE),
        "target": graph.target(element, Edge.FLOW_TARGET),
    }
    known = element.attrs.get("unresolved")
    told = known if isinstance(known, tuple) else ()
    for end, vertex in ends.items():
        if vertex is None and f"flow-{end}" not in told:
            name = element.name or "<Transition>"
            sink.report(DANGLING, graph.subject(element), transition=name, end=end)
    return None in ends.values()


def _lacks_initial(graph: Graph, region: Element, sink: Sink) -> bool:
    initial = initial_of(graph, region)
    if initial is not None and len(graph.sources(initial, Edge.FLOW_SOURCE)) == 1:
        return False
    if not any(one.kind in (Kind.STATE, Kind.FINAL_STATE) for one in graph.owned(region)):
        return False
    owner = graph.owner(region) or region
    name = region.name or "<Region>"
    sink.report(NO_INITIAL, graph.subject(region), region=name, owner=owner.name)
    return True


def initial_of(graph: Graph, region: Element) -> Element | None:
    """The first initial pseudostate of a region."""
    owned = graph.owned(region)
    return next((one for one in owned if one.subkind == "initial"), None)
