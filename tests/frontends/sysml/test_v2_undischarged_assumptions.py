"""An output that the contract of its part does not mention is free: it discharges no assumption."""

import pytest
from test_v2_composition_checks import check_model

FEEDER = """
    part def Feeder { in attribute power : Boolean; out attribute ready : Boolean;
        out attribute full : Boolean; }
    requirement def Feeds { subject feeder : Feeder;
        assume constraint { feeder.power } require constraint { feeder.full } }
"""
PICKER = """
    part def Picker { in attribute ready : Boolean; in attribute full : Boolean;
        out attribute taken : Boolean; }
    requirement def Takes { subject picker : Picker;
        assume constraint { picker.ready } assume constraint { picker.full }
        require constraint { picker.taken } }
"""
PARTS = "part feeder : Feeder; part picker : Picker; bind feeder.full = picker.full;"


def check(cell, feeder=FEEDER, picker=PICKER):
    """Return the verdict about block Cell, and the messages about open assumptions."""
    text = f"package Line {{ private import ScalarValues::*; {feeder} {picker} {cell} }}"
    results, diagnostics = check_model(text)
    (result,) = (result for result in results if result.component == "Line::Cell")
    messages = [
        item.message.partition(", which")[0] for item in diagnostics if item.rule.code == "SM595"
    ]
    return result.text().partition(": ")[2], messages


def describe_open(formula, part="picker", count=2):
    """Return what ``check`` returns about parts of which one assumes a formula in vain."""
    return (
        f"its {count} parts do not fit together",
        [f"part '{part}' of 'Line::Cell' assumes '{formula}'"],
    )


def test_the_report_names_who_decides_the_output():
    cell = f"part def Cell {{ {PARTS} bind feeder.ready = picker.ready; }}"
    _, (diagnostic,) = check_model(
        f"package Line {{ private import ScalarValues::*; {FEEDER} {PICKER} {cell} }}"
    )
    assert diagnostic.message == (
        "part 'picker' of 'Line::Cell' assumes 'feeder.ready', which neither the other parts nor "
        "the block's assumptions guarantee ('Takes' assumes it)"
    )
    assert diagnostic.notes == (
        "'feeder' decides 'feeder.ready' and guarantees nothing about it",
        "step 1: feeder.ready=false  <-- violated here",
        "then again from step 1",
    )


@pytest.mark.parametrize(
    ("cell", "variable"),
    [
        ("bind feeder.ready = picker.ready;", "feeder.ready"),
        ("flow feeder.ready to picker.ready;", "feeder.ready"),
        ("attribute wire : Boolean; bind feeder.ready = wire; bind wire = picker.ready;", "wire"),
        ("out attribute lamp : Boolean; bind lamp = picker.ready;", "lamp"),
        ("part spare : Spare; bind spare.ready = picker.ready;", "spare.ready"),
    ],
    ids=["binding", "flow", "chain of bindings", "output of the block", "part without contract"],
)
def test_whatever_joins_the_output_with_the_input(cell, variable):
    spare = "part def Spare { out attribute ready : Boolean; }"
    assert check(f"{spare} part def Cell {{ {PARTS} {cell} }}") == describe_open(variable)


def test_a_requirement_on_the_block_changes_nothing():
    cell = f"""part def Cell {{ in attribute power : Boolean; out attribute taken : Boolean;
        {PARTS} bind power = feeder.power; bind feeder.ready = picker.ready;
        bind picker.taken = taken; }}
    requirement def Works {{ subject cell : Cell;
        assume constraint {{ cell.power }} require constraint {{ cell.taken }} }}"""
    _, open_assumptions = describe_open("feeder.ready")
    assert check(cell) == ("its 2 parts together violate its contract", open_assumptions)


