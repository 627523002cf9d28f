"""Pipes, sockets and devices in the folders of a repository are never opened.

Folder searches skip them with a warning. Opening a pipe would wake the program that writes to it.
"""

import os
import socket
import threading
import time

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")

WARNING = "is a pipe, a socket or a device"
SYSML = "package  P { part def Gate; }\n"
XMI = """\
<?xml version="1.0" encoding="UTF-8"?>
<uml:Model xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML" xmi:id="m" name="Plant">
  <packagedElement xmi:type="uml:Class" xmi:id="c" name="Gate">
    <generalization xmi:id="g"><general xmi:type="uml:Class" href="types.uml#x"/></generalization>
  </packagedElement>
</uml:Model>
"""
AML = """\
<CAEXFile FileName="plant.aml" SchemaVersion="2.15">
  <ExternalReference Path="types.aml" Alias="types"/><InstanceHierarchy Name="Plant"/>
</CAEXFile>
"""


@pytest.fixture(autouse=True)
def _plant(project):
    (project.folder / "plant.ir").unlink()


def make_pipe(project, name):
    """Create a pipe with a writer that waits for a reader; return whether one has come."""
    path = project.folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    os.mkfifo(path)
    opened = threading.Event()

    def wait_for_reader():
        with open(path, "wb"):  # noqa: PTH123 - waits until the pipe is opened for reading
            opened.set()

    thread = threading.Thread(target=wait_for_reader, daemon=True)
    thread.start()
    time.sleep(0.05)

    def was_opened() -> bool:
        seen = opened.is_set()
        os.close(os.open(path, os.O_RDONLY | os.O_NONBLOCK))  # lets the writer end
        thread.join(5)
        return seen

    return was_opened


@pytest.mark.parametrize("command", ["check", "build", "format"])
def test_a_pipe_in_a_folder_is_skipped_with_a_warning(command, project):
    project.write("models/plant.sysml", SYSML)
    was_opened = make_pipe(project, "models/pipe.sysml")
    result = project.run(command, "models")
    assert not was_opened()
    assert (result.exit_code, WARNING in result.stderr) == (0, True)
    assert "models/pipe.sysml" in result.stderr
    assert ("SM908 special-file" in result.stderr) == (command != "format")


@pytest.mark.parametrize("command", ["check", "build", "format"])
def test_a_socket_in_a_folder_is_skipped_with_a_warning(command, project):
    project.write("models/plant.sysml", SYSML)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("models/s.sysml")
        result = project.run(command, "models")
    assert (result.exit_code, WARNING in result.stderr) == (0, True)


@pytest.mark.parametrize("pattern", ["models/*", "**/*.sysml", "models/p???.sysml", "models"])
@pytest.mark.parametrize("command", ["check", "build"])
def test_a_pipe_that_the_configuration_names_is_skipped_with_a_warning(command, pattern, project):
    project.write("models/plant.sysml", SYSML)
    was_opened = make_pipe(project, "models/pipe.sysml")
    files = f'["{pattern}", "models/plant.sysml"]'
    project.write("sysmlc.toml", f'[[model]]\nname = "plant"\nfiles = {files}\n')
    result = project.run(command)
    assert not was_opened()
    assert (result.exit_code, WARNING in result.stderr) == (0, True)


def test_a_pipe_on_the_command_line_is_an_error(project):
    was_opened = make_pipe(project, "pipe.sysml")
    for command in ("check", "build", "format"):
        result = project.run(command, "pipe.sysml")
        assert (result.exit_code, "is not a regular file" in result.stderr) == (2, True)
    assert not was_opened()


@pytest.mark.parametrize(
    ("model", "text", "pipe"),
    [
        ("plant.uml", XMI, "types.uml"),
        ("plant.aml", AML, "types.aml"),
        ("plant.sysml", SYSML, "plant.overlay.yaml"),
        ("plant.sysml", SYSML, "manifest.json"),
        ("plant.sysml", SYSML, "sub/manifest.json"),
        ("plant.sysml", SYSML, "sysmlc.toml"),
        ("plant.sysml", SYSML, "pyproject.toml"),
    ],
)
def test_a_pipe_to_which_a_model_refers_is_not_opened(model, text, pipe, project):
    project.write(model, text)
    was_opened = make_pipe(project, pipe)
    result = project.run("check", ".")
    assert not was_opened()
    assert result.exit_code in (0, 1, 2)
    assert "fault of sysmlc" not in result.stderr


def test_a_pipe_among_the_schemas_is_refused(project):
    project.write("plant.uml", XMI)
    was_opened = make_pipe(project, "schemas/a.xsd")
    result = project.run("check", "plant.uml", "--schema", "schemas")
    assert not was_opened()
    assert (result.exit_code, "is not a regular file" in result.stderr) == (2, True)
