"""Syntax errors: each is reported once, at its location, and the parser reads the rest."""

import random
from codecs import BOM_UTF8

import pytest
from tree_outlines import list_advice, list_diagnostics, parse_outline, parse_with_diagnostics

from sysmlc.diagnostics import Sink
from sysmlc.language.text import parse, rules
from sysmlc.sources import Source

EXAMPLES = [
    rules.SYNTAX,
    rules.MISSING,
    rules.KEYWORD,
    rules.UNCLOSED,
    rules.CHARACTER,
    rules.PLACE,
    rules.PREFIX,
    rules.VISIBILITY,
    rules.COMBINATION,
]


@pytest.mark.parametrize("rule", EXAMPLES, ids=lambda rule: rule.code)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule):
    assert [line.split()[1] for line in list_diagnostics(rule.read_page().wrong)] == [rule.code]
    assert list_diagnostics(rule.read_page().right) == []


def test_sm190_names_the_unexpected_and_the_expected_token():
    tree, messages = parse_with_diagnostics("part a : ; part b = 1 +; part c;")
    assert messages == [
        "1:10 SM190 unexpected ';'; expected a name",
        "1:24 SM190 unexpected ';'; expected an expression",
    ]
    assert tree == [
        "OwningMembership PartUsage a",
        "OwningMembership PartUsage b",
        "  FeatureValue (=) LiteralInteger value=1",
        "OwningMembership PartUsage c",
    ]


def test_the_body_behind_a_faulty_head_is_read():
    tree, messages = parse_with_diagnostics("part a : : B { part c; part d : ; } part e;")
    assert messages == [
        "1:10 SM190 unexpected ':'; expected a name",
        "1:33 SM190 unexpected ';'; expected a name",
    ]
    assert tree == [
        "OwningMembership PartUsage a",
        "  FeatureMembership PartUsage c",
        "  FeatureMembership PartUsage d",
        "OwningMembership PartUsage e",
    ]


def test_sm191_a_missing_semicolon_is_reported_where_it_belongs():
    tree, messages = parse_with_diagnostics("part a : A\npart b { part c }\npart d")
    assert messages == [
        "1:10 SM191 ';' is missing after 'A'",
        "2:15 SM191 ';' is missing after 'c'",
        "3:6 SM191 ';' is missing after 'd'",
    ]
    assert len(tree) == 4


def test_sm191_a_missing_bracket_is_inserted():
    assert list_diagnostics("attribute a = (1 + 2;") == ["1:20 SM191 ')' is missing after '2'"]
    assert list_diagnostics("part b[2;") == ["1:8 SM191 ']' is missing after '2'"]


def test_sm192_a_keyword_in_place_of_a_name_is_read_as_the_name():
    tree, messages = parse_with_diagnostics("part def Cell { port in : Input; attribute end = 3; }")
    assert messages == [
        "1:22 SM192 'in' is a keyword of SysML; expected a name",
        "1:44 SM192 'end' is a keyword of SysML; expected a name",
    ]
    assert "  FeatureMembership PortUsage in FeatureTyping->Input" in tree
    assert parse_outline("port 'in' : Input;") == [
        "OwningMembership PortUsage in FeatureTyping->Input"
    ]
    assert parse_outline("port step;") == ["OwningMembership PortUsage step"]


def test_a_binding_in_place_of_an_assignment_is_reported():
    text = "action a { assign x = 1; } attribute y := 2;"
    assert list_diagnostics(text) == ["1:21 SM190 unexpected '='; expected ':='"]
    assert "':='" in list_advice(text)[0]


def test_sm193_the_innermost_open_brace_is_reported_once():
    assert list_diagnostics("part a { part b { part c; }") == ["1:8 SM193 this '{' is never closed"]
    assert list_diagnostics("part a { part b { part c; ") == ["1:17 SM193 this '{' is never closed"]


def test_sm193_unclosed_comments_and_quotes_are_reported():
    assert list_diagnostics("part a; /* b") == ["1:9 SM193 this comment is never closed"]
    assert list_diagnostics("part 'a b : C;\npart d;") == [
        "1:6 SM193 this name in quotes is never closed"
    ]
    assert parse_with_diagnostics("part 'abc;")[0] == ["OwningMembership PartUsage abc"]
    assert list_diagnostics('attribute a = "b;') == ["1:15 SM193 this string is never closed"]


