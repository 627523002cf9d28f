"""Compiles models for the tests of the examples: in memory, as the command line would."""

from pathlib import Path

from sysmlc.driver import Compilation, Request, compile_model, select_backends

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(p for p in (ROOT / "examples").glob("*/*.uml") if p.stem == p.parent.name)
PLANT = ROOT / "examples" / "baygate" / "baygate.aml"
"""AutomationML with an overlay, which names the behaviours of ``gate.uml`` beside it."""

TEXT = ROOT / "examples" / "lego-recipe-v2" / "lego-recipe.sysml"
"""The lego recipe in SysML v2."""


def compile_example(model: Path, *emit: str) -> Compilation:
    """Compile with the default back ends, or with those named as after ``--emit``."""
    return compile_model(Request((model,), backends=tuple(select_backends(emit))))


def compile_text(folder: Path, name: str, data: bytes, *emit: str) -> Compilation:
    """Compile a document that stands in no file yet."""
    model = folder / name
    model.write_bytes(data)
    return compile_example(model, *emit)


def outputs(compilation: Compilation) -> dict[str, str]:
    """The texts of all files that are not withheld, by path."""
    return {artefact.path: artefact.text for artefact in compilation.list_published()}


def findings(compilation: Compilation) -> str:
    """One line a finding: code, severity, message, element."""
    return "".join(
        f"{found.rule.code} {found.severity} {found.message} [{found.subject.name}]\n"
        for found in compilation.diagnostics
    )
