"""Blocks with parts: their contracts, and the features that connectors make one variable."""

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text
from sysmlc.logic.composition.derivation import compose_blocks
from sysmlc.logic.contract import Contract, IntegerDomain
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import Limits
from sysmlc.synthesis.composition_check import check_compositions
from sysmlc.synthesis.decision import Options

analysis.load("contracts")
PANEL = """
package Line {
    private import ScalarValues::*;
    port def Level { out attribute value : Integer; }
    part def Sensor {
        port level : Level;
        out attribute busy : Boolean := false;
        constraint { 0 <= level.value and level.value <= 7 }
    }
    part def Display {
        port shown : ~Level;
        in attribute waits : Boolean;
        out attribute lamp : Boolean := false;
        constraint { 0 <= shown.value and shown.value <= 7 }
    }
    part def Panel {
        part sensor : Sensor;
        part display : Display;
        out attribute light : Boolean := false;
        INSIDE
    }
    requirement def Measures {
        subject it : Sensor;
        require constraint { language "ltl" /* G F (level.value > 3 & !busy) */ }
    }
    requirement def Shows {
        subject it : Display;
        assume constraint { language "ltl" /* G F !waits */ }
        require constraint { language "ltl" /* G (it.shown.value > 3 -> X lamp) */ }
    }
    requirement def Lights {
        subject it : Panel;
        require constraint { language "ltl" /* G F light */ }
    }
}
"""
JOINED = """
        connect sensor.level to display.shown;
        bind light = display.lamp;
        flow from sensor.busy to display.waits;
"""


def compose(text):
    reading = read(text)
    run_all(reading.graph, reading.sink)
    compositions = list(
        compose_blocks(reading.graph, reading.graph.derived(Contract), reading.sink)
    )
    codes = [
        diagnostic.rule.code
        for diagnostic in reading.sink
        if diagnostic.rule.code.startswith("SM5")
    ]
    return {composition.component: composition for composition in compositions}, codes


def list_variables(contract):
    return [f"{variable.owner.value} {variable.name}" for variable in contract.variables]


def print_formulas(conjuncts):
    return [print_formula(conjunct.formula) for conjunct in conjuncts]


def compose_panel(inside=JOINED):
    compositions, codes = compose(PANEL.replace("INSIDE", inside))
    assert codes == []
    return compositions["Line::Panel"]


def test_features_joined_by_connectors_bindings_and_flows_are_one_variable():
    sensor, display = compose_panel().parts
    assert (sensor.name, display.name) == ("sensor", "display")
    assert list_variables(sensor.contract) == ["sys sensor.level_value", "sys sensor.busy"]
    assert list_variables(display.contract) == [
        "env sensor.level_value",
        "env sensor.busy",
        "sys light",
    ]
    assert print_formulas(display.contract.assumptions) == ["!sensor.busy"]
    assert print_formulas(display.contract.guarantees)[-1] == "sensor.level_value>3 -> light'"


def test_the_contract_of_the_block_is_that_of_its_requirements():
    whole = compose_panel().whole
    assert list_variables(whole) == ["sys light"]
    assert print_formulas(whole.guarantees) == ["!light", "light"]


def test_features_that_nothing_joins_are_variables_of_their_part():
    sensor, display = compose_panel("bind light = display.lamp;").parts
    assert list_variables(sensor.contract) == ["sys sensor.level_value", "sys sensor.busy"]
    assert list_variables(display.contract) == [
        "env display.shown_value",
        "env display.waits",
        "sys light",
    ]


def test_what_a_reader_does_not_know_it_assumes_not_to_come():
    text = PANEL.replace("INSIDE", JOINED).replace("shown.value <= 7", "shown.value <= 5")
    compositions, codes = compose(text)
    _, display = compositions["Line::Panel"].parts
    level = next(
        variable for variable in display.contract.variables if variable.name.endswith("value")
    )
    assert level.domain == IntegerDomain(0, 7)
    assert [
        (str(assumption.class_), print_formula(assumption.formula))
        for assumption in display.contract.assumptions
    ][:2] == [("init", "sensor.level_value<=5"), ("safety", "sensor.level_value'<=5")]
    assert codes == []


def test_copies_of_a_part_are_parts_each():
    composition = compose_panel("part spare : Sensor [2]; bind light = display.lamp;")
    assert [part.name for part in composition.parts] == [
        "sensor",
        "display",
        "spare[1]",
        "spare[2]",
    ]


