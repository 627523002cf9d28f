"""Guards and effects that the standard allows, but a contract cannot express, are no errors."""

import pytest
from pass_runs import derive_contracts

from sysmlc.logic.printing import print_formula

TEXTS_OF_A_TRANSITION = """\
Package p "Plant"
  Class c "Gate"
    -> classifier-behavior m
    Property door "door" aggregation="composite"
      -> typed-by d
    Property count "count"
      -> typed-by int
    Constraint k body="count >= 0 and count <= 15"
    Property total "total"
      -> typed-by int
    Constraint l body="total * total >= 0"
    Property weight "weight"
      -> typed-by real
    Property word "word"
      -> typed-by text
    Operation fill "fill"
      Parameter amount "amount" direction="in"
    StateMachine m "Behaviour"
      Region r
        Pseudostate i subkind="initial"
        State a "A"
        Transition t0
          -> flow-source i
          -> flow-target a
        Transition t1 {guard}
          -> flow-source a
          -> flow-target a
          -> trigger tr
          -> effect e
          Trigger tr subkind="call"
            -> typed-by fill
          Activity e subkind="opaque" body="{effect}"
  Class d "Door"
    Property open "open"
      -> typed-by bool
    Property most "MOST" default=7 static=true
      -> typed-by int
  Association s "opens"
    -> end s.gate s.key
    Property s.gate "gate"
      -> typed-by c
    Property s.key "key"
      -> typed-by d
  DataType bool "Boolean"
  DataType int "Integer"
  DataType real "Real"
  DataType text "String"
"""


def list_text_findings(
    guard="count > 3", effect="count := 1", language="", model=TEXTS_OF_A_TRANSITION
):
    """Return the findings about a guard and an effect, except the assumed range."""
    attributes = f'guard="{guard}"' + (f' guard_language="{language}"' if language else "")
    text = model.replace("{guard}", attributes).replace("{effect}", effect)
    _, _, sink = derive_contracts(text)
    return [
        f"{diagnostic.rule.code}: {diagnostic.message}"
        for diagnostic in sink
        if diagnostic.rule.code not in ("SM410", "SM428")
    ]


@pytest.mark.parametrize(
    ("guard", "language", "reason"),
    [
        ("key.open", "OCL", "'key.open' is a feature of 'Door'"),
        ("count < Door::MOST", "OCL", "'Door::MOST' is a feature of 'Door'"),
        ("amount > 3", "", "'amount' is a feature of 'fill'"),
        ("total > 300", "OCL", "300 is outside 0..15, a range that is assumed"),
        ("word = 'open'", "OCL", "'open' in single quotes is not a text here"),
        ("ready", "English", "'ready' is not known, and names in English are not checked"),
        ("count > LIMIT", "Java", "'LIMIT' is not known, and names in Java are not checked"),
    ],
)
def test_a_guard_that_a_contract_cannot_express_is_no_error(guard, language, reason):
    (finding,) = list_text_findings(guard=guard, language=language)
    assert finding.startswith(f"SM411: guard '{guard}' has no formula: {reason}; ")


def test_a_word_without_a_language_is_a_condition_in_words():
    (finding,) = list_text_findings(guard="ready")
    assert finding == (
        "SM411: guard 'ready' has no formula: the word 'ready' is no feature of 'Gate'; "
        "the contract treats it as the input 'ready'"
    )


LANGUAGES = ["", "C", "C++", "Java", "JavaScript", "Python", "OCL", "Modelica", "English"]


def read_guard(guard, language=""):
    """Return the formula of a guard as the contract has it."""
    model = TEXTS_OF_A_TRANSITION.replace("  DataType bool", MODES + "  DataType bool")
    model = model.replace('    Property word "word"', FEATURES + '    Property word "word"')
    assert list_text_findings(guard=guard, language=language, model=model) == []
    attributes = f'guard="{guard}" guard_language="{language}"'
    text = model.replace("{guard}", attributes).replace("{effect}", "count := 1")
    _, (contract,), _ = derive_contracts(text)
    step = next(c for c in contract.guarantees if c.origin == "t1")
    condition, _, _ = print_formula(step.formula).partition(" -> ")
    return condition.removeprefix("state=A & ").removeprefix("event=fill & ")


FEATURES = """\
    Property ready "ready"
      -> typed-by bool
    Property mode "mode"
      -> typed-by modes
"""
MODES = """\
  Enumeration modes "Modes"
    EnumerationLiteral auto "auto"
    EnumerationLiteral off "off"
"""


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize(
    ("guard", "formula"),
    [
        ("count < 8 && !ready", "count<8 & !ready"),
        ("count <> 3 and not ready", "count!=3 & !ready"),
        ("not ready or count = 3", "(!ready | count=3)"),
        ("!(count >= 3) || mode == Modes::auto", "(count<3 | mode=auto)"),
        ("ready == True", "ready"),
        ("ready && !False", "ready"),
        ("not (mode = auto) AND ready", "mode!=auto & ready"),
    ],
)
def test_a_plain_condition_is_read_in_any_language(guard, formula, language):
    assert read_guard(guard, language) == formula


