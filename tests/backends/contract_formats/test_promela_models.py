"""SPIN decides the requirements in the Promela model of a behaviour, and finds faults in it."""

import re
import shutil
import subprocess

import pytest

from contract_oracle import list_models, require
from sysmlc.backends.contract_formats import NOT_EXPRESSIBLE, PROMELA
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.support.output import Output

COMPILER = shutil.which("cc") or shutil.which("gcc")
needs_spin = pytest.mark.skipif(
    shutil.which("spin") is None or COMPILER is None, reason="needs SPIN and a C compiler"
)

PRESS = """package Shop {
    private import ScalarValues::*;
    item def Go;
    part def Press {
        attribute strokes : Integer := 0;
        attribute closed : Boolean := false;
        constraint { 0 <= strokes and strokes <= 3 }
        exhibit state S {
            entry; then Idle;
            state Idle;
            transition first Idle accept Go do assign strokes := strokes + 1 then Busy;
            state Busy {
                do action work {
                    first start;
                    then action close assign closed := true;
                    then action press;
                    then action open assign closed := false;
                    then done;
                }
            }
            transition first Busy then Idle;
        }
    }
    requirement def Rules {
        subject press : Press;
        require constraint counts { language "ltl"
            /* G (state=Idle & event=Go & strokes<3 -> X strokes>0) */ }
        require constraint closes { language "ltl" /* G (running(press) -> closed) */ }
        require constraint opens { language "ltl" /* G (closed -> F !closed) */ }
        require constraint jumps { language "ltl"
            /* G (strokes'=strokes | strokes'=strokes + 1) */ }
        require constraint twice { language "ltl" /* G (running(press) -> X X !closed) */ }
        require constraint repeats { language "ltl" /* G F state=Busy */ }
    }
}
"""
CLAIMS = ("Rules", "Rules_2", "Rules_3", "Rules_4", "Rules_5", "Rules_6")
"""The claims for the six constraints."""
EXPECTED = {name: name not in CLAIMS[4:] for name in CLAIMS}


def write_model(text, folder, component):
    """Return the Promela model of a component's requirements, and the diagnostics."""
    path = folder / "model.sysml"
    path.write_text(text, encoding="utf-8")
    output, sink = Output(), Sink()
    PROMELA.emit(compile_model(Request((path,))).graph, output, sink, None)
    files = {artefact.path: artefact.text for artefact in output.artefacts()}
    return files.get(f"contracts/{component}.pml", ""), list(sink)


def verify(model, folder):
    """Return the claims of a Promela model, and for each whether SPIN finds no error."""
    (folder / "model.pml").write_text(model, encoding="utf-8")
    run(["spin", "-a", "model.pml"], folder)
    run([COMPILER, "-w", "-o", "pan", "pan.c"], folder)
    answers = {}
    for claim in re.findall(r"^ltl (\w+)", model, re.MULTILINE):
        text = run(["./pan", "-a", "-m200000", "-N", claim], folder)
        assert "max search depth too small" not in text
        answers[claim] = "errors: 0" in text
    return answers


def run(command, folder):
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert "Error" not in result.stdout, result.stdout
    assert result.returncode == 0, result.stderr
    return result.stdout


@pytest.fixture(scope="module")
def press(tmp_path_factory):
    """The model of the press."""
    model, _ = write_model(PRESS, tmp_path_factory.mktemp("press"), "Shop.Press.requirements")
    return model


@needs_spin
def test_spin_decides_each_requirement(press, tmp_path):
    assert verify(press, tmp_path) == EXPECTED


@needs_spin
def test_spin_finds_a_fault_in_the_model(press, tmp_path):
    """The faulty press does not close: the requirement that it is closed while it works fails."""
    faulty = re.sub(r"^(    closed = )next_closed;", r"\1false;", press, flags=re.MULTILINE)
    assert faulty != press
    answers = verify(faulty, tmp_path)
    assert not answers["Rules_2"]
    assert answers["Rules_4"]


def test_the_model_names_inputs_outputs_and_formulas(press):
    assert "mtype event, next_event; /* input */" in press
    assert "byte strokes, next_strokes; /* output */" in press
    assert "next_strokes==strokes + 1" in press  # arithmetic across a step
    assert "/* G (closed -> F !closed) */" in press


@needs_spin
def test_words_of_promela_and_c_are_no_names(tmp_path):
    text = PRESS.replace("closed", "int").replace("strokes", "MAXSEQ").replace("Idle", "linux")
    model, diagnostics = write_model(
        text.replace("part def Press", "part def '*/ #include'").replace(
            ": Press", ": '*/ #include'"
        ),
        tmp_path,
        "Shop.%2A%2F_%23include.requirements",
    )
    assert diagnostics == []
    assert "*/ #" not in model
    assert verify(model, tmp_path) == EXPECTED


def test_requirements_without_behaviour_have_no_model(tmp_path):
    text = """package P { private import ScalarValues::*;
        part def Lamp { out attribute on : Boolean; }
        requirement def Lit { subject lamp : Lamp; require constraint { lamp.on } } }"""
    model, diagnostics = write_model(text, tmp_path, "P.Lamp")
    assert model == ""
    assert [diagnostic.rule for diagnostic in diagnostics] == [NOT_EXPRESSIBLE]


@needs_spin
@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.parametrize(
    "model",
    [
        model
        for model in list_models()
        if model.path.stem in ("timeout", "mutex_race", "call_nested")
    ],
    ids=lambda model: model.path.stem,
)
def test_spin_agrees_with_the_oracle(model, tmp_path):
    text = require(model)
    component = model.component.replace("::", ".")
    for name in (f"{component}.requirements", component):
        promela, _ = write_model(text, tmp_path, name)
        if "ltl R_" in promela:
            break
    expected = {f"R_{fact.name}": fact.holds for fact in model.properties}
    assert verify(promela, tmp_path) == expected
