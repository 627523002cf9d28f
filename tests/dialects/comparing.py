"""Compares what the dialects of one model become: graphs, and output texts."""

from pathlib import Path

from dialects import enterprise_architect, magicdraw
from examples.compiling import compile_text, outputs
from graph_differences import Change, diff
from sysmlc.driver import Compilation

WRITERS = {
    "xml": magicdraw.write_xml,
    "mdzip": magicdraw.write_mdzip,
    "xmi": enterprise_architect.write_xmi,
}
"""Writers of the dialects by the suffix of their files."""

_IDS = {"xmi": enterprise_architect.ids_of}

OF_THE_DIALECT = frozenset(
    {"href", "namespace", "qualified_name", "tag.Id", "tag.id", "tag.Text", "tag.text"}
)
"""Attributes in which the dialects differ by their nature: where the standard's files are, how the
tools' SysML profiles are called and spelt, and the path that MagicDraw writes beside a reference.
What they mean is in roles and attributes."""


def compile_both(
    folder: Path, papyrus: bytes, dialect: str = "xml", *emit: str
) -> tuple[Compilation, Compilation]:
    """The compilation of a Papyrus document, and of the same model in another dialect."""
    other = WRITERS[dialect](papyrus)
    return (
        compile_text(folder, "model.uml", papyrus, *emit),
        compile_text(folder, f"model.{dialect}", other, *emit),
    )


def graph_changes(one: Compilation, other: Compilation) -> list[Change]:
    """Differences of the graphs that are not of the dialect."""
    ignored = {"id", "source", "trace", *OF_THE_DIALECT}
    return [change for change in diff(one.graph, other.graph, ignored) if not of_dialect(change)]


def of_dialect(change: Change) -> bool:
    """Whether a difference is of the dialect, not of the model.

    Papyrus applies SysML package by package and MagicDraw once; the tools' libraries have other
    names; MagicDraw notes the path of a connector end also where partWithPort says it.
    """
    is_library = "::" not in change.element or change.element.startswith("SysML::")
    stand_in = change.detail in ("Profile", "Package") and is_library
    path = change.detail == "Application" and change.element.endswith("::NestedConnectorEnd")
    applied = change.detail.startswith("applies ")
    imported = change.element.endswith("::<Import>") and change.detail.startswith("references ")
    return stand_in or path or applied or imported


def common_outputs(
    papyrus: bytes, one: Compilation, other: Compilation
) -> tuple[dict[str, str], dict[str, str]]:
    """The outputs of both, the second with the ids, the file name and the digest of the first."""
    here, there = one.inputs[0], other.inputs[0]
    ids_of = _IDS.get(there.path.rpartition(".")[2], magicdraw.ids_of)
    names = {new: old for old, new in ids_of(papyrus).items()}
    names |= {there.sha256: here.sha256, there.path: here.path}
    return outputs(one), {path: _translated(text, names) for path, text in outputs(other).items()}


def _translated(text: str, names: dict[str, str]) -> str:
    for new, old in names.items():
        text = text.replace(new, old)
    return text