def test_outputs_of_ports():
    port = "port def Tray { out attribute ready : Boolean; out attribute full : Boolean; }"
    feeder = f"""{port} part def Feeder {{ port tray : Tray; }}
        requirement def Feeds {{ subject feeder : Feeder;
            require constraint {{ feeder.tray.full }} }}"""
    picker = """part def Picker { port tray : ~Tray; out attribute taken : Boolean; }
        requirement def Takes { subject picker : Picker;
            assume constraint { picker.tray.ready } assume constraint { picker.tray.full }
            require constraint { picker.taken } }"""
    cell = """part def Cell { part feeder : Feeder; part picker : Picker;
        connect feeder.tray to picker.tray; }"""
    assert check(cell, feeder, picker) == describe_open("feeder.tray_ready")


@pytest.mark.parametrize(
    ("inner", "variable"),
    [("", "left.ready"), ("bind feeder.ready = ready;", "left.feeder.ready")],
    ids=["decided by the inner block", "decided by its part"],
)
def test_outputs_of_nested_blocks(inner, variable):
    half = f"""part def Half {{ out attribute ready : Boolean; out attribute full : Boolean;
        part feeder : Feeder; bind feeder.full = full; {inner} }}"""
    cell = """part def Cell { part left : Half; part picker : Picker;
        bind left.full = picker.full; bind left.ready = picker.ready; }"""
    assert check(half + cell) == describe_open(variable)


def test_a_consumer_in_a_nested_block():
    half = """part def Half { in attribute ready : Boolean; in attribute full : Boolean;
        part picker : Picker; bind full = picker.full; bind ready = picker.ready; }"""
    cell = """part def Cell { part feeder : Feeder; part right : Half;
        bind feeder.full = right.full; bind feeder.ready = right.ready; }"""
    assert check(half + cell) == describe_open("feeder.ready", "right.picker")


def test_parts_that_share_nothing_else_and_several_of_a_kind():
    picker = PICKER.replace("assume constraint { picker.full }", "")
    cell = """part def Cell { part feeder : Feeder; part picker : Picker; part spare : Picker;
        bind feeder.ready = picker.ready; bind feeder.ready = spare.ready; }"""
    verdict, messages = check(cell, picker=picker)
    assert verdict == "its 3 parts do not fit together"
    assert messages == [
        "part 'picker' of 'Line::Cell' assumes 'feeder.ready'",
        "part 'spare' of 'Line::Cell' assumes 'feeder.ready'",
    ]


@pytest.mark.parametrize(
    "feeder",
    [
        FEEDER.replace("out attribute ready", "attribute ready"),
        FEEDER.replace("out attribute ready", "inout attribute ready"),
        FEEDER.replace("ready : Boolean", "ready : Boolean := false"),
        FEEDER.replace(
            "Boolean;\n", "Boolean; item def Go; exhibit state M { entry; then A; state A; }\n"
        ),
    ],
    ids=["no direction", "both directions", "wrong initial value", "with a behaviour"],
)
def test_outputs_are_decided_by_their_part(feeder):
    cell = f"part def Cell {{ {PARTS} bind feeder.ready = picker.ready; }}"
    assert check(cell, feeder) == describe_open("feeder.ready")


def test_an_initial_value_says_nothing_about_later_steps():
    cell = f"part def Cell {{ {PARTS} bind feeder.ready = picker.ready; }}"
    feeder = FEEDER.replace("ready : Boolean", "ready : Boolean := true")
    assert check(cell, feeder) == describe_open("feeder.ready'")


def test_a_range_of_an_output_that_the_reader_cannot_read():
    feeder = """part def Feeder { out attribute ready : Integer; out attribute full : Boolean;
            assert constraint { 0 <= ready and ready <= 9 } }
        requirement def Feeds { subject feeder : Feeder; require constraint { feeder.full } }"""
    picker = PICKER.replace("ready : Boolean;", "ready : Integer; ").replace(
        "taken : Boolean; }",
        "taken : Boolean; assert constraint { 0 <= ready and ready <= 5 } }",
    )
    cell = f"part def Cell {{ {PARTS} bind feeder.ready = picker.ready; }}"
    verdict, messages = check(
        cell, feeder, picker.replace("{ picker.ready }", "{ picker.ready > 0 }")
    )
    assert verdict == "its 2 parts do not fit together"
    assert messages == [
        "part 'picker' of 'Line::Cell' assumes 'feeder.ready<=5'",
        "part 'picker' of 'Line::Cell' assumes 'feeder.ready>0'",
    ]


