"""Comparison of the graphs and outputs of one model in the dialects of several tools."""

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

_ID_TABLES = {"xmi": enterprise_architect.map_ids}

DIALECT_ATTRIBUTES = frozenset(
    {"href", "namespace", "qualified_name", "tag.Id", "tag.id", "tag.Text", "tag.text"}
)
"""Attributes that differ between dialects although the model is the same.

They hold the locations of the standard's files, the names and spellings of the tools' SysML
profiles, and the path that MagicDraw writes beside a reference. Roles and other attributes hold
their meaning, and are compared.
"""


def compile_both(
    folder: Path, papyrus: bytes, dialect: str = "xml", *emit: str
) -> tuple[Compilation, Compilation]:
    """Compile a Papyrus document and the same model in another dialect."""
    translated = WRITERS[dialect](papyrus)
    return (
        compile_text(folder, "model.uml", papyrus, *emit),
        compile_text(folder, f"model.{dialect}", translated, *emit),
    )


def find_graph_changes(first: Compilation, second: Compilation) -> list[Change]:
    """Return the differences of the graphs that the dialects do not explain."""
    ignored = {"id", "source", "trace", *DIALECT_ATTRIBUTES}
    return [
        change
        for change in diff(first.graph, second.graph, ignored)
        if not is_dialect_difference(change)
    ]


def is_dialect_difference(change: Change) -> bool:
    """Whether the dialects explain a difference, so that the models may still be equal.

    Papyrus applies SysML package by package and MagicDraw once. The tools' libraries have
    different names. MagicDraw writes the path of a connector end also where partWithPort states it.
    """
    element, detail = change.element, change.detail
    is_in_library = "::" not in element or element.startswith("SysML::")
    is_library_stub = detail in ("Profile", "Package") and is_in_library
    is_connector_path = detail == "Application" and element.endswith("::NestedConnectorEnd")
    is_applied_profile = detail.startswith("applies ")
    is_import_target = element.endswith("::<Import>") and detail.startswith("references ")
    return is_library_stub or is_connector_path or is_applied_profile or is_import_target


def normalize_outputs(
    papyrus: bytes, first: Compilation, second: Compilation
) -> tuple[dict[str, str], dict[str, str]]:
    """Return both outputs, the second with the ids, the file name and the digest of the first."""
    first_input, second_input = first.inputs[0], second.inputs[0]
    map_ids = _ID_TABLES.get(second_input.path.rpartition(".")[2], magicdraw.map_ids)
    names = {new: old for old, new in map_ids(papyrus).items()}
    names |= {second_input.sha256: first_input.sha256, second_input.path: first_input.path}
    return outputs(first), {
        path: _replace_all(text, names) for path, text in outputs(second).items()
    }


def _replace_all(text: str, names: dict[str, str]) -> str:
    for new, old in names.items():
        text = text.replace(new, old)
    return text
