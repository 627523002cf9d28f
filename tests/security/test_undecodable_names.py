"""File names that are not UTF-8 are escaped in outputs and messages; no command fails on them."""

import json
import os
import subprocess
import sys

import pytest
from click.testing import CliRunner

from long_runs import quick_first
from sysmlc.cli import group

V2 = b"package P { part def A; part a : B; }"
IR = b'Class a "A"\n  -> specializes a\n'
NAME = b"pl\xffnt"

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="other systems refuse file names that are not UTF-8"
)


@pytest.fixture
def folder(tmp_path):
    """Return a project with files of undecodable names."""
    (tmp_path / ".git").mkdir()
    for name, data in {
        b"models/" + NAME + b".sysml": V2,
        b"models/back\\slash.sysml": b"package Q;",
        NAME + b".ir": IR,
        NAME + b".toml": b"nonsense = 1\n",
        NAME + b".yaml": b"nonsense: 1\n",
        NAME + b".ltl": b"G (a -> X b)\n",
        b"clean.ir": b'Class a "A"\n',
    }.items():
        path = tmp_path / os.fsdecode(name)
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)
    return tmp_path


@pytest.fixture
def run_sysmlc(folder):
    """Return a function that runs ``sysmlc`` with arguments as bytes in a process of its own."""

    def invoke(*args):
        command = [os.fsencode(sys.executable), b"-m", b"sysmlc", *args]
        result = subprocess.run(command, cwd=folder, capture_output=True)
        text = result.stdout.decode() + result.stderr.decode()  # raises if it is not UTF-8
        assert result.returncode in (0, 1, 2)
        assert "Traceback" not in text
        assert "fault of sysmlc" not in text
        return text

    return invoke


@pytest.mark.parametrize(
    "format_name", quick_first([b"text", b"sarif", b"concise", b"github", b"json"], 2)
)
def test_every_format_names_the_file(run_sysmlc, format_name):
    report = run_sysmlc(b"check", b"models", b"--format", format_name)
    assert ("pl%5Cxffnt" if format_name == b"sarif" else r"pl\xffnt.sysml") in report.replace(
        r"\\", "\\"
    )


@pytest.mark.parametrize(
    "args",
    [
        [b"check", NAME + b".ir"],
        [b"check", b"missing" + NAME],
        [b"check", b"clean.ir", b"--config", NAME + b".toml"],
        [b"check", b"clean.ir", b"--overlay", NAME + b".yaml"],
        [b"check", b"clean.ir", b"--library", NAME],
        [b"check", b"clean.ir", b"--emit", NAME],
        [b"check", b"clean.ir", b"--templates", NAME],
        [b"simulate", b"clean.ir", NAME + b".yaml"],
        [b"contracts", b"check", NAME + b".ltl"],
        [b"format", b"models/" + NAME + b".sysml", b"--diff"],
        [b"show", NAME + b".ir"],
        [b"coverage", b"models", b"--format", b"json"],
        [b"explain", NAME],
        [NAME],
    ],
    ids=lambda args: os.fsdecode(args[0]) if len(args) == 1 else None,
)
def test_commands_do_not_fail(folder, monkeypatch, args):
    monkeypatch.chdir(folder)
    result = CliRunner().invoke(group.sysmlc, list(map(os.fsdecode, args)), catch_exceptions=False)
    assert result.exit_code in (0, 1, 2)
    assert result.output_bytes.decode()  # raises if it is not UTF-8


@pytest.mark.parametrize(
    "second_name", quick_first([b"models/pl\\xffnt.sysml", b"models/e\xcc\x81.sysml"])
)
def test_two_files_that_are_displayed_alike_are_reported(run_sysmlc, tmp_path, second_name):
    (tmp_path / "models" / "é.sysml").write_text("package É;")
    assert "SM159" not in run_sysmlc(b"check", b"models")
    (tmp_path / os.fsdecode(second_name)).write_bytes(V2)
    assert "error[SM159 same-file-name]: a second file is called" in run_sysmlc(b"check", b"models")


def test_outputs_are_utf_8_and_contain_the_escaped_name(run_sysmlc, tmp_path):
    backends = b"+graph,+ir,+sysml,+sysmlx,+uml,+ecore"
    run_sysmlc(b"build", b"models", b"-o", b"out" + NAME, b"--emit", backends)
    output = tmp_path / os.fsdecode(b"out" + NAME)
    texts = {path.name: path.read_text("utf-8") for path in output.rglob("*") if path.is_file()}
    assert [file["path"] for file in json.loads(texts["manifest.json"])["inputs"]] == [
        r"back\slash.sysml",
        r"pl\xffnt.sysml",
    ]
    assert {"back%5Cslash.sysmlx", "pl%5Cxffnt.sysmlx"} <= texts.keys()
