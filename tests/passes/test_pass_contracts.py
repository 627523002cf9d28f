"""The pass ``contracts``: contracts of state machines and of LTL formulas in the model."""

import pytest
from pass_runs import derive_contracts, list_codes, print_conjuncts

from machine_samples import arrow, choice, machine, machine_of, region, state
from rule_examples import has_graphs, read_graphs
from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import print_text
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.printing import print_formula

analysis.load("contracts")
RULES = [
    rule
    for code, rule in catalogue().items()
    if 410 <= int(code[-3:]) < 440 or 500 <= int(code[-3:]) < 505
]


def print_formulas(contract, class_):
    """Return the guarantees of a class."""
    return [print_formula(c.formula) for c in contract.guarantees if c.class_ is class_]


WITH_GRAPHS = [rule for rule in RULES if has_graphs(rule)]
"""Rules whose examples are graphs; those in XMI or SysML v2 are compiled as files."""


@pytest.mark.parametrize("rule", WITH_GRAPHS, ids=lambda rule: rule.name)
def test_rule_reports_its_wrong_example_and_not_its_right_one(rule):
    assert rule.code in list_codes(derive_contracts(read_graphs(rule).wrong)[2])
    assert rule.code not in list_codes(derive_contracts(read_graphs(rule).right)[2])


def test_there_are_twenty_nine_rules():
    assert len(RULES) == 29


GATE = machine(
    arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"),
    arrow("b", "a", after="after 3 s"),
)


def test_guards_effects_signals_and_time_become_guarantees():
    _, (contract,), sink = derive_contracts(GATE)
    assert list_codes(sink) == []
    assert contract.component == "Plant::Gate"
    assert [(v.name, v.owner.value) for v in contract.variables] == [
        ("event", "env"),
        ("level", "sys"),
        ("state", "sys"),
        ("send_opened", "sys"),
        ("ticks_B", "sys"),
    ]
    assert contract.assumptions == ()
    assert print_formulas(contract, Class.INIT) == [
        "state=A",
        "level=0",
        "!send_opened",
        "ticks_B=0",
    ]
    assert print_formulas(contract, Class.SAFETY) == [
        "state=A & event=start & level<9 -> state'=B & level'=level + 1 & send_opened'",
        "state=B & ticks_B=2 -> state'=A",
        "!(state=A & event=start & level<9 | state=B & ticks_B=2) -> state'=state",
        "!(state=A & event=start & level<9) -> level'=level",
        "!(state=A & event=start & level<9) -> !send_opened'",
        "state=B & ticks_B!=2 & ticks_B<3 -> ticks_B'=ticks_B + 1",
        "state=B & ticks_B=3 -> ticks_B'=3",
        "!(state=B & ticks_B!=2) -> ticks_B'=0",
    ]


def test_every_conjunct_has_an_origin_and_a_sentence():
    graph, (contract,), _ = derive_contracts(GATE)
    for conjunct in contract.guarantees:
        assert conjunct.origin in graph
        assert conjunct.text.endswith(".")
    assert [c.origin for c in contract.guarantees if c.class_ is Class.SAFETY][:2] == [
        "a-b-start-9",
        "b-a",
    ]


def test_a_do_behaviour_runs_while_its_state_is_active_until_the_environment_ends_it():
    text = machine(arrow("b", "a"), arrow("a", "b", "start"))
    text = text.replace(
        'State b "B"\n',
        'State b "B"\n          -> do d\n'
        '          Activity d "mill" subkind="opaque" body="mill"\n',
    )
    _, (contract,), _ = derive_contracts(text)
    (assumption,) = contract.assumptions
    assert (assumption.class_, print_formula(assumption.formula)) == (
        Class.LIVENESS,
        "!do_mill | done_mill",
    )
    safety = print_formulas(contract, Class.SAFETY)
    assert "do_mill <-> state=B" in safety
    assert "state=B & done_mill -> state'=A" in safety


