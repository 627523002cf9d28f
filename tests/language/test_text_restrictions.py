"""Which members, prefixes and tails go with which declaration: one case for each."""

from itertools import pairwise

import pytest
from tree_outlines import parse_with_diagnostics

OWNERS = {
    "subject s;": ("a subject", "requirement", "case"),
    "actor a;": ("an actor", "requirement", "case"),
    "stakeholder a;": ("a stakeholder", "requirement", "concern"),
    "objective o;": ("an objective", "case", "verification"),
    "assume constraint c;": ("an 'assume' or 'require' constraint", "requirement"),
    "require constraint c;": ("an 'assume' or 'require' constraint", "requirement"),
    "frame concern c;": ("'frame'", "requirement"),
    "verify requirement r;": ("'verify'", "requirement"),
    "render rendering r;": ("'render'", "view"),
    "entry;": ("an 'entry', 'do' or 'exit' action", "state", "exhibit"),
    "do a;": ("an 'entry', 'do' or 'exit' action", "state"),
    "exit;": ("an 'entry', 'do' or 'exit' action", "state"),
    "1 + 1": ("an expression", "calc", "constraint"),
    "return r;": ("'return'", "calc", "case"),
    "expose A::*;": ("'expose'", "view"),
    "expose A;": ("'expose'", "view"),
    "filter @A;": ("a filter", "package", "view", "view def"),
    "transition first a then b;": ("a transition", "state", "action"),
}
"""For each restricted member: what the message calls it, and keywords of usages that may own it."""
STEPS = (
    *("accept e;", "send e;", "assign a := 1;", "terminate;", "if a { }", "while a { }"),
    *("for i in 1..2 { }", "merge m;", "decide m;", "join m;", "fork m;", "first a;"),
)


def list_messages(text, language="sysml"):
    return [line.split(" ", 1)[1] for line in parse_with_diagnostics(text, language)[1]]


@pytest.mark.parametrize("member", OWNERS)
def test_a_member_belongs_in_the_bodies_of_some_kinds(member):
    what, *owners = OWNERS[member]
    assert list_messages(f"part p {{ {member} }}") == [f"SM195 {what} is not allowed in 'p'"]
    for owner in owners:
        assert list_messages(f"{owner} p {{ {member} }}") == [], owner


def test_a_file_may_have_a_filter_and_no_subject():
    assert list_messages("filter @A;") == []
    assert list_messages("filter true;", "kerml") == []
    assert list_messages("subject s;") == ["SM195 a subject is not allowed outside of any body"]


@pytest.mark.parametrize("step", STEPS)
def test_a_step_belongs_in_an_action(step):
    assert list_messages(f"part p {{ {step} }}") == [
        "SM195 a step of an action is not allowed in 'p'"
    ]
    assert list_messages(f"action p {{ {step} }}") == []


IN_ORDER = {
    "sysml": (
        *("end", "in", "derived", "abstract", "constant", "ref", "individual", "snapshot"),
        "#m",
    ),
    "kerml": ("member", "end", "in", "derived", "abstract", "composite", "var", "#m"),
}
EXCLUDING = {
    "sysml": (
        *("in out", "out in", "inout in", "abstract variation", "variation abstract"),
        *("snapshot timeslice", "timeslice snapshot"),
    ),
    "kerml": ("composite portion", "portion composite", "var const", "const var"),
}
KEYWORDS = {"sysml": "part", "kerml": "feature"}


@pytest.mark.parametrize("language", IN_ORDER)
def test_prefixes_have_one_order(language):
    keyword, prefixes = KEYWORDS[language], IN_ORDER[language]
    assert list_messages(f"{' '.join(prefixes)} {keyword} p;", language) == []
    for first, second in pairwise(prefixes):
        words = [word.replace("#m", "metadata") for word in (first, second)]
        messages = list_messages(f"{second} {first} {keyword} p;", language)
        assert messages == [f"SM196 '{words[0]}' stands after '{words[1]}'"]


@pytest.mark.parametrize("language", EXCLUDING)
def test_some_prefixes_exclude_one_another(language):
    for pair in EXCLUDING[language]:
        first, second = pair.split()
        messages = list_messages(f"{pair} {KEYWORDS[language]} p;", language)
        assert messages == [f"SM196 '{second}' and '{first}' exclude one another"]


