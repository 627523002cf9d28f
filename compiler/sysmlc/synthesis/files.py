"""The files of controllers: names and texts, in the form that is wanted."""

from collections.abc import Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.support.file_names import assign_file_names
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.controllers import gr1c_text, machine_text, table_text
from sysmlc.synthesis.controllers.closed import Controller
from sysmlc.synthesis.controllers.mealy import Machine
from sysmlc.synthesis.decide import Place
from sysmlc.synthesis.synthesise import Synthesis

OWN, TABLE, GR1C = FORMS = ("own", "table", "gr1c")
"""Forms of controllers as files: machine or table, table, gr1c's JSON."""


class Written(Struct, frozen=True):
    """What was made, and the files of it; what a form cannot say counts as not made."""

    made: tuple[Synthesis, ...]
    files: tuple[tuple[str, str], ...]
    """Names and texts; small machines have a diagram too."""


def written(made: Sequence[Synthesis], place: Place, sink: Sink, form: str = OWN) -> Written:
    """The files of all controllers there are; what cannot be said in this form is reported."""
    names = assign_file_names([one.contract.component for one in made])
    files: list[tuple[str, str]] = []
    kept: list[Synthesis] = []
    for one in made:
        try:
            if one.machine is not None:
                files += files_of(names[one.contract.component], one.machine, one.contract, form)
            kept.append(one)
        except LimitError as problem:
            subject, name = place(one.contract.origin), one.contract.component
            sink.report(rules.NO_MACHINE, subject, component=name, why=str(problem))
            kept.append(replace(one, machine=None))
    return Written(tuple(kept), tuple(files))


def files_of(
    name: str, controller: Controller, contract: Contract, form: str
) -> Iterator[tuple[str, str]]:
    """The files of one controller. Raises LimitError for one that is too large for gr1c's form."""
    if form == GR1C:
        yield f"{name}.gr1c.json", gr1c_text.json_of(controller, contract)
    elif not isinstance(controller, Machine):
        yield f"{name}.controller.json", table_text.json_of(controller, contract)
    else:
        yield f"{name}.machine.json", machine_text.json_of(controller, contract)
        if machine_text.has_diagram(controller):
            yield f"{name}.machine.puml", machine_text.plantuml_of(controller, contract)
