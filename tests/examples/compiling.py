"""The models in ``examples``, and functions that compile them in memory."""

from pathlib import Path

from sysmlc.driver import Compilation, Request, compile_model, select_backends

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(
    path for path in (ROOT / "examples").glob("*/*.uml") if path.stem == path.parent.name
)
PLANT = ROOT / "examples" / "baygate" / "baygate.aml"
"""AutomationML with an overlay, which names the behaviours in ``gate.uml``."""

TEXT = ROOT / "examples" / "lego-recipe-v2" / "lego-recipe.sysml"
"""The lego recipe in SysML v2."""


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