def test_sm194_letters_that_need_quotes_are_reported_at_their_location():
    assert list_diagnostics("part ä : Ö;") == [
        "1:6 SM194 unexpected character 'ä'",
        "1:10 SM194 unexpected character 'Ö'",
    ]
    assert parse_outline("part 'ä' : 'Ö'; /* ü */ // ß") == [
        "OwningMembership PartUsage ä FeatureTyping->Ö",
        "OwningMembership Comment body=ü ",
    ]


def test_sm194_a_number_beyond_the_range_of_floats_is_reported():
    assert list_diagnostics("attribute a = 1e999;") == ["1:15 SM194 '1e999' is too large a number"]
    assert list_diagnostics("attribute a = 1e300;") == []


def test_a_comment_within_a_declaration_is_reported_with_the_notation_of_a_note():
    tree, messages = parse_with_diagnostics("part a /* b */ : C;")
    assert messages == ["1:8 SM190 unexpected comment; expected a note (// or //*)"]
    assert tree == ["OwningMembership PartUsage a FeatureTyping->C"]
    assert "//* ... */" in list_advice("part a /* b */ : C;")[0]


def test_a_superfluous_symbol_is_reported_and_skipped():
    tree, messages = parse_with_diagnostics("part a;; } part b;")
    assert messages == [
        "1:8 SM190 unexpected ';'; expected a declaration or '}'",
    ]
    assert len(tree) == 2


def test_a_misspelt_keyword_is_corrected_in_the_advice():
    assert list_advice("attribut x : T;") == [
        "'attribut' is not a keyword: did you mean 'attribute'?"
    ]


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("attribute a = 3 kg;", "units stand in brackets: 3 [kg]"),
        ("enum def E { a, b; }", "members end with ';', they are not separated by commas"),
        ("part def A extends B;", "write ':>' or 'specializes' before a general type"),
        ("attribute a = if b then c else d;", "question mark: if a ? b else c"),
        ("action def Fill(in fuel : F, out level : L);", "of the body: { in fuel; }"),
        ("calc def Double(x) { x }", "of the body: { in x; }"),
        ("part p { connect a.p[1] to b.p; }", "before the end: [0..1] a"),
        ("private import ISQ::TorqueValue as Torque;", "alias Torque for ...;"),
        ("private import ISQ.*;", "names of packages are joined by '::'"),
        ("action a { succession b then c; }", "succession first b then ..."),
        ("state s { transition b to c; }", "transition first b then ..."),
        ("state s { transition t first b then c when x; }", "write 'accept when c'"),
        ("calc def F { return x * 2; }", "declares the result: return r = ...;"),
        ("part p { assert x > 5; }", "in braces: assert constraint { x > 0 }"),
        ("part p { connect a with b; }", "joined by 'to': connect a to b"),
        ("block Gate;", "'block' is not a keyword: a block is a 'part def'"),
        ("part p { value x : Real; }", "'attribute' is meant"),
        ("action a { stream b.x to c.y; }", "'flow' is meant: flow from a.x to b.y"),
        ("attribute a = b && c;", "conditions are joined by 'and'"),
        ("attribute a = b || c;", "conditions are joined by 'or'"),
        ("attribute a = b ? c : d;", "starts with 'if': if a ? b else c"),
        ("action a { if b = 3 then c; }", "'==' compares two values"),
        ("attribute a == 3;", "'==' compares two values; ':=' gives an initial value"),
        ("constraint c { a > b; }", "without ';' at the end of the body"),
        ('requirement r { doc "text"; }', "between /* and */"),
        ("part p { connect a -> b; }", "joined by 'to': a to b"),
        ("part p { port in q; }", "write the direction before the kind: in port"),
        ("part def A specialises B;", "did you mean 'specializes'?"),
        ("feature f;", "in SysML a feature is a 'ref'"),
    ],
)
def test_the_advice_about_a_common_mistake_shows_the_right_notation(text, advice):
    assert advice in list_advice(text)[0]


