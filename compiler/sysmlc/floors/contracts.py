"""All contracts of a floor, by the names under which they are written (thesis, 4.3)."""

from collections.abc import Iterator

from sysmlc.floors.environment import environment_contract
from sysmlc.floors.mission import mission_contract
from sysmlc.floors.robot import robot_contract
from sysmlc.floors.study import Study
from sysmlc.floors.system import system_contract
from sysmlc.floors.travel import Travel, shortest
from sysmlc.logic.contract import Contract


def contracts_of(study: Study, travel: Travel | None = None) -> Iterator[Contract]:
    """C_S, C_E, C_R of each robot (alone, and among others), and C_M when there are targets.

    Without travel times that were measured the mission assumes those of shortest ways.
    """
    yield system_contract(study)
    yield environment_contract(study)
    for robot in study.robots:
        yield robot_contract(study, robot)
        yield robot_contract(study, robot, is_alone=False)
    if study.targets:
        yield mission_contract(study, travel or shortest(study))
