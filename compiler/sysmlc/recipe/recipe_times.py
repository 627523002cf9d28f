"""The time of a whole recipe, and verdicts on the times that requirements state."""

from collections.abc import Iterable, Iterator, Mapping
from math import inf
from typing import Literal as OneOf

from msgspec import Struct

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir.algorithms import sort_topologically
from sysmlc.recipe.durations import find_full_duration, format_range
from sysmlc.recipe.flow import find_cycles, find_reachable
from sysmlc.recipe.model import Derived, Model, Number, Range, Recipe, Task, TimeLimit
from sysmlc.recipe.tables import Finding, Tables

TIME_LIMIT = rule(
    "SM641",
    "recipe-breaks-time-limit",
    Severity.WARNING,
    "requirement '{requirement}' allows {limit}, but '{name}' takes {derived} ms",
    help="correct the requirement, shorten a service or a loop, or let services run in parallel",
)
TIME_OPEN = rule(
    "SM642",
    "recipe-time-limit-undecided",
    Severity.INFO,
    "'{name}' may take longer than {limit}, which requirement '{requirement}' allows: {reason}",
    help="apply «Loop» with maxIterations to the decision, or state the missing duration",
)

Verdict = OneOf["holds", "broken", "not-decided"]


# -- recipes -----------------------------------------------------------------------------------


def derive_recipe(recipe: Recipe) -> Derived | None:
    """Return the duration of a recipe; None if the duration of a task is unknown.

    Tasks that may run at the same time and need one machine follow one another. The minimum is that
    of the longest path or of the busiest machine, the maximum an upper bound for every order in
    which no task waits while its machines are free.
    """
    durations = {task.id: _find_task_duration(task) for task in recipe.tasks}
    stated = {id: duration for id, duration in durations.items() if duration is not None}
    is_cyclic = bool(find_cycles(durations, recipe.precedence))
    if not stated or len(stated) < len(durations) or is_cyclic:
        return None
    ends = _find_path_ends(recipe, {id: span.min for id, span in stated.items()})
    shortest = max(*ends.values(), *_sum_machine_work(recipe).values(), 0)
    longest = {task.id: _find_longest_time(task, stated[task.id]) for task in recipe.tasks}
    maxima = {id: time for id, time in longest.items() if time is not None}
    if len(maxima) < len(stated):
        endless = next(id for id, time in longest.items() if time is None)
        reason = f"'{endless}' has no longest duration"
        return Derived(duration=Range(shortest, None), because=reason)
    return Derived(duration=Range(shortest, max(_find_latest_ends(recipe, maxima).values())))


def _find_task_duration(task: Task) -> Range | None:
    """Return the derived duration of a task, or without one the range of its stated durations."""
    if task.derived is not None and task.derived.duration is not None:
        return task.derived.duration
    stated = [mode.duration for mode in task.equipment if mode.duration is not None]
    is_complete = bool(stated) and len(stated) == len(task.equipment)
    return Range(min(stated), max(stated)) if is_complete else None


def _find_longest_time(task: Task, duration: Range) -> Number | None:
    """Return the longest time of a task, executions that end early included."""
    full = None if task.derived is None else find_full_duration(task.derived)
    return (full or duration).max


def _find_path_ends(recipe: Recipe, times: Mapping[str, Number]) -> dict[str, Number]:
    """Return the earliest end of each task by the tasks before it."""
    ends: dict[str, Number] = {}
    for id in sort_topologically(times, recipe.precedence):
        before = (ends[a] for a, b in recipe.precedence if b == id)
        ends[id] = max(before, default=0) + times[id]
    return ends


def _sum_machine_work(recipe: Recipe) -> dict[str, Number]:
    """Return the least time in which each machine does the sub-tasks that no other machine can."""
    work: dict[str, Number] = {}
    sub_tasks = (entry for task in recipe.tasks if task.derived for entry in task.derived.sub_tasks)
    for sub_task in sub_tasks:
        machines = {machine for mode in sub_task.alternatives for machine in mode.machines}
        times = [mode.duration for mode in sub_task.alternatives if mode.duration is not None]
        if len(machines) == 1 and len(times) == len(sub_task.alternatives) and sub_task.runs:
            machine = machines.pop()
            work[machine] = work.get(machine, 0) + sub_task.runs.min * min(times)
    return work


def _find_latest_ends(recipe: Recipe, times: Mapping[str, Number]) -> dict[str, Number]:
    """Return an upper bound for the end of each task.

    A task waits only while a rival is running (``_find_rivals``), and each rival runs once: a task
    ends at the latest after the tasks before it, its rivals and itself. Neither does its end exceed
    the total time of all tasks that are before it or rivals of one of these.
    """
    rivals = _find_rivals(recipe)
    ends: dict[str, Number] = {}
    involved: dict[str, set[str]] = {}
    for id in sort_topologically(times, recipe.precedence):
        before = [a for a, b in recipe.precedence if b == id]
        involved[id] = rivals[id].union({id}, *(involved[task] for task in before))
        waiting = sum(times[rival] for rival in rivals[id])
        latest = max((ends[task] for task in before), default=0) + waiting + times[id]
        ends[id] = min(latest, sum(times[task] for task in involved[id]))
    return ends


