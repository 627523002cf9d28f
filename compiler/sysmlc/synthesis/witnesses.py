"""Runs as explanations for users: text, PlantUML sequence diagrams, and notes of diagnostics."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import KEY_MARK, Rule, Sink, Subject
from sysmlc.logic import formula as f
from sysmlc.logic.components.names import Atom
from sysmlc.logic.contract import Class, Conjunct, Contract, Owner
from sysmlc.logic.evaluate import value_of
from sysmlc.logic.formula import Literal, rename_variables
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.logic.quantities import Quantity, rename_features, show_numbers
from sysmlc.logic.violations import find_violated_step
from sysmlc.support.counts import count
from sysmlc.support.output import assign_file_names
from sysmlc.support.plantuml_text import escape_line, format_label
from sysmlc.synthesis.algebra.fair_systems import Trace
from sysmlc.synthesis.algebra.refinement import Failure
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.games.game import OutsideGr1Error

_MAX_SHOWN_STEPS = 12
"""Steps of a run that a message lists; further steps are only counted."""
_NAMES_OF_VIOLATIONS = {False: "violated here", True: "never fulfilled from here on"}
"""How texts mark the violated step of a run, by whether a demand stays open."""
_ENVIRONMENT = "environment"

ShownValues = Mapping[str, Literal | Quantity]


class Party(Struct, frozen=True):
    """A participant of a run: a name, and the contract that lists its variables."""

    name: str
    contract: Contract


class Witness(Struct, frozen=True):
    """A run that violates a conjunct which *component* assumes or should guarantee."""

    component: str
    broken: Conjunct
    trace: Trace
    parties: tuple[Party, ...]


def mark_violation(trace: Trace, broken: Conjunct) -> Trace:
    """Return a run with the step that violates a conjunct, both in the variables of a behaviour."""
    if trace.violated is not None or trace.loop == len(trace.steps):
        return trace
    step, is_decided = find_violated_step(broken, trace.steps, trace.loop) or (None, True)
    return replace(trace, violated=step, is_open=not is_decided)


def _iter_changes(trace: Trace, hidden: Set[str] = frozenset()) -> Iterator[ShownValues]:
    """Yield for each step the values that have changed; for the first step all values.

    Numbers replace regions, and *hidden* variables are omitted. Quiet variables are false before
    the first step.
    """
    previous: ShownValues = dict.fromkeys(trace.quiet, False)
    for values, numbers in zip(trace.steps, trace.numbers or [{}] * len(trace.steps), strict=True):
        visible = {name: value for name, value in values.items() if name not in hidden}
        shown = show_numbers(visible, numbers)
        yield {name: value for name, value in shown.items() if previous.get(name) != value}
        previous = shown


def describe_run(trace: Trace, broken: Conjunct | None = None) -> Iterator[str]:
    """Yield a line for each step with the changed values.

    Auxiliary variables are omitted and, with *broken*, variables that never change. Those that the
    text of *broken* names are shown.
    """
    hidden = _hidden_variables(trace, broken)
    marked = mark_violation(trace, broken) if broken is not None else trace
    violated = 0 if marked.violated is None else marked.violated + 1
    last_shown = 0
    changes = zip(_iter_changes(trace), _iter_changes(trace, hidden), strict=True)
    for number, (changed, shown) in enumerate(changes, 1):
        if number > _MAX_SHOWN_STEPS and number != violated:
            continue
        if number > last_shown + 1:
            yield f"and {count(number - last_shown - 1, 'more step')}"
        unchanged = "only auxiliary variables change" if changed else "nothing changes"
        mark = KEY_MARK + _NAMES_OF_VIOLATIONS[marked.is_open] if number == violated else ""
        yield f"step {number}: {_print_values(shown, shown) or unchanged}{mark}"
        last_shown = number
    if last_shown < len(trace.steps):
        yield f"and {count(len(trace.steps) - last_shown, 'more step')}"
    is_ended = trace.loop == len(trace.steps)
    yield "then there is no answer" if is_ended else f"then again from step {trace.loop + 1}"


def _hidden_variables(trace: Trace, broken: Conjunct | None) -> Set[str]:
    """Return the variables that texts and diagrams of a run omit."""
    if broken is None:
        return trace.auxiliary
    named = f.variable_names(broken.wording or broken.formula)
    return (trace.auxiliary - named) | _constant_variables(trace, broken)


def _constant_variables(trace: Trace, broken: Conjunct) -> set[str]:
    """Return the variables that never change, unless the conjunct reads them or they matter."""
    changes = list(_iter_changes(replace(trace, numbers=())))[1:]
    changing = {name for changed in changes for name in changed}
    return set(trace.steps[0]) - changing - f.variable_names(broken.formula) - trace.relevant


def name_run(trace: Trace, atoms: Sequence[Atom]) -> Trace:
    """Return a run of a behaviour with the atoms of authors in place of its variables.

    Variables that no atom replaces stay. Without *atoms* the run is returned as it is.
    """
    replaced = {atom.replaced for atom in atoms}
    read = [f.variable_names(atom.meaning) for atom in atoms]
    steps = tuple(
        {
            atom.variable.name: value_of(atom.meaning, values)
            for atom, names in zip(atoms, read, strict=True)
            if names <= values.keys()
        }
        | {name: value for name, value in values.items() if name not in replaced}
        for values in trace.steps
    )
    auxiliary = {atom.variable.name for atom in atoms if atom.variable.is_auxiliary}
    quiet = frozenset(atom.variable.name for atom in atoms if atom.is_quiet)
    names = {atom.replaced: atom.variable.name for atom in atoms}
    return replace(
        trace,
        steps=steps,
        numbers=rename_features(trace.numbers, names),
        auxiliary=trace.auxiliary | auxiliary,
        quiet=quiet,
        relevant=frozenset(names.get(name, name) for name in trace.relevant),
    )


def name_conjunct(conjunct: Conjunct, atoms: Sequence[Atom]) -> Conjunct:
    """Return a conjunct about the variables of a behaviour with atoms in their place."""
    names = {atom.replaced: atom.variable.name for atom in atoms}
    return replace(conjunct, formula=rename_variables(conjunct.formula, names))


def describe_named_run(trace: Trace, broken: Conjunct, atoms: Sequence[Atom]) -> tuple[str, ...]:
    """Return the lines of ``describe_run`` with *atoms* in place of variables."""
    named = name_run(mark_violation(trace, broken), atoms)
    return tuple(describe_run(named, name_conjunct(broken, atoms)))


def export_run(trace: Trace) -> dict[str, object]:
    """Return a run for JSON, without auxiliary variables."""
    steps = [
        {name: value for name, value in values.items() if name not in trace.auxiliary}
        for values in trace.steps
    ]
    run = {"steps": steps, "loop": trace.loop, "violated": trace.violated}
    return run | export_numbers(trace)


def export_numbers(trace: Trace) -> dict[str, object]:
    """Return the member of a run for JSON with the numbers for regions; nothing without regions."""
    numbers = [
        {
            key: quantity.export()
            for name, quantities in step.items()
            if name not in trace.auxiliary
            for key, quantity in quantities.items()
        }
        for step in trace.numbers
    ]
    return {"numbers": numbers} if numbers else {}


def witness_files(witnesses: Iterable[Witness]) -> Iterator[tuple[str, str]]:
    """Yield name and text of a diagram for each run, numbered within its component."""
    witnesses_by_component: dict[str, list[Witness]] = {}
    for witness in witnesses:
        witnesses_by_component.setdefault(witness.component, []).append(witness)
    for component, name in assign_file_names(witnesses_by_component).items():
        for number, witness in enumerate(witnesses_by_component[component], 1):
            yield f"{name}.run{number}.puml", witness_diagram(witness)


def witness_diagram(witness: Witness) -> str:
    """Return the run as a sequence diagram, with the violated conjunct as its title."""
    broken = format_label(print_temporal(witness.broken))
    title = f"{format_label(witness.component)}\\nnot kept: {broken}"
    hidden = _hidden_variables(witness.trace, witness.broken)
    trace = mark_violation(witness.trace, witness.broken)
    return run_diagram(title, trace, witness.parties, hidden)


def run_diagram(
    title: str, trace: Trace, parties: Sequence[Party], hidden: Set[str] = frozenset()
) -> str:
    """Return a run as a sequence diagram of the environment and the parties.

    A changed variable is a message from its owner to each reader, or a note if it has no reader.
    *hidden* variables are omitted.
    """
    head = [
        "@startuml",
        f"title {title}",
        "hide footbox",
        f"participant {_ENVIRONMENT} as p0",
        *(
            f'participant "{escape_line(party.name)}" as p{index}'
            for index, party in enumerate(parties, 1)
        ),
    ]
    contracts = [party.contract for party in parties]
    return "\n".join((*head, *_diagram_steps(trace, contracts, hidden), "@enduml", ""))


_TEMPORAL_PREFIXES = {Class.INIT: "", Class.SAFETY: "G ", Class.LIVENESS: "G F ", Class.OTHER: ""}


def print_temporal(conjunct: Conjunct) -> str:
    """Return the conjunct in the author's names, with the operators that its class implies."""
    if conjunct.wording is not None:
        return print_formula(conjunct.wording)
    formula, operators = print_formula(conjunct.formula), _TEMPORAL_PREFIXES[conjunct.class_]
    return f"{operators}({formula})" if operators else formula


