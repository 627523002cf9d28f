"""Templates of a repository cannot run code, read files or exhaust time and memory."""

import os
from pathlib import Path

import pytest

from long_runs import quick_first
from machine_samples import arrow, machine
from refinement import run_all
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import BACKEND as CONTRACTS
from sysmlc.backends.plantuml import BACKEND as PLANTUML
from sysmlc.backends.reqtable import BACKEND as REQTABLE
from sysmlc.backends.templates import files, process
from sysmlc.diagnostics import Sink
from sysmlc.ir import parse_text
from sysmlc.support.output import Output

PLANT = 'Package p "Plant"\n  Class gate "Gate" role="block"\n    Port gate.in "in"\n'
SHELL = "{{ cycler.__init__.__globals__.os.popen('touch pwned').read() }}"
CONFIGURATIONS = {
    "sysmlc.toml": 'templates = "t"\n',
    "pyproject.toml": '[tool.sysmlc]\ntemplates = "t"\n',
}


@pytest.fixture
def repository(project):
    """A project with a block and an empty folder ``t`` for templates."""
    project.write("plant.ir", PLANT)
    (project.folder / "t" / "plantuml").mkdir(parents=True)
    return project


def draw(text: str | None, folder: Path) -> tuple[list[str], list[str]]:
    """Return texts and messages of the block definition diagram with its template replaced."""
    if text is not None:
        (folder / "bdd.puml.j2").write_text(text)
    output, sink = Output(), Sink()
    PLANTUML.emit(parse_text(PLANT), output, sink, EmitOptions(folder))
    texts = [
        artefact.text for artefact in output.artefacts() if artefact.path.endswith(".bdd.puml")
    ]
    return texts, [diagnostic.message for diagnostic in sink]


@pytest.mark.parametrize("configuration", CONFIGURATIONS)
def test_templates_of_a_repository_run_no_shell(repository, configuration):
    Path(configuration).write_text(CONFIGURATIONS[configuration])
    Path("t/plantuml/bdd.puml.j2").write_text(SHELL)
    result = repository.run("build", "plant.ir", "--emit", "plantuml")
    assert result.exit_code == 1
    assert "plantuml/bdd.puml.j2:1: access to attribute '__init__'" in result.stderr
    assert not Path("pwned").exists()


@pytest.mark.parametrize("configuration", CONFIGURATIONS)
def test_check_uses_the_shipped_templates_only(repository, configuration):
    Path(configuration).write_text(CONFIGURATIONS[configuration])
    Path("t/plantuml/bdd.puml.j2").write_text("{{ 1 / 0 }}")
    assert "SM700" in repository.run("build", "plant.ir").stderr
    result = repository.run("check", "plant.ir")
    assert (result.exit_code, "SM700" in result.stderr) == (0, False)
    assert repository.run("check", "plant.ir", "--templates", "t").exit_code == 2


SANDBOX_ESCAPES = [
    "{{ ''.__class__.__mro__[1].__subclasses__() }}",
    "{{ ''['__class__'] }}",
    "{{ ''|attr('__class__') }}",
    "{{ [''] | map(attribute='__class__') | first }}",
    "{{ '{0.__class__}'.format(1) }}",
    "{{ '{x.__class__}'.format_map({'x': 1}) }}",
    "{{ ('{0.__class__}' | attr('format'))(1) }}",
    "{{ self._TemplateReference__context }}",
    "{{ self.__init__.__globals__ }}",
    "{{ joiner.__init__.__globals__ }}",
    "{{ lipsum.__globals__ }}",
    "{{ namespace.__init__.__globals__ }}",
    "{{ range.__init__.__globals__ }}",
    "{% macro m() %}{% endmacro %}{{ m._func.__globals__ }}",
    "{{ view.__class__ }}",
    "{{ diagram.trace() }}",
    "{{ view.lines.append(1) }}",
    "{{ {}.update(a=1) }}",
    "{% for a in [1] %}{{ loop._iterator.gi_frame }}{% endfor %}",
    "{{ (view.lines | map('upper')).gi_frame }}",
    "{{ undefined_name.__init__ }}",
    "{% extends '/etc/hostname' %}",
    "{% import '../secret.j2' as secret %}{{ secret.x }}",
]


@pytest.mark.parametrize("text", SANDBOX_ESCAPES)
def test_known_escapes_from_the_sandbox_are_refused(tmp_path, text):
    texts, messages = draw(text, tmp_path)
    assert texts == []
    assert len(messages) == 1
    assert "bdd.puml.j2:1: " in messages[0]


@pytest.mark.parametrize("name", ["../secret.j2", "/etc/passwd", "sub/../../secret.j2"])
def test_a_template_cannot_include_files_outside_of_its_folder(tmp_path, name):
    (tmp_path / "secret.j2").write_text("secret")
    folder = tmp_path / "t"
    folder.mkdir()
    texts, messages = draw(f"{{% include '{name}' %}}", folder)
    assert (texts, len(messages)) == ([], 1)
    assert f"bdd.puml.j2:1: there is no template '{name}'" in messages[0]


