"""One run, told: who is where, who goes where, and what was reached."""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from sysmlc.robots.answers import Answers
from sysmlc.robots.run_sets import RunSpace, difference
from sysmlc.robots.study import STAY, Study
from sysmlc.robots.world import Allocation, World
from sysmlc.support.plantuml_text import label, plain


class Moment(Struct, frozen=True):
    """A step of one run, by robot."""

    cells: tuple[int, ...]
    goals: tuple[int | None, ...]
    """The cell that a robot is sent to; None for one that rests."""
    commands: tuple[str, ...]
    reached: tuple[tuple[int, int], ...]
    """Robot and target of what has been reached in this step."""


def record_run(
    study: Study,
    allocation: Allocation,
    answers: Sequence[Answers],
    starts: Sequence[int],
    steps: int,
) -> tuple[Moment, ...]:
    """The run from some starts, for so many steps."""
    cells = range(study.grid.size)
    placed = tuple(tuple(int(cell == start) for cell in cells) for start in starts)
    runs = RunSpace(1, 0, placed, difference)
    world = World(study, allocation, answers, runs)
    done = list(world.done)
    found = [_capture_moment(world, done)]
    for _ in range(steps):
        world.step()
        found.append(_capture_moment(world, done))
        done = list(world.done)
    return tuple(found)


def _capture_moment(world: World[int], before: list[int]) -> Moment:
    cells, goals, commands = [], [], []
    for number, body in enumerate(world.bodies):
        cells.append(body.places.index(1))
        goals.append(_current_goal(world, number))
        commands.append(next((way for way, one in body.commands.items() if one), STAY))
    new = [at for at, one in enumerate(world.done) if one and not before[at]]
    owner = {target: robot for robot, own in enumerate(world.allocation) for target in own}
    reached = tuple((owner[target], target) for target in new)
    return Moment(tuple(cells), tuple(goals), tuple(commands), reached)


def _current_goal(world: World[int], number: int) -> int | None:
    body = world.bodies[number]
    sent = (world.study.targets[target].cell for target in _active_targets(world, number))
    aside = (cell for cell, one in enumerate(body.aside) if one)
    return next((*sent, *aside).__iter__(), None)


def _active_targets(world: World[int], number: int) -> Iterator[int]:
    pairs = zip(world.allocation[number], world.bodies[number].sent, strict=True)
    return (target for target, one in pairs if one)


def describe_cell(study: Study, cell: int) -> str:
    """A cell as the model names it: a target, or its row and column."""
    name = next((one.name for one in study.targets if one.cell == cell), "")
    row, column = divmod(cell, study.grid.columns)
    return f"'{name}'" if name else f"row {row}, column {column}"


def describe_moments(study: Study, moments: Sequence[Moment], most: int = 40) -> Iterator[str]:
    """What changes in each step, a line a step; steps without a change are left out."""
    shown = 0
    for step, moment in enumerate(moments):
        before = moments[step - 1] if step else None
        told = [text for _, text in _describe_changes(study, before, moment)]
        if step == 0:
            pairs = zip(study.robots, moment.cells, strict=True)
            told = [f"'{robot.name}' is at {describe_cell(study, cell)}" for robot, cell in pairs]
        if told:
            shown += 1
            if shown > most:
                yield "and so on"
                return
            yield f"step {step}: {'; '.join(told)}"


def _describe_changes(
    study: Study, before: Moment | None, now: Moment
) -> Iterator[tuple[int, str]]:
    """Robot and words for new targets and for what was reached."""
    goals = {one.cell for one in study.targets}
    for robot, goal in enumerate(now.goals):
        if before is not None and goal is not None and before.goals[robot] != goal:
            verb = "goes to" if goal in goals else "makes way to"
            yield robot, f"'{study.robots[robot].name}' {verb} {describe_cell(study, goal)}"
    for robot, target in now.reached:
        yield robot, f"'{study.robots[robot].name}' reaches '{study.targets[target].name}'"


def sequence_diagram(study: Study, moments: Sequence[Moment], title: str) -> str:
    """The run as a sequence diagram in PlantUML: targets given, commands, targets reached."""
    text = ["@startuml", f"title {plain(title)}", "hide footbox", 'participant "mission" as m']
    text += [f'participant "{label(one.name)}" as r{at}' for at, one in enumerate(study.robots)]
    goals = {one.cell for one in study.targets}
    for step, moment in enumerate(moments):
        found: list[str] = []
        for robot, goal in enumerate(moment.goals):
            if step and goal is not None and moments[step - 1].goals[robot] != goal:
                arrow = "->" if goal in goals else "-[dashed]>"
                where = describe_cell(study, goal).strip("'")
                found.append(f"m {arrow} r{robot} : {plain(where)}")
        for robot, target in moment.reached:
            found.append(f"r{robot} --> m : {plain(study.targets[target].name)} reached")
        if found:
            text += [f"== step {step} ==", *found]
    return "\n".join((*text, "@enduml", ""))
