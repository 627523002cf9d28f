"""Random blocks in SysML v2, and an explicit-state interpreter that reads no contract.

A block has two Booleans, a state machine whose states perform activities, and may perform an
activity by itself. A step of an activity is an elementary action, an assignment, a call of another
activity, a fork of two such steps and their join, or a decision before one or two such steps and
their merge. An activity that only others call may have an input ``p`` and an output ``r``.
"""

import re
from collections.abc import Iterable, Iterator
from itertools import chain, combinations, product, zip_longest
from random import Random

from msgspec import Struct
from msgspec.structs import replace

FEATURES = ("b0", "b1")
EVENTS = ("E0", "E1")


class Step(Struct, frozen=True):
    """A step of an activity: ``kind`` is elementary, assign, call, fork or decide."""

    kind: str
    name: str
    feature: str = ""
    """What an assignment sets, or the output of a call."""
    value: str = ""
    called: str = ""
    branches: tuple["Step", ...] = ()
    argument: tuple[str, str] = ("", "")
    """How the input of a call gets its value (``:=`` or ``=``), and the value."""
    guards: tuple[str, ...] = ()
    """The guards behind a decision, of which at most one holds. Those after the last branch lead to
    the merge."""


class Move(Struct, frozen=True):
    """A transition; without event it is a completion transition.

    ``choice`` is a guard behind it, and the target if that is false.
    """

    source: str
    target: str
    event: str
    guard: str
    effect: tuple[str, str] | None
    choice: tuple[str, str] | None = None


class Block(Struct, frozen=True):
    """A random block."""

    activities: dict[str, tuple[Step, ...]]
    do: dict[str, str]
    moves: tuple[Move, ...]
    own: str
    states: tuple[str, ...]
    signatures: frozenset[str] = frozenset()
    """The activities that have parameters."""
    entry: dict[str, str] = {}
    """The activities that states perform when they are entered; they take time."""
    exit: dict[str, str] = {}
    """The activities that states perform before they are left; they take time."""
    start: str = ""
    """The feature that the machine sets to true before it enters its first state."""


def make_block(random: Random) -> Block:
    """Return a random block."""
    names = [f"a{number}" for number in range(3)]
    signatures = frozenset(names[random.choice((1, 2, 3)) :])
    activities = {
        name: tuple(
            _make_step(random, f"{name}s{position}", names[index + 1 :], signatures)
            for position in range(random.randint(1, 2))
        )
        for index, name in enumerate(names)
    }
    states = ("S0", "S1", "S2")[: random.randint(2, 3)]
    # Each activity is performed in one place, so that its name is unique; calls have copies.
    roots = random.sample([name for name in names if name not in signatures], 3 - len(signatures))
    do = {state: roots.pop() for state in states[:2] if roots and random.random() < 0.7}
    moves = tuple(_make_move(random, states) for _ in range(random.randint(2, 3)))
    # A feature that nothing assigns counts as an input.
    moves += tuple(
        Move(
            random.choice(states), random.choice(states), random.choice(EVENTS), "", (name, "true")
        )
        for name in FEATURES
    )
    own = roots.pop() if roots and random.random() < 0.4 else ""
    long = [name for name in roots if _takes_time(activities[name])]
    entry = {random.choice(states): long.pop()} if long and random.random() < 0.5 else {}
    exit = {random.choice(states): long.pop()} if long and random.random() < 0.7 else {}
    used = _list_performed(activities, [*do.values(), *entry.values(), *exit.values(), own])
    performed = {name: activities[name] for name in names if name in used}
    # A state with an exit that takes time is left straight to other states.
    moves = tuple(dict.fromkeys(replace(m, choice=None) if m.source in exit else m for m in moves))
    start = random.choice(("", *FEATURES))
    return Block(performed, do, moves, own, states, signatures, entry, exit, start)


def _takes_time(steps: tuple[Step, ...]) -> bool:
    kinds = {step.kind for outer in steps for step in (outer, *outer.branches)}
    return not kinds.isdisjoint(("elementary", "call"))


