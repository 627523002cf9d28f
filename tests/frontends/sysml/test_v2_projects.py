"""Project archives as inputs: one model, whose files are checked against the description."""

import hashlib
import io
import json
import zipfile

import pytest

from sysmlc.driver import Request, compile_model

TEXT = b"package Robots { part def Robot; }"
SUM = hashlib.sha256(TEXT).hexdigest()
STANDARD = "https://www.omg.org/spec/SysML/20250201/Systems-Library.kpar"


def pack(path, value=SUM, usage=(), described=True):
    about = {
        "name": "Robots",
        "version": "1.0.0",
        "usage": [{"resource": resource} for resource in usage],
    }
    meta = {"index": {}, "checksum": {"R.sysml": {"value": value, "algorithm": "SHA256"}}}
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w") as zipped:
        zipped.writestr("R.sysml", TEXT)
        if described:
            zipped.writestr(".project.json", json.dumps(about))
            zipped.writestr(".meta.json", json.dumps(meta))
    path.write_bytes(written.getvalue())
    return path


def compile_files(*paths):
    compilation = compile_model(Request(inputs=paths))
    diagnostics = [
        (diagnostic.rule.code, diagnostic.subject.place.file)
        for diagnostic in compilation.diagnostics
    ]
    return {compilation.graph.qualified_name(element) for element in compilation.graph}, diagnostics


def test_the_models_of_an_archive_are_compiled(tmp_path):
    names, diagnostics = compile_files(pack(tmp_path / "robots.kpar", usage=[STANDARD]))
    assert "Robots::Robot" in names
    assert diagnostics == []


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        ({"value": "00"}, [("SM168", "robots.kpar!.meta.json")]),
        ({"usage": ["Gone.kpar"]}, [("SM169", "robots.kpar!.project.json")]),
        (
            {"described": False},
            [("SM752", "robots.kpar!.project.json"), ("SM752", "robots.kpar!.meta.json")],
        ),
    ],
)
def test_differences_from_the_project_description_are_reported(tmp_path, message, expected):
    assert sorted(compile_files(pack(tmp_path / "robots.kpar", **message))[1]) == sorted(expected)


def test_archives_that_are_given_together_are_found(tmp_path):
    user = pack(tmp_path / "plant.kpar", usage=["https://example.org/1.0/Robots.kpar"])
    # Both archives have the same file in this test, so that they declare one package (SM243).
    assert compile_files(user, pack(tmp_path / "robots.kpar"))[1] == [
        ("SM243", "plant.kpar!R.sysml")
    ]


def test_archives_of_the_library_are_examined(tmp_path):
    (tmp_path / "m.sysml").write_text("package M { private import Robots::*; part r : Robot; }")
    for name, value in (("good", SUM), ("bad", "00")):
        library = pack(tmp_path / f"{name}.kpar", value)
        compilation = compile_model(Request((tmp_path / "m.sysml",), library=str(library)))
        codes = [diagnostic.rule.code for diagnostic in compilation.diagnostics]
        assert ("SM168" in codes) == (name == "bad")


def test_archives_of_the_library_of_the_environment_are_examined(tmp_path, monkeypatch):
    (tmp_path / "m.sysml").write_text("package M { private import Robots::*; part r : Robot; }")
    for name, value in (("good", SUM), ("bad", "00")):
        monkeypatch.setenv("SYSML_LIBRARY_PATH", str(pack(tmp_path / f"{name}.kpar", value)))
        compilation = compile_model(Request((tmp_path / "m.sysml",)))
        codes = [diagnostic.rule.code for diagnostic in compilation.diagnostics]
        assert ("SM168" in codes) == (name == "bad")
