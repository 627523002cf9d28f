"""``sysmlc watch`` as a process of its own, beside tools that save in all the ways they do.

Pauses are what the tools do between two writes. What is waited for is always an output, with a
bound; no test asserts how long something takes.
"""

import gc
import io
import os
import signal
import subprocess
import sys
import time
import zipfile
from functools import partial

import pytest

from sysmlc.cli import session, watching
from sysmlc.cli.session import Settings
from sysmlc.cli.watching import Watch

BOUND = 60
HEAD = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<uml:Model xmi:version="20131001"'
    ' xmlns:xmi="http://www.omg.org/spec/XMI/20131001"'
    ' xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="{id}" name="M">\n'
)
ENTRY = "com.nomagic.magicdraw.uml_model.model"


def model(name, more="", id="m"):
    one = f'<packagedElement xmi:type="uml:Class" xmi:id="{id}c" name="{name}">{more}'
    return (HEAD.format(id=id) + one + "</packagedElement>\n</uml:Model>\n").encode()


def mdzip(name):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as opened:
        opened.writestr(ENTRY, model(name))
    return made.getvalue()


class Watching:
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
            # A shell starts what runs in the background deaf to SIGINT, and that is inherited.
            preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
        )

    def until(self, what):
        """Wait until something holds; fail when it does not."""
        end = time.monotonic() + BOUND
        while not what():
            assert self.process.poll() is None, self.said()
            assert time.monotonic() < end, f"{self.built()} {self.said()}"
            time.sleep(0.02)

    def until_built(self, name):
        """Wait until the outputs show a class of this name."""
        self.until(lambda: f'"{name}"' in self.graph())

    def graph(self):
        path = self.folder / "out" / "graph.json"
        return path.read_text() if path.exists() else ""

    def built(self):
        """The lines that say that something was written or kept."""
        return (self.folder / "lines.txt").read_text().splitlines()

    def said(self):
        """Findings so far."""
        return (self.folder / "errors.txt").read_text()

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(BOUND)
        self.errors.close()
        self.lines.close()


@pytest.fixture
def watch(tmp_path):
    """Starts ``sysmlc watch`` with files and waits until they are built."""
    started = []

    def start(files, *args):
        for name, data in files.items():
            (tmp_path / name).write_bytes(data)
        made = Watching(tmp_path, *args)
        started.append(made)
        made.until(lambda: made.built())
        return made

    yield start
    for made in started:
        made.end()


def in_pieces(path, data, pause, count=4):
    """Save as a tool that empties the file and writes bit by bit."""
    size = len(data) // count + 1
    with path.open("wb") as stream:
        for start in range(0, len(data), size):
            stream.write(data[start : start + size])
            stream.flush()
            time.sleep(pause)


@pytest.mark.parametrize("pause", [0.05, 0.35])
def test_a_file_that_is_written_in_pieces_is_no_error(watch, pause):
    """The longer pause is longer than the settling time: half a file is compiled, and not told."""
    watched = watch({"plant.uml": model("Old")}, "plant.uml")
    in_pieces(watched.folder / "plant.uml", model("New"), pause)
    watched.until_built("New")
    assert watched.said() == ""


def test_a_file_that_is_replaced_or_gone_for_a_moment_is_no_error(watch):
    watched = watch({"plant.uml": model("Old")}, "plant.uml")
    path = watched.folder / "plant.uml"
    path.rename(watched.folder / "plant.uml.bak")
    time.sleep(0.4)
    path.write_bytes(model("Back"))
    watched.until_built("Back")
    (watched.folder / "new.tmp").write_bytes(model("Renamed"))
    (watched.folder / "new.tmp").replace(path)
    watched.until_built("Renamed")
    assert watched.said() == ""


def test_a_text_that_is_empty_or_gone_for_a_moment_clears_no_outputs(watch):
    """An empty text is no error, and neither is a folder with one file less."""
    files = {"a.sysml": b"package A;\n", "b.sysml": b"package B;\n"}
    watched = watch(files, ".")
    path = watched.folder / "a.sysml"
    path.write_bytes(b"")
    time.sleep(0.6)
    path.write_bytes(b"package Written;\n")
    watched.until_built("Written")
    path.rename(watched.folder / "a.bak")
    time.sleep(0.6)
    path.write_bytes(b"package Replaced;\n")
    watched.until_built("Replaced")
    watched.until(lambda: len(watched.built()) > 2)
    assert len(watched.built()) == 3


def test_an_archive_that_is_saved_in_place_is_no_error(watch):
    watched = watch({"plant.mdzip": mdzip("Old")}, "plant.mdzip")
    in_pieces(watched.folder / "plant.mdzip", mdzip("New"), 0.3)
    watched.until_built("New")
    (watched.folder / "x.tmp").write_bytes(mdzip("Renamed"))
    (watched.folder / "x.tmp").replace(watched.folder / "plant.mdzip")
    watched.until_built("Renamed")
    assert watched.said() == ""