def _list_performed(activities: dict[str, tuple[Step, ...]], roots: list[str]) -> set[str]:
    """Return the activities that are performed or called."""
    used, worklist = set(), [name for name in roots if name]
    while worklist:
        name = worklist.pop()
        used.add(name)
        steps = activities[name]
        inner = [branch for step in steps for branch in step.branches]
        worklist += [step.called for step in (*steps, *inner) if step.called]
    return used


def _make_step(
    random: Random, name: str, others: list[str], signatures: frozenset, *, is_branch: bool = False
) -> Step:
    kinds = ["elementary", "assign", *(["call", "call"] if others else [])]
    kind = random.choice([*kinds, *([] if is_branch else ["fork", "decide"])])
    has_parameters = name[:2] in signatures
    if kind in ("fork", "decide"):
        branches = tuple(
            _make_step(random, f"{name}{letter}", others, signatures, is_branch=True)
            for letter in "xy"
        )
        if kind == "fork":
            return Step(kind, name, branches=branches)
        guard = random.choice(("b0", "b1", "not b0", "not b1", *("pr" if has_parameters else "")))
        guards = random.choice(((guard,), (guard, "else"), (guard, _negate(guard))))
        count = random.randint(1, len(guards))
        return Step(kind, name, branches=branches[:count], guards=guards)
    # At most one action sets an output in a step.
    targets = (*FEATURES, *(["r", "r"] if has_parameters and not is_branch else []))
    values = ("true", "false", "b0", "not b1", *(["p", "not p", "r"] if has_parameters else []))
    if kind != "call":
        return Step(kind, name, random.choice(targets), random.choice(values))
    called = random.choice(others)
    if called not in signatures:
        return Step(kind, name, called=called)
    argument = random.choice((":=", "=")), random.choice(values)
    return Step(kind, name, random.choice(("", *targets)), "", called, argument=argument)


def _negate(guard: str) -> str:
    return guard.removeprefix("not ") if guard.startswith("not ") else f"not {guard}"


def _make_move(random: Random, states: tuple[str, ...]) -> Move:
    guards = ("", "", "b0", "b1", "not b0")
    values = ("true", "false", "b0", "b1", "not b1")
    effect = (random.choice(FEATURES), random.choice(values)) if random.random() < 0.6 else None
    event = random.choice(("", *EVENTS))
    source, target, guard = random.choice(states), random.choice(states), random.choice(guards)
    others = [state for state in states if state != target]
    choice = (random.choice(guards[2:]), random.choice(others)) if random.random() < 0.4 else None
    return Move(source, target, event, guard, effect, choice)


# -- text --------------------------------------------------------------------------------------


def move_to_part(text: str) -> str:
    """Return a text about a block in which feature b1 belongs to its part ``cell``."""
    return re.sub(r"\bb1\b", "cell.b1", text)


def write_block(block: Block, *, has_part: bool = False) -> str:
    """Return the block as SysML v2; *has_part* states that b1 belongs to its part ``cell``."""
    text = "\n".join(_write_lines(block))
    if not has_part:
        return text
    declared = "attribute b1 : Boolean := false;"
    head, tail = text.split(declared)
    part = f"part cell {{ {declared} }}"
    return f"{move_to_part(head)}{part}{move_to_part(tail)}"


