"""The driver: inputs -> graph -> passes -> back ends -> output folder. It prints nothing."""

from sysmlc.driver.compilation import (
    Compilation,
    Observer,
    OpenedUnit,
    Request,
    compile_model,
    open_texts,
    open_unit,
)
from sysmlc.driver.outcome import (
    Outcome,
    collect_results,
    format_manifest,
    format_trace,
    summarize,
)
from sysmlc.driver.publishing import Publication, Target, compare, publish
from sysmlc.driver.registry import (
    BackendError,
    PlugInWarning,
    list_backend_names,
    load_all_backends,
    load_backends,
    load_full_catalogue,
    select_backends,
)
from sysmlc.driver.units import open_units

__all__ = [
    "BackendError",
    "Compilation",
    "Observer",
    "OpenedUnit",
    "Outcome",
    "PlugInWarning",
    "Publication",
    "Request",
    "Target",
    "collect_results",
    "compare",
    "compile_model",
    "format_manifest",
    "format_trace",
    "list_backend_names",
    "load_all_backends",
    "load_backends",
    "load_full_catalogue",
    "open_texts",
    "open_unit",
    "open_units",
    "publish",
    "select_backends",
    "summarize",
]
