"""Random valid models of SysML v2: no error, only true warnings, and the text is repeated.

``random_texts`` draws models that are valid by construction.
"""

from random import Random

import pytest

from long_runs import quick_first
from random_texts.models import draw_text
from sysmlc import compile_model

QUICK, ALL = 15, 120
TRUE_WARNINGS = {
    "SM411": "the contract cannot express a condition over reals, quantities or calls",
    "SM414": "a value is outside the range of an attribute",
    "SM415": "the contract cannot express an assignment to an attribute without finite type",
    "SM417": "the contract cannot express an absolute time",
    "SM422": "random guards do not exclude each other",
    "SM428": "a random number is outside the assumed range",
    "SM434": "an event occurs while another region takes several transitions",
    "SM452": "a step after an endless loop is never reached",
    "SM456": "a random guard has no else",
    "SM458": "the contract cannot express a condition over reals, quantities or calls",
    "SM480": "views and events outside sequences are not part of the graph",
    "SM520": "random values are too many for a SPIN formula",
    "SM482": "a connector leads to an element that is not part of the graph",
    "SM315": "a random connector joins two outputs",
}
"""What the warnings that remain say, each about a fact of the model or about the tool."""


@pytest.mark.parametrize("seed", quick_first(range(ALL), QUICK))
def test_a_valid_model_has_no_error_and_is_repeated(seed, tmp_path):
    text = draw_text(Random(seed))
    path = tmp_path / "model.sysml"
    path.write_text(text, encoding="utf-8", newline="")
    compilation = compile_model(path, emit=["+sysml"])
    findings = [
        f"{diagnostic.rule.code} {diagnostic.message}"
        for diagnostic in compilation.diagnostics
        if diagnostic.severity.name == "ERROR"
        or (diagnostic.severity.name == "WARNING" and diagnostic.rule.code not in TRUE_WARNINGS)
    ]
    assert findings == []
    texts = [
        artefact.text for artefact in compilation.artefacts if artefact.path.startswith("sysml/")
    ]
    assert texts == [text]