def _write_lines(block: Block) -> list[str]:
    lines = ["package P {", "private import ScalarValues::*;", "item def E0; item def E1;"]
    lines += ["part def B {", *(f"attribute {name} : Boolean := false;" for name in FEATURES)]
    for name, steps in block.activities.items():
        own = "perform " if name == block.own else ""
        parameters = "in attribute p : Boolean; out attribute r : Boolean := false;"
        lines += [f"{own}action {name} {{", *([parameters] if name in block.signatures else [])]
        lines += [*_write_steps(steps), "}"]
    first_action = f"entry assign {block.start} := true" if block.start else "entry"
    lines += ["exhibit state M {", f"{first_action}; then S0;"]
    for state in block.states:
        entry = f" entry {block.entry[state]};" if state in block.entry else ""
        do = f" do {block.do[state]};" if state in block.do else ""
        exit = f" exit {block.exit[state]};" if state in block.exit else ""
        lines.append(f"state {state} {{{entry}{do}{exit} }}")
    for move in block.moves:
        accept = f" accept {move.event}" if move.event else ""
        guard = f" if {move.guard}" if move.guard else ""
        effect = f" do assign {move.effect[0]} := {move.effect[1]}" if move.effect else ""
        target, branches = move.target, list_branches(block, move)
        if branches:
            target = name_choice(block, move)
            lines.append(f"#SysMLC::Choice state {target};")
        lines += [f"transition first {target} if {guard} then {end};" for guard, end in branches]
        lines.append(f"transition first {move.source}{accept}{guard}{effect} then {target};")
    return [*lines, "}", "}", "}", ""]


def name_choice(block: Block, move: Move) -> str:
    """Return the name of the choice behind a transition."""
    return f"c{block.moves.index(move)}"


def list_branches(block: Block, move: Move) -> list[tuple[str, str]]:
    """Return the guards of the choice behind a transition, if any, and their targets."""
    if move.choice is None:
        return []
    guard, other = move.choice
    return [(guard, move.target), (_negate(guard), other)]


def _write_steps(steps: tuple[Step, ...]) -> Iterator[str]:
    """Yield the lines of an activity: each step is reached from the end of the one before."""
    yield f"first start then {_entry_of(steps[0])};"
    for position, step in enumerate(steps):
        following = "done" if position + 1 == len(steps) else _entry_of(steps[position + 1])
        if step.kind == "fork":
            join = f"j_{step.name}"
            yield f"fork {_entry_of(step)}; join {join};"
            for branch in step.branches:
                yield _write_action(branch)
                yield f"first {_entry_of(step)} then {branch.name};"
                yield f"first {branch.name} then {join};"
            yield f"first {join} then {following};"
        elif step.kind == "decide":
            merge = f"m_{step.name}"
            yield from map(_write_action, step.branches)
            yield f"decide {_entry_of(step)};"
            for guard, branch in zip_longest(step.guards, step.branches):
                target = branch.name if branch else merge
                yield f"{guard if guard == 'else' else f'if {guard} then'} {target};"
            yield f"merge {merge};"
            yield from (f"first {branch.name} then {merge};" for branch in step.branches)
            yield f"first {merge} then {following};"
        else:
            yield _write_action(step)
            yield f"first {step.name} then {following};"


def _entry_of(step: Step) -> str:
    return f"{step.kind[0]}_{step.name}" if step.branches else step.name


def _write_action(step: Step) -> str:
    if step.kind == "assign":
        return f"action {step.name} assign {step.feature} := {step.value};"
    if step.kind == "call":
        operator, value = step.argument
        arguments = f"in attribute :>> p {operator} {value}; " if operator else ""
        arguments += f"out attribute :>> r = {step.feature};" if step.feature else ""
        return f"perform action {step.name} references {step.called} {{ {arguments} }}"
    return f"action {step.name};"


def list_actions(block: Block, *, is_elementary: bool = False) -> list[str]:
    """Return the paths of all actions, or of those that the environment ends."""
    states = (*block.do.values(), *block.entry.values(), *block.exit.values())
    roots = [*states, *filter(None, [block.own])]
    paths = [] if is_elementary else list(roots)
    worklist = [(name, step) for name in roots for step in block.activities[name]]
    while worklist:
        path, step = worklist.pop(0)
        inner = f"{path}.{step.name}"
        if step.branches:
            worklist += [(path, branch) for branch in step.branches]
        elif not is_elementary or step.kind == "elementary":
            paths.append(inner)
        if step.kind == "call":
            worklist += [(inner, content) for content in block.activities[step.called]]
    return paths


