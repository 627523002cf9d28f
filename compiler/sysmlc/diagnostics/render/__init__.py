"""Renderers: one module for each form in which findings are shown."""

from sysmlc.diagnostics.render.registry import FORMATS, XPATH_FORMATS, render
from sysmlc.diagnostics.render.report import Finding, Report, make_report, shorten

__all__ = ["FORMATS", "XPATH_FORMATS", "Finding", "Report", "make_report", "render", "shorten"]
