"""The workflow of figure 4.3 of the thesis: from a study to a validated mission."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.robots.allocation import (
    BestAllocation,
    allocate_as_printed,
    allocate_greedily,
    allocate_optimally,
    neighbour_allocations,
)
from sysmlc.robots.answers import Answers
from sysmlc.robots.claims import Claim, decide_claims
from sysmlc.robots.crew_cache import CrewCache, RobotCrew
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.mission_run import Moment, describe_moments, record_run
from sysmlc.robots.robot_controller import (
    Times,
    build_answers,
    measure_travel_times,
    synthesise_robot,
    travel_times_of,
)
from sysmlc.robots.schedule import Schedule, TravelTimes, meets_deadlines
from sysmlc.robots.study import Study
from sysmlc.robots.validation import Validation, validate_allocation
from sysmlc.support.counts import count
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.decision import Options, Place, decide

MAX_CANDIDATES = 12
"""Number of allocations that are validated before the mission counts as failed."""
_PRINTED_IS_IMPOSSIBLE = (
    "Algorithm 1 as printed leaves a target out of reach, breaks an order, or assigns a carried "
    "target to another robot"
)
SHARED_CELL_CLAIM = "C_E is realizable as the thesis defines it"
"""The claim that the thesis's C_E is realizable, which fails because robots may share a cell."""