def test_a_part_without_a_contract_is_opened():
    text = PANEL.replace("INSIDE", JOINED).replace(
        "part def Panel {",
        """part def Rack { part panel : Board; part spare : Sensor; }
    part def Board {
        port inner : Level;
        part one : Sensor;
        part two : Display;
        connect one.level to two.shown;
    }
    part def Panel {""",
    )
    compositions, _ = compose(text)
    rack = compositions["Line::Rack"]
    assert [part.name for part in rack.parts] == ["panel.one", "panel.two", "spare"]
    assert "env panel.one.level_value" in list_variables(rack.parts[1].contract)
    assert rack.whole is None


@pytest.mark.parametrize("code", ["SM508", "SM524", "SM525", "SM526"])
def test_rules_report_their_wrong_model_and_not_their_right_one(code):
    rule = catalogue()[code]
    for text, expected in ((rule.read_page().wrong, True), (rule.read_page().right, False)):
        reading = read(text)
        graph, sink = reading.graph, reading.sink
        run_all(graph, sink, verify_each=True)
        is_composed = len(list(compose_blocks(graph, graph.derived(Contract), sink))) == 1
        assert (code in [diagnostic.rule.code for diagnostic in sink]) is expected
        assert is_composed is (code in ("SM508", "SM526") or not expected)


GATE = """
package Plant {
    private import ScalarValues::*;
    attribute def start;
    attribute def opened;
    port def Told { in ref start; out ref opened; }
    part def Gate {
        port told : Told;
        exhibit state life {
            entry; then shut;
            state shut;
            transition first shut accept start do send opened() to told then open;
            state open;
            transition first open accept start then shut;
        }
    }
    part def Operator {
        port tells : ~Told;
        exhibit state life {
            entry; then idle;
            state idle;
            transition first idle accept after 2 do send start() to tells then waiting;
            state waiting;
            transition first waiting accept opened then idle;
        }
    }
    part def Yard {
        part gate : Gate;
        part operator : Operator;
        connect gate.told to operator.tells;
    }
}
"""


def test_a_signal_that_one_part_sends_occurs_at_the_other():
    compositions, _ = compose(GATE)
    yard = compositions["Plant::Yard"]
    assert [part.name for part in yard.parts] == ["gate", "operator"]
    assert print_formulas(yard.wiring) == [
        "gate.event=start -> operator.send_start",
        "operator.send_start -> gate.event=start & operator.send_start",
        "operator.event=opened -> gate.send_opened",
        "gate.send_opened -> operator.event=opened & gate.send_opened",
    ]
    assert yard.wiring[0].text == "'start' occurs at 'gate' only when 'operator' sends it."


def test_parts_that_nothing_joins_hear_nothing_of_one_another():
    compositions, _ = compose(GATE.replace("connect gate.told to operator.tells;", ""))
    assert compositions["Plant::Yard"].wiring == ()


def test_a_block_is_a_composite_only_when_there_is_something_to_compare():
    assert (
        compose(
            GATE.replace("part operator : Operator;", "").replace(
                "connect gate.told to operator.tells;", ""
            )
        )[0]
        == {}
    )


LOADER = """
package Cells {
    private import DIN8580::*;
    private import ScalarValues::*;
    part def Loader :> Picking, Placing, Moving {
        action pick : Pick;
        action place : Place { out attribute :>> grip := false; }
        action move : CoordinatedMove {
            constant attribute :>> columns = 3;
            constant attribute :>> rows = 3;
        }
        bind pick.command = command;
        bind place.command = command;
        bind move.command = command;
        bind pick.executed = pick_executed;
        bind place.executed = place_executed;
        bind move.moved = move_executed;
        bind place.executed = pick.placed;
        bind pick.executed = place.picked;
        bind move.grip = grip;
        in attribute piece : Boolean;
        in attribute space : Boolean;
        bind pick.pos = piece;
        bind place.pos = space;
    }
    requirement def LoaderContract {
        subject it : Loader;
        assume constraint 'a piece comes' { language "ltl" /* G F (command!=pick | piece) */ }
        assume constraint 'a place is free' { language "ltl" /* G F (command!=place | space) */ }
    }
}
"""


