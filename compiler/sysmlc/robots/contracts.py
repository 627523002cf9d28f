"""All contracts of a floor, under the names of their files (thesis, 4.3)."""

from collections.abc import Iterator

from sysmlc.logic.contract import Contract
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.schedule import TravelTimes, shortest_travel_times
from sysmlc.robots.study import Study
from sysmlc.robots.system_contract import system_contract


def study_contracts(study: Study, travel: TravelTimes | None = None) -> Iterator[Contract]:
    """Yield C_S, C_E, C_R of each robot (alone, and among others), and C_M if there are targets.

    Without measured travel times, the mission assumes those of shortest paths.
    """
    yield system_contract(study)
    yield environment_contract(study)
    for robot in study.robots:
        yield robot_contract(study, robot)
        yield robot_contract(study, robot, is_alone=False)
    if study.targets:
        yield mission_contract(study, travel or shortest_travel_times(study))
