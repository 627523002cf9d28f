"""Assignments of actions are in the contract of their activity, as in SysML v1, or reported."""

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.contract_checks import check_contracts
from sysmlc.synthesis.decision import Options

analysis.load("contracts")

V2 = """
package P {
    private import ScalarValues::*;
    part def Cell {
        attribute total : Integer := 0;
        assert constraint { 0 <= total and total <= 9 }
        action work {
            attribute n : Integer default = 0;
            assert constraint { 0 <= n and n <= 3 }
            first start; then again; merge again;
            then action fill;
            then action count assign n := n + 1;
            then action add assign total := total + n;
            then enough; decide enough; if n < 3 then again; else done;
        }
    }
}
"""
V1 = """\
Package p "P"
  Class c "Cell" role="block"
    Property t "total" default=0
      -> typed-by int
    Constraint ct body="0 <= total and total <= 9"
    Activity a "work"
      Property k "n" default=0
        -> typed-by int
      Constraint ck body="0 <= n and n <= 3"
      Control i "start" subkind="initial"
      Control m "again" subkind="merge"
      Action f "fill" subkind="opaque"
      Action w "count" subkind="opaque" body="n := n + 1"
      Action d "add" subkind="opaque" body="total := total + n"
      Control q "enough" subkind="decision"
      Control e "done" subkind="final"
FLOWS  DataType int "Integer"
"""
_FLOWS = ("i m", "m f", "f w", "w d", "d q", "q m n < 3", "q e else")


def compile_v1(text=V1):
    flows = ""
    for number, flow in enumerate(_FLOWS):
        source, target, *guard = flow.split(" ", 2)
        attribute = f' guard="{guard[0]}"' if guard else ""
        flows += f"      ControlFlow f{number}{attribute}\n"
        flows += f"        -> flow-source {source}\n        -> flow-target {target}\n"
    graph, sink = parse_text(text.replace("FLOWS", flows)), Sink()
    run_all(graph, sink)
    return graph, sink


def compile_v2(text=V2):
    reading = read(text)
    run_all(reading.graph, reading.sink)
    return reading.graph, reading.sink


def find_contract(graph):
    return next(
        find_contract
        for find_contract in graph.derived(Contract)
        if find_contract.component.endswith("::Cell.work")
    )


def describe_assignments(contract):
    """Return the texts of the guarantees about the variables that actions assign."""
    names = {variable.name for variable in contract.variables if variable.name in ("n", "total")}
    return [
        guarantee.text
        for guarantee in contract.guarantees
        if guarantee.class_ is not Class.LIVENESS
        and any(f"'{name}'" in guarantee.text for name in names)
    ]


def test_variables_that_actions_assign_are_outputs():
    contract = find_contract(compile_v2()[0])
    assert [variable.name for variable in contract.variables if variable.owner is Owner.SYSTEM][
        :2
    ] == ["n", "total"]
    assert describe_assignments(contract) == [
        "At the start 'n' is 0.",
        "At the start 'total' is 0.",
        "When action 'count' is done and n>2, 'n' becomes 3.",
        "When action 'count' is done and n<=2, 'n' becomes n + 1.",
        "'n' is 0 whenever activity 'work' starts.",
        "'n' keeps its value until an action writes another.",
        "When action 'add' is done and total + n>9, 'total' becomes 9.",
        "When action 'add' is done and total + n<=9, 'total' becomes total + n.",
        "'total' keeps its value until an action writes another.",
    ]


def test_a_loop_that_a_counter_ends_needs_no_assumption():
    contract = find_contract(compile_v2()[0])
    assert [assumption.text for assumption in contract.assumptions] == [
        "Whenever action 'fill' runs, the environment ends it sooner or later."
    ]
    assert is_realizable(contract, compile_v2()[0]) is True


def is_realizable(contract, graph):
    (result,) = check_contracts(
        [contract], [contract], lambda id: graph.subject(graph[id]), Sink(), Options()
    )
    return result.verdict.is_realizable


def test_a_loop_that_its_counter_never_ends_cannot_be_finished():
    graph, _ = compile_v2(V2.replace("n := n + 1", "n := 0"))
    assert is_realizable(find_contract(graph), graph) is False


def test_both_notations_have_the_same_contract():
    descriptions = [
        [
            [(variable.name, variable.owner, variable.domain) for variable in contract.variables],
            [
                (assumption.class_, print_formula(assumption.formula))
                for assumption in contract.assumptions
            ],
            [
                (guarantee.class_, print_formula(guarantee.formula), guarantee.text)
                for guarantee in contract.guarantees
            ],
        ]
        for contract in (find_contract(compile_v1()[0]), find_contract(compile_v2()[0]))
    ]
    assert descriptions[0] == descriptions[1]


