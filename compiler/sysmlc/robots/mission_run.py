"""The record of one run of a mission, and its presentation as text and as a sequence diagram."""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from sysmlc.robots.answers import Answers
from sysmlc.robots.run_sets import RunSpace, difference
from sysmlc.robots.study import STAY, Study
from sysmlc.robots.world import Allocation, World
from sysmlc.support.plantuml_text import escape_line, format_label


class Moment(Struct, frozen=True):
    """One step of a run; cells, goals and commands are listed by robot."""

    cells: tuple[int, ...]
    goals: tuple[int | None, ...]
    """The cell to which a robot is sent; None for a resting robot."""
    commands: tuple[str, ...]
    reached: tuple[tuple[int, int], ...]
    """Robot and target of each target that was reached in this step."""


def record_run(
    study: Study,
    allocation: Allocation,
    answers: Sequence[Answers],
    starts: Sequence[int],
    steps: int,
) -> tuple[Moment, ...]:
    """Simulate and record *steps* steps from the start cells of the robots."""
    # The simulation of many runs, here with a single one.
    cells = range(study.grid.size)
    start_sets = tuple(tuple(int(cell == start) for cell in cells) for start in starts)
    runs = RunSpace(1, 0, start_sets, difference)
    world = World(study, allocation, answers, runs)
    done_before = list(world.done)
    moments = [_capture_moment(world, done_before)]
    for _ in range(steps):
        world.step()
        moments.append(_capture_moment(world, done_before))
        done_before = list(world.done)
    return tuple(moments)


def _capture_moment(world: World[int], done_before: list[int]) -> Moment:
    cells, goals, commands = [], [], []
    for number, body in enumerate(world.bodies):
        cells.append(body.places.index(1))
        goals.append(_current_goal(world, number))
        commands.append(next((way for way, run_set in body.commands.items() if run_set), STAY))
    new_targets = [
        target_number
        for target_number, run_set in enumerate(world.done)
        if run_set and not done_before[target_number]
    ]
    robot_by_target = {
        target: robot for robot, targets in enumerate(world.allocation) for target in targets
    }
    reached = tuple((robot_by_target[target], target) for target in new_targets)
    return Moment(tuple(cells), tuple(goals), tuple(commands), reached)


def _current_goal(world: World[int], number: int) -> int | None:
    body = world.bodies[number]
    targets = (world.study.targets[target].cell for target in _active_targets(world, number))
    evasions = (cell for cell, run_set in enumerate(body.evasions) if run_set)
    return next(iter((*targets, *evasions)), None)


def _active_targets(world: World[int], number: int) -> Iterator[int]:
    pairs = zip(world.allocation[number], world.bodies[number].assigned, strict=True)
    return (target for target, run_set in pairs if run_set)


def describe_cell(study: Study, cell: int) -> str:
    """Return the description of a cell: the name of its target, or row and column."""
    target_name = next((target.name for target in study.targets if target.cell == cell), "")
    row, column = divmod(cell, study.grid.columns)
    return f"'{target_name}'" if target_name else f"row {row}, column {column}"


def describe_moments(study: Study, moments: Sequence[Moment], max_lines: int = 40) -> Iterator[str]:
    """Yield a line for each step with new or reached targets, up to *max_lines*."""
    shown = 0
    for step, moment in enumerate(moments):
        previous = moments[step - 1] if step else None
        events = [text for _, text in _describe_changes(study, previous, moment)]
        if step == 0:
            pairs = zip(study.robots, moment.cells, strict=True)
            events = [f"'{robot.name}' is at {describe_cell(study, cell)}" for robot, cell in pairs]
        if events:
            shown += 1
            if shown > max_lines:
                yield "and so on"
                return
            yield f"step {step}: {'; '.join(events)}"


def _describe_changes(
    study: Study, previous: Moment | None, moment: Moment
) -> Iterator[tuple[int, str]]:
    """Yield robot and text for each target that a robot gets or reaches."""
    target_cells = {target.cell for target in study.targets}
    for robot, goal in enumerate(moment.goals):
        if previous is not None and goal is not None and previous.goals[robot] != goal:
            verb = "goes to" if goal in target_cells else "makes way to"
            yield robot, f"'{study.robots[robot].name}' {verb} {describe_cell(study, goal)}"
    for robot, target in moment.reached:
        yield robot, f"'{study.robots[robot].name}' reaches '{study.targets[target].name}'"


def sequence_diagram(study: Study, moments: Sequence[Moment], title: str) -> str:
    """Return the run as a PlantUML sequence diagram of the mission and the robots.

    Messages are assigned targets, evasions (dashed) and reached targets.
    """
    lines = [
        "@startuml",
        f"title {escape_line(title)}",
        "hide footbox",
        'participant "mission" as m',
    ]
    lines += [
        f'participant "{format_label(robot.name)}" as r{number}'
        for number, robot in enumerate(study.robots)
    ]
    target_cells = {target.cell for target in study.targets}
    for step, moment in enumerate(moments):
        messages: list[str] = []
        for robot_number, goal in enumerate(moment.goals):
            if step and goal is not None and moments[step - 1].goals[robot_number] != goal:
                arrow = "->" if goal in target_cells else "-[dashed]>"
                place_name = describe_cell(study, goal).strip("'")
                messages.append(f"m {arrow} r{robot_number} : {escape_line(place_name)}")
        for robot_number, target_number in moment.reached:
            name = escape_line(study.targets[target_number].name)
            messages.append(f"r{robot_number} --> m : {name} reached")
        if messages:
            lines += [f"== step {step} ==", *messages]
    return "\n".join((*lines, "@enduml", ""))