# -- activities --------------------------------------------------------------------------------


class Performance(Struct, frozen=True):
    """A performance of an activity: its marks, and the values of its parameters.

    A mark is a position and what is there: the performance of the step ("run", with the performance
    that a call has started), or a token that waits for the join ("wait") or at the decision
    ("decide"). A position is the index of a step, and of a branch or -1. ``input`` is the value
    that was taken at the start, or None; it ``is_due`` until the values of the first step are
    known.
    """

    marks: frozenset
    input: bool | None = None
    is_due: bool = False
    output: bool = False


def start(block: Block, name: str, *, is_due: bool = False) -> Performance:
    """Return the first state of a performance, in which its first step runs."""
    return Performance(frozenset(_arrive(block, block.activities[name], 0)), is_due=is_due)


def take_inputs(block: Block, name: str, performance: Performance, scope: dict) -> Performance:
    """Return the performance with the inputs of the calls that start with this step.

    *scope* has the values of features and parameters in this step.
    """
    marks = set()
    for mark in performance.marks:
        step = None if mark[2] == "wait" else _step_at(block.activities[name], mark)
        if step is not None and step.kind == "call":
            inner = mark[3]
            if inner.is_due:
                value = evaluate(step.argument[1], scope)
                inner = replace(inner, input=value, is_due=False)
            inner_scope = _open_scope(step, inner, scope)
            mark = (*mark[:3], take_inputs(block, step.called, inner, inner_scope))
        marks.add(mark)
    return replace(performance, marks=frozenset(marks))


def _find_open_guard(guards: tuple[str, ...], scope: dict) -> int | None:
    """Return the index of the guard that holds; none may."""
    is_open = [guard != "else" and evaluate(guard, scope) for guard in guards]
    if guards[-1] == "else":
        is_open[-1] = not any(is_open)
    return is_open.index(True) if any(is_open) else None


def _open_scope(call: Step, performance: Performance, scope: dict) -> dict:
    """Return the values of features and parameters inside a performance that a call has started."""
    operator, value = call.argument
    bound = evaluate(value, scope) if operator == "=" else performance.input
    return {**scope, "p": bound, "r": performance.output}


def list_decisions(
    block: Block, name: str, performance: Performance, scope: dict
) -> Iterator[tuple[str, str]]:
    """Yield the decisions at which tokens are, each with the guard that holds or ""."""
    for mark in performance.marks:
        step = None if mark[2] == "wait" else _step_at(block.activities[name], mark)
        if mark[2] == "decide":
            index = _find_open_guard(step.guards, scope)
            yield step.name, "" if index is None else step.guards[index]
        elif step is not None and step.kind == "call":
            inner_scope = _open_scope(step, mark[3], scope)
            yield from list_decisions(block, step.called, mark[3], inner_scope)


def _step_at(steps: tuple[Step, ...], mark: tuple) -> Step:
    step = steps[mark[0]]
    return step if mark[1] < 0 else step.branches[mark[1]]


def list_running(block: Block, name: str, performance: Performance, path: tuple) -> Iterator[tuple]:
    """Yield the paths of the running actions of a performance, each with its step."""
    for mark in performance.marks:
        if mark[2] == "run":
            step = _step_at(block.activities[name], mark)
            yield (*path, step.name), step
            if step.kind == "call":
                yield from list_running(block, step.called, mark[3], (*path, step.name))