def test_a_comparison_in_place_of_a_binding_is_read_as_a_binding():
    tree, messages = parse_with_diagnostics("attribute a == 3;")
    assert messages == ["1:13 SM190 unexpected '=='; expected '='"]
    assert tree[1] == "  FeatureValue (=) LiteralInteger value=3"


@pytest.mark.parametrize("text", ["part a b;", "part p { connect a b; }"])
def test_an_error_that_is_no_common_mistake_has_no_advice(text):
    assert list_advice(text) == [""]


def test_the_advice_about_parameters_in_parentheses_fits_kerml_too():
    assert list_advice("feature f { expr s(x) : Boolean; }", "kerml") == [
        "parameters are members of the body: { in x; }"
    ]


@pytest.mark.parametrize("text", ["action def A (", "action def A (in", "private import A as"])
def test_a_common_mistake_at_the_end_of_a_text_has_advice(text):
    assert list_advice(text)


def test_a_word_that_is_right_elsewhere_is_not_called_a_mistake():
    assert "not a keyword" not in "".join(list_advice("class Gate { value : Real ; ] }", "kerml"))


def test_sm195_members_are_allowed_only_in_the_owners_that_give_them_a_meaning():
    assert list_diagnostics("part p { entry; return x; x + 1 }") == [
        "1:10 SM195 an 'entry', 'do' or 'exit' action is not allowed in 'p'",
        "1:17 SM195 'return' is not allowed in 'p'",
        "1:27 SM195 an expression is not allowed in 'p'",
    ]
    assert list_diagnostics("state s { entry; } calc c { return x; x + 1 }") == []
    assert list_diagnostics("enum def E { a; part b; }") == [
        "1:17 SM195 a member that is not an enumerated value is not allowed in 'E'"
    ]


def test_sm196_prefixes_have_an_order_and_a_meaning():
    assert list_diagnostics("abstract in item a; in out item b; standard part c;") == [
        "1:10 SM196 'in' stands after 'abstract'",
        "1:24 SM196 'out' and 'in' exclude one another",
        "1:36 SM196 'standard' cannot stand before this declaration",
    ]
    assert (
        list_diagnostics("standard library package P { in abstract ref item a; end item b; }") == []
    )
    assert list_diagnostics("const end feature a; abstract class B;", "kerml") == []


@pytest.mark.parametrize(
    ("text", "word", "keyword"),
    [
        ("prt def A { attribute x; } part a : A;", "prt", "part"),
        ("prat a; part b = a;", "prat", "part"),
        ("abstract prot p { in item x; }", "prot", "port"),
        (
            "requirment def R { subject s; require constraint { true } }",
            "requirment",
            "requirement",
        ),
        ("pakage P { part a; }", "pakage", "package"),
    ],
)
def test_a_misspelt_keyword_is_one_error_and_is_read_as_the_keyword(text, word, keyword):
    column = text.index(word) + 1
    assert list_diagnostics(text) == [f"1:{column} SM190 unexpected '{word}'; expected '{keyword}'"]
    assert list_diagnostics(text.replace(word, keyword)) == []


def test_a_very_long_word_is_not_compared_with_keywords():
    (diagnostic,) = list_diagnostics(f"{'p' * 100_000}art def A;")
    assert "SM191" in diagnostic


def test_a_word_that_resembles_no_keyword_is_no_misspelt_one():
    assert list_diagnostics("part def A { foo bar; }") == [
        "1:18 SM190 unexpected name 'bar'; expected ';', '{', '}', '::' or something else"
    ]


def test_sm197_every_import_needs_a_visibility():
    assert list_diagnostics("import A::*; public import B; package P { import C::**; }") == [
        "1:1 SM197 the import has no visibility and is read as 'public import'",
        "1:43 SM197 the import has no visibility and is read as 'public import'",
    ]


def test_sm198_text_nested_more_than_200_levels_deep_is_not_read():
    fits, deep = ("part p { " * n + "}" * n for n in (200, 201))
    assert list_diagnostics(fits) == []
    assert list_diagnostics(deep) == [
        "1:1808 SM198 this is nested more than 200 levels deep and is not read"
    ]