def test_only_a_variable_that_can_leave_its_range_is_reported():
    """The loop ends before the counter does; the total goes on in the next run."""
    assert [diagnostic.message for diagnostic in compile_v2()[1]] == [
        "action 'add' can take 'total' out of its range; it stops at the bound"
    ]


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("assert constraint { 0 <= n and n <= 3 }", "", "it has no range"),
        ("n := n + 1", "n := measure(n)", "'measure(n)' is unknown, or has too many cases"),
    ],
)
def test_an_assignment_that_cannot_be_derived_is_reported_with_the_reason(old, new, reason):
    graph, sink = compile_v2(V2.replace(old, new))
    assert next(diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM544") == (
        f"the contract of 'work' treats 'n' as an input although action 'count' assigns it: "
        f"{reason}"
    )
    owners = {variable.name: variable.owner for variable in find_contract(graph).variables}
    assert owners["n"] is Owner.ENVIRONMENT


def test_a_feature_that_two_behaviours_write_is_an_input_of_both():
    second_action = "action reset { first start; then action clear assign total := 0; then done; }"
    text = V2.replace("action work {", f"{second_action}\n        action work {{")
    graph, sink = compile_v2(text.replace("if n < 3", "if total < 9"))
    assert [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM544"] == [
        "the contract of 'reset' treats 'total' as an input although action 'clear' assigns "
        "it: 'add' assigns it too",
        "the contract of 'work' treats 'total' as an input although action 'add' assigns it: "
        "'clear' assigns it too",
    ]
    assert "total" not in [
        variable.name
        for variable in find_contract(graph).variables
        if variable.owner is Owner.SYSTEM
    ]


WRITES = V1.replace(
    'Action w "count" subkind="opaque" body="n := n + 1"',
    """Action w "count" subkind="write"
        -> calls k
        Pin wo "object" direction="in" subkind="object"
        Pin wv "value" direction="in" subkind="value" value=3""",
)


def test_a_structural_feature_gets_the_value_of_its_pin():
    graph, sink = compile_v1(WRITES)
    texts = describe_assignments(find_contract(graph))
    assert "When action 'count' is done, 'n' becomes 3." in texts
    assert "SM544" not in [diagnostic.rule.code for diagnostic in sink]


def test_a_feature_that_a_state_machine_of_the_block_writes_is_an_input_of_the_activity():
    machine = """exhibit state life {
            entry; then idle;
            state idle;
            transition first idle accept after 1 do assign total := 0 then idle;
        }"""
    graph, sink = compile_v2(V2.replace("action work {", f"{machine}\n        action work {{"))
    assert [
        diagnostic.message.rpartition(": ")[2]
        for diagnostic in sink
        if diagnostic.rule.code == "SM544"
    ] == ["'life' assigns it too"]
    assert "SM546" in [diagnostic.rule.code for diagnostic in sink]
    owners = [
        variable.owner
        for find_contract in graph.derived(Contract)
        for variable in find_contract.variables
        if variable.name == "total"
    ]
    assert Owner.SYSTEM not in owners


