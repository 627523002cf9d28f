"""Typical typing errors in SysML v2 text: each is one finding, at its place, with its remedy.

The models are compiled as a whole, so that consequences of an error would be findings too.
"""

from pathlib import Path

import pytest

from sysmlc.driver import Request, compile_model

TYPOS = {
    "missing semicolon": ("part a : A\n part b : A;", "2:10 ';' is missing after 'A'", "put ';'"),
    "missing type": ("part a : ;", "2:10 unexpected ';'; expected a name", ""),
    "brace in place of a type": ("part a : };", "2:10 unexpected '}'; expected a name", ""),
    "misspelt keyword": ("prat a : A;", "2:1 unexpected 'prat'; expected 'part'", "'part'"),
    "capital keyword": ("Part a : A;", "2:1 unexpected 'Part'; expected 'part'", "'part'"),
    "two colons": ("part a :: A;", "2:8 unexpected '::'; expected ':'", "before a type"),
    "colon of a definition": (
        "part def B : A;",
        "2:12 unexpected ':'; expected ':>'",
        "a general type",
    ),
    "blank in an operator": ("part def B : > A;", "2:12 unexpected ':'; expected ':>'", "blanks"),
    "binding as assignment": (
        "action c { attribute m : ScalarValues::Integer; assign m = 3; }",
        "2:58 unexpected '='; expected ':='",
        "here only ':='",
    ),
    "sum of another language": (
        "action c { attribute m : ScalarValues::Integer; assign m += 3; }",
        "2:58 unexpected '+'; expected '#', '(', '->', '.' or something else",
        "m := m + ...",
    ),
    "binding as comparison": (
        "assert constraint { n = 3 }",
        "2:23 unexpected '='; expected '=='",
        "'==' compares",
    ),
    "arrow of an implication": (
        "assert constraint { on => on }",
        "2:24 unexpected '=>'; expected 'implies'",
        "a implies b",
    ),
    "thin arrow of an implication": (
        "assert constraint { on -> on }",
        "2:24 unexpected '->'; expected 'implies'",
        "a implies b",
    ),
    "inequality of another language": (
        "assert constraint { n <> 3 }",
        "2:23 unexpected '<'; expected '!='",
        "differ",
    ),
    "negation of another language": ("assert constraint { !on }", "2:21 '!' is no operator", "not"),
    "open quote": ("part def 'My part;", "2:10 this name in quotes is never closed", "put '"),
    "quote without a beginning": (
        "part def My part';",
        "2:17 this name in quotes is never closed",
        "put '",
    ),
    "open string": (
        'attribute s : ScalarValues::String = "abc;',
        "2:38 this string is never closed",
        'put "',
    ),
    "string as name": (
        'part "x";',
        "2:6 unexpected string; expected ';', '{', a name, '#' or something else",
        "",
    ),
    "typographic quotes": (
        "part def “B”;",
        "2:10 '“' is a typographic quotation mark",
        "straight",
    ),
    "keyword as name": (
        "part state : A;",
        "2:6 'state' is a keyword of SysML; expected a name",
        "single quotes",
    ),
    "keyword as a name of a definition": (
        "part def state;",
        "2:10 'state' is a keyword of SysML; expected a name",
        "single quotes",
    ),
    "hyphen in a name": (
        "part def my-part;",
        "2:12 unexpected '-'; expected ';', '{', ':>' or 'specializes'",
        "'my-part'",
    ),
    "digit before a name": (
        "part def 2A;",
        "2:10 unexpected number '2'; expected ';', '{', a name, ':>' or 'specializes'",
        "'2A'",
    ),
    "superfluous semicolon": (
        "part def B { };",
        "2:15 unexpected ';'; expected a declaration or '}'",
        "take it away",
    ),
    "superfluous brace": ("part def B { }}", "3:1 unexpected '}'; expected a declaration", "open"),
    "missing opening brace": (
        "part def B\n    part c : A;\n}",
        "2:10 '{' is missing after 'B'",
        "put '{' there",
    ),
    "missing parenthesis": ("attribute m = (3 + 4;", "2:20 ')' is missing after '4'", "put ')'"),
    "comma between members": (
        "part b : A,",
        "2:11 unexpected ','; expected ';'",
        "end with ';'",
    ),
    "dash between ends": ("connect a1 - a2;", "2:12 unexpected '-'; expected 'to'", "a to b"),
    "comma between ends": ("connect a1, a2;", "2:11 unexpected ','; expected 'to'", "a to b"),
    "arrow between steps": (
        "action c { action d; action e; first d -> e; }",
        "2:40 unexpected '->'; expected 'then'",
        "first a then b",
    ),
    "arrow as a member": (
        "action c { action d; action e; d -> e; }",
        "2:34 unexpected '->'; expected 'then'",
        "'first a then b;'",
    ),
    "order without 'first'": (
        "action c { action d; action e; d then e; }",
        "2:32 unexpected name 'd'; expected 'first'",
        "first d then",
    ),
    "'then' before steps": (
        "action c { attribute m := 1; if m > 3 then { action d; } }",
        "2:39 unexpected 'then'; expected '{'",
        "without 'then'",
    ),
    "'do' before steps": (
        "action c { attribute m := 1; while m > 3 do { action d; } }",
        "2:42 unexpected 'do'; expected '{'",
        "without 'do'",
    ),
    "loop of another language": (
        "action c { for (i = 0; i < 3; i = 1) { action d; } }",
        "2:16 unexpected '('; expected a name",
        "for i in 1..3",
    ),
    "call as a statement": (
        "action def D; action c { D(); }",
        "2:29 unexpected ';'; expected '}'",
        "action x : D;",
    ),
    "type before a name": (
        "A b;",
        "2:3 unexpected name 'b'; expected ';', '{', '}', '::' or something else",
        "part b : A;",
    ),
    "word behind a value": (
        "attribute m : ScalarValues::Integer = 3 default;",
        "2:41 unexpected 'default'; expected ';', '{', 'accept', 'allocate' or something else",
        "",
    ),
    "direction behind the kind": (
        "port def B { item in b; }",
        "2:14 unexpected 'item'; expected 'in'",
        "in item ...",
    ),
}
"""Members with an error; the line and column, the message, and a part of the advice."""
MODEL = """package P {{ part def A; part a1 : A; part a2 : A; attribute n : ScalarValues::Integer; \
attribute on : ScalarValues::Boolean;
{member}
}}
"""


