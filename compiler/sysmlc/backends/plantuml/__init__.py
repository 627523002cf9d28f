"""The PlantUML back end: block definition, internal block, activity, state machine and
requirement diagrams in ``out/diagrams``."""

from sysmlc.backends.plantuml.backend import PlantUml

BACKEND = PlantUml()

__all__ = ["BACKEND", "PlantUml"]
