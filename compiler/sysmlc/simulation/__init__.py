"""Scenarios, played on the reference interpreters of activities and state machines.

A scenario passes if some run of the diagram shows every expected value.
"""

from collections.abc import Iterable, Iterator, Mapping

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, query
from sysmlc.logic.basis import describe_basis
from sysmlc.logic.components.names import Atom
from sysmlc.logic.contract import Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.domains import contains, describe
from sysmlc.logic.formula import Literal
from sysmlc.logic.machines.interpreter import Valuation
from sysmlc.logic.quantities import (
    NumberReader,
    Numbers,
    Quantity,
    choose_numbers,
    rename_features,
    show_numbers,
)
from sysmlc.simulation.components import MAX_RUNS
from sysmlc.simulation.numbers import ScenarioNumbers
from sysmlc.simulation.players import (
    NamedPlayer,
    Player,
    find_component_player,
    find_default_number,
    find_players,
    find_resting_value,
    list_atoms,
    list_blocks,
)
from sysmlc.simulation.report import Difference, Report, Result, show_value
from sysmlc.simulation.scenario import (
    COMPONENT,
    NOT_INPUT,
    TOO_MANY_RUNS,
    VALUE,
    VARIABLE,
    Entry,
    Scenario,
    read_scenarios,
)
from sysmlc.sources import Source
from sysmlc.support.suggestions import did_you_mean

__all__ = ["Report", "list_variables", "run_scenarios"]


_Trace = tuple[Valuation, ...]


def run_scenarios(graph: Graph, scenario_source: Source, sink: Sink) -> Report:
    """Play every scenario of a file on a graph that the passes have refined.

    Faults of the file are reported to *sink*. A scenario with a fault is not played.
    """
    scenarios = read_scenarios(scenario_source, sink)
    players = find_players(graph) if scenarios else {}
    results = [_play_scenario(graph, scenario, players, sink) for scenario in scenarios]
    return Report(scenario_source.name, tuple(results))


def _play_scenario(
    graph: Graph, scenario: Scenario, players_by_name: Mapping[str, Player], sink: Sink
) -> Result:
    played = _find_player(graph, scenario, players_by_name, sink)
    player = None if played is None else NamedPlayer(played, list_atoms(graph, played))
    invalid = Result(scenario.name, scenario.component, scenario.location.line, is_valid=False)
    if player is None:
        return invalid
    numbers = _read_numbers(graph, _resolve_inputs(scenario, player.atoms), player, sink)
    scenario = numbers.scenario
    if not numbers.is_valid or not _has_valid_entries(scenario, player, sink):
        return invalid
    resting_values = {
        variable.name: find_resting_value(graph, variable)
        for variable in player.variables
        if variable.owner is Owner.ENVIRONMENT
    }
    result = _follow_runs(scenario, player, resting_values, sink)
    trace = tuple(
        {name: value for name, value in step.items() if name not in player.hidden_names}
        for step in result.trace
    )
    given = numbers.numbers[: len(trace)]
    return replace(_show_numbers(result, player, given), trace=trace)


def _read_numbers(
    graph: Graph, scenario: Scenario, player: NamedPlayer, sink: Sink
) -> ScenarioNumbers:
    own = player.player.variables
    inputs = (variable for variable in own if variable.owner is Owner.ENVIRONMENT)
    defaults = {
        variable.term[0][0]: number
        for variable in inputs
        if (number := find_default_number(graph, variable)) is not None
    }
    return ScenarioNumbers(scenario, own, player.variables, defaults, sink)


def _show_numbers(result: Result, player: NamedPlayer, given: tuple[Numbers, ...]) -> Result:
    """Return a result with numbers in place of the regions in its run."""
    chosen = choose_numbers(player.player.variables, result.trace, given)
    names = {atom.replaced: atom.variable.name for atom in player.atoms if atom.replaced}
    numbers = rename_features(chosen, names)
    features = {
        key for step in numbers for name in step.keys() & result.inputs for key in step[name]
    }
    difference = result.difference
    if difference is not None and numbers:
        shown = show_numbers({difference.variable: difference.actual or ""}, numbers[-1])
        actual = shown.get(difference.variable)
        difference = (
            replace(difference, actual=str(actual)) if isinstance(actual, Quantity) else difference
        )
    return replace(result, numbers=numbers, inputs=result.inputs | features, difference=difference)