def test_inner_transitions_have_priority_over_outer_ones():
    inner_region = region("s", state("d"), state("e"), arrow("si", "d"), arrow("d", "e", "start"))
    outer_state = state("a", inner_region)
    text = machine_of(
        region("r", outer_state, state("b"), arrow("i", "a"), arrow("a", "b", "start"))
    )
    _, (contract,), _ = derive_contracts(text)
    assert "state=A & event=start & A_state!=D -> A_state'=inactive & state'=B" in print_formulas(
        contract, Class.SAFETY
    )


def test_a_choice_reads_what_the_effect_has_assigned():
    text = machine(
        choice(),
        arrow("a", "x", "start", "level < 9", "level := level + 1"),
        arrow("x", "b", guard="level == 5"),
        arrow("x", "a", guard="else"),
    )
    _, (contract,), _ = derive_contracts(text)
    assert print_formulas(contract, Class.SAFETY)[0] == (
        "state=A & event=start & level=4 -> state'=B & level'=level + 1"
    )


def test_a_choice_between_transitions_is_an_output_and_reported():
    text = machine(arrow("a", "b", "start"), arrow("a", "a", "start", effect="level := 3"))
    _, (contract,), sink = derive_contracts(text)
    assert list_codes(sink) == ["SM422"]
    assert print_formulas(contract, Class.SAFETY)[:2] == [
        "state=A & event=start & taken_A'=to_B -> state'=B",
        "state=A & event=start & taken_A'=to_A -> state'=A & level'=3",
    ]


def test_only_the_transitions_that_compete_are_listed():
    text = machine(
        arrow("a", "b", "start"),
        arrow("a", "a", "start", effect="level := 3"),
        arrow("a", "b", "stop"),
    )
    (finding,) = derive_contracts(text)[2]
    assert finding.message == (
        "transitions 'A to B', 'A to A' that leave 'A' can be enabled at once"
    )


def test_competing_transitions_of_one_name_are_told_apart():
    text = machine(arrow("a", "b", "start"), arrow("a", "b", after="3"), arrow("a", "a", "stop"))
    messages = [item.message for item in derive_contracts(text)[2] if item.rule.code == "SM432"]
    assert messages == [
        "transitions 'A to B' (when 'start' occurs), 'A to B' (when 'time_3' is "
        "reported), 'A to A' can leave 'A' in the same step; the contract leaves open which of "
        "them does"
    ]


@pytest.mark.parametrize(
    ("left", "right", "codes", "inputs"),
    [
        ("heat(level) < 2.5", "!(heat(level) < 2.5)", [], ["heat_level_2_5"]),
        ("heat(level)<2.5", "(heat(level)) >= 2.5", [], ["heat_level_2_5"]),
        ("2.5 > heat(level)", "heat(level) >= 2.5", [], ["_2_5_heat_level"]),
        ("hot(level) = true", "hot(level) <> true", [], ["hot_level"]),
        ("hot(level) && level > 2", "!hot(level)", [], ["hot_level_and_level_2", "hot_level"]),
        (
            "heat(level) < 2.5",
            "heat(level) >= 3.5",
            ["SM422"],
            ["heat_level_2_5", "heat_level_3_5"],
        ),
        ("heat(level) < 2.5", "2.5 > heat(level)", ["SM422"], ["heat_level_2_5"]),
        ("heat(level) < 2.5", "", ["SM422"], ["heat_level_2_5"]),
        ("bay is  free", "bay is free ", ["SM422"], ["bay_is_free"]),
    ],
)
def test_guards_without_formula_share_an_input_and_may_exclude_each_other(
    left, right, codes, inputs
):
    text = machine(arrow("a", "b", "start", left), arrow("a", "a", "start", right))
    _, (contract,), sink = derive_contracts(text)
    assert [code for code in list_codes(sink) if code == "SM422"] == codes
    names = [variable.name for variable in contract.variables if variable.condition]
    assert names == inputs
    is_exclusive = not codes and len(inputs) == 1
    assert is_exclusive != ("taken_A" in [variable.name for variable in contract.variables])


def test_a_condition_without_formula_may_have_another_value_after_a_choice():
    text = machine(
        choice(),
        arrow("a", "x", "start", "hot(level)", "level := 3"),
        arrow("x", "b", guard="!hot(level)"),
        arrow("x", "a", guard="hot(level)"),
    )
    _, (contract,), _ = derive_contracts(text)
    assert print_formulas(contract, Class.SAFETY)[:2] == [
        "state=A & event=start & hot_level & !hot_level_2 -> state'=B & level'=3",
        "state=A & event=start & hot_level & hot_level_2 -> state'=A & level'=3",
    ]


