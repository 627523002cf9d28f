"""One compilation: inputs, order of diagnostics, withheld outputs, internal errors."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from driver_helpers import (
    FAULTY,
    PLANT,
    UNNAMED_PORT,
    CheckPorts,
    OutlineBackend,
    compile_files,
    list_codes,
    list_inputs,
    list_published,
)

from sysmlc.config import Config
from sysmlc.diagnostics import Severity
from sysmlc.diagnostics.sink import Suppression
from sysmlc.driver import Observer, Request, compile_model, faults, inputs
from sysmlc.sources import files
from sysmlc.support.output import Output


@pytest.fixture
def plant(tmp_path):
    file = tmp_path / "plant.ir"
    file.write_text(PLANT)
    return file


@pytest.fixture
def faulty(tmp_path):
    file = tmp_path / "faulty.ir"
    file.write_text(FAULTY)
    return file


def test_a_model_becomes_a_graph_and_artefacts(plant):
    compilation = compile_files(plant)
    assert [element.name for element in compilation.graph] == [
        "Plant",
        "Gate",
        "in",
        "Robot",
        "out",
    ]
    assert list_published(compilation) == ["outlines/Gate.txt", "outlines/Robot.txt"]
    assert [(file.path, file.language) for file in compilation.inputs] == [("plant.ir", "ir")]
    assert compilation.coverage.as_json()["total"]["mapped"] == 5


def test_warnings_are_exit_code_0_unless_strict(plant):
    compilation = compile_files(plant)
    assert list_codes(compilation) == ["SM941", "SM941"]
    assert compilation.exit_code() == 0
    assert compilation.exit_code(strict=True) == 1


def test_an_error_withholds_the_outputs_of_its_element_only(faulty):
    compilation = compile_files(faulty)
    assert compilation.exit_code() == 1
    assert list_published(compilation) == ["outlines/Robot.txt"]
    assert {
        path: [error.rule for error in errors] for path, errors in compilation.withheld.items()
    } == {"outlines/Gate.txt": [UNNAMED_PORT]}


def test_an_error_about_an_owner_withholds_the_outputs_of_its_members(faulty):
    @dataclass(frozen=True)
    class WritesPortOnly(OutlineBackend):
        def emit(self, graph, output, sink, options):
            output.add("port.txt", "", ["robot.out"], self.name)

    @dataclass(frozen=True)
    class ReportsRobot(CheckPorts):
        def run(self, graph, sink):
            sink.report(UNNAMED_PORT, graph.subject(graph["robot"]), owner="Robot")

    compilation = compile_files(faulty, passes=(ReportsRobot(),), backends=(WritesPortOnly(),))
    assert list_published(compilation) == []


def test_an_error_withholds_the_outputs_of_elements_derived_from_its_element(faulty):
    @dataclass(frozen=True)
    class SetsOrigin(CheckPorts):
        def run(self, graph, sink):
            super().run(graph, sink)
            graph.set(graph["robot.out"], origin="gate.in")

    assert list_published(compile_files(faulty, passes=(SetsOrigin(),))) == []


def test_the_configured_severity_decides_the_exit_code(faulty):
    config = Config(rules={"test-unnamed-port": Severity.WARNING})
    compilation = compile_files(faulty, config=config)
    assert compilation.exit_code() == 0
    assert not compilation.withheld


def test_a_suppressed_diagnostic_is_omitted_and_an_unused_suppression_is_reported(faulty):
    suppressions = (
        Suppression("test-unnamed-port", "old gate", "Plant::Gate::*"),
        Suppression("SM941", "no longer there", "Plant::Gone::*"),
    )
    compilation = compile_files(faulty, config=Config(suppress=suppressions))
    assert list_codes(compilation) == ["SM902", "SM941"]
    assert compilation.diagnostics[0].message == (
        "the suppression of 'SM941' for 'Plant::Gone::*' matches no finding"
    )


def test_a_recipe_level_for_an_unknown_element_is_reported(plant):
    config = Config(passes={"recipe": {"levels": {"Plant::Robbot": "machine", "gate": "machine"}}})
    compilation = compile_files(plant, config=config)
    (diagnostic,) = [
        reported for reported in compilation.diagnostics if reported.rule.code == "SM903"
    ]
    assert diagnostic.message == "[recipe.levels] names 'Plant::Robbot', which is not in the model"
    assert diagnostic.help == "did you mean 'Plant::Robot'?"


def test_a_missing_file_is_exit_code_2(tmp_path, plant):
    compilation = compile_files(tmp_path / "plant.irr")
    assert list_codes(compilation) == ["SM170"]
    assert compilation.diagnostics[0].help == "did you mean 'plant.ir'?"
    assert compilation.exit_code() == 2


def test_a_missing_file_with_braces_in_its_name_is_reported_as_well(tmp_path):
    assert list_codes(compile_files(tmp_path / "{0}{x}.uml")) == ["SM170"]


def test_a_named_file_that_no_front_end_recognises_is_an_error(tmp_path):
    file = tmp_path / "page.xml"
    file.write_text("<html/>")
    compilation = compile_files(file)
    assert (list_codes(compilation), compilation.exit_code()) == (["SM171"], 1)


def test_an_unrecognised_file_in_a_folder_is_a_warning(tmp_path, plant):
    (tmp_path / "page.xml").write_text("<html/>")
    (tmp_path / "notes.txt").write_text("not a model")
    compilation = compile_files(tmp_path)
    assert list_codes(compilation) == ["SM175", "SM941", "SM941"]
    assert compilation.exit_code() == 0
    assert list_inputs(compilation) == ["plant.ir"]


def test_a_folder_without_a_model_is_an_error(tmp_path):
    compilation = compile_files(tmp_path)
    assert (list_codes(compilation), compilation.exit_code()) == (["SM173"], 1)
    (diagnostic,) = compilation.diagnostics
    assert diagnostic.message == f"'{tmp_path.name}' contains no model"
    suffixes_on_page = set(re.findall(r"\.\w+", faults.NOTHING_TO_COMPILE.read_page().why))
    assert suffixes_on_page == set(inputs.SUFFIXES)


def test_outputs_of_an_earlier_run_are_no_inputs(tmp_path, plant):
    out = tmp_path / "out"
    out.mkdir()
    (out / "manifest.json").write_text('{\n "format": "sysmlc-manifest/2"}')
    (out / "graph.ir").write_text(PLANT)
    assert list_inputs(compile_files(tmp_path)) == ["plant.ir"]


def test_a_file_without_read_permission_is_exit_code_2(plant, monkeypatch):
    def refuse_access(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(files, "_open_nonblocking", refuse_access)
    compilation = compile_files(plant)
    assert (list_codes(compilation), compilation.exit_code()) == (["SM179"], 2)


def test_a_file_that_changes_while_it_is_read_is_not_compiled(plant, monkeypatch):
    stamps = [(0, 1), (0, 2), (0, 3), (0, 4)]
    monkeypatch.setattr(files, "_PAUSE", 0)
    with monkeypatch.context() as writing:
        writing.setattr(files, "_make_state", lambda _: stamps.pop(0))
        compilation = compile_files(plant)
    assert (list_codes(compilation), compilation.exit_code(), compilation.is_complete) == (
        ["SM127"],
        2,
        False,
    )
    assert compile_files(plant).exit_code() == 0


def test_a_damaged_file_is_reported_with_the_line(tmp_path):
    file = tmp_path / "plant.ir"
    file.write_text('Package pkg "Plant"\n  Klass gate "Gate"\n')
    compilation = compile_files(file)
    assert (list_codes(compilation), compilation.exit_code(), compilation.is_complete) == (
        ["SM176"],
        1,
        False,
    )
    assert compilation.diagnostics[0].subject.place.line == 2


@pytest.mark.parametrize(
    ("module", "message"),
    [
        ("sysmlc.passes.ports", "internal error of sysmlc in pass ports: TypeError: boom"),
        (
            "acme.ports",
            "pass ports failed, so that nothing is written: TypeError: boom (acme.ports)",
        ),
    ],
)
def test_an_exception_in_a_pass_is_a_diagnostic_and_stops_the_outputs(plant, module, message):
    @dataclass(frozen=True)
    class RaisesError(CheckPorts):
        def run(self, graph, sink):
            raise TypeError("boom")

    RaisesError.__module__ = module
    compilation = compile_files(plant, passes=(RaisesError(),), backends=(OutlineBackend(),))
    assert (compilation.exit_code(), compilation.artefacts) == (2, ())
    (diagnostic,) = compilation.diagnostics
    assert diagnostic.rule.code == ("SM900" if module.startswith("sysmlc") else "SM916")
    assert diagnostic.message == message


@pytest.mark.parametrize(
    ("module", "problem", "exit_code", "message"),
    [
        (
            "sysmlc.backends.broken",
            RecursionError(),
            2,
            "internal error of sysmlc in back end broken: RecursionError: ",
        ),
        ("acme", RecursionError(), 1, "back end broken failed: RecursionError:  (acme)"),
        (
            "sysmlc.backends.broken",
            ModuleNotFoundError("No module named 'jinja2'", name="jinja2.sandbox"),
            1,
            "back end broken cannot load the package 'jinja2', so that its files are missing: "
            "ModuleNotFoundError: No module named 'jinja2'",
        ),
    ],
)
def test_an_exception_in_a_back_end_omits_only_its_outputs(
    plant, module, problem, exit_code, message
):
    """Neither does a missing package stop the other back ends (SM918)."""

    @dataclass(frozen=True)
    class RaisesError(OutlineBackend):
        name: str = "broken"

        def emit(self, graph, output, sink, options):
            output.add("half.txt", "half")
            raise problem

    RaisesError.__module__ = module
    compilation = compile_files(plant, passes=(), backends=(RaisesError(), OutlineBackend()))
    assert list_published(compilation) == ["outlines/Gate.txt", "outlines/Robot.txt"]
    assert [diagnostic.message for diagnostic in compilation.diagnostics] == [message]
    assert (compilation.exit_code(), compilation.is_complete) == (exit_code, False)


def test_verify_each_names_the_pass_that_broke_the_graph(plant):
    @dataclass(frozen=True)
    class BreakGraph(CheckPorts):
        def run(self, graph, sink):
            graph["gate"].owner = "robot"

    assert list_codes(compile_files(plant, passes=(BreakGraph(),))) == []
    compilation = compile_files(plant, passes=(BreakGraph(),), verify_each=True)
    assert set(list_codes(compilation)) == {"SM901"}
    assert "after ports" in compilation.diagnostics[0].message


def test_an_observer_sees_each_step_and_the_graph_after_each_pass(plant):
    @dataclass
    class RecordingObserver(Observer):
        steps: list = field(default_factory=list)
        graphs: list = field(default_factory=list)

        def step(self, step_name, number, total):
            self.steps.append(f"{number}/{total} {step_name}")

        def after(self, step_name, graph):
            self.graphs.append((step_name, len(graph)))

    class OutlineOfRecipes(OutlineBackend):
        needs = ("recipe",)

    observer = RecordingObserver()
    request = Request((plant,), passes=(CheckPorts(),), backends=(OutlineOfRecipes(),))
    compile_model(request, observer, analyses=())
    assert observer.steps == [
        "0/5 read 1 ir",
        "1/5 pass ports",
        "2/5 analysis activities",
        "3/5 analysis recipe",
        "4/5 emit outline",
    ]
    assert observer.graphs == [("read", 5), ("ports", 5), ("activities", 5), ("recipe", 5)]


# -- the same input gives the same bytes ---------------------------------------------------------


def write_two_files(folder):
    (folder / "a.ir").write_text('Package a "A"\n  Class a.c "C"\n')
    (folder / "b.ir").write_text('Package b "B"\n  Class b.c "D"\n')
    return folder / "a.ir", folder / "b.ir"


def test_the_order_of_the_inputs_does_not_matter(tmp_path):
    first, second = write_two_files(tmp_path)
    orders = [(first, second), (second, first), (tmp_path,), (second, tmp_path)]
    results = {
        (compilation.artefacts, compilation.inputs, compilation.diagnostics)
        for compilation in (compile_files(*files) for files in orders)
    }
    assert len(results) == 1


def test_the_hash_seed_does_not_matter(tmp_path):
    script = (
        "import sys; from pathlib import Path; from driver_helpers import compile_files\n"
        "from sysmlc.driver import format_manifest, format_trace, summarize\n"
        "compilation = compile_files(*map(Path, sys.argv[1:]))\n"
        "print(format_manifest(summarize(compilation), {}))\n"
        "print(format_trace(compilation), compilation.diagnostics)"
    )
    (tmp_path / "faulty.ir").write_text(FAULTY)
    outputs = set()
    for seed in ("0", "1", "2"):
        env = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(__file__).parent)}
        run = [sys.executable, "-c", script, str(tmp_path / "faulty.ir")]
        outputs.add(subprocess.run(run, env=env, capture_output=True, check=True).stdout)
    assert len(outputs) == 1
    assert b"outlines/Gate.txt" in outputs.pop()


def test_names_are_relative_to_the_configuration_or_to_the_nearest_common_folder(tmp_path):
    (tmp_path / "sub").mkdir()
    first, second = write_two_files(tmp_path)
    moved = second.rename(tmp_path / "sub" / "b.ir")
    assert list_inputs(compile_files(first, moved)) == ["a.ir", "sub/b.ir"]
    assert list_inputs(compile_files(moved)) == ["b.ir"]
    config = Config(folder=tmp_path)
    assert list_inputs(compile_files(moved, config=config)) == ["sub/b.ir"]


def test_an_output_outside_of_the_folder_is_an_internal_error(plant):
    @dataclass(frozen=True)
    class WritesOutsideFolder(OutlineBackend):
        def emit(self, graph, output, sink, options):
            output.add("../passwd", "")

    WritesOutsideFolder.__module__ = "sysmlc.backends.outside"
    compilation = compile_files(plant, passes=(), backends=(WritesOutsideFolder(),))
    assert (list_codes(compilation), compilation.artefacts) == (["SM900"], ())
    assert Output().artefacts() == []