def list_findings(text: str, folder: Path) -> list[tuple[str, str]]:
    """Return the warnings and errors about a text, ``line:column message``, and their advice."""
    path = folder / "m.sysml"
    path.write_text(text, encoding="utf-8")
    findings = []
    for diagnostic in compile_model(Request((path,), backends=())).diagnostics:
        if diagnostic.severity != "info":
            before = text.encode()[: diagnostic.subject.place.offset].decode()
            place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
            findings.append((f"{place} {diagnostic.message}", diagnostic.help))
    return findings


@pytest.mark.parametrize("typo", TYPOS)
def test_a_typing_error_is_one_finding_with_its_remedy(typo, tmp_path):
    member, message, advice = TYPOS[typo]
    (finding,) = list_findings(MODEL.format(member=member), tmp_path)
    assert finding[0] == message
    assert advice in finding[1]


def test_a_text_that_ends_within_a_declaration_is_one_finding(tmp_path):
    text = "package P {\n    part def A { attribute x :\n"
    assert list_findings(text, tmp_path) == [("3:1 unexpected end of file; expected a name", "")]


def test_the_body_that_its_margin_shows_to_be_open_is_reported(tmp_path):
    text = "package P {\n    part def A {\n        part b;\n    part def C;\n}\n"
    ((message, _),) = list_findings(text, tmp_path)
    assert message == "2:16 this '{' is never closed"


