"""What is known of the robots of a floor whatever their mission is, and where it is kept.

New targets on the same floor ask for nothing but another allocation (MOOD4I thesis, 4.6.1): the
controller, the times that robots travel and what was decided of the contracts stay.
"""

from collections.abc import Mapping
from hashlib import sha256
from typing import Any

import msgspec
from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic.reduction.reduce import reduced
from sysmlc.robots.relations import Relation
from sysmlc.robots.stored import controller_of, form_of
from sysmlc.robots.strategy import Times, controller_contract
from sysmlc.robots.study import Study
from sysmlc.support.cache import Cache
from sysmlc.synthesis.decide import Verdict
from sysmlc.synthesis.synthesise import Synthesis

_FORMAT = 2


class Crew(Struct, frozen=True):
    """The robots of a floor."""

    controller: Synthesis
    times: Times
    claims: Mapping[str, Relation] = field(default_factory=dict)
    """What was decided of the contracts of the floor."""


class _Entry(msgspec.Struct, array_like=True):
    """A crew as the cache stores it."""

    controller: Mapping[str, Any]
    times: tuple[tuple[int, tuple[tuple[int, int], ...]], ...]
    claims: tuple[tuple[str, bool, str, tuple[str, ...]], ...]


class Keeper(Struct, frozen=True):
    """Stores crews in a cache, by floor and robots; ``tool`` is the digest of the tool."""

    cache: Cache
    tool: str

    def get(self, study: Study) -> Crew | None:
        """Return the crew of this floor if an earlier run has stored it."""
        entry = self.cache.get(self._key(study))
        if entry is None:
            return None
        try:
            return _decode(msgspec.json.decode(entry, type=_Entry), study)
        except (LookupError, ValueError, TypeError, AttributeError, RecursionError):
            return None

    def put(self, study: Study, crew: Crew) -> None:
        """Store a crew that has a controller."""
        if crew.controller.machine is not None:
            self.cache.put(self._key(study), msgspec.json.encode(_encode(crew)))

    def _key(self, study: Study) -> str:
        return sha256(repr((_FORMAT, self.tool, floor_of(study))).encode()).hexdigest()


def floor_of(study: Study) -> Study:
    """The study without what a crew does not depend on: mission, starts, and ids in the model."""
    robots = tuple(replace(one, start=None, origin="") for one in study.robots)
    floor = replace(study, robots=robots, origin="", obstacles=())
    return replace(floor, targets=(), orders=(), deadline=None)


def _encode(crew: Crew) -> "_Entry":
    machine = crew.controller.machine
    return _Entry(
        controller={} if machine is None else form_of(machine),
        times=tuple((goal, tuple(sorted(steps.items()))) for goal, steps in crew.times.items()),
        claims=tuple(
            (claim.claim, claim.holds, claim.reason, claim.run)
            for claim in crew.claims.values()
            if claim.holds is not None
        ),
    )


def _decode(entry: "_Entry", study: Study) -> Crew:
    contract = controller_contract(study)
    told = reduced(contract).contract
    machine = controller_of(entry.controller, told.variables)
    times = {goal: dict(steps) for goal, steps in entry.times}
    claims = {
        claim: Relation(claim, holds, reason, run) for claim, holds, reason, run in entry.claims
    }
    verdict = Verdict(contract.component, is_realizable=True)
    return Crew(Synthesis(verdict, told, machine), times, claims)
