"""The files that show how a contract is defeated."""

from collections.abc import Iterable, Iterator

from sysmlc.logic.contract import Contract
from sysmlc.support.file_names import assign_file_names
from sysmlc.synthesis.counter import drawing, sysml
from sysmlc.synthesis.counter.machine import Counter


def files(
    made: Iterable[tuple[Counter, Contract]], named: sysml.Named
) -> Iterator[tuple[str, str]]:
    """Name and text of the files of counter-strategies; small ones have a diagram of states."""
    known = {contract.component: (counter, contract) for counter, contract in made}
    for component, name in assign_file_names(known).items():
        counter, contract = known[component]
        if len(counter.states) <= drawing.MOST_SHOWN:
            yield f"{name}.counter.puml", drawing.diagram(counter, contract)
        yield f"{name}.counter-run.puml", drawing.run(counter, contract)
        yield f"{name}.counter.sysml", sysml.text(counter, contract, named)