def test_a_machine_is_its_actions_and_its_coordinator():
    compositions, codes = compose(LOADER)
    loader = compositions["Cells::Loader"]
    assert codes == []
    assert [part.name for part in loader.parts] == ["pick", "place", "move", "Loader"]
    assert loader.whole is None
    pick, place, move, coordinator = (list_variables(part.contract) for part in loader.parts)
    assert pick[:4] == ["env command", "sys pick_executed", "env piece", "env place_executed"]
    assert "env pick_executed" in place
    assert "env grip" in move
    assert "sys move_executed" in move
    assert {"sys command", "sys grip", "env move_executed"} <= set(coordinator)
    assert "!place.grip" in print_formulas(loader.parts[1].contract.guarantees)


def check_page(text):
    """Return the diagnostics about the parts of a machine, and whether they fit together."""
    reading = read(text)
    run_all(reading.graph, reading.sink)
    graph, sink = reading.graph, Sink()
    compositions = list(compose_blocks(graph, graph.derived(Contract), sink))
    place = lambda it: graph.subject(graph[it])  # noqa: E731
    (result,) = check_compositions(compositions, place, sink, Options("", Limits()))
    return [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in sink], result.text()


def test_the_actions_and_the_coordinator_of_a_machine_fit_together():
    assert check_page(LOADER) == ([], "Cells::Loader: its 4 behaviours fit together")


@pytest.mark.parametrize(
    ("missing", "assumed"),
    [
        (" { out attribute :>> grip := false; }", "what is picked was free"),
        (" bind move.grip = grip;", "a piece is held"),
        (" bind pick.pos = piece;", "commanded again"),
    ],
)
def test_missing_assumptions_of_a_machine_are_reported(missing, assumed):
    messages, verdict = check_page(LOADER.replace(missing, ";" if "{" in missing else " "))
    assert any(assumed in message for message in messages)
    assert verdict == "Cells::Loader: its 4 behaviours do not fit together"


DRAWN = """
        action fetch { first start; then action grip; then gate;
            decide gate; if ready then end; if not ready then again;
            action again; then end; merge end; then done; }
        action put { first start; then gate;
            decide gate; if ready then drop; if not ready then end;
            action drop; then end; merge end; then done; }
"""
OWN = """
package Cells {
    private import ScalarValues::*;
    action def Fetch { first start; then action grip; then done; }
    action def Put { first start; then action drop; then done; }
    part def Cell {
        in attribute ready : Boolean;
        INSIDE
    }
}
"""


@pytest.mark.parametrize("inside", [DRAWN, "action fetch : Fetch; action put : Put;"])
def test_a_block_that_has_only_actions_of_its_own_is_made_up_of_them(inside):
    compositions, codes = compose(OWN.replace("INSIDE", inside))
    assert [part.name for part in compositions["Cells::Cell"].parts] == ["fetch", "put"]
    assert codes == []


def test_what_actions_read_of_their_block_is_one_variable():
    fetch, put = compose(OWN.replace("INSIDE", DRAWN))[0]["Cells::Cell"].parts
    assert [
        variable for variable in list_variables(fetch.contract) if variable.startswith("env")
    ] == [
        "env fetch.done_grip",
        "env fetch.done_again",
        "env ready",
    ]
    assert [
        variable for variable in list_variables(put.contract) if variable.startswith("env")
    ] == [
        "env put.done_drop",
        "env ready",
    ]


OPERATIONS = """\
Package p "Cells"
  Package l "Library"
    Activity f "Fetch"
      Control fi subkind="initial"
      Action fa "grip" subkind="opaque"
      ControlFlow ff
        -> flow-source fi
        -> flow-target fa
  Class c "Cell" role="block"
    Operation c.f "fetch"
      -> method f
    Operation c.p "put"
      -> method u
    Activity u "Put"
      Control ui subkind="initial"
      Action ua "drop" subkind="opaque"
      ControlFlow uf
        -> flow-source ui
        -> flow-target ua
"""


def test_operations_are_composed_by_their_methods():
    graph, sink = parse_text(OPERATIONS), Sink()
    run_all(graph, sink)
    (cell,) = compose_blocks(graph, graph.derived(Contract), sink)
    assert cell.component == "Cells::Cell"
    assert [part.name for part in cell.parts] == ["fetch", "put"]


def test_an_action_that_another_one_calls_takes_part_only_by_it():
    calls = "action put : Put; action sub { first start; then action grip; then done; }"
    calls += "action all { first start; then action it : sub; then done; }"
    compositions, _ = compose(OWN.replace("INSIDE", calls))
    assert [part.name for part in compositions["Cells::Cell"].parts] == ["put", "all"]
