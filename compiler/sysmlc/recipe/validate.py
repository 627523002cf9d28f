"""The rules that a schema cannot say, REC001 to REC012 (SM601 to SM612) and their neighbours."""

from sysmlc.diagnostics import Sink
from sysmlc.recipe import check_bindings, check_data, check_graphs, check_tasks, check_times
from sysmlc.recipe.checks import Check, Locate, tell
from sysmlc.recipe.derive import Tables
from sysmlc.recipe.model import Model

CHECKS: tuple[Check, ...] = (
    check_tasks.references,
    check_tasks.order,
    check_graphs.ways,
    check_graphs.nesting,
    check_data.guards,
    check_data.names,
    check_data.readable,
    check_tasks.machines,
    check_times.task_times,
    check_times.groups,
    check_times.releases,
    check_times.bounds,
    check_bindings.materials,
    check_bindings.calls,
)


def validate(model: Model, sink: Sink, locate: Locate, tolerance: float = 0.1) -> None:
    """Report what is wrong with a recipe model; ``locate`` turns element ids into subjects.

    ``tolerance`` is the share by which function times may differ from service times.
    """
    tables = Tables.of(model)
    for check in CHECKS:
        tell(check(model, tables), sink, locate)
    tell(check_times.service_times(model, tables, tolerance), sink, locate)
