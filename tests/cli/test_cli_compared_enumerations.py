"""Formulas compare a feature with the values of its own enumeration only."""

import pytest


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ("open", ""),
        ("Door::open", ""),
        ("Lamp::open", "'Lamp::open' is a value of 'M::Lamp', not of 'M::Door'"),
        ("lamp", "'lamp' is a value of 'M::Lamp', not of 'M::Door'"),
    ],
)
def test_equal_literals_of_two_enumerations_differ(workspace, all_passes, value, reason):
    workspace.write(
        "model.sysml",
        f"""package M {{
            enum def Door {{ open; shut; }}
            enum def Lamp {{ open; shut; }}
            part def P {{ in attribute door : Door; in attribute lamp : Lamp; }}
            requirement def R {{ subject it : P;
                assume constraint {{ language "ltl" /* G (door = {value}) */ }}
                require constraint {{ language "ltl" /* G (lamp = open) */ }} }} }}""",
    )
    output = workspace.sysmlc("contracts", "check", "model.sysml").output
    assert ("SM522" in output) is bool(reason)
    assert reason in output
