"""The driver: inputs -> graph -> passes -> back ends -> output folder. It prints nothing."""

from sysmlc.driver.compilation import (
    Compilation,
    Observer,
    Opened,
    Request,
    compile_model,
    open_unit,
)
from sysmlc.driver.manifest import manifest_text
from sysmlc.driver.outcome import Outcome, outcome
from sysmlc.driver.publishing import Publication, Target, compare, publish
from sysmlc.driver.registry import (
    BackendError,
    backend_names,
    full_catalogue,
    load_backends,
    select_backends,
)
from sysmlc.driver.tracing import trace_text
from sysmlc.driver.units import open_units

__all__ = [
    "BackendError",
    "Compilation",
    "Observer",
    "Opened",
    "Outcome",
    "Publication",
    "Request",
    "Target",
    "backend_names",
    "compare",
    "compile_model",
    "full_catalogue",
    "load_backends",
    "manifest_text",
    "open_unit",
    "open_units",
    "outcome",
    "publish",
    "select_backends",
    "trace_text",
]
