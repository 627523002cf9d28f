"""Files of synthesised controllers, in the format that the caller chooses."""

from collections.abc import Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.support.file_names import assign_file_names
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.controller_synthesis import Synthesis
from sysmlc.synthesis.controllers import controller_formats
from sysmlc.synthesis.controllers.closed_loop import Controller
from sysmlc.synthesis.controllers.mealy import Machine
from sysmlc.synthesis.decision import Place

OWN, TABLE, GR1C = FORMS = ("own", "table", "gr1c")
"""Forms of controllers as files: machine or table, table, gr1c's JSON."""


class ControllerFiles(Struct, frozen=True):
    """Controllers and their files; a controller that its format cannot express is None."""

    made: tuple[Synthesis, ...]
    files: tuple[tuple[str, str], ...]
    """Names and texts; small machines have a diagram too."""


def write_controllers(
    results: Sequence[Synthesis], place: Place, sink: Sink, form: str = OWN
) -> ControllerFiles:
    """Return the files of all controllers; controllers that the format cannot express are
    reported.
    """
    file_names = assign_file_names([result.contract.component for result in results])
    files: list[tuple[str, str]] = []
    written: list[Synthesis] = []
    for result in results:
        try:
            if result.machine is not None:
                files += controller_files(
                    file_names[result.contract.component], result.machine, result.contract, form
                )
            written.append(result)
        except LimitError as problem:
            subject, name = place(result.contract.origin), result.contract.component
            sink.report(rules.NO_MACHINE, subject, component=name, why=str(problem))
            written.append(replace(result, machine=None))
    return ControllerFiles(tuple(written), tuple(files))


def controller_files(
    name: str, controller: Controller, contract: Contract, form: str
) -> Iterator[tuple[str, str]]:
    """Yield the files of one controller. Raises LimitError if it is too large for gr1c's format."""
    if form == GR1C:
        yield f"{name}.gr1c.json", controller_formats.gr1c_json(controller, contract)
    elif not isinstance(controller, Machine):
        yield f"{name}.controller.json", controller_formats.table_json(controller, contract)
    else:
        yield f"{name}.machine.json", controller_formats.machine_json(controller, contract)
        if controller_formats.has_diagram(controller):
            yield f"{name}.machine.puml", controller_formats.machine_diagram(controller, contract)
