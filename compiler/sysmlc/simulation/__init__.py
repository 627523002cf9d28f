"""Scenarios, played on the reference interpreters of activities and state machines."""

from sysmlc.simulation.report import Report
from sysmlc.simulation.runner import run_scenarios

__all__ = ["Report", "run_scenarios"]
