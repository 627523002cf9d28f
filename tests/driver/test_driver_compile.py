"""One compile: inputs, findings in order, withheld outputs, faults that are no tracebacks."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from driver_fakes import FAULTY, PLANT, UNNAMED_PORT, Outlines, Ports, compiled

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


def codes(compilation):
    return [diagnostic.rule.code for diagnostic in compilation.diagnostics]


def paths(compilation):
    return [artefact.path for artefact in compilation.list_published()]


def test_a_model_becomes_a_graph_and_artefacts(plant):
    made = compiled(plant)
    assert [element.name for element in made.graph] == ["Plant", "Gate", "in", "Robot", "out"]
    assert paths(made) == ["outlines/Gate.txt", "outlines/Robot.txt"]
    assert [(file.path, file.language) for file in made.inputs] == [("plant.ir", "ir")]
    assert made.coverage.as_json()["total"]["mapped"] == 5


def test_warnings_leave_the_exit_code_zero_unless_strict(plant):
    made = compiled(plant)
    assert codes(made) == ["SM941", "SM941"]
    assert made.exit_code() == 0
    assert made.exit_code(strict=True) == 1


def test_an_error_withholds_what_comes_from_its_element_and_nothing_else(faulty):
    made = compiled(faulty)
    assert made.exit_code() == 1
    assert paths(made) == ["outlines/Robot.txt"]
    assert {p: [e.rule for e in errors] for p, errors in made.withheld.items()} == {
        "outlines/Gate.txt": [UNNAMED_PORT]
    }


def test_an_error_about_an_owner_withholds_what_comes_from_below_it(faulty):
    @dataclass(frozen=True)
    class BelowOnly(Outlines):
        def emit(self, graph, output, sink, options):
            output.add("port.txt", "", ["robot.out"], self.name)

    @dataclass(frozen=True)
    class AboutRobot(Ports):
        def run(self, graph, sink):
            sink.report(UNNAMED_PORT, graph.subject(graph["robot"]), owner="Robot")

    assert paths(compiled(faulty, passes=(AboutRobot(),), backends=(BelowOnly(),))) == []


def test_what_a_pass_made_is_withheld_with_its_origin(faulty):
    @dataclass(frozen=True)
    class Derives(Ports):
        def run(self, graph, sink):
            super().run(graph, sink)
            graph.set(graph["robot.out"], origin="gate.in")

    assert paths(compiled(faulty, passes=(Derives(),))) == []


def test_a_severity_that_the_project_chose_counts(faulty):
    config = Config(rules={"test-unnamed-port": Severity.WARNING})
    made = compiled(faulty, config=config)
    assert made.exit_code() == 0
    assert not made.withheld


def test_a_suppressed_finding_is_gone_and_an_unused_suppression_is_reported(faulty):
    accepted = (
        Suppression("test-unnamed-port", "Plant::Gate::*", "old gate"),
        Suppression("SM941", "Plant::Gone::*", "no longer there"),
    )
    made = compiled(faulty, config=Config(suppress=accepted))
    assert codes(made) == ["SM902", "SM941"]
    assert made.diagnostics[0].message == (
        "the suppression of 'SM941' for 'Plant::Gone::*' matches no finding"
    )


def test_a_recipe_level_for_an_element_that_is_not_there_is_reported(plant):
    config = Config(passes={"recipe": {"levels": {"Plant::Robbot": "machine", "gate": "machine"}}})
    found = [f for f in compiled(plant, config=config).diagnostics if f.rule.code == "SM903"]
    assert [(f.message, f.help) for f in found] == [
        (
            "[recipe.levels] names 'Plant::Robbot', which is not in the model",
            "did you mean 'Plant::Robot'?",
        )
    ]


def test_a_missing_file_stops_us(tmp_path, plant):
    made = compiled(tmp_path / "plant.irr")
    assert codes(made) == ["SM170"]
    assert made.diagnostics[0].help == "did you mean 'plant.ir'?"
    assert made.exit_code() == 2


def test_a_missing_file_with_braces_in_its_name_is_reported_as_well(tmp_path):
    assert codes(compiled(tmp_path / "{0}{x}.uml")) == ["SM170"]


def test_a_named_file_that_no_front_end_recognises_is_an_error(tmp_path):
    file = tmp_path / "page.xml"
    file.write_text("<html/>")
    made = compiled(file)
    assert (codes(made), made.exit_code()) == (["SM171"], 1)


def test_in_a_folder_it_is_a_warning_and_other_files_do_not_matter(tmp_path, plant):
    (tmp_path / "page.xml").write_text("<html/>")
    (tmp_path / "notes.txt").write_text("not a model")
    made = compiled(tmp_path)
    assert codes(made) == ["SM175", "SM941", "SM941"]
    assert made.exit_code() == 0
    assert [file.path for file in made.inputs] == ["plant.ir"]


def test_a_folder_without_a_model_is_an_error(tmp_path):
    made = compiled(tmp_path)
    assert (codes(made), made.exit_code()) == (["SM173"], 1)
    (found,) = made.diagnostics
    assert found.message == f"'{tmp_path.name}' contains no model"
    named = set(re.findall(r"\.\w+", faults.NOTHING_TO_COMPILE.read_page().why))
    assert named == set(inputs.SUFFIXES)


def test_our_own_outputs_in_a_folder_are_no_inputs(tmp_path, plant):
    out = tmp_path / "out"
    out.mkdir()
    (out / "manifest.json").write_text('{\n "format": "sysmlc-manifest/2"}')
    (out / "graph.ir").write_text(PLANT)
    assert [file.path for file in compiled(tmp_path).inputs] == ["plant.ir"]


def test_a_file_that_may_not_be_opened_stops_us(plant, monkeypatch):
    def refuses(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(files, "_open_nonblocking", refuses)
    made = compiled(plant)
    assert (codes(made), made.exit_code()) == (["SM179"], 2)


def test_a_file_that_is_being_saved_is_not_compiled_and_compiled_when_it_is_whole(
    plant, monkeypatch
):
    stamps = [(0, 1), (0, 2), (0, 3), (0, 4)]
    monkeypatch.setattr(files, "_PAUSE", 0)
    with monkeypatch.context() as writing:
        writing.setattr(files, "_make_state", lambda _: stamps.pop(0))
        made = compiled(plant)
    assert (codes(made), made.exit_code(), made.is_complete) == (["SM127"], 2, False)
    assert compiled(plant).exit_code() == 0


def test_a_damaged_file_names_the_line(tmp_path):
    file = tmp_path / "plant.ir"
    file.write_text('Package pkg "Plant"\n  Klass gate "Gate"\n')
    made = compiled(file)
    assert (codes(made), made.exit_code(), made.is_complete) == (["SM176"], 1, False)
    assert made.diagnostics[0].subject.place.line == 2


def test_a_fault_in_a_pass_is_a_finding_and_stops_the_outputs(plant):
    @dataclass(frozen=True)
    class Broken(Ports):
        def run(self, graph, sink):
            raise TypeError("no such thing")

    made = compiled(plant, passes=(Broken(),))
    assert (codes(made), made.exit_code(), made.artefacts) == (["SM900"], 2, ())
    assert made.diagnostics[0].message == (
        "internal error of sysmlc in pass ports: TypeError: no such thing"
    )


def test_a_fault_in_one_back_end_leaves_the_outputs_of_the_others(plant):
    @dataclass(frozen=True)
    class Broken(Outlines):
        name: str = "broken"

        def emit(self, graph, output, sink, options):
            output.add("half.txt", "half")
            raise RecursionError

    made = compiled(plant, passes=(), backends=(Broken(), Outlines()))
    assert paths(made) == ["outlines/Gate.txt", "outlines/Robot.txt"]
    assert (codes(made), made.exit_code()) == (["SM900"], 2)


def test_verify_each_names_the_pass_that_broke_the_graph(plant):
    @dataclass(frozen=True)
    class Breaks(Ports):
        def run(self, graph, sink):
            graph["gate"].owner = "robot"

    assert codes(compiled(plant, passes=(Breaks(),))) == []
    made = compiled(plant, passes=(Breaks(),), verify_each=True)
    assert set(codes(made)) == {"SM901"}
    assert "after ports" in made.diagnostics[0].message


def test_an_observer_sees_each_step_and_the_graph_after_each_pass(plant):
    @dataclass
    class Notes(Observer):
        steps: list = field(default_factory=list)
        graphs: list = field(default_factory=list)

        def step(self, what, number, total):
            self.steps.append(f"{number}/{total} {what}")

        def after(self, what, graph):
            self.graphs.append((what, len(graph)))

    notes = Notes()
    compile_model(Request((plant,), passes=(Ports(),), backends=(Outlines(),)), notes)
    assert notes.steps == ["0/3 read 1 ir", "1/3 pass ports", "2/3 emit outline"]
    assert notes.graphs == [("read", 5), ("ports", 5)]


# -- the same input gives the same bytes ---------------------------------------------------------


def two_files(folder):
    (folder / "a.ir").write_text('Package a "A"\n  Class a.c "C"\n')
    (folder / "b.ir").write_text('Package b "B"\n  Class b.c "D"\n')
    return folder / "a.ir", folder / "b.ir"


def test_the_order_of_the_inputs_does_not_matter(tmp_path):
    one, other = two_files(tmp_path)
    results = [
        compiled(*files) for files in [(one, other), (other, one), (tmp_path,), (other, tmp_path)]
    ]
    assert len({(made.artefacts, made.inputs, made.diagnostics) for made in results}) == 1


def test_the_hash_seed_does_not_matter(tmp_path):
    script = (
        "import sys; from pathlib import Path; from driver_fakes import compiled\n"
        "from sysmlc.driver import format_manifest, format_trace, summarize\n"
        "made = compiled(*map(Path, sys.argv[1:]))\n"
        "print(format_manifest(summarize(made), {}), format_trace(made), made.diagnostics)"
    )
    (tmp_path / "faulty.ir").write_text(FAULTY)
    printed = set()
    for seed in ("0", "1", "2"):
        env = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(__file__).parent)}
        run = [sys.executable, "-c", script, str(tmp_path / "faulty.ir")]
        printed.add(subprocess.run(run, env=env, capture_output=True, check=True).stdout)
    assert len(printed) == 1
    assert b"outlines/Gate.txt" in printed.pop()


def test_names_are_relative_to_the_configuration_or_to_the_nearest_common_folder(tmp_path):
    (tmp_path / "sub").mkdir()
    one, other = two_files(tmp_path)
    moved = other.rename(tmp_path / "sub" / "b.ir")
    assert [file.path for file in compiled(one, moved).inputs] == ["a.ir", "sub/b.ir"]
    assert [file.path for file in compiled(moved).inputs] == ["b.ir"]
    config = Config(folder=tmp_path)
    assert [file.path for file in compiled(moved, config=config).inputs] == ["sub/b.ir"]


def test_an_output_that_leaves_the_folder_is_a_fault_of_the_back_end(plant):
    @dataclass(frozen=True)
    class Leaves(Outlines):
        def emit(self, graph, output, sink, options):
            output.add("../passwd", "")

    made = compiled(plant, passes=(), backends=(Leaves(),))
    assert (codes(made), made.artefacts) == (["SM900"], ())
    assert Output().artefacts() == []