def test_layout_files_of_papyrus_start_no_run(watch):
    watched = watch({"plant.uml": model("Old")}, "plant.uml")
    for name in ("plant.notation", "plant.di", "plant.sash"):
        (watched.folder / name).write_bytes(b"<notation/>")
    time.sleep(1.5)
    (watched.folder / "plant.notation").write_bytes(b"<other/>")
    (watched.folder / "plant.uml").write_bytes(model("New"))
    (watched.folder / "plant.di").write_bytes(b"<other/>")
    watched.until_built("New")
    watched.until(lambda: len(watched.built()) > 1)
    assert len(watched.built()) == 2


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


def test_drawings_of_authors_are_waited_for_too(watch):
    """First the model is new and the drawing shows what is gone, then there is half a drawing."""
    files = {
        "plant.uml": model("Old"),
        "plant.notation": NOTATION.format("First", "mc").encode(),
        "plant.di": b"<di/>",
    }
    watched = watch(files, "plant.uml", "--diagrams", "author")
    (watched.folder / "plant.uml").write_bytes(model("New", id="m").replace(b'"mc"', b'"mn"'))
    in_pieces(watched.folder / "plant.notation", NOTATION.format("Second", "mn").encode(), 0.35)
    (watched.folder / "plant.di").write_bytes(b"<other/>")
    watched.until_built("Second")
    assert watched.said() == ""
    (watched.folder / "plant.notation").write_text(NOTATION.format("Alone", "mn"))
    watched.until_built("Alone")
    assert watched.said() == ""


def test_files_that_refer_to_one_another_are_saved_one_after_the_other(watch):
    """Between the two saves a reference leads nowhere; that is not told."""
    refers = '<generalization xmi:id="g" general="{}"/>'
    files = {
        "a.uml": model("A", refers.format("bc"), "a"),
        "b.uml": model("B", id="b"),
    }
    watched = watch(files, "a.uml", "b.uml")
    (watched.folder / "a.uml").write_bytes(model("A2", refers.format("dc"), "a"))
    time.sleep(0.5)
    (watched.folder / "b.uml").write_bytes(model("D", id="d"))
    watched.until_built("D")
    watched.until_built("A2")
    assert watched.said() == ""


def test_a_checkout_that_changes_many_files_is_built_whole(watch):
    files = {f"f{n}.sysml": f"package Old{n};".encode() for n in range(20)}
    watched = watch(files, ".")
    (watched.folder / "f3.sysml").unlink()
    for n in range(20):
        if n != 3:
            (watched.folder / f"f{n}.sysml").write_text(f"package New{n};")
            time.sleep(0.01)
    (watched.folder / "more.sysml").write_text("package More;")
    watched.until_built("More")
    watched.until_built("New19")
    assert "Old" not in watched.graph()
    assert watched.said() == ""


def test_the_last_of_many_saves_is_built(watch):
    """Saves come faster than compilations end."""
    watched = watch({"plant.uml": model("Old")}, "plant.uml")
    for number in range(30):
        (watched.folder / "plant.uml").write_bytes(model(f"Save{number}"))
        time.sleep(0.05)
    watched.until_built("Save29")
    assert watched.said() == ""


def test_a_true_error_is_told_and_the_outputs_kept_until_it_is_mended(watch):
    watched = watch({"plant.uml": model("Old")}, "plant.uml")
    kept = watched.graph()
    (watched.folder / "plant.uml").write_bytes(model("New")[:-20])
    watched.until(lambda: "malformed-file" in watched.said())
    watched.until(lambda: watched.built()[-1] == "out: not updated because the model has errors")
    assert watched.graph() == kept
    (watched.folder / "plant.uml").write_bytes(model("Mended"))
    watched.until_built("Mended")
    assert watched.said().count("malformed-file") == 1


def test_the_configuration_is_watched_too(watch):
    files = {"plant.uml": model("Old"), "sysmlc.toml": b'output = "out"\n'}
    watched = watch(files, "plant.uml")
    (watched.folder / "sysmlc.toml").write_bytes(b'output = "made"\n')
    watched.until(lambda: (watched.folder / "made" / "graph.json").exists())
    in_pieces(watched.folder / "sysmlc.toml", b'output = "again"\n', 0.35)
    watched.until(lambda: (watched.folder / "again" / "graph.json").exists())
    assert watched.said() == ""


def test_findings_that_were_told_before_are_not_waited_for(tmp_path, monkeypatch):
    """A model with known errors is compiled as soon as any other."""
    waited = []
    real = watching.wait_until_stable

    def rested(paths, seconds):
        waited.append(seconds)
        return real(paths, 0)

    monkeypatch.setattr(watching, "wait_until_stable", rested)
    path = tmp_path / "plant.uml"
    path.write_bytes(model("Old")[:-20])
    watched = Watch((path,), tmp_path / "out", Settings(has_cache=False), 0.05)
    watched.build()
    path.write_bytes(model("Others")[:-20])
    watched.build()
    assert waited == [0.05, 1.5, 0.05]


class Clock:
    """Time that passes only when somebody sleeps; at some times something is saved."""

    def __init__(self, path, saves):
        self.now = 0.0
        self._path, self._saves = path, saves

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds
        while self._saves and self._saves[0] <= self.now:
            self._path.write_bytes(self._path.read_bytes() + b"x")
            del self._saves[0]


