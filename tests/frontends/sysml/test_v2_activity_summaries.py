"""The page of an activity's contract opens with what the activity does, in sentences."""

from itertools import pairwise

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.backends.contract_pages import print_page
from sysmlc.logic.contract import Contract


def list_paragraphs(steps, features="", more=""):
    """Return the paragraphs of the summary of a performed action by their titles."""
    text = f"""package P {{
        private import ScalarValues::*;
        part def Cell {{
            {features}
            perform action work {{ {steps} }}
            {more}
        }}
    }}"""
    reading = read(text)
    run_all(reading.graph, reading.sink)
    contracts = reading.graph.derived(Contract)
    (contract,) = (contract for contract in contracts if contract.component == "P::Cell")
    page = print_page(reading.graph, contract)
    head, _, rules = page.partition("<details>")
    assert "## Guarantees" in rules
    assert rules.rstrip().endswith("</details>")
    lines = (line for line in head.splitlines() if line.startswith("**"))
    return dict(line.removeprefix("**").split(".** ", 1) for line in lines)


GRIP = """first start; then action approach; then action close assign held := true;
    then action lift; then done;"""
HELD = "attribute held : Boolean := false;"


def test_a_sequence_is_one_sentence():
    paragraphs = list_paragraphs(GRIP, HELD)
    assert paragraphs["Order of the steps"] == (
        "It starts with 'approach'. 'approach', 'close' and 'lift' run one after the other. "
        "After 'lift' comes the end."
    )


def test_values_before_and_after_are_stated():
    paragraphs = list_paragraphs(GRIP, HELD)
    assert paragraphs["Inputs"] == "It reads no feature."
    assert paragraphs["Outputs"] == (
        "Its steps assign `held` (Boolean). 'close' sets `held` to `true`."
    )
    assert paragraphs["Before"] == "`!held` when it starts."
    assert paragraphs["After"].endswith("At the end `held` is `true`, set by 'close'.")
    assert paragraphs["Assumed"] == ("Sooner or later, the environment ends 'approach' and 'lift'.")


@pytest.mark.parametrize(
    ("features", "steps", "more"),
    [
        pytest.param(
            HELD,
            "first start; then decide; if ready then close; else done;"
            "action close assign held := true; then done;",
            "in attribute ready : Boolean;",
            id="a way around the assignment",
        ),
        pytest.param(
            HELD,
            "first start; then fork both; then a; then close; action a; then done;"
            "action close assign held := true; then done;",
            "",
            id="the end may come before the assignment",
        ),
        pytest.param(
            "attribute n : Integer := 0; constraint { 0 <= n and n <= 3 }",
            "first start; then action add assign n := n + 1; then done;",
            "",
            id="a value that depends on the one before",
        ),
        pytest.param(
            HELD,
            GRIP,
            "action drop { first start; then action open assign held := false; then done; }",
            id="another behaviour assigns it",
        ),
    ],
)
def test_a_value_at_the_end_is_stated_only_if_it_is_certain(features, steps, more):
    assert "At the end" not in list_paragraphs(steps, features, more)["After"]


def test_guards_stand_behind_the_steps_that_they_select():
    paragraphs = list_paragraphs(
        """first start then again; merge again; then put; action put; then more; decide more;
           if ready then close; else again; action close; then done;""",
        "in attribute ready : Boolean;",
    )
    assert paragraphs["Inputs"] == "It reads `ready` (Boolean)."
    assert paragraphs["Order of the steps"] == (
        "It starts with 'put'. After 'put' comes 'close' if `ready`, otherwise 'put'. "
        "After 'close' comes the end."
    )


def test_steps_at_the_same_time_and_their_join():
    paragraphs = list_paragraphs(
        """first start then split; fork split; then open; then move; action open; then sync;
           action move; then sync; join sync; then grip; action grip; then done;"""
    )
    assert paragraphs["Order of the steps"] == (
        "It starts with 'open' and 'move' at the same time. After 'open' comes 'grip'. "
        "After 'move' comes 'grip'. After 'grip' comes the end. 'grip' waits for 'open' and 'move'."
    )


def test_names_cannot_break_the_page():
    steps = "first start; then action '</details> `*a*`\\n# B'; then done;"
    order = list_paragraphs(steps)["Order of the steps"]
    assert r"\</details> \`\*a\*\` # B" in order


def decide_often(count):
    """Return a chain of decisions whose branches meet again, before the action 'last'."""
    names = [*(f"d{number}" for number in range(count)), "last"]
    steps = [
        f"decide {name}; if go then m{name}; else m{name}; merge m{name}; then {following};"
        for name, following in pairwise(names)
    ]
    return " ".join(["first start then d0;", *steps, "action last; then done;"])


@pytest.mark.parametrize(
    ("count", "start"),
    [
        (1, "'last' if `go`, otherwise 'last'."),
        (40, "'last', as the guards in between decide."),
    ],
)
def test_guards_of_very_many_paths_are_not_listed(count, start):
    paragraphs = list_paragraphs(decide_often(count), "in attribute go : Boolean;")
    assert paragraphs["Order of the steps"].startswith(f"It starts with {start}")


def test_a_path_of_very_many_decisions_is_followed():
    count = 1500
    steps = " ".join(f"decide d{n}; if go then d{n + 1};" for n in range(count))
    paragraphs = list_paragraphs(
        f"first start then d0; {steps} action d{count};", "in attribute go : Boolean;"
    )
    assert paragraphs["Order of the steps"].startswith(f"It starts with 'd{count}' if `go`.")


def test_a_value_into_which_an_assignment_is_substituted_names_its_conditions():
    features = (
        "in attribute c : Boolean; attribute n : Integer := 0; attribute k : Integer := 0; "
        "assert constraint { 0 <= n and n <= 3 } assert constraint { 0 <= k and k <= 3 }"
    )
    steps = "action a { assign n := if c ? 1 else 2; assign k := n; } then done;"
    assert list_paragraphs(f"first start; then {steps}", features)["Outputs"] == (
        "Its steps assign `n` (0..3) and `k` (0..3). 'a' sets `n` to `1` if `c` or `2` if `!c`. "
        "'a' sets `k` to `1` if `c` or `2` if `!c`."
    )