@pytest.mark.parametrize(
    ("declaration", "description"),
    [
        ("comment /* a */", "a comment"),
        ("doc /* a */", "documentation"),
        ('rep language "c" /* a */', "a representation"),
        ("dependency from a to b;", "a dependency"),
        ("alias a for b;", "an alias"),
        ("import A;", "an import"),
        ("import A::*;", "an import"),
        ("expose A;", "'expose'"),
        ("expose A::*;", "'expose'"),
        ("metadata m;", "metadata"),
        ("package A;", "a package"),
        ("part def A;", "a definition"),
    ],
)
def test_some_declarations_have_no_prefix_of_usages(declaration, description):
    assert f"SM196 'ref' cannot stand before {description}" in list_messages(f"ref {declaration}")


@pytest.mark.parametrize(
    "keyword",
    [
        *("type", "classifier", "datatype", "class", "struct", "metaclass", "assoc"),
        *("assoc struct", "interaction", "behavior", "function", "predicate"),
    ],
)
def test_a_type_of_kerml_may_be_abstract_and_nothing_else(keyword):
    assert list_messages(f"abstract {keyword} A;", "kerml") == []
    messages = list_messages(f"derived {keyword} A;", "kerml")
    assert messages == ["SM196 'derived' cannot stand before this declaration"]


def test_metadata_of_kerml_has_no_prefix():
    messages = list_messages("derived metadata m;", "kerml")
    assert messages == ["SM196 'derived' cannot stand before metadata"]


@pytest.mark.parametrize(
    ("tail", "word", "keywords"),
    [
        ("connect a to b", "'connect' goes with connections", "connection interface"),
        ("allocate a to b", "'allocate' goes with allocations", "allocation"),
        ("bind a = b", "'bind' goes with bindings", "binding"),
        ("first a then b", "'first' goes with successions", "succession"),
        ("of a", "'of' goes with flows", "flow message"),
        ("from a to b", "'from' goes with flows", "flow message"),
        ("accept e", "what an action does goes with actions", "action"),
    ],
)
def test_a_tail_goes_with_its_declarations(tail, word, keywords):
    (message,) = list_messages(f"action p {{ part x {tail}; }}")
    assert message.startswith(f"SM199 {word}")
    for keyword in keywords.split():
        assert list_messages(f"action p {{ {keyword} x {tail}; }}") == []


@pytest.mark.parametrize(
    ("tail", "keywords"),
    [
        ("of a", ("flow", "succession flow")),
        ("from a to b", ("flow", "succession flow", "connector")),
        ("first a then b", ("succession",)),
    ],
)
def test_a_tail_of_kerml_goes_with_its_declarations(tail, keywords):
    (message,) = list_messages(f"feature x {tail};", "kerml")
    assert message.startswith("SM199")
    for keyword in keywords:
        assert list_messages(f"{keyword} x {tail};", "kerml") == []


@pytest.mark.parametrize("head", ["constraint", "assert", "assume", "require"])
def test_an_equals_sign_in_a_condition_compares(head):
    messages = list_messages(f"requirement r {{ {head} c {{ n = 3 }} }}")
    assert messages == ["SM190 unexpected '='; expected '=='"]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("first a -> b;", "then"),
        ("succession s first a -> b;", "then"),
        ("transition a -> b;", "then"),
        ("connect a -> b;", "to"),
        ("connection c connect a and b;", "to"),
        ("flow from a -> b;", "to"),
        ("interface a -> b;", "to"),
        ("message from a -> b;", "to"),
    ],
)
def test_an_arrow_is_read_as_the_word_between_both_ends(text, word):
    (message,) = list_messages(f"action p {{ {text} }}")
    assert message.endswith(f"expected '{word}'")


@pytest.mark.parametrize("word", ["entry", "do", "exit"])
def test_the_steps_of_a_state_stand_in_an_action(word):
    (message,) = list_messages(f"state s {{ {word} {{ }} }}")
    assert message == "SM190 unexpected '{'; expected 'action'"


@pytest.mark.parametrize(
    "prefix",
    [
        *("private", "protected", "public", "in", "out", "inout", "abstract", "derived"),
        *("constant", "ref", "end"),
    ],
)
def test_a_word_of_another_language_may_have_prefixes(prefix):
    (message,) = list_messages(f"part p {{ {prefix} property x; }}")
    assert message == "SM190 unexpected name 'property'; expected 'attribute'"
