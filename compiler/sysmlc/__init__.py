"""sysmlc: a model transformation compiler for cyber-physical production systems.

The names below are the Python API (docs/python-api.md). They are imported at their first use, so
that ``sysmlc --version`` and the completion of the shell do not import the compiler.

This module imports nothing at its start: ``python -m sysmlc`` runs it while the working folder,
which may belong to a stranger, still comes first in the search for modules (see ``__main__``).
"""

TYPE_CHECKING = False
"""Type checkers take it as true, like the name in ``typing``."""
if TYPE_CHECKING:
    from sysmlc.api.compiling import (
        BackendError,
        Change,
        Compilation,
        Config,
        ConfigError,
        Contract,
        Diagnostic,
        Edge,
        Element,
        Finding,
        Graph,
        Kind,
        Pass,
        RecipeModel,
        Request,
        Rule,
        Severity,
        Sink,
        compile_model,
        compile_texts,
        diff,
        format_findings,
        list_findings,
        query,
        rule,
        write,
    )
    from sysmlc.api.verification import (
        CheckedContract,
        CompositionVerdict,
        ContractChecks,
        SimulationReport,
        Synthesis,
        check_contracts,
        simulate,
        synthesise,
    )

__version__ = "0.1.0"

__all__ = [
    "BackendError",
    "Change",
    "CheckedContract",
    "Compilation",
    "CompositionVerdict",
    "Config",
    "ConfigError",
    "Contract",
    "ContractChecks",
    "Diagnostic",
    "Edge",
    "Element",
    "Finding",
    "Graph",
    "Kind",
    "Pass",
    "RecipeModel",
    "Request",
    "Rule",
    "Severity",
    "SimulationReport",
    "Sink",
    "Synthesis",
    "check_contracts",
    "compile_model",
    "compile_texts",
    "diff",
    "format_findings",
    "list_findings",
    "query",
    "rule",
    "simulate",
    "synthesise",
    "write",
]


_VERIFICATION = (
    "CheckedContract",
    "CompositionVerdict",
    "ContractChecks",
    "SimulationReport",
    "Synthesis",
    "check_contracts",
    "simulate",
    "synthesise",
)
"""Names of ``sysmlc.api.verification``; the others are those of ``sysmlc.api.compiling``."""


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    module = "verification" if name in _VERIFICATION else "compiling"
    return getattr(import_module(f"sysmlc.api.{module}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
