"""Files about a study: Markdown report, sequence diagram, controller, contract of the mission."""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.controllers.machine import Machine
from sysmlc.logic.formats import write
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.mission_run import describe_cell, describe_moments, sequence_diagram
from sysmlc.robots.outcome import Outcome
from sysmlc.robots.schedule import START, Schedule
from sysmlc.robots.study import Study
from sysmlc.support.counts import count
from sysmlc.support.escapes import escape_markdown
from sysmlc.support.output import assign_file_names
from sysmlc.synthesis.controller_files import controller_files


def study_files(outcome: Outcome) -> Iterator[tuple[str, str]]:
    """Yield paths and texts of all files about one study."""
    study = outcome.study
    names = assign_file_names([study.component, outcome.controller.contract.component])
    name = names[study.component]
    yield f"robots/{name}.md", study_markdown(outcome)
    if outcome.run:
        title = f"{study.component}: one run of the mission"
        yield f"robots/{name}.seq.puml", sequence_diagram(study, outcome.run, title)
    if outcome.controller.machine is not None:
        contract = outcome.controller.contract
        machine = names[contract.component]
        for file, text in controller_files(machine, outcome.controller.machine, contract, "own"):
            # Conditions over all cells make the arrows of a diagram unreadable.
            if file.endswith(".json"):
                yield f"robots/{file}", text
    if study.targets and outcome.travel.steps:
        mission = mission_contract(study, outcome.travel)
        yield f"robots/{name}.mission.contract.json", write(mission, "contract")


def summarise_outcome(outcome: Outcome) -> str:
    """Return floor and outcome of a study on one line."""
    study = outcome.study
    head = f"{study.component}: {count(study.grid.size, 'cell')}, "
    head += f"{count(len(study.robots), 'robot')}, {count(len(study.targets), 'target')}"
    if outcome.controller.machine is None:
        return f"{head}: no controller"
    if not study.targets:
        return f"{head}: no mission"
    tried = outcome.chosen
    if tried is None:
        return f"{head}: no allocation is possible in time"
    starts = count(tried.validation.starts, "start")
    if not tried.validation.is_good:
        return f"{head}: the mission fails ({count(len(outcome.tried), 'allocation')} tried)"
    return f"{head}: done in {count(tried.validation.steps, 'step')} at most, from {starts}"


def study_markdown(outcome: Outcome) -> str:
    """Return the report on one study, with the model's names escaped."""
    study = _escape_names(outcome.study)
    outcome = replace(outcome, study=study)
    text = [f"# {study.component}", "", f"{summarise_outcome(outcome)}.", "", *_draw_floor(study)]
    text += _describe_controller(outcome)
    if study.targets and outcome.travel.steps:
        text += [*_describe_travel_times(outcome), *_describe_allocations(outcome)]
    if outcome.relations:
        text += _describe_claims(outcome)
    if outcome.run:
        text += [
            "",
            "## One run",
            "",
            *(f"- {line}" for line in describe_moments(study, outcome.run)),
        ]
    return "\n".join((*text, ""))


def _escape_names(study: Study) -> Study:
    return replace(
        study,
        component=escape_markdown(study.component),
        robots=tuple(replace(item, name=escape_markdown(item.name)) for item in study.robots),
        targets=tuple(replace(item, name=escape_markdown(item.name)) for item in study.targets),
    )


def _draw_floor(study: Study) -> Iterator[str]:
    """Yield the floor as text: obstacles, letters for robots and digits for targets."""
    robot_letters = {
        item.start: chr(ord("A") + number % 26) for number, item in enumerate(study.robots)
    }
    target_digits = {item.cell: str((number + 1) % 10) for number, item in enumerate(study.targets)}
    yield "```"
    for row in range(study.grid.rows):
        cells = range(row * study.grid.columns, (row + 1) * study.grid.columns)
        yield " ".join(
            "#"
            if cell in study.grid.blocked
            else robot_letters.get(cell, target_digits.get(cell, "."))
            for cell in cells
        )
    yield "```"
    robots = (
        f"{chr(ord('A') + number % 26)} {item.name}" for number, item in enumerate(study.robots)
    )
    targets = (f"{(number + 1) % 10} {item.name}" for number, item in enumerate(study.targets))
    yield f"Robots: {', '.join(robots)}. Targets: {', '.join(targets) or 'none'}."


def _describe_controller(outcome: Outcome) -> Iterator[str]:
    """Yield the section about the controller. CPU times would make the file irreproducible."""
    yield from ("", "## Controller of the robots", "")
    machine = outcome.controller.machine
    if machine is None:
        yield "There is none."
    elif isinstance(machine, Machine):
        size = count(machine.size, "state")
        yield f"A machine of {size}, the same for all robots, checked against their contract."
    else:
        nodes = count(len(machine.nodes), "decision node")
        yield f"A table of {nodes}, the same for all robots, checked against their contract."


def _describe_travel_times(outcome: Outcome) -> Iterator[str]:
    """Yield the table of travel times between places.

    Rows from targets are the same for all robots and occur once.
    """
    study = outcome.study
    yield from ("", "## Travel times", "", "Steps, measured in the simulation of one robot.", "")
    yield f"| from | {' | '.join(target.name for target in study.targets)} |"
    yield f"|---|{'---|' * len(study.targets)}"
    for number, robot in enumerate(study.robots):
        start = "any start" if robot.start is None else describe_cell(study, robot.start)
        yield f"| {robot.name}: {start} | {_travel_times_row(outcome, number, START)} |"
    for place, target in enumerate(study.targets):
        yield f"| {target.name} | {_travel_times_row(outcome, 0, place)} |"


def _travel_times_row(outcome: Outcome, robot: int, place: int) -> str:
    goals = range(len(outcome.study.targets))
    return " | ".join(str(outcome.travel.get(robot, place, goal) or "") for goal in goals)


def _describe_allocations(outcome: Outcome) -> Iterator[str]:
    yield from ("", "## Allocation", "")
    if outcome.greedy is not None:
        name = "Algorithm 1 as printed" if outcome.is_printed else "Algorithm 1"
        yield f"- {name}: {_describe_allocation(outcome.study, outcome.greedy)}"
    if outcome.best is not None:
        quality = "the best there is" if outcome.best.is_proven else "the best that was found"
        allocation = _describe_allocation(outcome.study, outcome.best.schedule)
        yield f"- Branch and bound ({quality}): {allocation}"
    yield from ("", "## Simulation of robots and environment together", "")
    for tried in outcome.tried:
        validation = tried.validation
        result = (
            f"done in {count(validation.steps, 'step')} at most" if validation.is_good else "fails"
        )
        allocation_text = _describe_allocation(outcome.study, tried.schedule)
        yield f"- {allocation_text}: {result}, from {count(validation.starts, 'start')}"


def _describe_allocation(study: Study, schedule: Schedule) -> str:
    names = [
        f"{robot.name} {', '.join(study.targets[target].name for target in targets) or 'nothing'}"
        for robot, targets in zip(study.robots, schedule.allocation, strict=True)
    ]
    return f"{'; '.join(names)} ({count(schedule.duration, 'step')}, {schedule.total} travelled)"


def _describe_claims(outcome: Outcome) -> Iterator[str]:
    yield from ("", "## What the thesis claims", "", "| claim | holds | |", "|---|---|---|")
    answers = {True: "yes", False: "no", None: "not decided"}
    for claim in outcome.relations:
        yield f"| {claim.claim} | {answers[claim.holds]} | {claim.reason} |"
