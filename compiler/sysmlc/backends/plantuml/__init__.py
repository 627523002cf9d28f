"""The PlantUML back end: diagrams of structure, behaviour and requirements in ``out/diagrams``."""

from sysmlc.backends.plantuml.backend import PlantUml

BACKEND = PlantUml()

__all__ = ["BACKEND", "PlantUml"]
