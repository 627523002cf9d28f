"""The formats by name."""

from collections.abc import Callable
from importlib import import_module
from typing import cast

from sysmlc.diagnostics.render.report import Report

FORMATS = ("text", "concise", "json", "sarif", "github")
"""Names of the formats; each is a module of this package with a function ``render``."""

XPATH_FORMATS = frozenset({"json", "sarif"})
"""Formats that say where in the XML tree an element is; text does with ``--verbose``."""


def render(report: Report, format: str, *, color: bool = False) -> str:
    """The findings in one format, with a line end, or nothing when there is nothing to say."""
    module = import_module(f"sysmlc.diagnostics.render.{format}")
    return cast("Callable[..., str]", module.render)(report, color=color)