def advance(
    block: Block, name: str, performance: Performance, path: tuple, ended: frozenset, scope: dict
) -> tuple[Performance, bool, list, set]:
    """Return the performance after a step, whether it ends, its writes, and what ends inside.

    *ended* are the paths of the elementary actions that the environment ends in this step; *scope*
    has the values of the features and of the parameters.
    """
    steps, marks = block.activities[name], performance.marks
    after, writes, finished = set(), [], set()
    for mark in marks:
        if mark[2] == "wait":
            after.add(mark)
            continue
        if mark[2] == "decide":
            index = _find_open_guard(_step_at(steps, mark).guards, scope)
            if index is None:
                after.add(mark)
            elif index < len(_step_at(steps, mark).branches):
                after |= _enter_branches(block, steps, mark[0], [index])
            else:
                after |= _arrive(block, steps, mark[0] + 1)
            continue
        new_marks, new_writes, new_finished = _perform(block, steps, mark, path, ended, scope)
        after |= new_marks
        writes += new_writes
        finished |= new_finished
    waiting = {mark for mark in after if mark[2] == "wait"}
    if len(waiting) == 2:
        (position, *_), _ = waiting
        after = _arrive(block, steps, position + 1)
    is_finished = not after
    output = ([value for target, value in writes if target == "r"] or [performance.output])[0]
    features = [(target, value) for target, value in writes if target != "r"]
    advanced = replace(performance, marks=frozenset(after), output=output)
    return advanced, is_finished, features, finished


def _arrive(block: Block, steps: tuple[Step, ...], position: int) -> set[tuple]:
    """Return the marks when a token reaches a step; none at the end, which takes no time."""
    if position == len(steps):
        return set()
    step = steps[position]
    if step.kind == "decide":
        return {(position, -1, "decide", None)}
    return _enter_branches(block, steps, position, range(len(step.branches)) or [-1])


def _enter_branches(
    block: Block, steps: tuple[Step, ...], position: int, branches: Iterable[int]
) -> set[tuple]:
    """Return the marks when tokens reach branches of a step, or the step itself (-1)."""
    marks = set()
    for index in branches:
        action, content = _step_at(steps, (position, index)), None
        if action.kind == "call":
            content = start(block, action.called, is_due=action.argument[0] == ":=")
        marks.add((position, index, "run", content))
    return marks


def _perform(
    block: Block, steps: tuple[Step, ...], mark: tuple, path: tuple, ended: frozenset, scope: dict
) -> tuple[set, list, set]:
    """Return the marks after a step of a running action, what it writes and what ends in it."""
    position, branch, _, inner = mark
    step = _step_at(steps, mark)
    own_path = (*path, step.name)
    is_done = step.kind == "assign" or own_path in ended
    content, finished, writes = None, set(), []
    if step.kind == "assign":
        writes.append((step.feature, evaluate(step.value, scope)))
    if step.kind == "call":
        own_scope = _open_scope(step, inner, scope)
        content, is_done, writes, finished = advance(
            block, step.called, inner, own_path, ended, own_scope
        )
        # The value of an output is written at the end, with what is assigned to it just now.
        writes += [(step.feature, content.output)] if is_done and step.feature else []
    if not is_done:
        return {(position, branch, "run", content)}, writes, finished
    is_forked = steps[position].kind == "fork"
    waiting = {(position, branch, "wait", None)}
    following = waiting if is_forked else _arrive(block, steps, position + 1)
    return following, writes, finished | {own_path}


# -- blocks ------------------------------------------------------------------------------------


class State(Struct, frozen=True):
    """A state of a block: marks of performances that do not run are None.

    While ``exit`` runs, ``leaving`` is the transition that has been taken.
    """

    state: str
    values: tuple[bool, bool]
    do: Performance | None
    is_over: bool
    own: Performance | None
    entry: Performance | None = None
    exit: Performance | None = None
    leaving: Move | None = None


def first_state(block: Block) -> State:
    """Return the state in the first step."""
    own = start(block, block.own) if block.own else None
    values = tuple(name == block.start for name in FEATURES)
    return _settle(block, _enter(block, "S0", values, own))


def _enter(block: Block, name: str, values: tuple[bool, bool], own: Performance | None) -> State:
    """Return the step in which a state is entered; its do behaviour waits for a long entry."""
    entry = start(block, block.entry[name]) if name in block.entry else None
    do = start(block, block.do[name]) if name in block.do and entry is None else None
    return State(name, values, do, False, own, entry)