EXHAUSTING_TEMPLATES = {
    "{% for i in range(99999) %}{% for j in range(99999) %}{% endfor %}{% endfor %}": "takes more",
    "{% for i in range(9**9) %}{% endfor %}": "Range too big",
    "{{ (9**9) ** (9**9) }}": "takes more",
    "{{ 'a' * 10**11 }}": "memory",
    "{{ 'a' | center(10**11) }}": "memory",
    "{{ '%99999999999d' % 1 }}": "memory",
    "{{ '{:99999999999}'.format(1) }}": "memory",
    "{% set a = 'a' * 10**5 %}{{ (a | replace('a', a)) | length }}": "memory",
    "{% set a = 'a' * 10**5 %}{{ ([a] * 10**5) | join | length }}": "memory",
    "{% set ns = namespace(a=[1, 1]) %}{% for i in range(99) %}{% set ns.a = [ns.a, ns.a] %}"
    "{% endfor %}{{ ns.a }}": "",
    "{% for i in range(99999) %}{{ 'a' * 10**6 }}{% endfor %}": "writes more than 10,000,000",
    "{% macro m() %}{{ m() }}{{ m() }}{% endmacro %}{{ m() }}": "",
    "{% include 'bdd.puml.j2' %}": "",
}


@pytest.mark.parametrize("text", quick_first(EXHAUSTING_TEMPLATES, 6))
def test_a_template_that_exceeds_a_limit_is_a_diagnostic(tmp_path, text, monkeypatch):
    monkeypatch.setattr(process, "MAX_SECONDS", 1)
    texts, messages = draw(text, tmp_path)
    assert (texts, len(messages)) == ([], 1)
    assert EXHAUSTING_TEMPLATES[text] in messages[0]


def test_a_back_end_waits_for_the_time_limit_only_once(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "MAX_SECONDS", 1)
    processes = []
    popen = process.Popen
    monkeypatch.setattr(process, "Popen", lambda *a, **k: processes.append(a) or popen(*a, **k))
    for name in ("bdd", "ibd", "act", "stm"):
        (tmp_path / f"{name}.puml.j2").write_text("{{ (9**9) ** (9**9) }}")
    parts = '    Property gate.p "p" subkind="part"\n      -> typed-by gate\n'
    output, sink = Output(), Sink()
    PLANTUML.emit(parse_text(PLANT + parts), output, sink, EmitOptions(tmp_path))
    assert len(processes) == 1
    assert {
        diagnostic.message.partition("used: ")[2]
        for diagnostic in sink
        if diagnostic.rule.code == "SM700"
    } == {"bdd.puml.j2: takes more than 1 s"}


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    (tmp_path / "secret").write_text("secret")
    folder = tmp_path / "t"
    folder.mkdir()
    (folder / "bdd.puml.j2").symlink_to(tmp_path / "secret")
    texts, messages = draw(None, folder)
    assert (texts, len(messages)) == ([], 1)
    assert messages[0].endswith("used: bdd.puml.j2: is a link out of the templates folder")


def test_a_linked_folder_of_a_back_end_is_refused(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "bdd.puml.j2").write_text("secret")
    (tmp_path / "t").mkdir()
    (tmp_path / "t" / "plantuml").symlink_to(tmp_path / "elsewhere")
    texts, messages = draw(None, tmp_path / "t")
    assert (texts, len(messages)) == ([], 1)
    assert "is a link out of the templates folder" in messages[0]


def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    os.mkfifo(tmp_path / "bdd.puml.j2")
    texts, messages = draw(None, tmp_path)
    assert (texts, len(messages)) == ([], 1)
    assert "bdd.puml.j2: is not a regular file" in messages[0]


def test_a_large_template_is_refused(tmp_path):
    texts, messages = draw("a" * (files.MAX_BYTES + 1), tmp_path)
    assert (texts, len(messages)) == ([], 1)
    assert "larger than" in messages[0]


def test_a_template_that_is_not_text_is_refused(tmp_path):
    (tmp_path / "bdd.puml.j2").write_bytes(b"@startuml \xff")
    texts, messages = draw(None, tmp_path)
    assert (texts, len(messages)) == ([], 1)
    assert "bdd.puml.j2: is not UTF-8: invalid byte at offset 10" in messages[0]


@pytest.mark.parametrize("location", ["..", "../outside", "link"])
def test_a_configuration_cannot_name_a_folder_outside_of_the_project(repository, location):
    Path("link").symlink_to(repository.outside)
    Path("sysmlc.toml").write_text(f'templates = "{location}"\n')
    result = repository.run("build", "plant.ir")
    assert result.exit_code == 2
    assert f"'templates': '{location}' leads out of the project root" in result.stderr
    Path("sysmlc.toml").unlink()
    result = repository.run("build", "plant.ir", "--templates", str(repository.outside))
    assert result.exit_code == 0


def test_modules_in_the_working_folder_are_not_imported(repository):
    """With ``python -m`` the rendering process would import ``jinja2.py`` of the repository."""
    Path("jinja2.py").write_text("open('pwned', 'w')\n")
    Path("json.py").write_text("open('pwned', 'w')\n")
    Path("t/plantuml/bdd.puml.j2").write_text("drawn")
    assert repository.run("build", "plant.ir", "--templates", "t").exit_code == 0
    assert Path("out/diagrams/Plant.bdd.puml").read_text() == "drawn"
    assert not Path("pwned").exists()


@pytest.mark.parametrize(
    ("backend", "name"), [(CONTRACTS, "contract.md.j2"), (REQTABLE, "requirements.md.j2")]
)
def test_other_back_ends_render_in_the_sandbox_too(tmp_path, backend, name):
    (tmp_path / name).write_text(SHELL)
    requirement = '  Class jam "No jam" role="requirement" req_id="R1"\n'
    graph, output, sink = (
        parse_text(machine(arrow("a", "b", "start")) + requirement),
        Output(),
        Sink(),
    )
    run_all(graph, Sink())
    backend.emit(graph, output, sink, EmitOptions(tmp_path))
    (message,) = [diagnostic.message for diagnostic in sink if diagnostic.is_error]
    assert f"{name}:1: access to attribute '__init__'" in message
