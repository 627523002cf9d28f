"""Small models, one for each kind of behaviour: their contracts are those of the same SysML v1.

Each text of SysML v2 is written as UML, which is read again; the contracts of both say the same.
Only change triggers mean something else in UML (tests/simulation/test_change_triggers.py).
"""

import pytest

from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.printing import print_formula

STATES = "part def M {{ exhibit state life {{ entry; then s; state s; {0} }} }}"
ACTIONS = (
    "part def M {{ in attribute ok : Boolean; action w {{ first start; then {0} then done; }} }}"
)
MODELS = {
    "hierarchy, entry, exit and do": """part def M { attribute on1 : Boolean := false;
        exhibit state life { entry; then off;
            state off; transition first off accept go then run;
            state run { entry assign on1 := true; then slow; do action spin;
                exit assign on1 := false;
                state slow; state fast;
                transition first slow accept go then fast;
                transition first fast accept after 3 then slow; }
            transition first run accept stop then off; } }""",
    "regions": """part def M { exhibit state life { entry; then w; state w parallel {
            state x { entry; then x1; state x1; state x2; transition first x1 accept go then x2; }
            state y { entry; then y1; state y1; state y2; transition first y1 accept stop then y2; }
        } } }""",
    "guards and counters": """part def M { attribute n : Integer := 0;
        assert constraint { 0 <= n and n <= 5 }
        exhibit state life { entry; then s; state s; state t;
            transition first s accept go if n < 2 do assign n := n + 1 then s;
            transition first s accept go if n >= 2 then t; } }""",
    "times": STATES.format("transition first s accept after 5 [SI::s] then t; state t;"),
    "completion and ends": STATES.format("state t; transition first s accept go then done;"),
    "sending": """port def Q { out ref stop; } part def M { port q : Q;
        exhibit state life { entry; then s; state s; state t;
            transition first s accept go do send new stop() via q then t; } }""",
    "fork and join": """part def M { action w { first start; then fork f; then a; first f then b;
            action a; action b; join j; first a then j; first b then j; first j then done; } }""",
    "loops": ACTIONS.format("loop { action a; then action b; } until ok;"),
    "branches": ACTIONS.format("if ok { action a; } else { action b; }"),
    "events": ACTIONS.format("action r accept x : go; then action q send new stop();"),
    "object flow": """part def M { action w { first start; then action a { out o : Boolean; }
            then action b { in i : Boolean; } flow from a.o to b.i; then done; } }""",
    "assignments": """part def M { attribute n : Integer := 0;
        assert constraint { 0 <= n and n <= 5 }
        action w { first start; then again; merge again; then action a assign n := n + 1;
            then d; decide d; if n < 3 then again; else done; } }""",
    "several actions": """part def M { action a { first start; then action x; then done; }
        perform action main { first start; then perform a; then done; } }""",
}


def compile_contracts(model):
    """Return the contracts of a model, in any order, and its text as UML."""
    compilation = compile_model(Request((model,), backends=tuple(select_backends(["uml"]))))
    contracts = {
        contract.component: describe_contract(contract)
        for contract in compilation.graph.derived(Contract)
    }
    return contracts, next(
        output.text for output in compilation.list_published() if output.path.endswith(".uml")
    )


def describe_contract(contract):
    conjuncts = (*contract.assumptions, *contract.guarantees)
    return (
        {(variable.name, variable.owner, variable.domain) for variable in contract.variables},
        {(conjunct.class_, _sort_words(print_formula(conjunct.formula))) for conjunct in conjuncts},
        sum(conjunct.class_ is Class.SAFETY for conjunct in conjuncts),
    )


def _sort_words(formula):
    """Words of a formula: flows stand in another order where loops are drawn otherwise."""
    return tuple(sorted(formula.replace("(", "").replace(")", "").split()))


@pytest.mark.parametrize("clause", MODELS)
def test_both_notations_have_the_same_contracts(clause, tmp_path):
    original, written = tmp_path / "model.sysml", tmp_path / "model.uml"
    common = "private import ScalarValues::*; attribute def go; attribute def stop;"
    original.write_text(f"package P {{ {common} {MODELS[clause]} }}", encoding="utf-8")
    contracts, text = compile_contracts(original)
    written.write_text(text, encoding="utf-8")
    again, _ = compile_contracts(written)
    assert contracts
    assert again == contracts
