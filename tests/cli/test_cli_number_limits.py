"""Constraints of blocks limit numbers: verdicts use them where they hold, and nowhere else."""

import pytest

GUARDED = """exhibit state M {
    entry; then A;
    state A;
    state B;
    transition first A if x > 10 then B;
}"""


@pytest.fixture
def check(workspace, all_passes):
    """Return a function from definitions to the verdicts about ``G state=A`` of a block."""

    def run(definitions, block="B"):
        text = f"""package P {{ private import ScalarValues::*; item def Day; item def Night;
            {definitions}
            requirement def R {{ subject it : {block};
                require constraint {{ language "ltl" /* G M.state=A */ }} }} }}"""
        workspace.write("model.sysml", text)
        result = workspace.sysmlc("contracts", "check", "-v", "model.sysml")
        lines = [line.strip() for line in result.stdout.splitlines()]
        return [line.rpartition(": G")[0] for line in lines if line.startswith("R:")]

    return run


@pytest.mark.parametrize(
    ("constraint", "verdict"),
    [
        ("x <= 10", "holds"),
        ("0 <= x and x < 8", "holds"),
        ("20 >= 2 * x", "holds"),
        ("x <= 11", "broken"),
        # The regions of one number do not show these; a run may have excluded values.
        ("x != 11", "not decided: it depends on 'x != 11'"),
        ("x < 5 or x > 20", "not decided: it depends on 'x < 5 or x > 20'"),
        ("not (x > 10)", "not decided: it depends on 'not (x > 10)'"),
    ],
)
def test_a_constraint_limits_the_numbers_of_its_block(constraint, verdict, check):
    block = f"attribute x : Real; assert constraint {{ {constraint} }} {GUARDED}"
    assert check(f"part def B {{ in {block} }}") == [f"R: {verdict}"]


@pytest.mark.parametrize("feature", ["", "in attribute :>> x : Real;"])
def test_a_constraint_of_a_special_block_says_nothing_about_the_general_one(feature, check):
    """A requirement on the general block is one on the special block, too."""
    general = f"part def B {{ in attribute x : Real; {GUARDED} }}"
    special = f"part def Small :> B {{ {feature} assert constraint {{ x < 5 }} }}"
    assert check(general + special) == ["R: broken", "R: holds"]
    assert check(general + special, "Small") == ["R: holds"]


def test_a_constraint_on_one_part_is_none_on_another_part(check):
    """The value of ``right.x`` is not limited, but the two share their regions."""
    machine = GUARDED.replace("x > 10", "right.x > 10")
    block = f"part left : Tank; part right : Tank; assert constraint {{ left.x < 5 }} {machine}"
    verdicts = check(f"part def Tank {{ in attribute x : Real; }} part def B {{ {block} }}")
    assert verdicts == ["R: not decided: it depends on 'left.x < 5'"]


def test_a_constraint_that_names_an_assigned_number_holds_for_its_present_value(check):
    """With the other value of ``top`` the constraint permits 11."""
    block = """in attribute x : Real; attribute top : Real := 10; assert constraint { x < top }
        exhibit state Clock {
            entry; then Run;
            state Run;
            transition first Run accept Day do assign top := 20 then Run;
            transition first Run accept Night do assign top := 10 then Run;
        }"""
    verdicts = check(f"part def B {{ {block} {GUARDED} }}")
    assert verdicts == ["R: not decided: it depends on 'x < top'"]
