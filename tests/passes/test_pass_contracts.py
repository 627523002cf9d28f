"""The pass ``contracts``: what it stores, what it reports, and what it does not derive."""

import pytest

from machine_samples import arrow, choice, machine, machine_of, region, state
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text, print_text
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.passes import pipeline

pipeline.load("contracts")
RULES = [
    rule
    for code, rule in catalogue().items()
    if 410 <= int(code[2:]) < 440 or 500 <= int(code[2:]) < 505
]


def derived(text):
    graph, sink = parse_text(text), Sink()
    pipeline.run(graph, sink, verify_each=True)
    return graph, list(graph.derived(Contract)), sink


def codes(sink):
    return [diagnostic.rule.code for diagnostic in sink]


def formulas(contract, *classes):
    return [print_formula(c.formula) for c in contract.guarantees if c.class_ in classes]


WITH_GRAPHS = [rule for rule in RULES if rule.read_page().language == "ir"]
"""Rules whose examples are graphs; those in XMI or SysML v2 are compiled as files."""


@pytest.mark.parametrize("rule", WITH_GRAPHS, ids=lambda rule: rule.name)
def test_rule_reports_its_wrong_model_and_not_its_right_one(rule):
    assert rule.code in codes(derived(rule.read_page().wrong)[2])
    assert rule.code not in codes(derived(rule.read_page().right)[2])


def test_every_rule_is_there():
    assert len(RULES) == 28


GATE = machine(
    arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"),
    arrow("b", "a", after="after 3 s"),
)


def test_the_contract_of_a_gate():
    _, (contract,), sink = derived(GATE)
    assert codes(sink) == []
    assert contract.component == "Plant::Gate"
    assert [(v.name, v.owner.value) for v in contract.variables] == [
        ("event", "env"),
        ("level", "sys"),
        ("state", "sys"),
        ("send_opened", "sys"),
        ("ticks_B", "sys"),
    ]
    assert contract.assumptions == ()
    assert formulas(contract, Class.INIT) == [
        "state=A",
        "level=0",
        "!send_opened",
        "ticks_B=0",
    ]
    assert formulas(contract, Class.SAFETY) == [
        "state=A & event=start & level<9 -> state'=B & level'=level + 1 & send_opened'",
        "state=B & ticks_B=2 -> state'=A",
        "!(state=A & event=start & level<9 | state=B & ticks_B=2) -> state'=state",
        "!(state=A & event=start & level<9) -> level'=level",
        "!(state=A & event=start & level<9) -> !send_opened'",
        "state=B & ticks_B!=2 & ticks_B<3 -> ticks_B'=ticks_B + 1",
        "state=B & ticks_B=3 -> ticks_B'=3",
        "!(state=B & ticks_B!=2) -> ticks_B'=0",
    ]


def test_every_conjunct_names_its_element_and_says_something():
    graph, (contract,), _ = derived(GATE)
    for conjunct in contract.guarantees:
        assert conjunct.origin in graph
        assert conjunct.text.endswith(".")
    assert [c.origin for c in contract.guarantees if c.class_ is Class.SAFETY][:2] == [
        "a-b-start-9",
        "b-a",
    ]


def test_a_do_behaviour_is_done_while_its_state_is_active_and_ends_when_the_environment_says():
    text = machine(arrow("b", "a"), arrow("a", "b", "start"))
    text = text.replace(
        'State b "B"\n',
        'State b "B"\n          -> do d\n'
        '          Activity d "mill" subkind="opaque" body="mill"\n',
    )
    _, (contract,), _ = derived(text)
    (assumption,) = contract.assumptions
    assert (assumption.class_, print_formula(assumption.formula)) == (
        Class.LIVENESS,
        "!do_mill | done_mill",
    )
    safety = formulas(contract, Class.SAFETY)
    assert "do_mill <-> state=B" in safety
    assert "state=B & done_mill -> state'=A" in safety


def test_inner_transitions_go_before_outer_ones():
    inner = region("s", state("d"), state("e"), arrow("si", "d"), arrow("d", "e", "start"))
    text = machine_of(
        region("r", state("a", inner), state("b"), arrow("i", "a"), arrow("a", "b", "start"))
    )
    _, (contract,), _ = derived(text)
    assert "state=A & event=start & A_state!=D -> A_state'=inactive & state'=B" in formulas(
        contract, Class.SAFETY
    )


def test_a_choice_reads_what_the_effect_has_assigned():
    text = machine(
        choice(),
        arrow("a", "x", "start", "level < 9", "level := level + 1"),
        arrow("x", "b", guard="level == 5"),
        arrow("x", "a", guard="else"),
    )
    _, (contract,), _ = derived(text)
    assert formulas(contract, Class.SAFETY)[0] == (
        "state=A & event=start & level=4 -> state'=B & level'=level + 1"
    )


def test_what_is_left_open_stays_open_and_is_reported():
    text = machine(arrow("a", "b", "start"), arrow("a", "a", "start", effect="level := 3"))
    _, (contract,), sink = derived(text)
    assert codes(sink) == ["SM422"]
    assert formulas(contract, Class.SAFETY)[:2] == [
        "state=A & event=start & taken_A'=to_B -> state'=B",
        "state=A & event=start & taken_A'=to_A -> state'=A & level'=3",
    ]