def test_a_text_that_begins_with_a_misspelt_keyword_is_read_as_sysml(tmp_path):
    ((message, _),) = list_findings("Package P { part def A; }", tmp_path)
    assert message == "1:1 unexpected 'Package'; expected 'package'"


def test_a_guard_and_an_effect_of_sysml_v1_have_their_notation_in_v2(tmp_path):
    states = "state s { entry; then a; state a; state b; transition first a %s then b; }"
    for clause, advice in (
        ("[n > 3]", "a guard is written with 'if'"),
        ("accept A / n", "an effect is written with 'do'"),
    ):
        findings = list_findings(MODEL.format(member=states % clause), tmp_path)
        assert [advice in help for _, help in findings] == [True]


# -- names of other languages ---------------------------------------------------------------------

IMPORTS = "private import ScalarValues::*; private import SI::*;"
TYPES = {
    "Int": "ScalarValues::Integer",
    "integer": "ScalarValues::Integer",
    "DINT": "ScalarValues::Integer",
    "uint": "ScalarValues::Natural",
    "bool": "ScalarValues::Boolean",
    "string": "ScalarValues::String",
    "float": "ScalarValues::Real",
    "double": "ScalarValues::Real",
    "duration": "ISQ::DurationValue",
}
UNITS = {
    "degC": "SI::'°C'",
    "ms": "SysMLC::Units::ms",
    "SI::ms": "SysMLC::Units::ms",
    "sec": "SI::s",
    "us": "SysMLC::Units::'µs'",
    "Nm": "SI::'N⋅m'",
    "m3": "SI::'m³'",
    "bar": "SysMLC::Units::bar",
    "kWh": "SysMLC::Units::kWh",
}


@pytest.mark.parametrize("name", TYPES)
def test_a_type_of_another_language_has_the_name_of_the_library_as_advice(name, tmp_path):
    text = "package P {{ attribute a : {}; }}"
    assert list_findings(text.format(name), tmp_path) == [
        (f"1:27 unknown name '{name}'", f"did you mean '{TYPES[name]}'?")
    ]
    assert list_findings(text.format(TYPES[name]), tmp_path) == []


@pytest.mark.parametrize("name", UNITS)
def test_another_spelling_of_a_unit_has_the_name_of_the_library_as_advice(name, tmp_path):
    text = "package P {{ attribute a = 20 [{}]; }}"
    ((message, advice),) = list_findings(text.format(name), tmp_path)
    assert message == f"1:31 unknown name '{name}'"
    assert UNITS[name] in advice
    assert list_findings(text.format(UNITS[name]), tmp_path) == []


def test_the_advice_has_the_short_name_if_the_library_is_imported(tmp_path):
    text = f"package P {{ {IMPORTS} attribute a : Int; attribute b = 20 [degC]; }}"
    advice = [advice for _, advice in list_findings(text, tmp_path)]
    assert advice == ["did you mean 'Integer'?", "did you mean '°C'?"]


def test_the_percent_sign_is_no_unit(tmp_path):
    ((_, advice),) = list_findings("package P { attribute a = 20 [%]; }", tmp_path)
    assert advice == "a ratio is a number: 0.2 for 20 %"


def test_a_usage_in_place_of_a_type_gets_its_two_remedies(tmp_path):
    ((message, advice),) = list_findings("package P { part a; part b : a; }", tmp_path)
    assert message.endswith("but 'a' is a part")
    assert advice == (
        "write 'part def a' to declare a type, or ':> a' for a usage that is one of these"
    )


def test_a_dot_behind_a_package_is_two_colons(tmp_path):
    text = "package P { package Q { part def A; } part b : P.Q.A; }"
    assert [advice for _, advice in list_findings(text, tmp_path)] == [
        "names of packages are joined by '::': P::Q::A"
    ]
