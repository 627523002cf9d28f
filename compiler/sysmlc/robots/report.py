"""What became of a study, for people: Markdown, a sequence diagram, the machine, the mission."""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.logic.formats import write
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.mission_run import describe_cell, describe_moments, sequence_diagram
from sysmlc.robots.outcome import Outcome, told_steps
from sysmlc.robots.schedule import START, Schedule
from sysmlc.robots.study import Study
from sysmlc.support.escapes import escape_markdown
from sysmlc.support.file_names import assign_file_names
from sysmlc.synthesis.controller_files import controller_files
from sysmlc.synthesis.controllers.mealy import Machine


def files(outcome: Outcome) -> Iterator[tuple[str, str]]:
    """Paths and texts of all files about one study."""
    study = outcome.study
    names = assign_file_names([study.component, outcome.controller.contract.component])
    name = names[study.component]
    yield f"robots/{name}.md", markdown(outcome)
    if outcome.run:
        title = f"{study.component}: one run of the mission"
        yield f"robots/{name}.seq.puml", sequence_diagram(study, outcome.run, title)
    if outcome.controller.machine is not None:
        contract = outcome.controller.contract
        machine = names[contract.component]
        for file, text in controller_files(machine, outcome.controller.machine, contract, "own"):
            # Conditions over all cells make arrows that nobody can read.
            if file.endswith(".json"):
                yield f"robots/{file}", text
    if study.targets and outcome.travel.steps:
        mission = mission_contract(study, outcome.travel)
        yield f"robots/{name}.mission.contract.json", write(mission, "contract")


def summary(outcome: Outcome) -> str:
    """The outcome on one line."""
    study = outcome.study
    head = f"{study.component}: {_count(study.grid.size, 'cell')}, "
    head += f"{_count(len(study.robots), 'robot')}, {_count(len(study.targets), 'target')}"
    if outcome.controller.machine is None:
        return f"{head}: no controller"
    if not study.targets:
        return f"{head}: no mission"
    tried = outcome.chosen
    if tried is None:
        return f"{head}: no allocation keeps the deadlines"
    starts = _count(tried.validation.starts, "start")
    if not tried.validation.is_good:
        return f"{head}: the mission fails ({_count(len(outcome.tried), 'allocation')} tried)"
    return f"{head}: done in {told_steps(tried.validation.steps)} at most, from {starts}"


def _count(number: int, what: str) -> str:
    return f"{number:,} {what}{'' if number == 1 else 's'}"


def markdown(outcome: Outcome) -> str:
    """Return the report on one study, names of the model escaped."""
    study = _escape_names(outcome.study)
    outcome = replace(outcome, study=study)
    text = [f"# {study.component}", "", f"{summary(outcome)}.", "", *_floor(study)]
    text += _controller(outcome)
    if study.targets and outcome.travel.steps:
        text += [*_travel(outcome), *_allocations(outcome)]
    if outcome.relations:
        text += _claims(outcome)
    if outcome.run:
        text += [
            "",
            "## One run",
            "",
            *(f"- {one}" for one in describe_moments(study, outcome.run)),
        ]
    return "\n".join((*text, ""))


def _escape_names(study: Study) -> Study:
    return replace(
        study,
        component=escape_markdown(study.component),
        robots=tuple(replace(one, name=escape_markdown(one.name)) for one in study.robots),
        targets=tuple(replace(one, name=escape_markdown(one.name)) for one in study.targets),
    )


def _floor(study: Study) -> Iterator[str]:
    """The floor as a drawing: obstacles, first letters of robots' and numbers of targets."""
    starts = {one.start: chr(ord("A") + at % 26) for at, one in enumerate(study.robots)}
    goals = {one.cell: str((at + 1) % 10) for at, one in enumerate(study.targets)}
    yield "```"
    for row in range(study.grid.rows):
        cells = range(row * study.grid.columns, (row + 1) * study.grid.columns)
        yield " ".join(
            "#" if cell in study.grid.blocked else starts.get(cell, goals.get(cell, "."))
            for cell in cells
        )
    yield "```"
    robots = (f"{chr(ord('A') + at % 26)} {one.name}" for at, one in enumerate(study.robots))
    targets = (f"{(at + 1) % 10} {one.name}" for at, one in enumerate(study.targets))
    yield f"Robots: {', '.join(robots)}. Targets: {', '.join(targets) or 'none'}."


def _controller(outcome: Outcome) -> Iterator[str]:
    """What the machine is like; times would make the file another one in each run."""
    yield from ("", "## Controller of the robots", "")
    machine = outcome.controller.machine
    if machine is None:
        yield "There is none."
    elif isinstance(machine, Machine):
        size = _count(machine.size, "state")
        yield f"A machine of {size}, the same for all robots, checked against their contract."
    else:
        nodes = _count(len(machine.nodes), "decision node")
        yield f"A table of {nodes}, the same for all robots, checked against their contract."


def _travel(outcome: Outcome) -> Iterator[str]:
    """Measured steps between places, robots that travel alike once."""
    study = outcome.study
    yield from ("", "## Travel times", "", "Steps, measured in the simulation of one robot.", "")
    yield f"| from | {' | '.join(one.name for one in study.targets)} |"
    yield f"|---|{'---|' * len(study.targets)}"
    for robot, one in enumerate(study.robots):
        where = "any start" if one.start is None else describe_cell(study, one.start)
        yield f"| {one.name}: {where} | {_row(outcome, robot, START)} |"
    for place, target in enumerate(study.targets):
        yield f"| {target.name} | {_row(outcome, 0, place)} |"


def _row(outcome: Outcome, robot: int, place: int) -> str:
    goals = range(len(outcome.study.targets))
    return " | ".join(str(outcome.travel.get(robot, place, goal) or "") for goal in goals)


def _allocations(outcome: Outcome) -> Iterator[str]:
    yield from ("", "## Allocation", "")
    if outcome.greedy is not None:
        yield f"- Algorithm 1: {_allocation(outcome.study, outcome.greedy)}"
    if outcome.best is not None:
        how = "the best there is" if outcome.best.is_proven else "the best that was found"
        yield f"- Branch and bound ({how}): {_allocation(outcome.study, outcome.best.schedule)}"
    yield from ("", "## Simulation of robots and environment together", "")
    for tried in outcome.tried:
        found = tried.validation
        words = f"done in {told_steps(found.steps)} at most" if found.is_good else "fails"
        told = _allocation(outcome.study, tried.schedule)
        yield f"- {told}: {words}, from {_count(found.starts, 'start')}"


def _allocation(study: Study, schedule: Schedule) -> str:
    names = [
        f"{robot.name} {', '.join(study.targets[one].name for one in own) or 'nothing'}"
        for robot, own in zip(study.robots, schedule.allocation, strict=True)
    ]
    return f"{'; '.join(names)} ({schedule.duration} steps, {schedule.total} travelled)"


def _claims(outcome: Outcome) -> Iterator[str]:
    yield from ("", "## What the thesis claims", "", "| claim | holds | |", "|---|---|---|")
    words = {True: "yes", False: "no", None: "not decided"}
    for one in outcome.relations:
        yield f"| {one.claim} | {words[one.holds]} | {one.reason} |"