@pytest.mark.parametrize(
    ("guard", "formula"),
    [
        ("not count < 3", "count>=3"),
        ("not count + 1 < 3", "count + 1>=3"),
        ("ready and not mode == auto", "ready & mode!=auto"),
        ("1 < count <= 3", "1<count & count<=3"),
        ("not 1 < count <= 3", "!(1<count & count<=3)"),
    ],
)
def test_comparisons_in_python_are_read_as_in_python(guard, formula):
    assert read_guard(guard, "Python") == formula


@pytest.mark.parametrize("language", ["", "C", "OCL"])
@pytest.mark.parametrize(
    ("guard", "advice"),
    [
        ("not count < 3", "'count' is a number, not a condition; write 'not (count < 3)'"),
        ("!count == 3 && f(1)", "'count' is a number, not a condition; write 'not (count == 3) "),
        ("not f(1) > 3", "calls such as 'f(1)' are not evaluated; write 'not (f(1) > 3)'"),
    ],
)
def test_not_before_a_comparison_needs_parentheses(guard, advice, language):
    (finding,) = list_text_findings(guard=guard, language=language)
    assert advice in finding
    assert "if 'not' is about the comparison" in finding


@pytest.mark.parametrize(("guard", "language"), [("cuont", ""), ("redy > 3", ""), ("ready", "OCL")])
def test_a_misspelt_property_and_a_name_in_an_expression_are_errors(guard, language):
    (finding,) = list_text_findings(guard=guard, language=language)
    assert finding.startswith(f"SM412: guard '{guard}' names ")


def test_a_guard_and_an_effect_may_name_a_feature_of_a_part():
    assert list_text_findings(guard="door.open", effect="door.open := false") == []


@pytest.mark.parametrize("guard", ["door.opne", "Door::LEAST > 3", "amuont > 3", "limit > count"])
def test_a_guard_that_names_nothing_is_an_error(guard):
    (finding,) = list_text_findings(guard=guard, language="OCL")
    assert finding.startswith(f"SM412: guard '{guard}' names ")


@pytest.mark.parametrize(
    ("effect", "reason"),
    [
        ("count := amount", "'amount' is a feature of 'fill'"),
        ("total := 300", "300 is outside 0..15, a range that is assumed"),
        ("weight := 3", "'weight' has no finite type"),
        ("key.open := true", "'key.open' is a feature of 'Door'"),
    ],
)
def test_an_effect_that_a_contract_cannot_express_is_no_error(effect, reason):
    (finding,) = list_text_findings(effect=effect)
    assert finding.startswith(f"SM416: effect '{effect}' is not understood: {reason}; ")


@pytest.mark.parametrize("multiplicity", ["3", "0..*", "2..4"])
def test_a_feature_with_several_values_is_no_variable(multiplicity):
    declaration = 'Property count "count"'
    model = TEXTS_OF_A_TRANSITION.replace(
        declaration, f'{declaration} multiplicity="{multiplicity}"'
    )
    guard, effect = list_text_findings(model=model)
    assert guard.startswith("SM411: guard 'count > 3' has no formula: 'count' has several values; ")
    assert effect.startswith("SM416: effect 'count := 1' is not understood: 'count' has several v")


@pytest.mark.parametrize("multiplicity", ["1", "0..1"])
def test_a_feature_with_one_value_is_a_variable(multiplicity):
    declaration = 'Property count "count"'
    model = TEXTS_OF_A_TRANSITION.replace(
        declaration, f'{declaration} multiplicity="{multiplicity}"'
    )
    assert list_text_findings(model=model) == []


@pytest.mark.parametrize(
    ("effect", "code"), [("count := amuont", "SM412"), ("cuont := 3", "SM415")]
)
def test_an_effect_that_names_nothing_is_an_error(effect, code):
    (finding,) = list_text_findings(effect=effect)
    assert finding.startswith(f"{code}: ")


WITHOUT_TEXTS = """\
Package p "P"
  Class c "Cell" role="block"
    StateMachine m "M"
      Region r "r"
        Pseudostate i "i" subkind="initial"
        State a "A"
          -> entry e
          Activity e "" subkind="opaque" body=""
        State b "B"
        Transition t0
          -> flow-source i
          -> flow-target a
        Transition t1 guard=""
          -> flow-source a
          -> flow-target b
          -> trigger g1
          Trigger g1 subkind="time" when=""
        Transition t2 guard=""
          -> flow-source b
          -> flow-target a
          -> trigger g2
          -> effect ef
          Trigger g2 subkind="change" condition=""
          Activity ef "" subkind="opaque" body=" "
    Activity w "work"
      Constraint k body="" subkind="precondition"
      Control w1 "start" subkind="initial"
      Action w2 "x" subkind="accept"
        -> trigger g3
        Trigger g3 subkind="change" condition=""
      Control w3 "done" subkind="final"
      ControlFlow f1 guard=""
        -> flow-source w1
        -> flow-target w2
      ControlFlow f2 guard=""
        -> flow-source w2
        -> flow-target w3
    Operation op
      Constraint k2 body=" " subkind="postcondition"
"""


def test_no_message_quotes_a_text_that_is_empty():
    sink = derive_contracts(WITHOUT_TEXTS)[2]
    messages = {diagnostic.rule.code: diagnostic.message for diagnostic in sink}
    assert {"SM411", "SM417", "SM458", "SM468", "SM505"} <= set(messages)
    assert [message for message in messages.values() if "''" in message] == []
