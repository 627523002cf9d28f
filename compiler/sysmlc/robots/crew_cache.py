"""The cache of robot crews: the results about the robots of a floor that no mission affects.

New targets on the same floor only need another allocation (MOOD4I thesis, 4.6.1). The controller,
the measured travel times and the decided claims about contracts are reused. The cache stores JSON,
in which a formula is a list of operator and operands.
"""

from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any

import msgspec
from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.controllers.machine import Machine, Move
from sysmlc.controllers.table import Bit, Entry, Table
from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.robots.claims import Claim
from sysmlc.robots.robot_controller import Times, controller_contract
from sysmlc.robots.study import Study
from sysmlc.support.cache import Cache
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.decision import Verdict
from sysmlc.synthesis.strategies.closed_loop import Controller

EncodedController = Mapping[str, Any]


def encode_controller(controller: Controller) -> EncodedController:
    """Encode a controller as a JSON value; variables are encoded by name."""
    names = {
        "inputs": _variable_names(controller.inputs),
        "outputs": _variable_names(controller.outputs),
    }
    if isinstance(controller, Machine):
        states = [[_encode_move(item) for item in moves] for moves in controller.states]
        return names | {"registers": _variable_names(controller.registers), "states": states}
    return names | {
        "bits": [[item.variable, item.position, item.is_before] for item in controller.bits],
        "nodes": controller.nodes,
        "entries": [
            [item.outputs, item.successors] for item in (controller.first, *controller.modes)
        ],
    }


def decode_controller(encoded: EncodedController, variables: Sequence[Variable]) -> Controller:
    """Decode a controller over variables of its contract.

    Raises LookupError, ValueError, TypeError.
    """
    variables_by_name = {item.name: item for item in variables}
    inputs, outputs = (
        tuple(variables_by_name[item] for item in encoded[side]) for side in ("inputs", "outputs")
    )
    if "states" in encoded:
        registers = tuple(variables_by_name[item] for item in encoded["registers"])
        states = tuple(tuple(map(_decode_move, moves)) for moves in encoded["states"])
        return Machine(inputs, outputs, registers, states)
    first, *modes = (
        Entry(tuple(bits), tuple(successors)) for bits, successors in encoded["entries"]
    )
    nodes = tuple((bit, low, high) for bit, low, high in encoded["nodes"])
    bits = tuple(Bit(*item) for item in encoded["bits"])
    return Table(inputs, outputs, bits, nodes, first, tuple(modes))


def _variable_names(variables: Sequence[Variable]) -> list[str]:
    return [variable.name for variable in variables]


def _encode_move(move: Move) -> list[Any]:
    return [
        _encode_formula(move.when),
        [_encode_formula(output_term) for output_term in move.output],
        move.state,
    ]


def _decode_move(encoded: Sequence[Any]) -> Move:
    when, output, state = encoded
    return Move(_decode_formula(when), tuple(map(_decode_formula, output)), state)


def _encode_formula(formula: Formula) -> Any:  # noqa: ANN401 - JSON
    # Constants, variables and applications differ in the length and the first item of the list.
    match formula:
        case Const(value):
            return [value]
        case Var(name, is_primed):
            return ["'" if is_primed else "", name]
        case Apply(op, args):
            return [op.value, *map(_encode_formula, args)]


def _decode_formula(encoded: Any) -> Formula:  # noqa: ANN401 - JSON
    match encoded:
        case [value]:
            return Const(value)
        case ["'" | "" as prime, str(name)]:
            return Var(name, bool(prime))
        case [op, *args]:
            return Apply(Op(op), tuple(map(_decode_formula, args)))
        case _:
            raise ValueError(encoded)


_FORMAT = 2
"""Number of the stored format, as part of the cache key."""


class RobotCrew(Struct, frozen=True):
    """The results about the robots of a floor: their common controller and how fast they are."""

    controller: Synthesis
    times: Times
    """Measured travel times between all cells."""
    claims: Mapping[str, Claim] = field(default_factory=dict)
    """Decided claims about the contracts of the floor."""


class _Entry(msgspec.Struct, array_like=True):
    """A crew as the cache stores it."""

    controller: Mapping[str, Any]
    times: tuple[tuple[int, tuple[tuple[int, int], ...]], ...]
    claims: tuple[tuple[str, bool, str, tuple[str, ...]], ...]


class CrewCache(Struct, frozen=True):
    """Stores crews by floor and robots."""

    cache: Cache
    tool: str
    """Digest of this compiler: another version does not reuse the entries."""

    def get(self, study: Study) -> RobotCrew | None:
        """Return the crew of this floor if an earlier run of the compiler has stored it."""
        entry = self.cache.get(self._key(study))
        if entry is None:
            return None
        try:
            return _decode_crew(msgspec.json.decode(entry, type=_Entry), study)
        # A damaged entry is a miss.
        except (LookupError, ValueError, TypeError, AttributeError, RecursionError):
            return None

    def put(self, study: Study, crew: RobotCrew) -> None:
        """Store a crew that has a controller."""
        if crew.controller.machine is not None:
            self.cache.put(self._key(study), msgspec.json.encode(_encode_crew(crew)))

    def _key(self, study: Study) -> str:
        return sha256(repr((_FORMAT, self.tool, _cache_identity(study))).encode()).hexdigest()


def _cache_identity(study: Study) -> Study:
    """Return the study reduced to what a crew depends on, as part of the cache key.

    The mission, the starts of the robots and ids of model elements are removed.
    """
    robots = tuple(replace(robot, start=None, origin="") for robot in study.robots)
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
    reduced_contract = reduce_contract(contract).contract
    machine = decode_controller(entry.controller, reduced_contract.variables)
    times = {goal: dict(steps) for goal, steps in entry.times}
    claims = {claim: Claim(claim, holds, reason, run) for claim, holds, reason, run in entry.claims}
    verdict = Verdict(contract.component, is_realizable=True)
    return RobotCrew(Synthesis(verdict, reduced_contract, machine), times, claims)