def _diagram_steps(trace: Trace, contracts: Sequence[Contract], hidden: Set[str]) -> Iterator[str]:
    variables = {key: name for step in trace.numbers for name in step for key in step[name]}
    for number, changed in enumerate(_iter_changes(trace, hidden)):
        if number == trace.loop:
            yield "group again and again"
        yield f"== step {number + 1} =="
        yield from _diagram_messages(changed, contracts, variables)
        if number == trace.violated:
            yield f"note over p1 #FFDDDD : {_NAMES_OF_VIOLATIONS[trace.is_open]}"
    is_ended = trace.loop == len(trace.steps)
    yield "note over p1 : no answer is left" if is_ended else "end"


def _diagram_messages(
    changed: ShownValues, contracts: Sequence[Contract], variables: Mapping[str, str]
) -> Iterator[str]:
    """Yield the messages of one step, from the owner of a variable to its readers.

    *variables* are those that carry the numbers of features without a variable of their own.
    """

    def find_parties(name: str, owner: Owner) -> list[int]:
        return [
            index
            for index, contract in enumerate(contracts, 1)
            if any(
                item.name in (name, variables.get(name)) and item.owner is owner
                for item in contract.variables
            )
        ]

    names_by_arrow: dict[tuple[int, int], list[str]] = {}
    for name in changed:
        # The environment, which is no party, has the number 0.
        sender = next(iter(find_parties(name, Owner.SYSTEM)), 0)
        for receiver in find_parties(name, Owner.ENVIRONMENT) or [sender]:
            names_by_arrow.setdefault((sender, receiver), []).append(name)
    for (sender, receiver), names in sorted(names_by_arrow.items()):
        text = _print_values(changed, names)
        if sender == receiver:
            yield f"hnote over p{sender} : {format_label(text)}"
        else:
            yield f"p{sender} -> p{receiver} : {format_label(text)}"