def _settle(block: Block, state: State) -> State:
    """Return the state after the calls that start with it have taken their inputs."""
    values = dict(zip(FEATURES, state.values, strict=True))
    do, own, entry = state.do, state.own, state.entry
    if do is not None:
        do = take_inputs(block, block.do[state.state], do, values)
    if own is not None:
        own = take_inputs(block, block.own, own, values)
    if entry is not None:
        entry = take_inputs(block, block.entry[state.state], entry, values)
    exit = state.exit
    if exit is not None:
        exit = take_inputs(block, block.exit[state.state], exit, values)
    return replace(state, do=do, own=own, entry=entry, exit=exit)


def list_inputs(block: Block, state: State) -> Iterator[tuple[str, frozenset]]:
    """Yield the events and sets of ended actions that the environment may choose."""
    running = [
        (root, path)
        for root, performance in _list_performances(block, state)
        for path, step in list_running(block, root, performance, (root,))
        if step.kind == "elementary"
    ]
    paths = [path for _, path in running]
    subsets = chain.from_iterable(combinations(paths, size) for size in range(len(paths) + 1))
    events = sorted({move.event for move in block.moves if move.event})
    yield from product(("none", *events), map(frozenset, subsets))


def _list_performances(block: Block, state: State) -> list[tuple[str, Performance]]:
    performances = []
    if state.entry is not None:
        performances.append((block.entry[state.state], state.entry))
    if state.do is not None:
        performances.append((block.do[state.state], state.do))
    if state.own is not None:
        performances.append((block.own, state.own))
    if state.exit is not None:
        performances.append((block.exit[state.state], state.exit))
    return performances


def observe(block: Block, state: State, event: str, ended: frozenset) -> frozenset:
    """Return what is true in a step: state, values, event, running and finished actions."""
    facts = {f"state={state.state}", f"event={event}"}
    values = dict(zip(FEATURES, state.values, strict=True))
    facts |= {name for name in FEATURES if values[name]}
    for root, performance in _list_performances(block, state):
        facts.add(f"running({root})")
        _, is_finished, _, finished = advance(block, root, performance, (root,), ended, values)
        facts |= {f"finished({root})"} if is_finished else set()
        for path, _ in list_running(block, root, performance, (root,)):
            facts.add(f"running({'.'.join(path)})")
        facts |= {f"finished({'.'.join(path)})" for path in finished}
    return frozenset(facts)


def observe_decisions(block: Block, state: State) -> set[tuple[str, str]]:
    """Return the decisions at which tokens are in a step, each with the guard that holds or ""."""
    values = dict(zip(FEATURES, state.values, strict=True))
    performances = _list_performances(block, state)
    decisions = (list_decisions(block, *performance, values) for performance in performances)
    return set(chain.from_iterable(decisions))


def list_successors(block: Block, state: State, event: str, ended: frozenset) -> set[State]:
    """Return the states that may follow."""
    return {after for _, after in list_reactions(block, state, event, ended)}


