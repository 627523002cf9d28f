"""What is known of the robots of a floor whatever their mission is, and where it is kept.

New targets on the same floor ask for nothing but another allocation (MOOD4I thesis, 4.6.1): the
controller, the times that robots travel and what was decided of the contracts stay.
"""

import json
import zlib
from collections.abc import Mapping
from dataclasses import field
from hashlib import sha256
from typing import Any

from sysmlc.cache import Cache
from sysmlc.floors.relations import Relation
from sysmlc.floors.stored import controller_of, form_of
from sysmlc.floors.strategy import Times, controller_contract
from sysmlc.floors.study import Study
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis.decide import Verdict
from sysmlc.synthesis.synthesise import Synthesis
from sysmlc.values import dataclass, replace

_FORMAT = 1


@dataclass(frozen=True, slots=True)
class Crew:
    """The robots of a floor."""

    controller: Synthesis
    times: Times
    claims: Mapping[str, Relation] = field(default_factory=dict)
    """What was decided of the contracts of the floor."""


@dataclass(frozen=True, slots=True)
class Keeper:
    """Keeps crews in a cache, by floor and robots; ``tool`` tells the versions of the tool."""

    cache: Cache
    tool: str

    def get(self, study: Study) -> Crew | None:
        """The crew of this floor, if an earlier run has kept one."""
        entry = self.cache.get(self._key(study))
        if entry is None:
            return None
        try:
            return _crew(json.loads(zlib.decompress(entry)), study)
        except (LookupError, ValueError, TypeError, zlib.error):
            return None

    def put(self, study: Study, crew: Crew) -> None:
        """Keep a crew; one without a controller is none."""
        if crew.controller.machine is not None:
            text = json.dumps(_form(crew), separators=(",", ":"))
            self.cache.put(self._key(study), zlib.compress(text.encode(), 1))

    def _key(self, study: Study) -> str:
        return sha256(repr((_FORMAT, self.tool, floor_of(study))).encode()).hexdigest()


def floor_of(study: Study) -> Study:
    """The study without what a crew does not depend on: mission, starts, and ids in the model."""
    robots = tuple(replace(one, start=None, origin="") for one in study.robots)
    floor = replace(study, robots=robots, origin="", obstacles=())
    return replace(floor, targets=(), orders=(), deadline=None)


def _form(crew: Crew) -> Mapping[str, Any]:
    machine = crew.controller.machine
    return {
        "controller": None if machine is None else form_of(machine),
        "times": [[goal, sorted(known.items())] for goal, known in sorted(crew.times.items())],
        "claims": [
            [one.claim, one.holds, one.reason, one.run]
            for one in crew.claims.values()
            if one.holds is not None
        ],
    }


def _crew(form: Mapping[str, Any], study: Study) -> Crew:
    contract = controller_contract(study)
    told = reduced(contract).contract
    machine = controller_of(form["controller"], told.variables)
    times = {goal: dict(known) for goal, known in form["times"]}
    claims = {
        claim: Relation(claim, holds, reason, tuple(run))
        for claim, holds, reason, run in form["claims"]
    }
    verdict = Verdict(contract.component, is_realizable=True)
    return Crew(Synthesis(verdict, told, machine), times, claims)
