"""The models in ``examples``, and functions that compile them in memory."""

import re
from pathlib import Path

from sysmlc.backends.contract_pages import print_page
from sysmlc.driver import Compilation, Request, compile_model, select_backends
from sysmlc.ir import Graph
from sysmlc.logic.contract import Contract
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.formula import variables

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(
    path for path in (ROOT / "examples").glob("*/*.uml") if path.stem == path.parent.name
)
PLANT = ROOT / "examples" / "baygate" / "baygate.aml"
"""AutomationML with an overlay, which names the behaviours in ``gate.uml``."""

TEXT = ROOT / "examples" / "lego-recipe-v2" / "lego-recipe.sysml"
"""The lego recipe in SysML v2."""

TANKS = ROOT / "examples" / "two-tanks" / "two-tanks.sysml"
"""Conditions over lengths, volumes and temperatures."""


def compile_example(model: Path, *emit: str) -> Compilation:
    """Compile with the default back ends, or with those that *emit* selects like ``--emit``."""
    return compile_model(Request((model,), backends=tuple(select_backends(emit))))


def compile_text(folder: Path, name: str, data: bytes, *emit: str) -> Compilation:
    """Write a document to a file in *folder* and compile it."""
    model = folder / name
    model.write_bytes(data)
    return compile_example(model, *emit)


def outputs(compilation: Compilation) -> dict[str, str]:
    """Return the texts of the outputs that are not withheld, by path."""
    return {artefact.path: artefact.text for artefact in compilation.list_published()}


def format_diagnostics(compilation: Compilation) -> str:
    """Return one line for each diagnostic: code, severity, message, element."""
    return "".join(
        f"{diagnostic.rule.code} {diagnostic.severity} {diagnostic.message} "
        f"[{diagnostic.subject.name}]\n"
        for diagnostic in compilation.diagnostics
    )


_REASON = re.compile(r"^No guarantee is about a feature or a signal: .+\.$", re.MULTILINE)


def list_silent_contracts(graph: Graph) -> list[str]:
    """Return the components whose pages say wrongly, or fail to say, that no feature is stated."""
    return [
        contract.component
        for contract in graph.derived(Contract)
        if (_REASON.search(print_page(graph, contract)) is not None)
        == _states_feature(graph, contract)
    ]


def _states_feature(graph: Graph, contract: Contract) -> bool:
    """Whether a guarantee is about a feature, or about a signal that is sent or received."""
    used = {variable.name for part in contract.guarantees for variable in variables(part.formula)}
    return any(
        graph[variable.origin].kind in VALUE_KINDS
        or re.search(r"event$|^(send|receive)_", variable.name) is not None
        for variable in contract.variables
        if variable.name in used and variable.origin in graph
    )