def test_assignments_in_a_row_are_one_value_as_long_as_they_have_few_cases():
    def assign(body, bound="total <= 9"):
        graph, sink = compile_v1(V1.replace("n := n + 1", body).replace("total <= 9", bound))
        messages = [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM544"]
        return [
            effect for effect in describe_assignments(find_contract(graph)) if "'count'" in effect
        ], messages

    assert assign("n := 2; n := n + 1") == (["When action 'count' is done, 'n' becomes 3."], [])
    effects, messages = assign("; ".join(["n := n + 1"] * 80))
    assert (len(effects), messages) == (4, [])
    primes = (2, 3, 5, 7, 11, 13)
    body = "; ".join(f"n := if (total + n) % {prime} == 1 ? n + 1 else 0" for prime in primes)
    _, messages = assign(body, "total <= 999")
    assert len(messages) == 1
    assert messages[0].endswith("is unknown, or has too many cases")


BODY = """
package Plant {
    private import ScalarValues::*;
    enum def Mode { enum on; enum off; }
    enum def Color { enum red; enum blue; }
    enum def Lamp { enum on; enum off; }
    part def Cell {
        attribute n : Integer := 9 { assert constraint { 0 <= n and n <= 9 } }
        attribute mode : Mode;
        constant attribute full : Boolean := false;
        action work {
            first start;
            then action up { BODY }
            then done;
        }
    }
}
"""


def compile_body(body):
    graph, sink = compile_v2(BODY.replace("BODY", body))
    (contract,) = graph.derived(Contract)
    becomes = [guarantee.text for guarantee in contract.guarantees if "becomes" in guarantee.text]
    return [
        f"{diagnostic.rule.code} {diagnostic.severity}: {diagnostic.message}" for diagnostic in sink
    ], becomes


def test_a_value_that_is_always_outside_is_reported_and_the_contract_states_the_bound():
    messages, becomes = compile_body("assign n := 12;")
    assert messages == ["SM414 warning: assignment 'n := 12': 12 is outside 0..9"]
    assert becomes == ["When action 'up' is done, 'n' becomes 9."]


def test_it_is_an_error_where_state_machines_have_one():
    _, sink = compile_v1(V1.replace("n := n + 1", "n := 12"))
    assert [str(diagnostic.severity) for diagnostic in sink if diagnostic.rule.code == "SM414"] == [
        "error"
    ]


def test_each_of_several_assignments_stops_at_the_bound_for_itself():
    messages, becomes = compile_body("assign n := n + 2; assign n := n - 2;")
    assert messages == [
        "SM428 warning: action 'up' can take 'n' out of its range; it stops at the bound"
    ]
    assert becomes == [
        "When action 'up' is done and n>7, 'n' becomes 7.",
        "When action 'up' is done and n<=7, 'n' becomes n + 2 - 2.",
    ]


def test_an_assignment_to_a_constant_is_reported():
    messages, becomes = compile_body("assign full := true;")
    assert messages[0] == ("SM415 warning: 'full := true' assigns to 'full', which is constant")
    assert becomes == []


def test_a_literal_of_another_enumeration_is_reported_although_the_literals_are_the_same():
    messages, becomes = compile_body("assign mode := Lamp::on;")
    assert messages[1:] == [
        "SM413 warning: assignment 'mode := Lamp::on': 'Lamp::on' is a value of 'Plant::Lamp', not "
        "of 'Plant::Mode'"
    ]
    assert becomes == []


def test_a_value_of_another_type_is_reported():
    messages, becomes = compile_body("assign mode := Color::red;")
    assert messages == [
        "SM544 info: the contract of 'work' treats 'mode' as an input although action 'up' "
        "assigns it: 'Color::red' is unknown, or has too many cases",
        "SM413 warning: assignment 'mode := Color::red': 'Color::red' is one of red, blue, not of "
        "on, off",
    ]
    assert becomes == []


@pytest.mark.parametrize(
    ("attribute", "value", "reason"),
    [
        ("m : Integer := 0", "n * n", "it has no range"),
        (
            "m : Integer := 0 { assert constraint { 0 <= m and m <= 9 } }",
            "Measure()",
            "'Measure()' is unknown, or has too many cases",
        ),
    ],
)
def test_an_assigned_feature_of_the_block_is_reported_even_if_no_guard_reads_it(
    attribute, value, reason
):
    text = BODY.replace("attribute mode", f"attribute {attribute};\n        attribute mode")
    text = text.replace("};\n", "}\n").replace("action work", "calc def Measure;\n action work")
    _, sink = compile_v2(text.replace("BODY", f"assign m := {value};"))
    assert [
        diagnostic.message.rpartition(": ")[2]
        for diagnostic in sink
        if diagnostic.rule.code == "SM544"
    ] == [reason]


COUNTING = """
package Plant {
    private import ScalarValues::*;
    part def Cell {
        attribute n : Integer START { assert constraint { 0 <= n and n <= MOST } }
        attribute ok : Boolean;
        action work { first start; STEPS then done; }
    }
}
"""
UP = "assign n := n + 1;"
LOOP = "then merge m; then decide d; if n < MOST then up; else over; action up { UP } then m;"
WIDE = "".join(
    f"first f then b{n}; action b{n}; then action c{n}; then action e{n}; then j; "
    for n in range(5)
)
COUNTS = {
    "a guard, and no initial value": (
        ("", 9, "then decide d; if n < 9 then up; else done; action up { UP }"),
        [],
    ),
    "each in a row by itself": (
        (
            ":= 0",
            2,
            f"then action one {{ {UP} }} then action two {{ {UP} }} then action three {{ {UP} }} "
            "then action zero { assign n := 0; }",
        ),
        ["action 'three' can"],
    ),
    "another that is written without an initial value": (
        (":= 0", 9, f"{LOOP.replace('UP', 'UP assign ok := not ok;')} action over;"),
        [],
    ),
    "the same words where it is guarded and where it is not": (
        (":= 0", 9, f"{LOOP} action over {{ UP }}"),
        ["action 'over' can"],
    ),
    "more states than are looked at": ((":= 0", 900, f"{LOOP} action over;"), []),
    "branches that have nothing to do with it": (
        (
            ":= 0",
            9,
            f"then action zero {{ assign n := 0; }} then fork f; {WIDE} join j; "
            "then action up { UP }",
        ),
        [],
    ),
    "branches, and too many states to tell": (
        (":= 0", 9, f"then fork f; {WIDE} join j; then action up {{ UP }}"),
        ["action 'up' may (it has too many states to tell)"],
    ),
}


@pytest.mark.parametrize("case", COUNTS)
def test_a_variable_can_leave_its_range_unless_the_path_to_the_action_rules_it_out(case):
    (start, most, steps), expected = COUNTS[case]
    text = COUNTING.replace("STEPS", steps).replace("START", start).replace("MOST", str(most))
    _, sink = compile_v2(text.replace("UP", UP))
    messages = [
        diagnostic.message.partition(" take ")[0]
        for diagnostic in sink
        if diagnostic.rule.code == "SM428"
    ]
    assert messages == expected
    assert not [diagnostic for diagnostic in sink if diagnostic.severity == "error"]


def test_writes_name_each_other_only_where_they_can_meet():
    def sizes(number):
        steps = "".join(f"then action a{n} {{ assign n := {n % 10}; }} " for n in range(number))
        text = COUNTING.replace("STEPS", steps).replace("START", "").replace("MOST", "9")
        guarantees = find_contract(compile_v2(text)[0]).guarantees
        return [
            len(print_formula(guarantee.formula))
            for guarantee in guarantees
            if "becomes" in guarantee.text
        ]

    assert max(sizes(30)) < 1.1 * max(sizes(10))


# -- what restricts a behaviour ------------------------------------------------------------------

GATE = """package P {
    private import ScalarValues::*;
    item def Go;
    port def Inlet { in item go : Go; }
    part def Gate {
        port left : Inlet; port right : Inlet; attribute n : Integer;
        INSIDE
        exhibit state s { entry; then A; state A MEMBERS
            transition first A accept Go via left then B; state B; }
    }
}"""


def compile_gate(members, inside=""):
    """Return the guarantees of a gate, and the codes of the findings."""
    graph, sink = compile_v2(GATE.replace("MEMBERS", members).replace("INSIDE", inside))
    (contract,) = graph.derived(Contract)
    formulas = [print_formula(guarantee.formula) for guarantee in contract.guarantees]
    return formulas, [diagnostic.rule.code for diagnostic in sink]


@pytest.mark.parametrize(
    ("words", "codes"),
    [("assert constraint", ["SM488"]), ("assert not constraint", ["SM488"]), ("constraint", [])],
)
def test_only_an_asserted_constraint_of_a_state_is_missing_in_the_contract(words, codes):
    _, findings = compile_gate(f"{{ {words} {{ n > 3 }} }}")
    assert [code for code in findings if code == "SM488"] == codes


def test_a_port_at_which_a_submachine_waits_is_another_event():
    inside = "state def D { entry; then C; state C; accept Go via right then E; state E; }"
    formulas, _ = compile_gate(": D;", inside)
    assert "A_state=C & event=Go_via_right -> A_state'=E" in formulas
    assert "state=A & event=Go_via_left -> A_state'=inactive & state'=B" in formulas


@pytest.mark.parametrize("links", [("left", "right"), ("own", "own.inner")])
def test_a_port_of_two_parts_is_two_events(links):
    first, second = (f"{link}.inlet" for link in links)
    inside = f"""part def Belt {{ port inlet : Inlet; part inner : Belt; }}
        part left : Belt; part right : Belt; part own : Belt;
        exhibit state s {{ entry; then A; state A; state B;
            transition first A accept Go via {first} then B;
            transition first B accept Go via {second} then A; }}"""
    graph, _ = compile_v2(f"""package P {{ item def Go; port def Inlet {{ in item go : Go; }}
        part def Cell {{ {inside} }}
        part def Steps {{ part left : Cell; part right : Cell;
            perform action t {{ first start; then accept Go via left.{first};
                then accept Go via right.{first}; then done; }} }} }}""")
    machine, steps = graph.derived(Contract)
    moves = [print_formula(guarantee.formula) for guarantee in machine.guarantees]
    names = [f"Go_via_{path.replace('.', '_')}" for path in (first, second)]
    assert f"state=A & event={names[0]} -> state'=B" in moves
    assert f"state=B & event={names[1]} -> state'=A" in moves
    inputs = {variable.name for variable in steps.variables if variable.owner is Owner.ENVIRONMENT}
    assert inputs == {f"receive_Go_via_{side}_{links[0]}_inlet" for side in ("left", "right")}


def test_an_index_in_the_path_to_a_port_is_reported():
    text = GATE.replace("via left", "via gates#(1).left").replace(
        "INSIDE", "part gates : Gate [2];"
    )
    assert "SM481" in read(text.replace("MEMBERS", ";")).list_codes()
    assert "SM481" not in read(text.replace("MEMBERS", ";").replace("#(1)", "")).list_codes()
