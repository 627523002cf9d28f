"""``sysmlc watch`` as a process of its own, while modelling tools save files in various ways.

The pauses are those of the tools between two writes. A test waits for an output, with a bound; no
test asserts how long something takes.
"""

import io
import os
import signal
import subprocess
import sys
import time
import zipfile
from functools import partial

import pytest

BOUND = 60
"""Seconds that a test waits for an output."""
MODEL = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<uml:Model xmi:version="20131001"'
    ' xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="{id}" name="M">\n'
)
ENTRY = "com.nomagic.magicdraw.uml_model.model"


def format_model(name, content="", id="m"):
    """Return a UML model with a class *name*; the ids in it start with *id*."""
    class_start = f'<packagedElement xmi:type="uml:Class" xmi:id="{id}c" name="{name}">'
    end = "</packagedElement>\n</uml:Model>\n"
    return (MODEL.format(id=id) + class_start + content + end).encode()


def pack_mdzip(name):
    """Return an archive of MagicDraw with such a model."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(ENTRY, format_model(name))
    return data.getvalue()


class WatchProcess:
    """A running ``sysmlc watch`` in a folder."""

    def __init__(self, folder, *args):
        self.folder = folder
        (folder / ".git").mkdir()
        command = [sys.executable, "-m", "sysmlc", "watch", *args, "--emit", "graph"]
        self.errors = (folder / "errors.txt").open("w+")
        self.lines = (folder / "lines.txt").open("w+")
        self.process = subprocess.Popen(
            [*command, "--settle", "200"],
            cwd=folder,
            stdout=self.lines,
            stderr=self.errors,
            env={**os.environ, "SYSMLC_CACHE": "off", "PYTHONUNBUFFERED": "1"},
            # Background processes of a shell ignore SIGINT, and children inherit that.
            preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
        )

    def wait_until(self, condition):
        """Wait until *condition* returns a true value; fail after BOUND seconds."""
        deadline = time.monotonic() + BOUND
        while not condition():
            assert self.process.poll() is None, self.read_errors()
            assert time.monotonic() < deadline, f"{self.read_lines()} {self.read_errors()}"
            time.sleep(0.02)

    def wait_until_built(self, name):
        """Wait until the output names an element *name*."""
        self.wait_until(lambda: f'"{name}"' in self.read_graph())

    def read_graph(self):
        path = self.folder / "out" / "graph.json"
        return path.read_text() if path.exists() else ""

    def read_lines(self):
        """Return the lines about written outputs, one for each build."""
        return (self.folder / "lines.txt").read_text().splitlines()

    def read_errors(self):
        """Return the diagnostics so far."""
        return (self.folder / "errors.txt").read_text()

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(BOUND)
        self.errors.close()
        self.lines.close()


@pytest.fixture
def start_watch(tmp_path):
    """Return a function that writes files and starts ``sysmlc watch``, up to the first build."""
    processes = []

    def start(files, *args):
        for name, data in files.items():
            (tmp_path / name).write_bytes(data)
        watch = WatchProcess(tmp_path, *args)
        processes.append(watch)
        watch.wait_until(watch.read_lines)
        return watch

    yield start
    for watch in processes:
        watch.stop()


def write_in_pieces(path, data, pause, count=4):
    """Save a file like a tool that truncates it and writes it in pieces."""
    size = len(data) // count + 1
    with path.open("wb") as stream:
        for start in range(0, len(data), size):
            stream.write(data[start : start + size])
            stream.flush()
            time.sleep(pause)


@pytest.mark.parametrize("pause", [0.05, 0.35])
def test_a_file_written_in_pieces_is_not_reported(start_watch, pause):
    """The longer pause exceeds the settling time, so half a file is compiled but not reported."""
    watch = start_watch({"plant.uml": format_model("Old")}, "plant.uml")
    write_in_pieces(watch.folder / "plant.uml", format_model("New"), pause)
    watch.wait_until_built("New")
    assert watch.read_errors() == ""


def test_a_file_that_is_missing_for_a_moment_is_not_reported(start_watch):
    watch = start_watch({"plant.uml": format_model("Old")}, "plant.uml")
    path = watch.folder / "plant.uml"
    path.rename(watch.folder / "plant.uml.bak")
    time.sleep(0.4)
    path.write_bytes(format_model("Back"))
    watch.wait_until_built("Back")
    (watch.folder / "new.tmp").write_bytes(format_model("Renamed"))
    (watch.folder / "new.tmp").replace(path)
    watch.wait_until_built("Renamed")
    assert watch.read_errors() == ""


def test_a_text_that_is_empty_or_missing_for_a_moment_clears_no_outputs(start_watch):
    """Neither an empty text nor a folder with one file less is an error, so nothing is reported."""
    files = {"a.sysml": b"package A;\n", "b.sysml": b"package B;\n"}
    watch = start_watch(files, ".")
    path = watch.folder / "a.sysml"
    path.write_bytes(b"")
    time.sleep(0.6)
    path.write_bytes(b"package Written;\n")
    watch.wait_until_built("Written")
    path.rename(watch.folder / "a.bak")
    time.sleep(0.6)
    path.write_bytes(b"package Replaced;\n")
    watch.wait_until_built("Replaced")
    watch.wait_until(lambda: len(watch.read_lines()) > 2)
    assert len(watch.read_lines()) == 3


def test_an_archive_saved_in_place_is_not_reported(start_watch):
    watch = start_watch({"plant.mdzip": pack_mdzip("Old")}, "plant.mdzip")
    write_in_pieces(watch.folder / "plant.mdzip", pack_mdzip("New"), 0.3)
    watch.wait_until_built("New")
    (watch.folder / "x.tmp").write_bytes(pack_mdzip("Renamed"))
    (watch.folder / "x.tmp").replace(watch.folder / "plant.mdzip")
    watch.wait_until_built("Renamed")
    assert watch.read_errors() == ""


def test_layout_files_of_papyrus_start_no_build(start_watch):
    watch = start_watch({"plant.uml": format_model("Old")}, "plant.uml")
    for name in ("plant.notation", "plant.di", "plant.sash"):
        (watch.folder / name).write_bytes(b"<notation/>")
    time.sleep(1.5)
    (watch.folder / "plant.notation").write_bytes(b"<other/>")
    (watch.folder / "plant.uml").write_bytes(format_model("New"))
    (watch.folder / "plant.di").write_bytes(b"<other/>")
    watch.wait_until_built("New")
    watch.wait_until(lambda: len(watch.read_lines()) > 1)
    assert len(watch.read_lines()) == 2


NOTATION = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
  xmlns:notation="http://www.eclipse.org/gmf/runtime/1.0.3/notation"
  xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">
 <notation:Diagram xmi:id="_d" type="PapyrusUMLClassDiagram" name="{}">
  <children xmi:type="notation:Shape" type="Class_Shape">
   <element xmi:type="uml:Class" href="plant.uml#{}"/></children>
  <element xmi:type="uml:Model" href="plant.uml#m"/>
 </notation:Diagram>
</xmi:XMI>
"""


