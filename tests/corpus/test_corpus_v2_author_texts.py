"""``--emit sysml`` repeats the real models in SysML v2; the texts are the same model again."""

import pytest

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir.compare import compare

UNITS = ("ice-lab", "showcase", "omg-release/training", "omg-release/examples")


@pytest.mark.corpus
@pytest.mark.parametrize("unit", UNITS)
def test_texts_are_repeated_and_accepted_again_without_differences(unit, corpus, tmp_path):
    folder = corpus / "sysml2" / unit
    compilation = compile_model(Request((folder,), backends=tuple(select_backends(("sysml",)))))
    for artefact in compilation.artefacts:
        path = tmp_path / artefact.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(artefact.text.encode())
    assert read_files(tmp_path / "sysml") == read_files(folder)
    again = compile_model(Request((tmp_path / "sysml",)))
    assert list_errors(again) == list_errors(compilation)
    assert list(compare(compilation.graph, again.graph)) == []


def read_files(folder):
    """Return the content of all texts below a folder, by path."""
    paths = (path for path in folder.rglob("*") if path.suffix in (".sysml", ".kerml"))
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def list_errors(compilation):
    return [str(d.message) for d in compilation.diagnostics if d.is_error]
