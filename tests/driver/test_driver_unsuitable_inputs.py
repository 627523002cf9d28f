"""Inputs that are empty or not a model are reported with a description of their content."""

import io
import zipfile

import pytest
from click.testing import CliRunner

from sysmlc.cli.group import sysmlc
from sysmlc.language import library

UML = (
    '<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001" '
    'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="M"/>'
)
PLANT = "<CAEXFile FileName='a.aml' SchemaVersion='3.0'><{} Name='x'/></CAEXFile>"
BOM = "\ufeff"


@pytest.fixture
def run_sysmlc(tmp_path, monkeypatch):
    """Return a function that runs a command in a folder: exit code, and one line per diagnostic."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".git").mkdir()

    def invoke(*args):
        result = CliRunner().invoke(sysmlc, [*args, "--format", "concise"])
        return result.exit_code, result.stdout + result.stderr

    return invoke


@pytest.mark.parametrize("suffix", ["uml", "xmi", "xml", "aml", "amlx", "mdzip", "kpar", "md"])
@pytest.mark.parametrize("content", ["", " \n\t\n", BOM])
def test_an_empty_file_is_an_error(run_sysmlc, tmp_path, suffix, content):
    (tmp_path / f"m.{suffix}").write_text(content, encoding="utf-8")
    code, report = run_sysmlc("check", f"m.{suffix}")
    assert (code, report.splitlines()[0]) == (
        1,
        f"m.{suffix}: error[SM171 unrecognised-content]: 'm.{suffix}' is not a model: it is empty",
    )


@pytest.mark.parametrize("suffix", ["sysml", "kerml"])
@pytest.mark.parametrize("content", ["", " \n\t\n", BOM])
def test_an_empty_text_of_sysml_v2_is_a_warning(run_sysmlc, tmp_path, suffix, content):
    (tmp_path / f"m.{suffix}").write_text(content, encoding="utf-8")
    code, report = run_sysmlc("check", f"m.{suffix}")
    assert (code, report.splitlines()) == (
        0,
        [
            f"m.{suffix}: warning[SM157 empty-file]: 'm.{suffix}' is empty: it defines nothing",
            "1 warning in 1 file",
        ],
    )


@pytest.mark.parametrize(
    ("name", "content"),
    [("m.sysml", "package P;"), ("m.uml", UML), ("m.aml", PLANT.format("InstanceHierarchy"))],
)
def test_a_minimal_model_has_no_diagnostics(run_sysmlc, tmp_path, name, content):
    (tmp_path / name).write_text(content)
    assert run_sysmlc("check", name) == (0, "")


def test_an_empty_text_reports_no_errors_in_the_library_of_sysmlc(
    run_sysmlc, tmp_path, monkeypatch
):
    """The bundled core library lacks 54 names that the library of sysmlc uses."""
    monkeypatch.setattr(library, "_find_installed", lambda: None)
    (tmp_path / "empty.sysml").touch()
    text = "package P { private import SysMLC::*; }"
    (tmp_path / "uses.sysml").write_text(text)
    for name, messages in {"empty.sysml": ["SM157"], "uses.sysml": ["SM207"]}.items():
        code, report = run_sysmlc("check", name, "--emit", "+sysmlx")
        assert code == 0
        assert [message for message in messages if message not in report] == []
        assert "SM205" not in report


@pytest.mark.parametrize(
    ("name", "data", "description"),
    [
        ("README.md", b"# Model\n\nA model; see {docs}.\n", "plain text"),
        ("notes.txt", b"part of the documentation of a plant\n", "plain text"),
        ("a.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "a PNG image"),
        ("plant.uml", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "a PNG image"),
        ("a.pdf", b"%PDF-1.7\n1 0 obj\n", "a PDF document"),
        ("a.json", b'{"a": 1}', "JSON"),
        ("plant.xmi", b"<!DOCTYPE html><html/>", "an HTML page"),
        ("pom.xml", b"<?xml version='1.0'?><project/>", "XML with the root element 'project'"),
        ("a.bin", bytes(range(256)), "binary data"),
    ],
)
def test_content_that_is_not_a_model_is_described(run_sysmlc, tmp_path, name, data, description):
    (tmp_path / name).write_bytes(data)
    code, report = run_sysmlc("check", name)
    assert code == 1
    assert report.startswith(
        f"{name}: error[SM171 unrecognised-content]: '{name}' is not a model: it is {description}\n"
    )


def test_text_of_sysml_v2_is_recognised_by_content(run_sysmlc, tmp_path):
    (tmp_path / "plant.txt").write_text("#derivation connection { }\npart def Gate;\n")
    assert "SM171" not in run_sysmlc("check", "plant.txt")[1]


def test_an_archive_without_a_model_is_reported(run_sysmlc, tmp_path):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("readme.txt", "hello")
    (tmp_path / "a.zip").write_bytes(stream.getvalue())
    code, report = run_sysmlc("check", "a.zip")
    assert code == 1
    assert "'a.zip' cannot be read: the archive holds no model" in report


def test_a_skipped_file_in_a_folder_is_reported_with_the_reason(run_sysmlc, tmp_path):
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "plant.sysml").write_text("package P;")
    (tmp_path / "models" / "pom.xml").write_text("<project/>")
    code, report = run_sysmlc("check", "models")
    assert code == 0
    assert (
        "'models/pom.xml' is named like a model but is not one: it is XML with the root" in report
    )


def test_a_folder_without_models_is_an_error(run_sysmlc, tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "readme.md").write_text("hello")
    code, report = run_sysmlc("check", "docs")
    assert (code, report.splitlines()[0]) == (
        1,
        "docs: error[SM173 nothing-to-compile]: 'docs' contains no model",
    )


def test_automationml_libraries_without_a_plant_are_an_info(run_sysmlc, tmp_path):
    (tmp_path / "lib.aml").write_text(PLANT.format("RoleClassLib"))
    (tmp_path / "plant.aml").write_text(PLANT.format("InstanceHierarchy"))
    _, report = run_sysmlc("check", "lib.aml")
    assert "info[SM158 only-caex-libraries]: 'lib.aml' contains only" in report
    assert run_sysmlc("check", "lib.aml", "plant.aml") == (0, "")


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
@pytest.mark.parametrize("doctype", ["", '<!DOCTYPE XMI SYSTEM "uml.dtd">'])
def test_an_old_version_of_xmi_is_named(run_sysmlc, tmp_path, version, doctype):
    root = f'<XMI xmi.version="{version}" xmlns:UML="omg.org/UML1.3"><XMI.content/></XMI>'
    (tmp_path / "plant.xml").write_text(f'<?xml version="1.0"?>{doctype}{root}')
    code, report = run_sysmlc("check", "plant.xml")
    assert (code, report.splitlines()[0]) == (
        1,
        "plant.xml: error[SM171 unrecognised-content]: 'plant.xml' is not a model: it is XMI "
        f"{version}; export XMI 2.1 or later",
    )


def test_an_empty_file_that_a_model_refers_to_is_named(run_sysmlc, tmp_path):
    general = '<generalization xmi:id="g"><general href="base.uml#b"/></generalization>'
    owned = f'<packagedElement xmi:type="uml:Class" xmi:id="c" name="C">{general}</packagedElement>'
    (tmp_path / "m.uml").write_text(UML.replace("/>", f">{owned}</uml:Model>"))
    (tmp_path / "base.uml").touch()
    _, report = run_sysmlc("check", "m.uml")
    assert "base.uml: warning[SM157 empty-file]: 'base.uml' is empty: it defines nothing" in report
