"""An error withholds the outputs of the elements it concerns, not those of the whole file."""

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


def list_withheld(tmp_path, *, inside="", state="", beside=""):
    (tmp_path / "m.sysml").write_text(TEXT.format(inside=inside, state=state, beside=beside))
    backends = tuple(select_backends(("contracts", "plantuml")))
    compilation = compile_model(Request((tmp_path / "m.sysml",), backends=backends))
    assert [
        diagnostic.rule.code for diagnostic in compilation.diagnostics if diagnostic.is_error
    ] in (
        [],
        ["SM205"],
    )
    written = {output.path.rpartition("/")[2] for output in compilation.list_published()}
    return {name for name in NAMES if name not in written}


NAMES = {"P.bdd.puml", "P.Moves.stm.puml", "P.Moves.contract.json", "P.Work.act.puml"}


def test_a_right_model_has_all_outputs(tmp_path):
    assert list_withheld(tmp_path) == set()


@pytest.mark.parametrize(
    ("backends", "expected"),
    [
        ({"inside": '@Unknown { url = "x"; }'}, set()),
        ({"inside": "part p : Unknown;"}, {"P.bdd.puml"}),
        ({"state": "entry send Unknown() to gate;"}, {"P.Moves.stm.puml", "P.Moves.contract.json"}),
        ({"beside": "private import Unknown::*;"}, NAMES),
    ],
)
def test_an_unknown_name_withholds_what_holds_it(tmp_path, backends, expected):
    assert expected <= list_withheld(tmp_path, **backends)
    assert "P.Work.act.puml" not in list_withheld(tmp_path, **backends) or "beside" in backends