def list_reactions(
    block: Block, state: State, event: str, ended: frozenset
) -> set[tuple[Move | None, State]]:
    """Return the states that may follow, each with the transition that leads to it or None."""
    values = dict(zip(FEATURES, state.values, strict=True))
    do, do_ends, do_writes = state.do, False, []
    own, own_writes = state.own, []
    entry, exit = state.entry, state.exit
    for root, performance in _list_performances(block, state):
        after, is_finished, writes, _ = advance(block, root, performance, (root,), ended, values)
        if root == block.own:
            own, own_writes = (None if is_finished else after), writes
        elif performance is state.entry:
            entry, do_writes = (None if is_finished else after), writes
            starts = is_finished and state.state in block.do
            do = start(block, block.do[state.state]) if starts else None
        elif performance is state.exit:
            exit, do_writes = (None if is_finished else after), writes
        else:
            do, do_ends, do_writes = (None if is_finished else after), is_finished, writes
    reactions = set()
    for seen in _list_seen(values, do_writes):
        moves = _list_moves(block, state, values, seen, event, do_ends)
        if state.exit is not None:
            moves = [] if exit is not None else [state.leaving]
        for move in moves or [None]:
            # The effect of a transition comes after the exit behaviour.
            is_delayed = move is not None and state.state in block.exit and state.exit is None
            effect = None if is_delayed else move
            for written in _list_values(values, seen, do_writes, own_writes, effect):
                if move is None:
                    is_over = state.is_over or do_ends
                    after = replace(state, do=do, is_over=is_over, entry=entry, exit=exit)
                    reactions.add((None, replace(after, values=written, own=own)))
                elif is_delayed:
                    exit_start = start(block, block.exit[state.state])
                    after = State(state.state, written, None, False, own, None, exit_start, move)
                    reactions.add((move, after))
                else:
                    target = _find_target(move, seen)
                    reactions.add((move, _enter(block, target, written, own)))
    return {(move, _settle(block, successor)) for move, successor in reactions}


def _list_moves(
    block: Block, state: State, values: dict, seen: dict, event: str, do_ends: bool
) -> list[Move | None]:
    """Return the enabled transitions; after the end of the do behaviour they read its writes."""
    if state.entry is not None:
        return []
    leaving = []
    for move in block.moves:
        read = seen if do_ends and not move.event else values
        if move.source == state.state and (not move.guard or evaluate(move.guard, read)):
            leaving.append(move)
    is_complete = state.state not in block.do or state.is_over or do_ends
    completing = [move for move in leaving if not move.event and is_complete]
    return completing or [move for move in leaving if move.event == event]


def _find_target(move: Move, seen: dict) -> str:
    """Return the state to which a transition leads; a choice reads the values after its effect."""
    if move.choice is None:
        return move.target
    reached = dict(seen)
    if move.effect:
        reached[move.effect[0]] = evaluate(move.effect[1], seen)
    guard, other = move.choice
    return move.target if evaluate(guard, reached) else other


def evaluate(text: str, values: dict) -> bool:
    """Return the value of a guard or of an assigned expression."""
    if text.startswith("not "):
        return not values[text[4:]]
    return {"true": True, "false": False}.get(text) if text in ("true", "false") else values[text]


def _list_seen(values: dict, do_writes: list) -> list[dict]:
    """Return what a transition may read: a write of the do behaviour, else the value before."""
    read = [
        [value for name, value in do_writes if name == feature] or [values[feature]]
        for feature in FEATURES
    ]
    return [dict(zip(FEATURES, row, strict=True)) for row in product(*read)]


def _list_values(
    values: dict, seen: dict, do_writes: list, own_writes: list, move: Move | None
) -> set[tuple[bool, bool]]:
    """Return the possible values of the features after a step.

    A transition overrides what the do behaviour writes, and reads it. The block's own activity is
    concurrent to both, so that any of the values may result.
    """
    options = []
    for feature in FEATURES:
        writes = [value for name, value in do_writes if name == feature]
        if move is not None and move.effect and move.effect[0] == feature:
            writes = [evaluate(move.effect[1], seen)]
        writes += [value for name, value in own_writes if name == feature]
        options.append(writes or [values[feature]])
    return set(product(*options))


def list_observed_steps(block: Block, limit: int) -> set[tuple[frozenset, frozenset]] | None:
    """Return the pairs of observations of successive steps; None for more than *limit* states."""
    seen, worklist = {first_state(block)}, [first_state(block)]
    pairs = set()
    while worklist:
        state = worklist.pop()
        for event, ended in list_inputs(block, state):
            observation = observe(block, state, event, ended)
            for after in list_successors(block, state, event, ended):
                if after not in seen:
                    seen.add(after)
                    worklist.append(after)
                    if len(seen) > limit:
                        return None
                for inputs in list_inputs(block, after):
                    pairs.add((observation, observe(block, after, *inputs)))
    return pairs