def test_what_does_not_parse_is_an_input():
    _, (contract,), sink = derived(machine(arrow("a", "b", "start", "bay is free")))
    assert codes(sink) == ["SM411"]
    assert "state=A & event=start & bay_is_free -> state'=B" in formulas(contract, Class.SAFETY)
    (variable,) = [v for v in contract.variables if v.name == "bay_is_free"]
    assert variable.owner == "env"


@pytest.mark.parametrize("kind", ["terminate", "some-day"])
def test_what_is_not_derived_is_named_and_there_is_no_contract(kind):
    text = machine(choice("h", kind), arrow("a", "h", "start"))
    _, contracts, sink = derived(text)
    assert contracts == []
    (found,) = [diagnostic for diagnostic in sink if diagnostic.rule.code == "SM420"]
    assert found.subject.id == "h"
    assert kind in found.message


def test_deferred_events_and_machines_in_themselves_are_named():
    deferred = machine(arrow("a", "b", "start")).replace(
        'State a "A"\n', 'State a "A"\n          Trigger g subkind="signal" deferred=true\n'
    )
    _, contracts, sink = derived(deferred)
    assert contracts == []
    assert any("deferral" in one.message for one in sink)
    nested = machine(arrow("a", "b", "start")).replace(
        'State a "A"\n', 'State a "A"\n          -> calls m\n'
    )
    _, contracts, sink = derived(nested)
    assert contracts == []
    assert any("submachine" in one.message for one in sink)


def test_extended_machines_are_named():
    text = (
        machine(arrow("a", "b", "start"))
        .replace("Signal start", 'StateMachine old "Old"\n  Signal start')
        .replace('"Behaviour"\n', '"Behaviour"\n      -> redefines old\n')
    )
    _, contracts, sink = derived(text)
    assert contracts == []
    assert any("extension by 'Behaviour'" in one.message for one in sink)


def test_a_transition_out_of_the_machine_is_no_crash():
    text = machine(arrow("a", "k", "start"))
    _, contracts, sink = derived(text)
    assert contracts == []
    assert "SM431" in codes(sink)


def with_formula(body):
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
    _, (contract,), sink = derived(with_formula(body))
    conjunct = getattr(contract, side)[-1]
    assert (conjunct.class_, print_formula(conjunct.formula)) == (class_, formula)
    assert conjunct.origin == "f"
    assert codes(sink) == (["SM503"] if formula.startswith("F G") else [])


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
def test_the_past_and_sentences_get_history_bits(language, body, guarantees):
    text = with_formula(body).replace('language="LTL"', f'language="{language}"')
    _, (contract,), sink = derived(text)
    found = [print_formula(one.formula) for one in contract.guarantees if one.origin == "f"]
    assert [a for a, b in zip(found, guarantees, strict=True) if b is not None and a != b] == []
    assert contract.variables[-1].name == "since_1"
    assert codes(sink) == []


def test_prose_in_english_is_no_formula():
    text = with_formula("After start the gate should close.").replace("LTL", "English")
    _, (contract,), sink = derived(text)
    assert codes(sink) == []
    assert "f" not in {one.origin for one in contract.guarantees}


def test_a_bad_formula_is_told_with_its_place():
    _, _, sink = derived(with_formula("[](state=B ->\\n state=C)"))
    (message,) = [diagnostic.message for diagnostic in sink if diagnostic.rule.code == "SM501"]
    assert message.endswith("'C' is neither a variable nor a literal (line 2, column 8)")


def test_what_a_requirement_demands_is_a_contract_that_the_behaviour_implements():
    text = machine(arrow("a", "b", "start")) + (
        '  Class q "Answer" role="requirement"\n'
        '    Constraint f "Answer" language="SPIN" body="[](event=start -> <>{state==B})"\n'
        '  Dependency d role="satisfy"\n    -> client c\n    -> supplier q\n'
    )
    text = text.replace(
        "    -> classifier-behavior m\n", "    -> classifier-behavior m\n    -> satisfies q\n", 1
    )
    _, (behaviour, demanded), _ = derived(text)
    assert (behaviour.component, demanded.component) == ("Plant::Gate", "Plant::Gate.requirements")
    assert "f" not in {one.origin for one in behaviour.guarantees}
    assert [(v.name, v.owner.value) for v in demanded.variables] == [
        ("event", "env"),
        ("state", "sys"),
    ]
    assert [
        (one.origin, one.class_, print_formula(one.formula)) for one in demanded.guarantees
    ] == [("f", Class.OTHER, "G (event=start -> F state=B)")]


def test_twice_equals_once_and_the_graph_stays_as_it_is():
    graph, contracts, _ = derived(GATE)
    before = print_text(graph)
    pipeline.load("contracts").run(graph, Sink())
    assert list(graph.derived(Contract)) == contracts
    assert print_text(graph) == before
