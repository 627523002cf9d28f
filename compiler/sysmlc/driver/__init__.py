"""The driver: inputs -> graph -> passes -> back ends -> output folder. It prints nothing."""

from sysmlc.driver.compilation import Compilation, Observer, Request, compile_model
from sysmlc.driver.manifest import manifest_text, trace_text
from sysmlc.driver.publish import OutputError, Plan, apply, plan
from sysmlc.driver.registry import (
    BackendError,
    backend_names,
    full_catalogue,
    load_backends,
    select_backends,
)

__all__ = [
    "BackendError",
    "Compilation",
    "Observer",
    "OutputError",
    "Plan",
    "Request",
    "apply",
    "backend_names",
    "compile_model",
    "full_catalogue",
    "load_backends",
    "manifest_text",
    "plan",
    "select_backends",
    "trace_text",
]
