"""The whole flow of the thesis's figure 4.3: from a study to a mission that is validated."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.robots.allocation import (
    BestAllocation,
    allocate_greedily,
    allocate_optimally,
    neighbour_allocations,
)
from sysmlc.robots.answers import Answers
from sysmlc.robots.claims import Claim, decide_claims
from sysmlc.robots.crew_cache import CrewCache, RobotCrew
from sysmlc.robots.environment_contract import Sharing, environment_contract
from sysmlc.robots.mission_run import Moment, describe_moments, record_run
from sysmlc.robots.robot_controller import Times, answers_of, measured, synthesise, travels
from sysmlc.robots.schedule import Schedule, TravelTimes, meets_deadlines
from sysmlc.robots.study import Study
from sysmlc.robots.validation import Validation, validate_allocation
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.decision import Options, Place, decide

MOST_TRIED = 12
"""Allocations that are validated before it is given up."""
SHARED = "C_E can be kept as the thesis has it"
"""The claim that is settled by offering a cell to one robot."""

SHARED_CELL = rule(
    "SM570",
    "environment-shares-cells",
    Severity.INFO,
    "no environment can keep C_E of '{floor}' as the thesis has it: '{one}' and '{other}' are both "
    "told that a cell is free, and go there; it is offered to one of them",
)
NOT_VALIDATED = rule(
    "SM571",
    "mission-fails",
    Severity.ERROR,
    "the mission of '{floor}' fails: {reason}",
    help=(
        "give more time, move obstacles or starts, or order fewer targets; the run shows one that "
        "fails, of the last allocation that was tried"
    ),
)
NO_ALLOCATION = rule(
    "SM572",
    "no-allocation",
    Severity.ERROR,
    "no allocation of the targets of '{floor}' keeps the deadlines: {reason}",
    help="give more time, another robot, or fewer targets",
)
NO_RELATION = rule(
    "SM573",
    "claim-does-not-hold",
    Severity.INFO,
    "on '{floor}' it does not hold that {claim}: {reason}",
)
NOT_DECIDED = rule(
    "SM574",
    "study-not-decided",
    Severity.INFO,
    "on '{floor}' it is not decided whether {claim}: {reason}",
    help="give more time (--question-limit), or study a smaller floor",
)


class Tried(Struct, frozen=True):
    """An allocation and what its simulation came to."""

    schedule: Schedule
    validation: Validation


class Outcome(Struct, frozen=True):
    """What became of a study."""

    study: Study
    controller: Synthesis
    travel: TravelTimes
    answers: tuple[Answers, ...] = ()
    """Of the controller, for each robot: what was asked once is known."""
    times: Times = field(default_factory=dict)
    """How long a robot travels from any cell to any other."""
    relations: tuple[Claim, ...] = ()
    greedy: Schedule | None = None
    best: BestAllocation | None = None
    tried: tuple[Tried, ...] = ()
    run: tuple[Moment, ...] = ()
    """The longest mission of the allocation that does, from one start; or a failing one."""

    @property
    def is_good(self) -> bool:
        """Whether the mission is done from every admissible start."""
        if self.controller.machine is None:
            return False
        return not self.study.targets or any(one.validation.is_good for one in self.tried)

    @property
    def chosen(self) -> Tried | None:
        """The allocation that was validated, else the last one that was tried."""
        good = (one for one in self.tried if one.validation.is_good)
        return next(good, self.tried[-1] if self.tried else None)


def studied(
    study: Study,
    place: Place,
    sink: Sink,
    options: Options,
    has_relations: bool = True,
    keeper: CrewCache | None = None,
) -> Outcome:
    """Synthesise, measure, decide what is claimed, allocate, validate; what fails is reported.

    What a keeper has of this floor and its robots is taken as it is.
    """
    known = keeper.get(study) if keeper else None
    crew = known or _crew(study, place, sink, options)
    answers = answers_of(study, crew.controller)
    made = Outcome(study, crew.controller, travels(study, crew.times), answers, crew.times)
    if has_relations:
        claims = {one.claim: one for one in _related(made, crew.claims, options)}
        _report_claims(study, claims.values(), place, sink)
        made = replace(made, relations=tuple(one for one in claims.values() if one.claim != SHARED))
        crew = replace(crew, claims={**crew.claims, **claims})
    if keeper and crew != known:
        keeper.put(study, crew)
    return allocated(made, place, sink)


def _crew(study: Study, place: Place, sink: Sink, options: Options) -> RobotCrew:
    controller = synthesise(study, place, sink, options)
    return RobotCrew(controller, measured(study, answers_of(study, controller)))


def allocated(made: Outcome, place: Place, sink: Sink, study: Study | None = None) -> Outcome:
    """Allocate and validate; another study with new targets on the same floor does with this one's
    robots: nothing is synthesised again (thesis 4.6.1)."""
    study = study or made.study
    answers = made.answers[:1] * len(study.robots)
    if not answers or not study.targets:
        return replace(made, study=study)
    travel = travels(study, made.times)
    first, found = allocate_greedily(study, travel), allocate_optimally(study, travel)
    made = replace(made, study=study, travel=travel, greedy=first, best=found, tried=(), run=())
    if found is None or not meets_deadlines(study, found.schedule):
        _report_no_allocation(study, found, place, sink)
        return made
    return _validated(made, answers, _candidates(study, travel, found.schedule, first), place, sink)


def _validated(
    made: Outcome,
    answers: Sequence[Answers],
    candidates: Iterator[Schedule],
    place: Place,
    sink: Sink,
) -> Outcome:
    """Simulate allocations until one does; a run of the last one tells how, or why not."""
    study = made.study
    tried: list[Tried] = []
    for schedule in islice(candidates, MOST_TRIED):
        tried.append(Tried(schedule, validate_allocation(study, schedule.allocation, answers)))
        if tried[-1].validation.is_good:
            break
    last = tried[-1]
    starts = last.validation.failed or _some_start(study)
    told = record_run(study, last.schedule.allocation, answers, starts, last.validation.steps)
    made = replace(made, tried=tuple(tried), run=told)
    if not last.validation.is_good:
        _report_failure(made, place, sink)
    return made


def _candidates(
    study: Study, travel: TravelTimes, found: Schedule, first: Schedule | None
) -> Iterator[Schedule]:
    """The best allocation, the thesis's, and those near the best one, the better ones first."""
    known: set[object] = set()
    others = sorted(
        neighbour_allocations(study, travel, found), key=lambda one: (one.cost, one.allocation)
    )
    for one in (found, *(() if first is None else (first,)), *others):
        if one.allocation not in known and meets_deadlines(study, one):
            known.add(one.allocation)
            yield one