def _resolve_inputs(scenario: Scenario, atoms: Iterable[Atom]) -> Scenario:
    """Return the scenario with the variables of inputs for the names that formulas give them."""
    variables = {atom.variable.name: atom.replaced for atom in atoms if atom.replaced}
    steps = tuple(
        replace(
            step,
            inputs=tuple(
                replace(entry, name=variables.get(entry.name, entry.name)) for entry in step.inputs
            ),
        )
        for step in scenario.steps
    )
    return replace(scenario, steps=steps)


def list_variables(graph: Graph) -> Iterator[str]:
    """Yield a line for each name that scenarios and formulas about a component may use."""
    alone = find_players(graph)
    names = [*(query.component_name(graph, block) for block in list_blocks(graph)), *alone]
    for component in dict.fromkeys(names):
        player = find_component_player(graph, component) or alone.get(component)
        if player is None:
            continue
        atoms = list_atoms(graph, player)
        replaced = {atom.replaced for atom in atoms}
        variables = [
            *(atom.variable for atom in atoms),
            *(variable for variable in player.variables if variable.name not in replaced),
        ]
        yield component
        reader = NumberReader(player.variables)
        for variable in variables:
            if not variable.is_auxiliary:
                sort = "input " if variable.owner is Owner.ENVIRONMENT else "output"
                yield f"  {sort} {variable.name}: {_describe_values(variable, reader)}"


def _describe_values(variable: Variable, reader: NumberReader) -> str:
    regions = describe(variable.domain)
    keys = [key for key, _ in variable.term]
    if len(keys) == 1:
        return f"{reader.describe(keys[0])} ({regions})"
    return f"numbers for {' and '.join(keys)} ({regions})" if keys else regions


# -- checks ------------------------------------------------------------------------------------


def _find_player(
    graph: Graph, scenario: Scenario, players_by_name: Mapping[str, Player], sink: Sink
) -> Player | None:
    """Return the player of the component: of the whole block, or else of its only behaviour."""
    name = scenario.component
    matches = [player for player in players_by_name if player.rpartition("::")[2] == name]
    if name not in players_by_name and len(matches) == 1:
        name = matches[0]
    player = find_component_player(graph, name) or players_by_name.get(name)
    if player is not None:
        return player
    names = ", ".join(sorted(matches or players_by_name)) or "none"
    sink.report(
        COMPONENT, scenario.subject(scenario.location), name=scenario.component, known=names
    )
    return None


def _has_valid_entries(scenario: Scenario, player: Player, sink: Sink) -> bool:
    variables = {variable.name: variable for variable in player.variables}
    valid = [
        _is_valid_entry(entry, is_input, variables, scenario, sink)
        for step in scenario.steps
        for is_input, entries in ((True, step.inputs), (False, step.expect))
        for entry in entries
    ]
    return all(valid)


def _is_valid_entry(
    entry: Entry,
    is_input: bool,
    variables: Mapping[str, Variable],
    scenario: Scenario,
    sink: Sink,
) -> bool:
    name, component = entry.name, scenario.component
    variable = variables.get(name)
    if variable is None:
        sink.report(
            VARIABLE,
            scenario.subject(entry.location),
            component=component,
            name=name,
            advice=did_you_mean(name, variables),
        )
    elif not entry.text and not contains(variable.domain, entry.value):
        shown, domain = show_value(entry.value), describe(variable.domain)
        domain += " (assumed)" if variable.is_range_assumed else ""
        sink.report(VALUE, scenario.subject(entry.location), value=shown, name=name, domain=domain)
    elif is_input and variable.owner is Owner.SYSTEM:
        sink.report(NOT_INPUT, scenario.subject(entry.location), name=name, component=component)
    else:
        return True
    return False


