"""Three-level recipe models: values, derived data, and checks.

The checks are those of the thesis, REC001 to REC012 (SM601 to SM612), and more.
"""

from collections.abc import Collection

from sysmlc.diagnostics import Sink
from sysmlc.recipe import check_data, check_graphs, check_resources, check_tasks, recipe_times
from sysmlc.recipe.model import Model
from sysmlc.recipe.tables import Check, Locate, Tables, report_findings

CHECKS: tuple[Check, ...] = (
    check_tasks.check_references,
    check_tasks.check_precedence,
    check_graphs.check_paths,
    check_graphs.check_nesting,
    check_data.check_guards,
    check_data.check_names,
    check_data.check_expressions,
    check_tasks.check_machines,
    check_resources.check_task_times,
    recipe_times.check_time_limits,
    check_resources.check_groups,
    check_resources.check_releases,
    check_graphs.check_bounds,
    check_graphs.check_rounds,
    check_resources.check_capability_times,
    check_resources.check_availability,
    check_tasks.check_materials,
    check_tasks.check_stock,
    check_tasks.check_opc_ua_calls,
)


def validate(
    model: Model,
    sink: Sink,
    locate: Locate,
    tolerance: float = 0.1,
    faulty: Collection[str] = (),
) -> None:
    """Report the violations of a recipe model; *locate* turns element ids into subjects.

    *tolerance* is the share by which function times may differ from service times. *faulty* has ids
    of elements with reported values, whose absence is no fault of its own.
    """
    tables = Tables.from_model(model)
    for check in CHECKS:
        report_findings(check(model, tables), sink, locate)
    report_findings(check_resources.check_service_times(model, tables, tolerance), sink, locate)
    missing = check_resources.check_missing_durations(model, tables)
    report_findings((item for item in missing if item.element not in faulty), sink, locate)