def _some_start(study: Study) -> tuple[int, ...]:
    """One admissible start: where robots are drawn, the others in the first cells that are left."""
    taken = {one.start for one in study.robots}
    left = (cell for cell in study.grid.cells if cell not in taken)
    return tuple(next(left) if one.start is None else one.start for one in study.robots)


def _related(made: Outcome, known: Mapping[str, Claim], options: Options) -> Iterator[Claim]:
    study = made.study
    if len(study.robots) > 1:
        yield known[SHARED] if SHARED in known else _arbitrated(study, options)
    yield from decide_claims(study, made.travel, options, known)


def _arbitrated(study: Study, options: Options) -> Claim:
    """Decide C_E as the thesis has it, for two of the robots: with more it is no easier."""
    two = replace(study, robots=tuple(replace(one, start=None) for one in study.robots[:2]))
    literal = environment_contract(two, Sharing.LITERAL)
    # Nobody is told why: that would take longer than all the rest.
    short = replace(options, is_explained=False)
    verdict = decide(literal, lambda origin: Subject(), Sink(), short)
    return Claim(SHARED, verdict.is_realizable)


def _report_claims(study: Study, claims: Iterable[Claim], place: Place, sink: Sink) -> None:
    subject, floor = place(study.origin), study.component
    for one in claims:
        facts = {"floor": floor, "claim": one.claim, "reason": one.reason}
        if one.claim == SHARED and one.holds is False:
            first, other = (robot.name for robot in study.robots[:2])
            sink.report(SHARED_CELL, subject, floor=floor, one=first, other=other)
        elif one.claim != SHARED and one.holds is None:
            sink.report(NOT_DECIDED, subject, notes=(), help="", **facts)
        elif one.claim != SHARED and not one.holds:
            sink.report(NO_RELATION, subject, notes=one.run, help="", **facts)


def _report_no_allocation(
    study: Study, found: BestAllocation | None, place: Place, sink: Sink
) -> None:
    reason = "some target is out of the reach of all robots, or waits for what is never done"
    if found is not None:
        reason = f"the best one that was found takes {told_steps(found.schedule.duration)}"
    sink.report(NO_ALLOCATION, place(study.origin), floor=study.component, reason=reason)


def told_steps(number: int) -> str:
    """A number of steps, in words."""
    return f"{number} step{'' if number == 1 else 's'}"


def _report_failure(made: Outcome, place: Place, sink: Sink) -> None:
    study, last = made.study, made.tried[-1]
    late = last.validation.late
    reason = "robots meet, or one has no answer"
    if late is not None:
        name = study.targets[late].name
        reason = f"'{name}' is not reached within {told_steps(last.validation.steps)}"
        if last.validation.is_slow:
            reason = f"a robot that is sent to '{name}' takes more than {study.within} steps"
    subject = place(study.targets[late].origin if late is not None else study.origin)
    notes = tuple(describe_moments(study, made.run))
    sink.report(NOT_VALIDATED, subject, notes=notes, floor=study.component, reason=reason)