def _find_rivals(recipe: Recipe) -> dict[str, set[str]]:
    """Return for each task the tasks for which it may wait at a machine.

    These may run at the same time and need one of its machines. If services keep a machine for a
    later service, rivals of rivals count, too, because the rival may wait with the machine.
    """
    machines = {task.id: _list_machines(task) for task in recipe.tasks}
    after = {task.id: find_reachable([task.id], recipe.precedence) for task in recipe.tasks}
    keeps_machines = any(task.derived and task.derived.same_machine for task in recipe.tasks)
    rivals: dict[str, set[str]] = {}
    for id, needed in machines.items():
        parallel = [task for task in machines if task not in after[id] and id not in after[task]]
        found: set[str] = set()
        reached = set(needed)
        while new := [t for t in parallel if t not in found and machines[t] & reached]:
            found.update(new)
            if not keeps_machines:
                break
            reached = reached.union(*(machines[task] for task in new))
        rivals[id] = found
    return rivals


def _list_machines(task: Task) -> set[str]:
    sub_tasks = () if task.derived is None else task.derived.sub_tasks
    modes = [*task.equipment, *(mode for entry in sub_tasks for mode in entry.alternatives)]
    return {machine for mode in modes for machine in mode.machines}


# -- requirements ------------------------------------------------------------------------------


def decide_limit(limit: TimeLimit, derived: Derived | None) -> Verdict:
    """Return whether all executions keep a limit by their derived duration.

    It is not decided if only the longest executions may break it: the maximum is an upper bound.
    """
    duration = None if derived is None else find_full_duration(derived)
    if duration is None:
        return "not-decided"
    longest = inf if duration.max is None else duration.max
    least = 0 if limit.least is None else limit.least
    most = inf if limit.most is None else limit.most
    if duration.min > most or longest < least:
        return "broken"
    return "holds" if longest <= most and duration.min >= least else "not-decided"


class LimitVerdict(Struct, frozen=True):
    """Whether all tasks and recipes keep the time that a requirement allows, and by which times."""

    verdict: Verdict
    reason: str


def decide_limits(models: Iterable[Model]) -> dict[str, LimitVerdict]:
    """Return the verdict on each time that a requirement allows, by the id of the requirement.

    A requirement on several tasks is broken if one of them breaks it.
    """
    verdicts: dict[str, LimitVerdict] = {}
    for model in models:
        owners: tuple[Recipe | Task, ...] = (model.recipe, *model.recipe.tasks)
        for owner in owners:
            for limit in owner.limits:
                verdict = _explain_limit(owner, limit)
                previous = verdicts.get(limit.element, verdict)
                order = ("holds", "not-decided", "broken")
                verdicts[limit.element] = max(
                    previous, verdict, key=lambda item: order.index(item.verdict)
                )
    return verdicts


def _explain_limit(owner: Recipe | Task, limit: TimeLimit) -> LimitVerdict:
    duration = None if owner.derived is None else find_full_duration(owner.derived)
    takes = "an unknown time" if duration is None else f"{format_range(duration)} ms"
    reason = f"'{owner.id}' takes {takes}, and {_format_limit(limit)} is allowed"
    return LimitVerdict(decide_limit(limit, owner.derived), reason)


def check_time_limits(model: Model, tables: Tables) -> Iterator[Finding]:
    """SM641, SM642: tasks and the recipe keep the times that their requirements state."""
    owners: tuple[Recipe | Task, ...] = (model.recipe, *model.recipe.tasks)
    for owner in owners:
        for limit in owner.limits:
            verdict = decide_limit(limit, owner.derived)
            if owner.derived is not None and verdict != "holds":
                yield _make_finding(owner, limit, owner.derived)


def _make_finding(owner: Recipe | Task, limit: TimeLimit, derived: Derived) -> Finding:
    facts = {"requirement": limit.requirement, "limit": _format_limit(limit), "name": owner.id}
    duration = find_full_duration(derived)
    is_open = duration is None or (
        duration.max is None and decide_limit(limit, derived) != "broken"
    )
    if duration is None or is_open:
        reason = derived.because or "the duration of a step is unknown"
        return Finding(TIME_OPEN, limit.element, {**facts, "reason": reason})
    return Finding(TIME_LIMIT, limit.element, {**facts, "derived": format_range(duration)})


def _format_limit(limit: TimeLimit) -> str:
    least = [] if limit.least is None else [f"at least {limit.least} ms"]
    most = [] if limit.most is None else [f"at most {limit.most} ms"]
    return " and ".join([*least, *most])