@pytest.mark.parametrize(
    "text",
    [
        "part p {" * 10_000,
        "a = " + "(" * 10_000,
        "a = " + "- " * 10_000 + "1;",
        "a = 1" + "+1" * 9_999,
    ],
    ids=["braces", "parentheses", "signs", "sums"],
)
def test_sm198_ten_thousand_levels_are_one_diagnostic(text):
    assert [line.split()[1] for line in list_diagnostics(text) if "SM191" not in line] == ["SM198"]


def test_a_long_chain_of_operators_is_not_nested():
    for operators in (" + ", " - "), (" and ",), (" * ", " / "):
        chain = "x" + "".join(operators[n % len(operators)] + "x" for n in range(1_000))
        sink = Sink()
        parse(f"attribute x; attribute a = {chain};", "m.sysml", "sysml", sink)
        assert list(sink) == []


def test_sm198_chains_of_operators_in_parentheses_are_nested():
    deep = "1 + 2 * (" * 101 + "1" + ")" * 101
    assert [line.split()[1] for line in list_diagnostics(f"attribute a = {deep};")] == ["SM198"]


def test_a_long_sequence_is_not_nested():
    document = parse(f"attribute a = ({'1, ' * 3_000}1);", "m.sysml", "sysml", Sink())
    literals = [node for node in document.root.walk() if node.kind == "LiteralInteger"]
    assert len(literals) == 3_001


def test_sm199_a_clause_of_another_kind_of_usage_is_reported():
    assert [
        line.split()[1] for line in list_diagnostics("part a connect b to c; connect b to c;")
    ] == ["SM199"]


def test_sm199_only_states_are_parallel():
    assert list_diagnostics("state s parallel { } state def T parallel { }") == []
    assert list_diagnostics("part p parallel { }") == [
        "1:1 SM199 'parallel' goes with states, not with this declaration"
    ]


def test_one_line_has_one_syntax_error_at_most():
    assert len(list_diagnostics("part a : b c d e f g;\n" * 3)) == 3


def test_the_first_hundred_syntax_errors_of_a_file_are_reported():
    assert len(list_diagnostics("part a : ;\n" * 1_000)) == 100


def test_the_hundredth_syntax_error_has_a_note_about_the_limit():
    sink = Sink()
    parse("part a : ;\n" * 1_000, "a.sysml", "sysml", sink)
    notes = ("of one file no more than 100 syntax errors are reported",)
    assert [diagnostic.notes for diagnostic in sink] == [()] * 99 + [notes]


@pytest.mark.parametrize("text", ["", " \n", "// nothing", "\ufeff"])
def test_an_empty_text_is_valid(text):
    assert parse_outline(text) == []


@pytest.mark.parametrize("marks", [0, 1, 2])
def test_an_error_is_located_at_its_byte_after_any_byte_order_marks(marks):
    source = Source("a.sysml", BOM_UTF8 * marks + b"part a : ;")
    sink = Sink()
    parse(source.data.decode("utf-8-sig"), source.name, "sysml", sink, source)
    assert [error.subject.place.offset for error in sink] == [source.data.index(b";")]


def test_a_file_in_another_encoding_has_one_diagnostic():
    text = "package P { part x; }".encode("utf-16").decode("utf-8", "replace")
    assert list_diagnostics(text) == ["1:1 SM194 the file is not text in UTF-8"]


def test_a_binary_file_has_one_diagnostic():
    for seed in range(20):
        text = random.Random(seed).randbytes(3_000).decode("utf-8", "replace")
        assert list_diagnostics(text) == ["1:1 SM194 the file is not text in UTF-8"]


def test_a_few_control_characters_are_reported_one_by_one():
    text = "package P { part x\x01; part y\x02; }"
    assert [line.split()[1] for line in list_diagnostics(text)] == ["SM194", "SM194"]


@pytest.mark.parametrize("text", ["\0", "\ufffd\ufffd", "'", '"', "/*", "}", "{", ";", "§" * 99])
def test_a_text_without_any_declaration_is_reported(text):
    assert list_diagnostics(text)
