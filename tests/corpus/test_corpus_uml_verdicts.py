"""A model in SysML v2 and its SysML v1 have the same verdicts in ``sysmlc contracts check``."""

from pathlib import Path

import pytest
from click.testing import CliRunner
from reading_corpus import list_models

from examples.compiling import ROOT
from sysmlc.cli.group import sysmlc

MODEL = """
package P {
    private import ScalarValues::*;
    part def Part { out attribute a : Boolean; }
    part def Whole {
        in attribute go : Boolean;
        out attribute on : Boolean := false;
        exhibit state Run {
            entry; then Off;
            state Off;
            transition first Off if go do assign on := true then On;
            state On;
        }
    }
    requirement def Assuming {
        subject w : Whole;
        assume constraint { w.go }
        require constraint { language "LTL" /* G (w.go -> w.on) */ }
    }
    requirement def DemandOverInputsAlone { subject w : Whole; require constraint { w.go } }
    requirement def AboutThePart { subject part1 : Part; require constraint { part1.a } }
    requirement def Sentence {
        subject w : Whole;
        require constraint { language "FRET" /* w shall always satisfy on */ }
    }
}
"""
# The hall of examples/robots is not among them: its saved model has no contracts yet.
MODELS = [
    ROOT / "examples" / "lego-recipe-v2" / "lego-recipe.sysml",
    *list_models("contracts", "reals", suffixes=(".sysml",)),
]


def run(*arguments):
    result = CliRunner().invoke(sysmlc, list(map(str, arguments)))
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.stdout


def list_verdicts_before_and_after(model, folder):
    run(model, "--emit", "uml", "-o", folder)
    (saved,) = Path(folder, "uml").glob("*.uml")
    return [run("contracts", "check", path).splitlines() for path in (model, saved)]


def test_subjects_assumptions_and_demands_have_the_same_verdicts_in_sysml_v1(tmp_path):
    model = tmp_path / "model.sysml"
    model.write_text(MODEL)
    before, after = list_verdicts_before_and_after(model, tmp_path / "out")
    names = ("Assuming", "DemandOverInputsAlone", "Sentence")
    assert all(any(line.strip().startswith(name) for line in before) for name in names)
    assert before == after


@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.name)
def test_models_have_the_same_verdicts_in_sysml_v1(model, tmp_path):
    before, after = list_verdicts_before_and_after(model, tmp_path / "out")
    assert before == after
