"""The formatter: line breaks, spaces between tokens, and text that it does not change."""

import pytest
from tree_outlines import list_node_values

from sysmlc.diagnostics import Sink
from sysmlc.language.formatter import format_text
from sysmlc.language.text import parse

CASES = {
    "one member a line": (
        "package P{part def A;part def B{attribute x;}}",
        """\
package P {
    part def A;
    part def B {
        attribute x;
    }
}
""",
    ),
    "spaces around operators": (
        "part a:A:>b:>>c::d=1+ -2*(x.y#(1)-3)**2;attribute z:=not q and p==null;",
        """\
part a : A :> b :>> c::d = 1 + -2 * (x.y#(1) - 3)**2;
attribute z := not q and p == null;
""",
    ),
    "multiplicities have no space, units have one": (
        "part w : W [ 4 ] ordered;attribute m [0 .. *] = 5[kg];attribute v = x [m / s ** 2];",
        """\
part w : W[4] ordered;
attribute m[0..*] = 5 [kg];
attribute v = x [m/s**2];
""",
    ),
    "multiplicities of ends stand apart": (
        "connect [1] a to [0 .. 1] b;",
        "connect [1] a to [0..1] b;\n",
    ),
    "names with sharp brackets": ("part def < 'R 1' > Robot;", "part def <'R 1'> Robot;\n"),
    "imports": (
        "private import A :: * ;public import B::C::**;private import D::*[ @Safe ];",
        "private import A::*;\npublic import B::C::**;\nprivate import D::*[@Safe];\n",
    ),
    "metadata": (
        "# safe part def A{@ Rated{level=3;}}filter @ Safe or not @ Old;",
        """\
#safe part def A {
    @Rated {
        level = 3;
    }
}
filter @Safe or not @Old;
""",
    ),
    "conjugation and typing by several": (
        "part def A{port p: ~ P;port q:P,Q;}",
        "part def A {\n    port p : ~P;\n    port q : P, Q;\n}\n",
    ),
    "calls": (
        "attribute x=f( a,b )->g (c) -> collect{in y;y.z}.k;",
        "attribute x = f(a, b)->g(c)->collect {in y; y.z}.k;\n",
    ),
    "conditions": (
        "attribute x=if a>b? a else b;attribute y=z ?? 1;",
        "attribute x = if a > b ? a else b;\nattribute y = z ?? 1;\n",
    ),
    "empty bodies": ("part def A{}part def B{ }", "part def A {}\npart def B {}\n"),
    "else and until stay with the body before them": (
        "action a{if x{action b;}else if y{action c;}else{action d;}loop{action e;}until z;}",
        """\
action a {
    if x {
        action b;
    } else if y {
        action c;
    } else {
        action d;
    }
    loop {
        action e;
    } until z;
}
""",
    ),
    "then begins a line, the target of a transition does not": (
        "state s{state a{state b;}then c;state c;transition t first a do action{action q;}then c;}",
        """\
state s {
    state a {
        state b;
    }
    then c;
    state c;
    transition t first a do action {
        action q;
    } then c;
}
""",
    ),
    "one blank line at most": (
        "package P {\n\n\npart def A;\n\n\n\npart def B;\npart def C;\n\n}\n\n\n",
        "package P {\n    part def A;\n\n    part def B;\n    part def C;\n}\n",
    ),
    "notes stay where they are": (
        "// head\n\npackage P { // of P\n//own\npart def A;//after\n\n// last\n}// end\n//tail",
        """\
// head

package P { // of P
    //own
    part def A; //after

    // last
} // end
//tail
""",
    ),
    "a note within a member ends the line": (
        "part a // why\n: A\n// because\n= b;",
        "part a // why\n        : A\n        // because\n        = b;\n",
    ),
    "notes of several lines": (
        "package P {\n//* one\n   two */ part def A;}",
        "package P {\n    //* one\n       two */\n    part def A;\n}\n",
    ),
    "short documentation stands behind its word": (
        "part def A{doc\n/* short */part b;}",
        "part def A {\n    doc /* short */\n    part b;\n}\n",
    ),
    "long documentation stands below it": (
        "part def A { doc /*\n        * one\n  *   two\n*\n */ }",
        """\
part def A {
    doc
    /*
     * one
     *   two
     *
     */
}
""",
    ),
    "comments without asterisks move as a whole": (
        "package P {\n  comment about A /* one\n      two\n    three */\n  part def A; }",
        """\
package P {
    comment about A
    /* one
      two
    three */
    part def A;
}
""",
    ),
    "a result stands alone": (
        "calc def C{in x;x*2}constraint{a<b}",
        "calc def C {\n    in x;\n    x * 2\n}\nconstraint {\n    a < b\n}\n",
    ),
}


@pytest.mark.parametrize(("text", "expected"), CASES.values(), ids=CASES)
def test_a_text_is_laid_out_canonically(text, expected):
    assert format_text(text, "sysml") == expected
    assert format_text(expected, "sysml") == expected


def test_kerml_is_formatted_with_its_own_keywords():
    text = "class A specializes B{feature x:C[1];inv{x>0}}"
    expected = """\
class A specializes B {
    feature x : C[1];
    inv {
        x > 0
    }
}
"""
    assert format_text(text, "kerml") == expected


def test_long_members_are_broken_at_clauses():
    text = (
        "part theWholeProductionLine : ProductionLineOfTheSecondHall[1..*] ordered :> "
        "everyProductionLine, everythingThatMoves redefines formerProductionLine;"
    )
    assert format_text(text, "sysml") == (
        "part theWholeProductionLine : ProductionLineOfTheSecondHall[1..*] ordered\n"
        "        :> everyProductionLine, everythingThatMoves redefines formerProductionLine;\n"
    )


