"""``synth`` calls a controller vacuous that need not do anything; counts have the right number."""

import pytest

from sysmlc.support.counts import count

LAMP = """package P {{
    private import ScalarValues::*;
    part def Lamp {{ in attribute go : Boolean; out attribute on : Boolean := false; }}
    requirement def R {{ subject lamp : Lamp;
        assume constraint {{ language "ltl" /* {assumed} */ }}
        require constraint {{ language "ltl" /* {demanded} */ }} }}
}}
"""


@pytest.mark.parametrize(
    ("assumed", "demanded", "end"),
    [
        (
            "G F go",
            "G (go -> !on')",
            "; vacuous: the controller needs to do nothing, since its outputs may stay as they are",
        ),
        (
            "G (on -> !go') & G (on -> go')",
            "G F on",
            "; vacuous: the controller can make the environment violate its assumptions",
        ),
        ("G F go", "G (go -> X on)", ""),
        ("G F go", "G F on & G F !on", ""),
    ],
)
def test_the_verdict_says_whether_the_controller_is_vacuous(
    workspace, all_passes, assumed, demanded, end
):
    workspace.write("lamp.sysml", LAMP.format(assumed=assumed, demanded=demanded))
    result = workspace.sysmlc("synth", "lamp.sysml")
    assert result.exit_code == 0
    assert result.stdout.startswith("P::Lamp: realizable (2 variables, 2 bits, ")
    assert result.stdout.endswith(f", checked{end}\n")
    assert " 1 moves" not in result.stdout


def test_an_unrealizable_contract_shows_the_core_and_what_would_help(workspace, all_passes):
    demanded = "G (go -> on') & G (on -> !on') & G F (on & go)"
    workspace.write("lamp.sysml", LAMP.format(assumed="true", demanded=demanded))
    notes = [
        line.strip()
        for line in workspace.sysmlc("synth", "lamp.sysml").stderr.splitlines()
        if "note:" in line
    ]
    assert notes[0].startswith("note: these 2 of ")
    assert notes[1].startswith("note: always: go -> on'")
    assert notes[2].startswith("note: always: on -> !on'")
    assert not any("more note" in note for note in notes)


@pytest.mark.parametrize(
    ("number", "noun", "text"),
    [
        (1, "move", "1 move"),
        (0, "move", "0 moves"),
        (1200, "node", "1,200 nodes"),
        (2, "query", "2 queries"),
        (2, "day", "2 days"),
        (2, "more step", "2 more steps"),
    ],
)
def test_a_number_has_its_noun(number, noun, text):
    assert count(number, noun) == text