CELL = """package Cells {{ part def Cell {{ part {0} : Robot; }} part def Robot; }}
package Lines {{ part def Line {{ part cell : {1}; }} }}
"""


def test_who_keeps_going_gets_what_no_error_concerns(tmp_path, capsys):
    path, drawn = tmp_path / "cell.sysml", tmp_path / "out" / "diagrams"
    settings = Settings(emit=("plantuml",), has_cache=False)
    watched = Watch((path,), tmp_path / "out", settings, 0, keep_going=True)
    path.write_text(CELL.format("arm", "Cells::Cell"))
    watched.build()
    assert {one.name for one in drawn.iterdir()} == {"Cells.bdd.puml", "Lines.bdd.puml"}
    path.write_text(CELL.format("gripper", "Cells::Nowhere"))
    watched.build()
    assert [one.name for one in drawn.iterdir()] == ["Cells.bdd.puml"]
    assert "gripper" in (drawn / "Cells.bdd.puml").read_text()
    assert "1 withheld because of errors" in capsys.readouterr().out


@pytest.mark.parametrize(("saves", "pauses"), [(3, 1), pytest.param(8, 0, marks=pytest.mark.long)])
def test_what_was_compiled_is_let_go(saves, pauses, tmp_path, monkeypatch):
    """Front ends freeze what they made, so that no collection looks at it later.

    In a pause it is let go, and after many saves without one.
    """
    monkeypatch.setenv("SYSMLC_CACHE", str(tmp_path / "cache"))
    path = tmp_path / "cell.sysml"
    path.write_text("package P;")
    watched = Watch((path,), tmp_path / "out", Settings(), 0)
    for number in range(saves):
        path.write_text(f"package P {{ part def Cell{number} {{ part arm : Cell{number}; }} }}")
        watched.build()
    for _ in range(pauses):
        watched.clean_up()
    gc.unfreeze()
    assert gc.collect() < 50


def test_what_is_saved_during_the_first_compilation_is_not_lost(tmp_path, monkeypatch):
    """What a folder holds is not known before it was read: nobody looked at the files then."""
    path, more = tmp_path / "a.sysml", tmp_path / "b.sysml"
    path.write_text("package A;")
    saves = {path: "package Edited;", more: "package More;"}
    real = session.compute_outcome

    def saving(*args):
        made = real(*args)
        while saves:
            path, text = saves.popitem()
            path.write_text(text)
        return made

    monkeypatch.setattr(session, "compute_outcome", saving)
    settings = Settings(emit=("graph",), has_cache=False)
    Watch((tmp_path,), tmp_path / "out", settings, 0).build()
    written = (tmp_path / "out" / "graph.json").read_text()
    assert '"Edited"' in written
    assert '"More"' in written


def test_a_file_that_came_before_the_system_told_of_saves_is_not_lost(tmp_path):
    (tmp_path / "a.sysml").write_text("package A;")
    settings = Settings(emit=("graph",), has_cache=False)
    watched = Watch((tmp_path,), tmp_path / "out", settings, 0)
    watched.build()
    (tmp_path / "b.sysml").write_text("package More;")
    watched.build_if_changed(())
    assert '"More"' in (tmp_path / "out" / "graph.json").read_text()


def spied(real, calls):
    """A compilation that is noted with its inputs."""

    def compiling(request, *rest):
        calls.append(request.inputs)
        return real(request, *rest)

    return compiling


def test_rest_begins_anew_with_each_save(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_bytes(b"")
    clock = Clock(path, [0.2, 0.4, 0.6, 2.0])
    monkeypatch.setattr(watching, "time", clock)
    seen = watching.wait_until_stable([path], 0.3)
    assert seen[path][0] == 3
    assert 0.9 <= clock.now < 1.1


def test_files_that_never_rest_are_taken_as_they_are(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_bytes(b"")
    clock = Clock(path, [n / 10 for n in range(1000)])
    monkeypatch.setattr(watching, "time", clock)
    watching.wait_until_stable([path], 0.3)
    assert 30 <= clock.now < 31


def test_rest_is_told_by_size_and_time(tmp_path):
    path, missing = tmp_path / "a", tmp_path / "b"
    path.write_bytes(b"x")
    os.utime(path, (0, 0))
    seen = watching.wait_until_stable([path, missing, tmp_path], 0)
    assert seen == {path: (1, 0), missing: None, tmp_path: (0, 0)}
    assert not watching.is_fresh({path: (1, 0)}, 1)
    assert watching.is_fresh({missing: None}, 1)
    path.write_bytes(b"xy")
    assert watching.read_stamps([path]) != {path: (1, 0)}
    assert watching.find_empty_files(seen) == {missing}
    path.write_bytes(b"")
    assert watching.find_empty_files(watching.read_stamps([path, missing, tmp_path])) == {
        path,
        missing,
    }
    path.write_bytes(b"xy")
    assert watching.is_fresh(watching.read_stamps([path]), 3600)