BINDING = "bind feeder.ready = picker.ready;"


@pytest.mark.parametrize(
    ("cell", "feeder"),
    [
        ("in attribute ready : Boolean; bind ready = picker.ready;", FEEDER),
        ("attribute ready : Boolean; bind ready = picker.ready;", FEEDER),
        ("", FEEDER),
        (BINDING, FEEDER.replace("{ feeder.full }", "{ feeder.full and feeder.ready }")),
        (
            BINDING,
            FEEDER + "requirement def Is { subject f : Feeder; require constraint { f.ready } }",
        ),
        (
            BINDING,
            FEEDER.replace(
                "out attribute ready : Boolean", "constant attribute ready : Boolean = true"
            ),
        ),
    ],
    ids=[
        "input of the block",
        "value of the block that nothing decides",
        "unbound input",
        "guaranteed",
        "guaranteed by another requirement",
        "constant",
    ],
)
def test_assumptions_that_the_block_makes_or_a_part_guarantees(cell, feeder):
    assert check(f"part def Cell {{ {PARTS} {cell} }}", feeder) == ("its 2 parts fit together", [])


@pytest.mark.parametrize("guard", ["", "if ready"], ids=["not read", "read"])
def test_the_behaviour_of_a_part_keeps_what_nothing_assigns(guard):
    feeder = f"""item def Go;
        part def Feeder {{
            out attribute ready : Boolean := true; out attribute full : Boolean := true;
            exhibit state M {{
                entry; then A; state A; state B;
                transition first A accept Go {guard} do assign full := true then B; }} }}"""
    cell = f"part def Cell {{ {PARTS} bind feeder.ready = picker.ready; }}"
    assert check(cell, feeder, PICKER.replace("assume constraint { picker.full }", "")) == (
        "its 2 parts fit together",
        [],
    )


def test_an_output_that_the_block_itself_assigns_is_not_free():
    feeder = FEEDER.replace("ready : Boolean", "ready : Boolean := true")
    action = "action x { first start then y; action y assign feeder.ready := true; then done; }"
    cell = f"part def Cell {{ {PARTS} bind feeder.ready = picker.ready; perform {action} }}"
    _, messages = check(cell, feeder)
    assert messages == []


@pytest.mark.parametrize(
    ("value", "is_given"),
    [("", False), (":= true", False), ("= true", True), ("= false", False)],
    ids=["free", "initial", "bound", "bound to the wrong value"],
)
def test_a_single_part_with_a_contract_relies_on_a_part_without_one(value, is_given):
    feeder = f"part def Feeder {{ out attribute ready : Boolean {value}; }}"
    picker = PICKER.replace("assume constraint { picker.full }", "")
    parts = "part feeder : Feeder; part picker : Picker;"
    cell = f"part def Cell {{ {parts} bind feeder.ready = picker.ready; }}"
    verdict, messages = check(cell, feeder, picker)
    assert verdict == ("its part fits" if is_given else "its part does not fit")
    assert len(messages) == (not is_given)


def test_an_assigned_feature_does_not_keep_its_bound_value():
    feeder = """item def Go;
        part def Feeder { out attribute ready : Boolean = true;
            exhibit state M {
                entry; then A; state A;
                transition first A accept Go do assign ready := false then A; } }"""
    picker = PICKER.replace("assume constraint { picker.full }", "")
    cell = "part feeder : Feeder; part picker : Picker; bind feeder.ready = picker.ready;"
    verdict, messages = check(f"part def Cell {{ {cell} }}", feeder, picker)
    assert verdict == "its 2 parts do not fit together"
    assert len(messages) == 1