def _print_values(values: ShownValues, names: Iterable[str]) -> str:
    return ", ".join(_print_value(name, values[name]) for name in names)


def _print_value(name: str, value: Literal | Quantity) -> str:
    """Return a value of a step: ``temp = 17 °C (below low)``, ``state=Idle``."""
    return f"{name} = {value}" if isinstance(value, Quantity) else f"{name}={print_literal(value)}"


def manager_factory(options: Options) -> Callable[[], Manager]:
    """Return a function that creates a new manager with the engine and limits of *options*."""
    return lambda: Manager(options.engine, options.limits, options.progress)


def describe_problem(problem: Exception) -> str:
    """Return the reason of an undecided question as text, with the formula outside GR(1) if any."""
    if isinstance(problem, OutsideGr1Error):
        return f"'{print_formula(problem.conjunct.formula)}': {problem}"
    return str(problem)


def text_in_parentheses(conjunct: Conjunct) -> str:
    """Return the conjunct's text in parentheses, or an empty string if it has none."""
    return f" ({conjunct.text.removesuffix('.')})" if conjunct.text else ""


def report_failure(
    rule: Rule,
    failure: Failure,
    component: str,
    subject: Subject,
    sink: Sink,
    notes: tuple[str, ...] = (),
    atoms: Sequence[Atom] = (),
) -> None:
    """Report a violated conjunct with the run that shows it, in terms of *atoms*, and notes."""
    conjunct = failure.conjunct
    sink.report(
        rule,
        subject,
        notes=(*describe_named_run(failure.trace, conjunct, atoms), *notes),
        component=component,
        formula=print_formula(conjunct.wording or conjunct.formula),
        context=text_in_parentheses(conjunct),
    )