def test_the_build_waits_for_authored_diagrams_too(start_watch):
    """First the diagram shows a class that the new model lacks, then only half of it is saved."""
    files = {
        "plant.uml": format_model("Old"),
        "plant.notation": NOTATION.format("First", "mc").encode(),
        "plant.di": b"<di/>",
    }
    watch = start_watch(files, "plant.uml", "--diagrams", "author")
    (watch.folder / "plant.uml").write_bytes(format_model("New", id="m").replace(b'"mc"', b'"mn"'))
    write_in_pieces(watch.folder / "plant.notation", NOTATION.format("Second", "mn").encode(), 0.35)
    (watch.folder / "plant.di").write_bytes(b"<other/>")
    watch.wait_until_built("Second")
    assert watch.read_errors() == ""
    (watch.folder / "plant.notation").write_text(NOTATION.format("Alone", "mn"))
    watch.wait_until_built("Alone")
    assert watch.read_errors() == ""


def test_a_reference_to_a_file_that_is_saved_next_is_not_reported(start_watch):
    """Between the two saves the target of the reference does not exist."""
    generalization = '<generalization xmi:id="g" general="{}"/>'
    files = {
        "a.uml": format_model("A", generalization.format("bc"), "a"),
        "b.uml": format_model("B", id="b"),
    }
    watch = start_watch(files, "a.uml", "b.uml")
    (watch.folder / "a.uml").write_bytes(format_model("A2", generalization.format("dc"), "a"))
    time.sleep(0.5)
    (watch.folder / "b.uml").write_bytes(format_model("D", id="d"))
    watch.wait_until_built("D")
    watch.wait_until_built("A2")
    assert watch.read_errors() == ""


def test_a_checkout_of_many_files_is_built_completely(start_watch):
    files = {f"f{n}.sysml": f"package Old{n};".encode() for n in range(20)}
    watch = start_watch(files, ".")
    (watch.folder / "f3.sysml").unlink()
    for n in range(20):
        if n != 3:
            (watch.folder / f"f{n}.sysml").write_text(f"package New{n};")
            time.sleep(0.01)
    (watch.folder / "more.sysml").write_text("package More;")
    watch.wait_until_built("More")
    watch.wait_until_built("New19")
    assert "Old" not in watch.read_graph()
    assert watch.read_errors() == ""


def test_the_last_of_many_saves_is_built(start_watch):
    """Saves follow each other faster than builds end."""
    watch = start_watch({"plant.uml": format_model("Old")}, "plant.uml")
    for number in range(30):
        (watch.folder / "plant.uml").write_bytes(format_model(f"Save{number}"))
        time.sleep(0.05)
    watch.wait_until_built("Save29")
    assert watch.read_errors() == ""


def test_an_error_is_reported_once_and_outputs_stay_until_it_is_corrected(start_watch):
    watch = start_watch({"plant.uml": format_model("Old")}, "plant.uml")
    graph = watch.read_graph()
    (watch.folder / "plant.uml").write_bytes(format_model("New")[:-20])
    watch.wait_until(lambda: "malformed-file" in watch.read_errors())
    watch.wait_until(
        lambda: watch.read_lines()[-1] == "out: not updated because the model has errors"
    )
    assert watch.read_graph() == graph
    (watch.folder / "plant.uml").write_bytes(format_model("Mended"))
    watch.wait_until_built("Mended")
    assert watch.read_errors().count("malformed-file") == 1


def test_a_changed_configuration_starts_a_build(start_watch):
    files = {"plant.uml": format_model("Old"), "sysmlc.toml": b'output = "out"\n'}
    watch = start_watch(files, "plant.uml")
    (watch.folder / "sysmlc.toml").write_bytes(b'output = "first"\n')
    watch.wait_until(lambda: (watch.folder / "first" / "graph.json").exists())
    write_in_pieces(watch.folder / "sysmlc.toml", b'output = "second"\n', 0.35)
    watch.wait_until(lambda: (watch.folder / "second" / "graph.json").exists())
    assert watch.read_errors() == ""
