"""Runs scenarios: at least one run of the diagram has to show what each step expects."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.domains import contains, describe
from sysmlc.logic.formula import Literal
from sysmlc.simulation import rules
from sysmlc.simulation.players import Player, Valuation, players, resting_value
from sysmlc.simulation.report import Difference, Report, Result
from sysmlc.simulation.scenario import Entry, Scenario, read
from sysmlc.sources import Source

_MOST_RUNS = 10_000
"""Runs that are followed at the same time where a diagram leaves choices."""

_Trace = tuple[Valuation, ...]


def run(graph: Graph, scenario_source: Source, sink: Sink) -> Report:
    """Play every scenario of the file on the graph, which the passes have refined.

    What is wrong with the file is reported to ``sink``; such scenarios fail.
    """
    scenarios = read(scenario_source, sink)
    known = players(graph) if scenarios else {}
    results = [_play(graph, scenario, known, sink) for scenario in scenarios]
    return Report(scenario_source.name, tuple(results))


def _play(graph: Graph, scenario: Scenario, known: Mapping[str, Player], sink: Sink) -> Result:
    player = _player(scenario, known, sink)
    if player is None or not _is_sound(scenario, player, sink):
        return Result(scenario.name, scenario.component, scenario.spot.line, is_valid=False)
    resting = {
        variable.name: resting_value(graph, variable)
        for variable in player.variables
        if variable.owner is Owner.ENVIRONMENT
    }
    return _follow(scenario, player, resting)


# -- checks ------------------------------------------------------------------------------------


def _player(scenario: Scenario, known: Mapping[str, Player], sink: Sink) -> Player | None:
    found = known.get(scenario.component)
    if found is not None:
        return found
    short = [name for name in known if _last(name) == scenario.component]
    if len(short) == 1:
        return known[short[0]]
    names = ", ".join(sorted(short or known)) or "none"
    sink.report(
        rules.COMPONENT, scenario.subject(scenario.spot), name=scenario.component, known=names
    )
    return None


def _last(name: str) -> str:
    return name.rpartition("::")[2]


def _is_sound(scenario: Scenario, player: Player, sink: Sink) -> bool:
    variables = {variable.name: variable for variable in player.variables}
    sound = [
        _is_known(entry, is_input, variables, scenario, sink)
        for step in scenario.steps
        for is_input, entries in ((True, step.inputs), (False, step.expect))
        for entry in entries
    ]
    return all(sound)


def _is_known(
    entry: Entry,
    is_input: bool,
    variables: Mapping[str, Variable],
    scenario: Scenario,
    sink: Sink,
) -> bool:
    name, component = entry.name, scenario.component
    variable = variables.get(name)
    if variable is None:
        hint = _hint(name, variables)
        sink.report(
            rules.VARIABLE, scenario.subject(entry.spot), component=component, name=name, hint=hint
        )
    elif not contains(variable.domain, entry.value):
        shown, domain = show(entry.value), describe(variable.domain)
        sink.report(
            rules.VALUE, scenario.subject(entry.spot), value=shown, name=name, domain=domain
        )
    elif is_input and variable.owner is Owner.SYSTEM:
        sink.report(rules.NOT_INPUT, scenario.subject(entry.spot), name=name, component=component)
    else:
        return True
    return False


def _hint(name: str, known: Iterable[str]) -> str:
    close = get_close_matches(name, list(known), 1)
    return f"; '{close[0]}' is near" if close else ""


# -- runs --------------------------------------------------------------------------------------


def _follow(scenario: Scenario, player: Player, resting: Valuation) -> Result:
    """Keep the runs that show what is expected; the first step without any is the difference."""
    inputs = dict(resting)
    traces: list[_Trace] = [()]
    for number, step in enumerate(scenario.steps):
        inputs.update({name: resting[name] for name in player.pulses})
        inputs.update({entry.name: entry.value for entry in step.inputs})
        traces = _extended(player, traces, dict(inputs))
        fitting = [trace for trace in traces if _misses(trace[-1], step.expect) is None]
        if not fitting:
            trace, entry = _nearest(traces, step.expect)
            found = trace[-1].get(entry.name)
            difference = Difference(number, entry.name, entry.value, found, entry.spot.line)
            return Result(
                scenario.name,
                player.component,
                scenario.spot.line,
                trace,
                difference,
                _inputs(player),
            )
        traces = fitting
    return Result(
        scenario.name, player.component, scenario.spot.line, traces[0], None, _inputs(player)
    )


def _inputs(player: Player) -> frozenset[str]:
    return frozenset(v.name for v in player.variables if v.owner is Owner.ENVIRONMENT)


def _extended(player: Player, traces: list[_Trace], inputs: Valuation) -> list[_Trace]:
    """Each run by one step; of runs that are in the same state one is kept."""
    found: dict[frozenset[tuple[str, Literal]], _Trace] = {}
    for trace in traces:
        after = player.successors(trace[-1], inputs) if trace else player.initial(inputs)
        for valuation in after:
            found.setdefault(frozenset(valuation.items()), (*trace, valuation))
    return list(found.values())[:_MOST_RUNS]


def _misses(valuation: Valuation, expect: Iterable[Entry]) -> Entry | None:
    return next((entry for entry in expect if valuation.get(entry.name) != entry.value), None)


def _nearest(traces: list[_Trace], expect: tuple[Entry, ...]) -> tuple[_Trace, Entry]:
    """The run that shows most of what is expected, and the first value that it misses."""

    def missed(trace: _Trace) -> int:
        return sum(trace[-1].get(entry.name) != entry.value for entry in expect)

    best = min(traces, key=missed)
    entry = _misses(best[-1], expect)
    assert entry is not None
    return best, entry


def show(value: Literal) -> str:
    """A value as the scenario writes it."""
    return str(value).lower() if isinstance(value, bool) else str(value)
