"""Analysis ``controllers``: a verified controller for each contract that is realizable."""

from functools import partial
from typing import ClassVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic.contract import Contract, locate_origin
from sysmlc.logic.formats.lowering import rename_ambiguous_literals
from sysmlc.synthesis.bdd.limits import Limits
from sysmlc.synthesis.controller_synthesis import Form, Synthesis, synthesise_controller
from sysmlc.synthesis.decision import Options, Place


class Controllers(Struct, frozen=True):
    """Synthesise controllers, each within the limits of *options*.

    *component* selects one component by its qualified name; empty stands for all.
    """

    options: Options = Options("", Limits(seconds=10.0), is_explained=True)
    component: str = ""
    form: Form = Form.ANY

    name: ClassVar[str] = "controllers"

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a Synthesis for each selected contract."""
        place = partial(locate_origin, graph)
        graph.store(
            Synthesis,
            [
                synthesise(contract, place, sink, self.options, self.form)
                for contract in graph.derived(Contract)
                if self.component in ("", contract.component)
            ],
        )


def synthesise(
    contract: Contract, place: Place, sink: Sink, options: Options, form: Form = Form.ANY
) -> Synthesis:
    """Decide a contract and build a controller; the result carries its findings.

    The findings have the severities of *sink*.
    """
    findings, renamed = sink.subset(()), rename_ambiguous_literals(contract)
    synthesis = synthesise_controller(renamed, place, findings, options, form)
    return replace(synthesis, diagnostics=tuple(findings))