SHARED_CELL = rule(
    "SM570",
    "environment-shares-cells",
    Severity.INFO,
    "no environment satisfies C_E of '{floor}' as the thesis defines it: '{one}' "
    "and '{other}' may both be informed that a cell is free and enter it; the cell "
    "is offered to one of them",
)
NOT_VALIDATED = rule(
    "SM571",
    "mission-fails",
    Severity.ERROR,
    "the mission of '{floor}' fails: {reason}",
    help=(
        "give more time, move obstacles or starts, or order fewer targets; the run "
        "shows a failure of the last allocation that was tried"
    ),
)
NO_ALLOCATION = rule(
    "SM572",
    "no-allocation",
    Severity.ERROR,
    "no allocation of the targets of '{floor}' is possible in time: {reason}",
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


class TriedAllocation(Struct, frozen=True):
    """An allocation and the result of its validation."""

    schedule: Schedule
    validation: Validation


class Outcome(Struct, frozen=True):
    """The results of a study."""

    study: Study
    controller: Synthesis
    travel: TravelTimes
    answers: tuple[Answers, ...] = ()
    """For each robot, the memoised answers of the controller."""
    times: Times = field(default_factory=dict)
    """Measured travel times between all cells."""
    relations: tuple[Claim, ...] = ()
    """Decided claims about relations between the contracts."""
    greedy: Schedule | None = None
    """The allocation of the thesis's algorithm."""
    is_printed: bool = False
    """Whether this allocation is that of the algorithm as printed, the only one that is tried."""
    best: BestAllocation | None = None
    """The allocation of branch and bound."""
    tried: tuple[TriedAllocation, ...] = ()
    """The validated allocations; all but the last one have failed."""
    run: tuple[Moment, ...] = ()
    """A run of the successful allocation from one start, or a failing run."""

    @property
    def is_good(self) -> bool:
        """Whether there is a controller, and the mission succeeds from every admissible start."""
        if self.controller.machine is None:
            return False
        return not self.study.targets or any(tried.validation.is_good for tried in self.tried)

    @property
    def chosen(self) -> TriedAllocation | None:
        """The allocation that succeeded, or the last one that failed."""
        successful = (tried for tried in self.tried if tried.validation.is_good)
        return next(successful, self.tried[-1] if self.tried else None)


def run_study(
    study: Study,
    place: Place,
    sink: Sink,
    options: Options,
    has_relations: bool = True,
    crew_cache: CrewCache | None = None,
    is_printed: bool = False,
) -> Outcome:
    """Synthesise the controller, measure travel times, decide claims, allocate and validate.

    Failures are reported. Results about the robots of this floor are reused from the cache. With
    *is_printed* the only allocation is that of Algorithm 1 as printed.
    """
    known_crew = crew_cache.get(study) if crew_cache else None
    crew = known_crew or _build_crew(study, place, sink, options)
    answers = build_answers(study, crew.controller)
    outcome = Outcome(
        study,
        crew.controller,
        travel_times_of(study, crew.times),
        answers,
        crew.times,
        is_printed=is_printed,
    )
    if has_relations:
        claims = {claim.claim: claim for claim in _decide_all_claims(outcome, crew.claims, options)}
        _report_claims(study, claims.values(), place, sink)
        outcome = replace(
            outcome,
            relations=tuple(claim for claim in claims.values() if claim.claim != SHARED_CELL_CLAIM),
        )
        crew = replace(crew, claims={**crew.claims, **claims})
    if crew_cache and crew != known_crew:
        crew_cache.put(study, crew)
    return allocate_mission(outcome, place, sink)


def _build_crew(study: Study, place: Place, sink: Sink, options: Options) -> RobotCrew:
    controller = synthesise_robot(study, place, sink, options)
    return RobotCrew(controller, measure_travel_times(study, build_answers(study, controller)))


def allocate_mission(
    outcome: Outcome, place: Place, sink: Sink, study: Study | None = None
) -> Outcome:
    """Allocate the targets and validate the mission.

    *study* may contain another mission on the same floor; controller and travel times of *outcome*
    are used for it (thesis 4.6.1).
    """
    study = study or outcome.study
    # All robots have the same controller, so its answers serve any number of robots.
    answers = outcome.answers[:1] * len(study.robots)
    if not answers or not study.targets:
        return replace(outcome, study=study)
    travel = travel_times_of(study, outcome.times)
    if outcome.is_printed:
        printed_schedule = allocate_as_printed(study, travel)
        outcome = replace(outcome, study=study, travel=travel, greedy=printed_schedule)
        if printed_schedule is None:
            subject, floor = place(study.origin), study.component
            sink.report(NO_ALLOCATION, subject, floor=floor, reason=_PRINTED_IS_IMPOSSIBLE)
            return outcome
        return _validate_candidates(outcome, answers, iter([printed_schedule]), place, sink)
    greedy_schedule, best_allocation = (
        allocate_greedily(study, travel),
        allocate_optimally(study, travel),
    )
    outcome = replace(
        outcome,
        study=study,
        travel=travel,
        greedy=greedy_schedule,
        best=best_allocation,
        tried=(),
        run=(),
    )
    if best_allocation is None or not meets_deadlines(study, best_allocation.schedule):
        _report_no_allocation(study, best_allocation, place, sink)
        return outcome
    return _validate_candidates(
        outcome,
        answers,
        _candidate_schedules(study, travel, best_allocation.schedule, greedy_schedule),
        place,
        sink,
    )


def _validate_candidates(
    outcome: Outcome,
    answers: Sequence[Answers],
    candidates: Iterator[Schedule],
    place: Place,
    sink: Sink,
) -> Outcome:
    """Validate allocations until one succeeds, and record a run of the last one."""
    study = outcome.study
    tried: list[TriedAllocation] = []
    for schedule in islice(candidates, MAX_CANDIDATES):
        tried.append(
            TriedAllocation(schedule, validate_allocation(study, schedule.allocation, answers))
        )
        if tried[-1].validation.is_good:
            break
    last_tried = tried[-1]
    starts = last_tried.validation.failed or _some_start(study)
    run_moments = record_run(
        study, last_tried.schedule.allocation, answers, starts, last_tried.validation.steps
    )
    outcome = replace(outcome, tried=tuple(tried), run=run_moments)
    if not last_tried.validation.is_good:
        _report_failure(outcome, place, sink)
    return outcome


def _candidate_schedules(
    study: Study, travel: TravelTimes, best_schedule: Schedule, greedy_schedule: Schedule | None
) -> Iterator[Schedule]:
    """Yield distinct allocations that meet the deadlines.

    First the best allocation, then that of the thesis's algorithm, then neighbours of the best one
    by cost.
    """
    known_allocations: set[object] = set()
    neighbours = sorted(
        neighbour_allocations(study, travel, best_schedule),
        key=lambda schedule: (schedule.cost, schedule.allocation),
    )
    for schedule in (
        best_schedule,
        *(() if greedy_schedule is None else (greedy_schedule,)),
        *neighbours,
    ):
        if schedule.allocation not in known_allocations and meets_deadlines(study, schedule):
            known_allocations.add(schedule.allocation)
            yield schedule


def _some_start(study: Study) -> tuple[int, ...]:
    """Return an admissible start: robots without a start get the first free cells."""
    given_starts = {robot.start for robot in study.robots}
    free_cells = (cell for cell in study.grid.cells if cell not in given_starts)
    return tuple(next(free_cells) if robot.start is None else robot.start for robot in study.robots)


def _decide_all_claims(
    outcome: Outcome, known_claims: Mapping[str, Claim], options: Options
) -> Iterator[Claim]:
    study = outcome.study
    if len(study.robots) > 1:
        yield (
            known_claims[SHARED_CELL_CLAIM]
            if SHARED_CELL_CLAIM in known_claims
            else _decide_shared_cell_claim(study, options)
        )
    yield from decide_claims(study, outcome.travel, options, known_claims)


def _decide_shared_cell_claim(study: Study, options: Options) -> Claim:
    """Decide whether the thesis's C_E is realizable for two robots; more make it only harder."""
    two_robots = replace(
        study, robots=tuple(replace(robot, start=None) for robot in study.robots[:2])
    )
    literal = environment_contract(two_robots, is_literal=True)
    # The explanation is not shown, and computing it would take longer than everything else.
    unexplained = replace(options, is_explained=False)
    verdict = decide(literal, lambda origin: Subject(), Sink(), unexplained)
    return Claim(SHARED_CELL_CLAIM, verdict.is_realizable)


def _report_claims(study: Study, claims: Iterable[Claim], place: Place, sink: Sink) -> None:
    subject, floor = place(study.origin), study.component
    for claim in claims:
        fields = {"floor": floor, "claim": claim.claim, "reason": claim.reason}
        if claim.claim == SHARED_CELL_CLAIM and claim.holds is False:
            first_robot, second_robot = (robot.name for robot in study.robots[:2])
            sink.report(SHARED_CELL, subject, floor=floor, one=first_robot, other=second_robot)
        elif claim.claim != SHARED_CELL_CLAIM and claim.holds is None:
            sink.report(NOT_DECIDED, subject, notes=(), help="", **fields)
        elif claim.claim != SHARED_CELL_CLAIM and not claim.holds:
            sink.report(NO_RELATION, subject, notes=claim.run, help="", **fields)


def _report_no_allocation(
    study: Study, best_allocation: BestAllocation | None, place: Place, sink: Sink
) -> None:
    reason = "some target is out of reach of all robots, or follows a target that is never reached"
    if best_allocation is not None:
        reason = (
            f"the best one that was found takes {count(best_allocation.schedule.duration, 'step')}"
        )
    sink.report(NO_ALLOCATION, place(study.origin), floor=study.component, reason=reason)


def _report_failure(outcome: Outcome, place: Place, sink: Sink) -> None:
    study, last_tried = outcome.study, outcome.tried[-1]
    late_target = last_tried.validation.late
    reason = "robots meet, or one has no answer"
    if late_target is not None:
        name = study.targets[late_target].name
        reason = f"'{name}' is not reached within {count(last_tried.validation.steps, 'step')}"
        if last_tried.validation.is_slow:
            steps = count(study.within or 0, "step")
            reason = f"a robot that is sent to '{name}' takes more than {steps}"
    subject = place(study.targets[late_target].origin if late_target is not None else study.origin)
    notes = tuple(describe_moments(study, outcome.run))
    sink.report(NOT_VALIDATED, subject, notes=notes, floor=study.component, reason=reason)
