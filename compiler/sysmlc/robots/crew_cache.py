"""What is known of the robots of a floor whatever their mission is, and where it is kept.

New targets on the same floor ask for nothing but another allocation (MOOD4I thesis, 4.6.1): the
controller, the times that robots travel and what was decided of the contracts stay.
"""

from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any

import msgspec
from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.robots.claims import Claim
from sysmlc.robots.robot_controller import Times, controller_contract
from sysmlc.robots.study import Study
from sysmlc.support.cache import Cache
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.controllers.closed_loop import Controller
from sysmlc.synthesis.controllers.mealy import Machine, Move
from sysmlc.synthesis.controllers.table import Bit, Entry, Table
from sysmlc.synthesis.decision import Verdict

EncodedController = Mapping[str, Any]


def encode_controller(made: Controller) -> EncodedController:
    """A controller as JSON; variables by their names."""
    names = {"inputs": _variable_names(made.inputs), "outputs": _variable_names(made.outputs)}
    if isinstance(made, Machine):
        states = [[_encode_move(one) for one in moves] for moves in made.states]
        return names | {"registers": _variable_names(made.registers), "states": states}
    return names | {
        "bits": [[one.variable, one.place, one.is_before] for one in made.bits],
        "nodes": made.nodes,
        "entries": [[one.outputs, one.successors] for one in (made.first, *made.modes)],
    }


def decode_controller(form: EncodedController, variables: Sequence[Variable]) -> Controller:
    """The controller over variables of its contract. Raises LookupError, ValueError, TypeError."""
    known = {one.name: one for one in variables}
    inputs, outputs = (tuple(known[one] for one in form[side]) for side in ("inputs", "outputs"))
    if "states" in form:
        registers = tuple(known[one] for one in form["registers"])
        states = tuple(tuple(map(_decode_move, moves)) for moves in form["states"])
        return Machine(inputs, outputs, registers, states)
    first, *modes = (Entry(tuple(done), tuple(onward)) for done, onward in form["entries"])
    nodes = tuple((bit, low, high) for bit, low, high in form["nodes"])
    bits = tuple(Bit(*one) for one in form["bits"])
    return Table(inputs, outputs, bits, nodes, first, tuple(modes))


def _variable_names(variables: Sequence[Variable]) -> list[str]:
    return [one.name for one in variables]


def _encode_move(move: Move) -> list[Any]:
    return [_encode_formula(move.when), [_encode_formula(one) for one in move.output], move.state]


def _decode_move(form: Sequence[Any]) -> Move:
    when, output, state = form
    return Move(_decode_formula(when), tuple(map(_decode_formula, output)), state)


def _encode_formula(formula: Formula) -> Any:  # noqa: ANN401 - JSON
    match formula:
        case Const(value):
            return [value]
        case Var(name, is_primed):
            return ["'" if is_primed else "", name]
        case Apply(op, args):
            return [op.value, *map(_encode_formula, args)]


def _decode_formula(form: Any) -> Formula:  # noqa: ANN401 - JSON
    match form:
        case [value]:
            return Const(value)
        case ["'" | "" as prime, str(name)]:
            return Var(name, bool(prime))
        case [op, *args]:
            return Apply(Op(op), tuple(map(_decode_formula, args)))
        case _:
            raise ValueError(form)


_FORMAT = 2


class RobotCrew(Struct, frozen=True):
    """The robots of a floor."""

    controller: Synthesis
    times: Times
    claims: Mapping[str, Claim] = field(default_factory=dict)
    """What was decided of the contracts of the floor."""


class _Entry(msgspec.Struct, array_like=True):
    """A crew as the cache stores it."""

    controller: Mapping[str, Any]
    times: tuple[tuple[int, tuple[tuple[int, int], ...]], ...]
    claims: tuple[tuple[str, bool, str, tuple[str, ...]], ...]


class CrewCache(Struct, frozen=True):
    """Stores crews in a cache, by floor and robots; ``tool`` is the digest of the tool."""

    cache: Cache
    tool: str

    def get(self, study: Study) -> RobotCrew | None:
        """Return the crew of this floor if an earlier run has stored it."""
        entry = self.cache.get(self._key(study))
        if entry is None:
            return None
        try:
            return _decode_crew(msgspec.json.decode(entry, type=_Entry), study)
        except (LookupError, ValueError, TypeError, AttributeError, RecursionError):
            return None

    def put(self, study: Study, crew: RobotCrew) -> None:
        """Store a crew that has a controller."""
        if crew.controller.machine is not None:
            self.cache.put(self._key(study), msgspec.json.encode(_encode_crew(crew)))

    def _key(self, study: Study) -> str:
        return sha256(repr((_FORMAT, self.tool, cache_identity(study))).encode()).hexdigest()


def cache_identity(study: Study) -> Study:
    """The study without what a crew does not depend on: mission, starts, and ids in the model."""
    robots = tuple(replace(one, start=None, origin="") for one in study.robots)
    floor = replace(study, robots=robots, origin="", obstacles=())
    return replace(floor, targets=(), orders=(), deadline=None)


def _encode_crew(crew: RobotCrew) -> "_Entry":
    machine = crew.controller.machine
    return _Entry(
        controller={} if machine is None else encode_controller(machine),
        times=tuple((goal, tuple(sorted(steps.items()))) for goal, steps in crew.times.items()),
        claims=tuple(
            (claim.claim, claim.holds, claim.reason, claim.run)
            for claim in crew.claims.values()
            if claim.holds is not None
        ),
    )


def _decode_crew(entry: "_Entry", study: Study) -> RobotCrew:
    contract = controller_contract(study)
    told = reduced(contract).contract
    machine = decode_controller(entry.controller, told.variables)
    times = {goal: dict(steps) for goal, steps in entry.times}
    claims = {claim: Claim(claim, holds, reason, run) for claim, holds, reason, run in entry.claims}
    verdict = Verdict(contract.component, is_realizable=True)
    return RobotCrew(Synthesis(verdict, told, machine), times, claims)
