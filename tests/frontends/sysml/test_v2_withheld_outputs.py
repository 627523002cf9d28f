"""An error withholds contracts, and marks diagrams, of the elements it concerns only."""

import pytest

from sysmlc.driver import Request, compile_model, select_backends

TEXT = """package P {{
    part def Gate {{ attribute open : ScalarValues::Boolean; {inside} }}
    state def Moves {{
        in gate : Gate;
        entry; then shut;
        state shut {{ {state} }}
        transition first shut accept Go then shut;
    }}
    item def Go;
    action def Work {{ first start; then action a; then done; }}
    {beside}
}}
"""


def compile_text(tmp_path, *, inside="", state="", beside=""):
    """Return the names of the withheld files, and of the diagrams with a mark."""
    (tmp_path / "m.sysml").write_text(TEXT.format(inside=inside, state=state, beside=beside))
    backends = tuple(select_backends(("contracts", "plantuml")))
    compilation = compile_model(Request((tmp_path / "m.sysml",), backends=backends))
    errors = [item.rule.code for item in compilation.diagnostics if item.is_error]
    assert errors in ([], ["SM205"])
    published = {output.path.rpartition("/")[2]: output.text for output in compilation.artefacts}
    withheld = {path.rpartition("/")[2] for path in compilation.withheld}
    marked = {name for name, text in published.items() if "⚠" in text}
    return {name for name in withheld if name.endswith(".json")}, marked


def test_a_right_model_has_all_outputs_without_marks(tmp_path):
    assert compile_text(tmp_path) == (set(), set())


CONTRACTS = {"P.Moves.contract.json", "P.Work.contract.json"}
DIAGRAMS = {"P.bdd.puml", "P.Moves.stm.puml", "P.Work.act.puml"}


@pytest.mark.parametrize(
    ("fault", "withheld", "marked"),
    [
        ({"inside": '@Unknown { url = "x"; }'}, set(), set()),
        ({"inside": "part p : Unknown;"}, set(), {"P.bdd.puml"}),
        (
            {"state": "entry send Unknown() to gate;"},
            {"P.Moves.contract.json"},
            {"P.Moves.stm.puml"},
        ),
        ({"beside": "private import Unknown::*;"}, CONTRACTS, DIAGRAMS),
    ],
    ids=["metadata", "part", "state", "import"],
)
def test_an_unknown_name_concerns_what_holds_it(tmp_path, fault, withheld, marked):
    assert compile_text(tmp_path, **fault) == (withheld, marked)