def change(source, target, condition):
    """Return a transition that a change triggers."""
    trigger = f'  Trigger {source}-c subkind="change" condition="{condition}"\n'
    return f"{arrow(source, target)}  -> trigger {source}-c\n{trigger}"


def test_changes_to_opposite_conditions_without_formula_read_one_input():
    text = machine(change("a", "b", "heat(level)>3"), change("b", "a", "!(heat(level) > (3))"))
    _, (contract,), sink = derive_contracts(text)
    assert [diagnostic.message.rpartition(" as ")[2] for diagnostic in sink] == [
        "the input 'heat_level_3'",
        "the negation of the input 'heat_level_3'",
    ]
    assert print_formulas(contract, Class.SAFETY)[-2:] == [
        "was_heat_level_3' <-> heat_level_3",
        "was_not_heat_level_3' <-> !heat_level_3",
    ]


def test_a_guard_that_does_not_parse_is_an_input():
    _, (contract,), sink = derive_contracts(machine(arrow("a", "b", "start", "bay is free")))
    assert list_codes(sink) == ["SM411"]
    assert "state=A & event=start & bay_is_free -> state'=B" in print_formulas(
        contract, Class.SAFETY
    )
    (variable,) = [v for v in contract.variables if v.name == "bay_is_free"]
    assert variable.owner == "env"


@pytest.mark.parametrize("kind", ["terminate", "some-day"])
def test_an_unsupported_pseudostate_is_reported_and_gives_no_contract(kind):
    text = machine(choice("h", kind), arrow("a", "h", "start"))
    _, contracts, sink = derive_contracts(text)
    assert contracts == []
    (diagnostic,) = [diagnostic for diagnostic in sink if diagnostic.rule.code == "SM420"]
    assert diagnostic.subject.id == "h"
    assert kind in diagnostic.message


def test_deferred_events_and_machines_that_contain_themselves_are_reported():
    deferred = machine(arrow("a", "b", "start")).replace(
        'State a "A"\n', 'State a "A"\n          Trigger g subkind="signal" deferred=true\n'
    )
    _, contracts, sink = derive_contracts(deferred)
    assert contracts == []
    assert any("deferral" in diagnostic.message for diagnostic in sink)
    nested = machine(arrow("a", "b", "start")).replace(
        'State a "A"\n', 'State a "A"\n          -> calls m\n'
    )
    _, contracts, sink = derive_contracts(nested)
    assert contracts == []
    assert any("submachine" in diagnostic.message for diagnostic in sink)


def test_extended_machines_are_reported():
    text = (
        machine(arrow("a", "b", "start"))
        .replace("Signal start", 'StateMachine old "Old"\n  Signal start')
        .replace('"Behaviour"\n', '"Behaviour"\n      -> redefines old\n')
    )
    _, contracts, sink = derive_contracts(text)
    assert contracts == []
    assert any("extension by 'Behaviour'" in diagnostic.message for diagnostic in sink)


def test_a_transition_out_of_the_machine_is_reported():
    text = machine(arrow("a", "k", "start"))
    _, contracts, sink = derive_contracts(text)
    assert contracts == []
    assert "SM431" in list_codes(sink)


def add_formula(body):
    text = machine(arrow("a", "b", "start"), arrow("b", "a", "stop"))
    line = f'    Constraint f "Lit" language="LTL" body="{body}"\n'
    return text.replace("    StateMachine", f"{line}    StateMachine")


