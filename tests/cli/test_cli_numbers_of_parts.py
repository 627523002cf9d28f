"""Guards compare the same feature of two parts; the parts have different values of it."""

import pytest

PLANT = """package P {{
private import ScalarValues::*;
part def Tank {{ in attribute level : Real; }}
part def Plant {{
    part left : Tank;
    part right : Tank;
    exhibit state M {{
        entry; then A;
        state A;
        state B;
        state C;
        transition first A if left.level > right.level{guard} then B;
        transition first A if left.level <= right.level then C;
    }}
}}
requirement def R {{ subject it : Plant; require constraint {{ language "ltl" /* {formula} */ }} }}
}}
"""


@pytest.mark.parametrize(
    ("guard", "formula", "verdict"),
    [
        ("", "X !state=A", "holds"),
        ("", "G state=A", "broken"),
        (" and right.level > left.level", "G !state=B", "holds"),
        (" and left.level < 5 and right.level > 10", "G !state=B", "holds"),
        (" and left.level > 5 and right.level < 10", "G !state=B", "broken"),
    ],
)
def test_guards_compare_a_feature_of_two_parts(guard, formula, verdict, workspace, all_passes):
    workspace.write("model.sysml", PLANT.format(guard=guard, formula=formula))
    result = workspace.sysmlc("contracts", "check", "-v", "model.sysml")
    assert f"  R: {verdict}: " in result.stdout


def test_a_formula_about_parts_that_is_not_understood_is_reported(workspace, all_passes):
    formula = "G (left.level > right.level -> X state=B)"
    workspace.write("model.sysml", PLANT.format(guard="", formula=formula))
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    assert "error[SM522" in result.stderr
    assert "SM900" not in result.stderr