@pytest.mark.parametrize(
    ("words", "language"),
    [
        *(("defined by", "sysml"), ("typed by", "kerml"), ("featured by", "kerml")),
        *(("disjoint from", "kerml"), ("inverse of", "kerml")),
    ],
)
def test_no_line_ends_within_a_keyword_of_two_words(words, language):
    declaration = f"{'part' if language == 'sysml' else 'feature'} {'n' * 80}"
    expected = f"{declaration}\n        {words} {'m' * 20};\n"
    assert format_text(f"{declaration} {words} {'m' * 20};", language) == expected


def test_long_expressions_are_broken_outside_parentheses():
    text = f"attribute total = {' + '.join(f'part{i}.weightOf({i}, mass)' for i in range(8))};"
    lines = format_text(text, "sysml").splitlines()
    assert all(len(line) <= 100 for line in lines)
    assert [line.strip()[0] for line in lines[1:]] == ["+"] * (len(lines) - 1)


@pytest.mark.parametrize(
    "operator",
    [
        *("and", "or", "xor", "implies", "??", "==", "!=", "===", "!==", "<", ">", "<=", ">="),
        *("|", "&", "+", "-", "*", "/", "%"),
    ],
)
def test_long_expressions_are_broken_before_an_operator(operator):
    operand = "aRatherLongNameOfOneOperand" * 2
    text = f"attribute total = {operand} {operator} {operand} {operator} {operand};"
    line = f"        {operator} {operand}"
    expected = f"attribute total = {operand}\n{line}\n{line};\n"
    assert format_text(text, "sysml") == expected


@pytest.mark.parametrize(
    "word",
    [
        *("specializes", "subsets", "redefines", "references", "crosses"),
        *(":>", ":>>", "::>", "=>"),
    ],
)
def test_long_members_are_broken_before_a_clause(word):
    name = "aRatherLongNameOfOneType" * 3
    text = f"part x {word} {name} {word} {name};"
    assert format_text(text, "sysml") == f"part x {word} {name}\n        {word} {name};\n"


@pytest.mark.parametrize(
    "statement",
    [
        *("part x = y [m];", "part x := y [m];", "part x default y [m];", "filter y [m];"),
        *("while y [m] {}", "loop {} until y [m];", "if y [m] {}", "assign x := y [m];"),
        *("accept when y [m];", "accept at y [m];", "accept after y [m];"),
    ],
)
def test_a_bracket_in_a_value_has_a_space_before_it(statement):
    text = f"action a {{\n    {statement}\n}}\n"
    assert format_text(text.replace(" [", "["), "sysml") == text


def test_long_body_expressions_have_a_line_for_each_member():
    text = (
        "attribute total = collection->select {in item : SomethingThatHasAWeight; "
        "item.weight > theLowestWeight}->size();"
    )
    assert format_text(text, "sysml") == (
        "attribute total = collection->select {\n"
        "    in item : SomethingThatHasAWeight;\n"
        "    item.weight > theLowestWeight\n"
        "}->size();\n"
    )


def test_line_ends_are_preserved():
    assert format_text("package P {\r\n}\r\n", "sysml") == "package P {}\r\n"
    assert format_text("part a;\r\npart b;\r\npart c;\n", "sysml").count("\r\n") == 3


@pytest.mark.parametrize("text", ["", "\n\n", "// note", "/* comment */"])
def test_texts_without_declarations_are_preserved(text):
    assert format_text(text, "sysml") == text.strip() + ("\n" if text.strip() else "")


def test_strings_and_quoted_names_are_preserved():
    text = "attribute 'a  b' = \"x  {;}  // no note\";\n"
    assert format_text(text, "sysml") == text


# -- the corpus ----------------------------------------------------------------------------------


@pytest.mark.long
@pytest.mark.corpus
def test_formatting_changes_no_tree_of_the_corpus(corpus):
    paths = [
        path
        for folder in ("omg-release", "ice-lab", "showcase")
        for path in sorted((corpus / "sysml2" / folder).rglob("*.*ml"))
        if path.suffix in (".sysml", ".kerml")
    ]
    assert len(paths) == 312
    for path in paths:
        sink = Sink()
        check_formatting(path.read_bytes().decode(), path.suffix[1:], sink, path)
        assert not sink, path


@pytest.mark.corpus
def test_formatting_changes_no_tree_of_the_pilot_models(corpus):
    valid = 0
    for path in sorted((corpus / "sysml2/pilot-xpect").rglob("*.xt")):
        text, sink = path.read_bytes().decode("utf-8", "replace"), Sink()
        language = "kerml" if ".kerml" in path.name else "sysml"
        parse(text, "m", language, sink)
        if not sink.has_errors():
            check_formatting(text, language, Sink(), path)
            valid += 1
    assert valid > 400


def check_formatting(text, language, sink, path):
    """Assert that formatting preserves the tree, and that formatting twice equals once."""
    formatted = format_text(text, language)
    assert format_text(formatted, language) == formatted, path
    before, after = (parse(version, "m", language, sink).root for version in (text, formatted))
    assert list_node_values(after) == list_node_values(before), path


@pytest.mark.long
@pytest.mark.corpus
def test_formatted_lines_of_the_corpus_have_at_most_100_characters(corpus):
    """Only names, strings, comments and notes may be longer than a line."""
    paths = sorted((corpus / "sysml2/ice-lab").rglob("*.sysml"))
    lines = [
        line
        for path in paths
        for line in format_text(path.read_text(encoding="utf-8"), "sysml").splitlines()
    ]
    long = [line for line in lines if len(line) > 100 and not line.strip().startswith(("*", "/"))]
    assert [line for line in long if '"' not in line and "//" not in line] == []