@pytest.mark.parametrize(
    ("body", "side", "class_", "formula"),
    [
        ("[](<>(state=B))", "guarantees", Class.LIVENESS, "state=B"),
        ("[](state=B -> X(state=A))", "guarantees", Class.SAFETY, "state=B -> state'=A"),
        ("G F event=start", "assumptions", Class.LIVENESS, "event=start"),
        ("event=none", "assumptions", Class.INIT, "event=none"),
        ("state=A U state=B", "guarantees", Class.OTHER, "state=A U state=B"),
        (
            "[](event=start -> <>(state=B))",
            "guarantees",
            Class.OTHER,
            "G (event=start -> F state=B)",
        ),
        ("<>[](state=B)", "guarantees", Class.OTHER, "F G state=B"),
    ],
)
def test_formulas_of_the_model_are_conjuncts(body, side, class_, formula):
    _, (contract,), sink = derive_contracts(add_formula(body))
    conjunct = getattr(contract, side)[-1]
    assert (conjunct.class_, print_formula(conjunct.formula)) == (class_, formula)
    assert conjunct.origin == "f"
    assert list_codes(sink) == (["SM503"] if formula.startswith("F G") else [])


@pytest.mark.parametrize(
    ("language", "body", "guarantees"),
    [
        (
            "LTL",
            "G (state=B -> O event=start)",
            ["state=B -> event=start | since_1", "!since_1", "since_1' <-> event=start | since_1"],
        ),
        (
            "English",
            "Globally, it is always the case that if state=B holds then event=start previously "
            "held.",
            [
                "!(state=B & !(event=start | since_1))",
                "!since_1",
                "since_1' <-> event=start | since_1",
            ],
        ),
        (
            "Pattern",
            "state=B holds again and again",
            ["!(!state=B | !state=B & since_1)", None, None],
        ),
    ],
)
def test_formulas_about_the_past_get_a_history_variable(language, body, guarantees):
    text = add_formula(body).replace('language="LTL"', f'language="{language}"')
    _, (contract,), sink = derive_contracts(text)
    printed = [print_formula(c.formula) for c in contract.guarantees if c.origin == "f"]
    for formula, expected in zip(printed, guarantees, strict=True):
        assert expected in (None, formula)
    assert contract.variables[-1].name == "since_1"
    assert list_codes(sink) == []


def test_prose_in_english_is_ignored():
    text = add_formula("After start the gate should close.").replace("LTL", "English")
    _, (contract,), sink = derive_contracts(text)
    assert list_codes(sink) == []
    assert "f" not in {conjunct.origin for conjunct in contract.guarantees}


def test_a_faulty_formula_is_reported_with_its_location():
    _, _, sink = derive_contracts(add_formula("[](state=B ->\\n state=C)"))
    (message,) = [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM501"]
    assert message.endswith("'C' is neither a variable nor a literal (line 2, column 8)")


def test_formulas_of_a_requirement_are_a_contract_of_their_own():
    text = machine(arrow("a", "b", "start")) + (
        '  Class q "Answer" role="requirement"\n'
        '    Constraint f "Answer" language="SPIN" body="[](event=start -> <>{state==B})"\n'
        '  Dependency d role="satisfy"\n    -> client c\n    -> supplier q\n'
    )
    text = text.replace(
        "    -> classifier-behavior m\n", "    -> classifier-behavior m\n    -> satisfies q\n", 1
    )
    _, (behaviour, requirement), _ = derive_contracts(text)
    assert behaviour.component == "Plant::Gate"
    assert "f" not in {conjunct.origin for conjunct in behaviour.guarantees}
    assert requirement.component == "Plant::Gate.requirements"
    assert [(v.name, v.owner.value) for v in requirement.variables] == [
        ("event", "env"),
        ("state", "sys"),
    ]
    assert [conjunct.origin for conjunct in requirement.guarantees] == ["f"]
    assert print_conjuncts(requirement.guarantees) == ["other: G (event=start -> F state=B)"]


def test_the_pass_leaves_the_elements_unchanged_and_is_idempotent():
    graph, contracts, _ = derive_contracts(GATE)
    before = print_text(graph)
    analysis.load("contracts").run(graph, Sink())
    assert list(graph.derived(Contract)) == contracts
    assert print_text(graph) == before


def test_a_timer_that_never_counts_on_has_no_guarantee_that_is_just_true():
    _, (contract,), _ = derive_contracts(machine(arrow("b", "a", after="after 1 s")))
    assert "true" not in print_formulas(contract, Class.SAFETY)
    assert any("ticks_B" in formula for formula in print_formulas(contract, Class.SAFETY))