# -- runs --------------------------------------------------------------------------------------


def _follow_runs(
    scenario: Scenario, player: Player, resting_values: Valuation, sink: Sink
) -> Result:
    """Follow all runs of the diagram that show the expected values, step by step.

    If no run remains after a step, the result has that step as its difference, and as its trace the
    run that shows most of the values expected in it. The difference is certain only if all runs
    were followed; otherwise the result is not decided, and SM578 is reported.
    """
    is_complete = True
    inputs = dict(resting_values)
    traces: list[_Trace] = [()]
    result = Result(
        scenario.name,
        player.component,
        scenario.location.line,
        inputs=frozenset(v.name for v in player.variables if v.owner is Owner.ENVIRONMENT),
    )
    for number, step in enumerate(scenario.steps, 1):
        # Inputs that are not pulses retain their value until the scenario sets them again.
        inputs.update({name: resting_values[name] for name in player.pulses})
        inputs.update({entry.name: entry.value for entry in step.inputs})
        traces, has_all = _extend_traces(player, traces, dict(inputs))
        is_complete &= has_all
        matching = [trace for trace in traces if _find_missed_entry(trace[-1], step.expect) is None]
        if not matching:
            trace, entry = _find_nearest(traces, step.expect)
            if not is_complete:
                location = scenario.subject(entry.location)
                name, component = entry.name, player.component
                sink.report(TOO_MANY_RUNS, location, name=name, component=component, limit=MAX_RUNS)
                return replace(result, is_decided=False)
            actual = trace[-1].get(entry.name)
            expected = entry.text or entry.value
            difference = Difference(number, entry.name, expected, actual, entry.location.line)
            text = _describe_bounds(player, trace)
            return replace(result, trace=trace, difference=difference, range_text=text)
        traces = matching
    return replace(result, trace=traces[0], range_text=_describe_bounds(player, traces[0]))


def _describe_bounds(player: Player, trace: _Trace) -> str:
    """Return the assumed ranges at whose bounds values of the component may have stopped."""
    reached = [
        variable.name
        for variable in player.variables
        if variable.is_range_assumed
        and variable.owner is Owner.SYSTEM
        and isinstance(variable.domain, IntegerDomain)
        and {variable.domain.low, variable.domain.high}
        & {step.get(variable.name) for step in trace}
    ]
    contract = Contract(player.component, "", tuple(player.variables), (), ())
    return describe_basis((contract,), reached).range_text


def _extend_traces(
    player: Player, traces: list[_Trace], inputs: Valuation
) -> tuple[list[_Trace], bool]:
    """Extend each run by each possible step; retain one run for each valuation that is reached.

    The second result is false if there are more runs than are followed.
    """
    has_all = True
    traces_by_state: dict[frozenset[tuple[str, Literal]], _Trace] = {}
    for trace in traces:
        valuations = player.successors(trace[-1], inputs) if trace else player.initial(inputs)
        has_all &= len(valuations) <= MAX_RUNS
        for valuation in valuations:
            traces_by_state.setdefault(frozenset(valuation.items()), (*trace, valuation))
        if len(traces_by_state) > MAX_RUNS:
            return list(traces_by_state.values())[:MAX_RUNS], False
    return list(traces_by_state.values()), has_all


def _find_missed_entry(valuation: Valuation, expect: Iterable[Entry]) -> Entry | None:
    return next((entry for entry in expect if valuation.get(entry.name) != entry.value), None)


def _find_nearest(traces: list[_Trace], expect: tuple[Entry, ...]) -> tuple[_Trace, Entry]:
    """Return the run whose last step misses the fewest expected values, and the first of these."""

    def count_missed(trace: _Trace) -> int:
        return sum(trace[-1].get(entry.name) != entry.value for entry in expect)

    nearest = min(traces, key=count_missed)
    entry = _find_missed_entry(nearest[-1], expect)
    assert entry is not None
    return nearest, entry
