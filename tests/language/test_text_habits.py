"""Habits from other languages: each is one finding, and the advice leads to a text that is right.

The models are compiled as a whole, so that consequences of an error would be findings too.
"""

import pytest
from test_text_typos import MODEL, list_findings
from tree_outlines import list_diagnostics

from sysmlc.diagnostics import Sink
from sysmlc.language.library import load_core
from sysmlc.language.names import resolve
from sysmlc.language.text import parse

HABITS = {
    "Python: note of a line": (
        "# a comment",
        "// a comment",
        "2:1 unexpected '#'; expected '//'",
        "a note to the end of the line begins with '//'",
    ),
    "Python: note of a line that reads as metadata": (
        "# the plant;",
        "// the plant",
        "2:3 unknown name 'the'",
        "a note to the end of the line begins with '//'",
    ),
    "SQL: note of a line": (
        "-- a comment",
        "// a comment",
        "2:1 unexpected '-'; expected '//'",
        "a note to the end of the line begins with '//'",
    ),
    "Modelica: note of a line": (
        "% a comment",
        "// a comment",
        "2:1 unexpected '%'; expected '//'",
        "a note to the end of the line begins with '//'",
    ),
    "Python: assignment": (
        "action c { attribute m : ScalarValues::Integer; m := m + 1; }",
        "action c { attribute m : ScalarValues::Integer; assign m := m + 1; }",
        "2:49 'c' has 2 members with the name 'm'",
        "a name without a keyword declares a new feature: write 'as",
    ),
    "C: assignment": (
        "action c { attribute m : ScalarValues::Integer; m = m + 1; }",
        "action c { attribute m : ScalarValues::Integer; assign m := m + 1; }",
        "2:49 'c' has 2 members with the name 'm'",
        "a name without a keyword declares a new feature: write 'as",
    ),
    "Python: assignment to a feature around": (
        "action c { n := n + 1; }",
        "action c { assign n := n + 1; }",
        "2:12 'n' of 'c' is a new feature; it changes nothing of the 'n' of 'P'",
        "'attribute n ...'",
    ),
    "C: increment": (
        "action c { attribute m : ScalarValues::Integer; m++; }",
        "action c { attribute m : ScalarValues::Integer; assign m := m + 1; }",
        "2:52 unexpected ';'; expected an expression",
        "write the new value: assign m := m + 1;",
    ),
    "C: compound assignment": (
        "action c { attribute m : ScalarValues::Integer; m += 1; }",
        "action c { attribute m : ScalarValues::Integer; assign m := m + 1; }",
        "2:52 unexpected '='; expected an expression",
        "write the new value: assign m := m + ...;",
    ),
    "Java: assignment to a member": (
        "action c { attribute m : T; m.n := 3; } attribute def T { attribute n; }",
        "action c { attribute m : T; assign m.n := 3; } attribute def T { attribute n; }",
        "2:29 unexpected name 'm'; expected 'assign'",
        "an assignment begins with 'assign': assign m.n := ...",
    ),
    "Basic: set": (
        "action c { set n = 3; }",
        "action c { assign n := 3; }",
        "2:12 unexpected name 'set'; expected 'assign'",
        "'set' is not a keyword: 'assign' is meant: assign x := 3;",
    ),
    "SysML v1: assignment as an entry": (
        "state s { entry; then a; state a { entry n := 3; } }",
        "state s { entry; then a; state a { entry assign n := 3; } }",
        "2:42 'n' is an attribute, but an action is required here",
        "to change it, write 'assign n := ...'",
    ),
    "SysML v1: slash before an action": (
        "state s { entry; then a; state a { action d; do / d; } }",
        "state s { entry; then a; state a { action d; do d; } }",
        "2:49 unexpected '/'; expected an action",
        "the action follows 'do' without '/'",
    ),
    "C: braces of an entry": (
        "state s { entry; then a; state a { entry { action d; } } }",
        "state s { entry; then a; state a { entry action { action d; } } }",
        "2:42 unexpected '{'; expected 'action'",
        "steps stand in an action: entry action { ... }",
    ),
    "C: conjunction": (
        "attribute x : ScalarValues::Boolean = on && n > 3;",
        "attribute x : ScalarValues::Boolean = on and n > 3;",
        "2:43 unexpected '&'; expected an expression",
        "conditions are joined by 'and'",
    ),
    "C: disjunction": (
        "attribute x : ScalarValues::Boolean = on || on;",
        "attribute x : ScalarValues::Boolean = on or on;",
        "2:43 unexpected '|'; expected an expression",
        "conditions are joined by 'or'",
    ),
    "Java: private field": (
        "private int x;",
        "private attribute x : ScalarValues::Integer;",
        "2:9 unexpected name 'int'; expected 'attribute'",
        "ScalarValues::Integer;",
    ),
    "C: variable": (
        "int x = 3;",
        "attribute x : ScalarValues::Integer = 3;",
        "2:1 unexpected name 'int'; expected 'attribute'",
        "ScalarValues::Integer;",
    ),
    "C: Boolean variable": (
        "bool x = true;",
        "attribute x : ScalarValues::Boolean = true;",
        "2:1 unexpected name 'bool'; expected 'attribute'",
        "ScalarValues::Boolean;",
    ),
    "Modelica: variable": (
        "Real x = 3.0;",
        "attribute x : ScalarValues::Real = 3.0;",
        "2:1 unexpected name 'Real'; expected 'attribute'",
        "ScalarValues::Real;",
    ),
    "Modelica: variable with a start value": (
        "Integer x(start = 3);",
        "attribute x : ScalarValues::Integer := 3;",
        "2:1 unexpected name 'Integer'; expected 'attribute'",
        "ScalarValues::Integer;",
    ),
    "Modelica: parameter": (
        "parameter Real x = 3;",
        "attribute x : ScalarValues::Real = 3;",
        "2:1 unexpected name 'parameter'; expected 'attribute'",
        "'parameter' is not a keyword: 'attribute' is meant",
    ),
    "Modelica: connector": (
        "connector a1 to a2;",
        "connect a1 to a2;",
        "2:1 unexpected name 'connector'; expected 'connect'",
        "'connect' is meant: connect a to b",
    ),
    "Modelica: input": (
        "port def Q { input x; }",
        "port def Q { in x; }",
        "2:14 unexpected name 'input'; expected 'in'",
        "'input' is not a keyword: 'in' is meant",
    ),
    "Modelica: type of an input": (
        "port def Q { in Real x; }",
        "port def Q { in attribute x : ScalarValues::Real; }",
        "2:17 unexpected name 'Real'; expected 'attribute'",
        "ScalarValues::Real;",
    ),
    "UML: class": (
        "class B { }",
        "part def B { }",
        "2:1 unexpected name 'class'; expected 'part def'",
        "in SysML a class is a 'part def', 'item def' or 'attribute def'",
    ),
    "Python: def": (
        "def part B;",
        "part def B;",
        "2:1 unexpected 'def'; expected 'part def'",
        "'def' stands after the kind: part def B",
    ),
    "Java: abstract class": (
        "abstract class B { }",
        "abstract part def B { }",
        "2:10 unexpected name 'class'; expected 'part def'",
        "in SysML a class is a 'part def', 'item def' or 'attribute def'",
    ),
    "C++: const": (
        "const x = 3;",
        "constant x = 3;",
        "2:1 unexpected 'const'; expected 'constant'",
        "'const' is not a keyword: did you mean 'constant'?",
    ),
    "Java: final": (
        "final attribute x;",
        "constant attribute x;",
        "2:1 unexpected name 'final'; expected 'attribute'",
        "'final' is not a keyword: what never changes is 'constant'",
    ),
    "Java: static": (
        "static attribute x;",
        "attribute x;",
        "2:1 unexpected name 'static'; expected 'attribute'",
        "a feature belongs to each element of its type, or to a package",
    ),
    "Java: void": (
        "void f();",
        "action f;",
        "2:1 unexpected name 'void'; expected 'action'",
        "'void' is not a keyword: an operation is an 'action'",
    ),
    "UML: operation": (
        "operation f();",
        "action f;",
        "2:1 unexpected name 'operation'; expected 'action'",
        "'operation' is not a keyword: 'action' is meant",
    ),
    "UML: association": (
        "association B;",
        "connection def B;",
        "2:1 unexpected name 'association'; expected 'connection def'",
        "in SysML an association is a 'connection def'",
    ),
    "UML: namespace": (
        "namespace Q { }",
        "package Q { }",
        "2:1 unexpected name 'namespace'; expected 'package'",
        "'namespace' is not a keyword: 'package' is meant",
    ),
    "Python: module": (
        "module Q;",
        "package Q;",
        "2:1 unexpected name 'module'; expected 'package'",
        "'module' is not a keyword: 'package' is meant",
    ),
    "C#: using": (
        "using A;",
        "private import A;",
        "2:1 unexpected name 'using'; expected 'private import'",
        "names are imported: private import A::*;",
    ),
    "Python: from": (
        "from P import A;",
        "private import P::A;",
        "2:8 unexpected 'import'; expected '.', '::', '::>', 'references' or 'to'",
        "write 'private import P::A;'",
    ),
    "TypeScript: let": (
        "let x = 3;",
        "attribute x = 3;",
        "2:1 unexpected name 'let'; expected 'attribute'",
        "'let' is not a keyword: 'attribute' is meant",
    ),
    "Kotlin: val": (
        "val x = 3;",
        "attribute x = 3;",
        "2:1 unexpected name 'val'; expected 'attribute'",
        "'val' is not a keyword: 'attribute' is meant",
    ),
    "C: typedef": (
        "typedef A B;",
        "alias B for A;",
        "2:9 unexpected name 'A'; expected ';', '{', '}', '::' or something else",
        "another name of a type is an alias: alias B for A;",
    ),
    "TypeScript: alias with an equals sign": (
        "alias B = A;",
        "alias B for A;",
        "2:9 unexpected '='; expected 'for'",
        "write 'alias B for A;'",
    ),
    "Python: alias with as": (
        "alias A as B;",
        "alias B for A;",
        "2:9 unexpected 'as'; expected 'for'",
        "write 'alias B for A;'",
    ),
    "SysML v1: enumeration": (
        "enumeration E { a; b; }",
        "enum def E { a; b; }",
        "2:1 unexpected name 'enumeration'; expected 'enum def'",
        "'enumeration' is not a keyword: 'enum def' is meant",
    ),
    "Java: values with commas": (
        "enum def E { a, b }",
        "enum def E { a; b; }",
        "2:15 unexpected ','; expected ';', '{', '}', '::' or something else",
        "members end with ';', they are not separated by commas",
    ),
    "C: last value": (
        "enum def E { a; b }",
        "enum def E { a; b; }",
        "2:17 ';' is missing after 'b'",
        "put ';' there, or a body in braces",
    ),
    "UML: stereotype in guillemets": (
        "«block» part def B;",
        "part def B;",
        "2:1 unexpected '«block»'",
        "a stereotype is metadata: #name before a declaration, or @",
    ),
    "UML: stereotype in angle brackets": (
        "<<block>> part def B;",
        "part def B;",
        "2:1 unexpected '<'; expected a declaration",
        "a stereotype is metadata: #name before a declaration, or @",
    ),
    "UML: stereotype": (
        "stereotype S;",
        "metadata def S;",
        "2:1 unexpected name 'stereotype'; expected 'metadata def'",
        "a stereotype is a 'metadata def'",
    ),
    "Java: annotation before a declaration": (
        "metadata def M; @M part b;",
        "metadata def M; #M part b;",
        "2:17 unexpected '@'; expected '#'",
        "metadata before a declaration is written with '#': #M part",
    ),
    "SysML v1: flow port": (
        "port def Q; flow port p : Q;",
        "port def Q; port p : Q;",
        "2:13 unexpected 'flow'; expected 'port'",
        "every port is a 'port'",
    ),
    "SysML v1: proxy port": (
        "proxy port p;",
        "port p;",
        "2:1 unexpected name 'proxy'; expected 'port'",
        "'proxy' is not a keyword: every port is a 'port'",
    ),
    "SysML v1: text of a requirement": (
        'requirement r { text "it shall run"; }',
        "requirement r { doc /* it shall run */ }",
        "2:22 unexpected string; expected ';', '{', '}', '::' or something else",
        "the text of a requirement is its documentation: doc /* ... */",
    ),
    "SysML v1: id of a requirement": (
        'requirement r id "R1";',
        "requirement <'R1'> r;",
        "2:15 unexpected name 'id'; expected ';', '{', '.', '::' or something else",
        "requirement <'R5'> name",
    ),
    "SysML v1: requirement with a documentation in quotes": (
        'requirement r { doc "it shall run" }',
        "requirement r { doc /* it shall run */ }",
        "2:21 unexpected string; expected a comment /* ... */, a name or 'locale'",
        "write the text between /* and */",
    ),
    "C++: general type": (
        "part def B : A { }",
        "part def B :> A { }",
        "2:12 unexpected ':'; expected ':>'",
        "':>' stands before a general type, ':' before the type of a usage",
    ),
    "Java: extends": (
        "part def B extends A { }",
        "part def B specializes A { }",
        "2:12 unexpected name 'extends'; expected ';', '{', ':>' or 'specializes'",
        "write ':>' or 'specializes' before a general type",
    ),
    "Ruby: general type with an angle": (
        "part def B <: A;",
        "part def B :> A;",
        "2:12 unexpected '<'; expected ':>'",
        "':>' stands before a general type",
    ),
    "Java: collection": (
        "part b : List<A>;",
        "part b : A[*];",
        "2:10 unexpected name 'List'; expected a type",
        "several of a type are written with a multiplicity: A[*]",
    ),
    "C: brackets behind the kind": (
        "part[3] b : A;",
        "part b[3] : A;",
        "2:11 unexpected ':'; expected '.' or 'to'",
        "the multiplicity follows the name: part b[3]",
    ),
    "Python: bounds with a colon": (
        "part b : A[0:3];",
        "part b : A[0..3];",
        "2:13 unexpected ':'; expected '..'",
        "bounds are joined by '..': [0..3]",
    ),
    "Python: no upper bound": (
        "part b : A[3..];",
        "part b : A[3..*];",
        "2:15 unexpected ']'; expected an expression",
        "no upper bound is written '*': [3..*]",
    ),
    "Java: name in double quotes": (
        'part def "My part";',
        "part def 'My part';",
        "2:10 unexpected string; expected ';', '{', a name, ':>' or 'specializes'",
        "a name stands in single quotes: 'My part'",
    ),
    "Word: name in typographic quotation marks": (
        "part def ‘My part’;",
        "part def 'My part';",
        "2:10 '‘' is a typographic quotation mark",
        "write straight quotation marks: 'name' or \"text\"",
    ),
    "Word: text in typographic quotation marks": (
        "attribute s : ScalarValues::String = “a b”;",
        'attribute s : ScalarValues::String = "a b";',
        "2:38 '“' is a typographic quotation mark",
        "write straight quotation marks: 'name' or \"text\"",
    ),
    "Python: text in single quotes": (
        "attribute s : ScalarValues::String = 'a b';",
        'attribute s : ScalarValues::String = "a b";',
        "2:38 unknown name 'a b'",
        '"a b"',
    ),
    "Python: True": (
        "attribute x : ScalarValues::Boolean = True;",
        "attribute x : ScalarValues::Boolean = true;",
        "2:39 unknown name 'True'",
        "did you mean 'true'?",
    ),
    "Python: None": (
        "attribute x = None;",
        "attribute x = null;",
        "2:15 unknown name 'None'",
        "did you mean 'null'?",
    ),
    "Python: list": (
        "attribute x = [1, 2, 3];",
        "attribute x = (1, 2, 3);",
        "2:15 unexpected '['; expected an expression",
        "a list of values stands in parentheses: (1, 2, 3)",
    ),
    "C: list in braces": (
        "attribute x = {1, 2, 3};",
        "attribute x = (1, 2, 3);",
        "2:17 unexpected ','; expected '}'",
        "a list of values stands in parentheses: (1, 2, 3)",
    ),
    "German: decimal comma": (
        "attribute x = 3,5;",
        "attribute x = 3.5;",
        "2:16 unexpected ','; expected ';', '{', 'accept', 'allocate' or something else",
        "a decimal number has a point: 3.5",
    ),
    "C: no digit behind the point": (
        "attribute x = 3.;",
        "attribute x = 3.0;",
        "2:17 unexpected ';'; expected '{', a name or 'metadata'",
        "a digit follows the point: 3.0",
    ),
    "C: hexadecimal number": (
        "attribute x = 0x1F;",
        "attribute x = 31;",
        "2:16 unexpected name 'x1F'; expected ';', '{', 'accept', 'allocate' or something else",
        "31 for 0x1F, 1000 for 1_000",
    ),
    "Python: digits in groups": (
        "attribute x = 1_000;",
        "attribute x = 1000;",
        "2:16 unexpected name '_000'; expected ';', '{', 'accept', 'allocate' or something else",
        "31 for 0x1F, 1000 for 1_000",
    ),
    "Pascal: remainder": (
        "attribute x = 3 mod 2;",
        "attribute x = 3 % 2;",
        "2:17 unexpected name 'mod'; expected ';', '{', 'accept', 'allocate' or something else",
        "write '%' for 'mod'",
    ),
    "C: unit behind a number": (
        "attribute x = 5kg;",
        "attribute x = 5 [kg];",
        "2:16 unexpected name 'kg'; expected ';', '{', 'accept', 'allocate' or something else",
        "units stand in brackets: 5 [kg]",
    ),
    "R: arrow of an assignment": (
        "attribute x <- 3;",
        "attribute x = 3;",
        "2:13 unexpected '<'; expected '='",
        "'=' gives the value",
    ),
    "C: question mark": (
        "attribute x : ScalarValues::Integer = on ? 1 : 2;",
        "attribute x : ScalarValues::Integer = if on ? 1 else 2;",
        "2:42 unexpected '?'; expected ';', '{', 'accept', 'allocate' or something else",
        "a conditional expression starts with 'if': if a ? b else c",
    ),
    "Haskell: less or equal": (
        "assert constraint { n =< 3 }",
        "assert constraint { n <= 3 }",
        "2:23 unexpected '='; expected '<='",
        "'<=' means at most",
    ),
    "Word: greater or equal": (
        "assert constraint { n ≥ 3 }",
        "assert constraint { n >= 3 }",
        "2:23 '≥' is no operator",
        "write '>='",
    ),
    "English: condition under a condition": (
        "assert constraint { if on then n > 3 }",
        "assert constraint { on implies n > 3 }",
        "2:34 unexpected '>'; expected ';', '{', '.', '::' or something else",
        "a condition under a condition is written: a implies b",
    ),
    "C: assertion": (
        "assert n > 3;",
        "assert constraint { n > 3 }",
        "2:10 unexpected '>'; expected ';', '{', '.', 'by' or something else",
        "assert constraint { x > 0 }",
    ),
    "Java: semicolon behind a condition": (
        "assert constraint { n > 3; }",
        "assert constraint { n > 3 }",
        "2:26 unexpected ';'; expected '}'",
        "the result is an expression without ';' at the end of the body",
    ),
    "Python: colon before steps": (
        "action c { attribute m : ScalarValues::Integer; if m > 3: { action d; } }",
        "action c { attribute m : ScalarValues::Integer; if m > 3 { action d; } }",
        "2:57 unexpected ':'; expected '{'",
        "the steps stand in braces: if x > 0 { ... }",
    ),
    "C: step without braces": (
        "action c { if (on) action d; }",
        "action c { if (on) { action d; } }",
        "2:28 unexpected ';'; expected '{' or what it specialises (':', ':>' or ':>>')",
        "the steps stand in braces: if x > 0 { ... }",
    ),
    "C#: foreach": (
        "action c { foreach i in 1..3 { action d; } }",
        "action c { for i in 1..3 { action d; } }",
        "2:12 unexpected name 'foreach'; expected 'for'",
        "'for' is meant: for i in 1..3 { ... }",
    ),
    "Java: return": (
        "calc c { return 3; }",
        "calc c { return r = 3; }",
        "2:17 unexpected number '3'; expected a declaration",
        "'return' declares the result: return r = ...;",
    ),
    "Java: parameters": (
        "action c(x : A) { }",
        "action c { in x : A; }",
        "2:9 unexpected '('; expected ';', '{', '.', '::' or something else",
        "parameters are members of the body: { in x; }",
    ),
    "UML: initial state": (
        "state s { initial a; state a; }",
        "state s { entry; then a; state a; }",
        "2:11 unexpected name 'initial'; expected 'entry; then'",
        "the first state follows the entry action: entry; then a;",
    ),
    "PlantUML: initial state": (
        "state s { [*] --> a; state a; }",
        "state s { entry; then a; state a; }",
        "2:11 unexpected '['; expected 'entry; then'",
        "the first state follows the entry action: entry; then a;",
    ),
    "PlantUML: transition": (
        "state s { entry; then a; state a; state b; a --> b; }",
        "state s { entry; then a; state a; state b; transition first a then b; }",
        "2:47 unexpected '->'; expected an expression",
        "an order is written 'first a then b;', a transition 'trans",
    ),
    "English: transition from": (
        "state s { entry; then a; state a; state b; transition from a to b; }",
        "state s { entry; then a; state a; state b; transition first a then b; }",
        "2:55 unexpected 'from'; expected a name, 'accept', 'do', 'first' or something else",
        "transition first a then ...",
    ),
    "UML: guard": (
        "state s { entry; then a; state a; state b; transition first a [n > 3] then b; }",
        "state s { entry; then a; state a; state b; transition first a if n > 3 then b; }",
        "2:63 unexpected '['; expected '.', 'accept', 'do', 'if' or 'then'",
        "transition first a if x > 0 then b",
    ),
    "English: connection with and": (
        "connect a1 and a2;",
        "connect a1 to a2;",
        "2:12 unexpected 'and'; expected 'to'",
        "ends are joined by 'to': a to b",
    ),
    "English: binding without a sign": (
        "bind a1 a2;",
        "bind a1 = a2;",
        "2:9 unexpected name 'a2'; expected '.', '::', '::>', '=' or 'references'",
        "write '=' between both: bind a1 = a2;",
    ),
    "C: semicolon before a body": (
        "part def B; { part c; }",
        "part def B { part c; }",
        "2:13 unexpected '{'; expected '}', a declaration or an expression",
        "take away the ';' before the body",
    ),
    "doubled keyword": (
        "part part b;",
        "part b;",
        "2:6 unexpected 'part'; expected a name",
        "take it away",
    ),
    "doubled def": (
        "part def def B;",
        "part def B;",
        "2:10 unexpected 'def'; expected a name",
        "take it away",
    ),
    "second kind": (
        "part def part B;",
        "part def B;",
        "2:10 unexpected 'part'; expected a name",
        "take it away",
    ),
    "open comment": (
        "part b; /* comment",
        "part b; /* comment */",
        "2:9 this comment is never closed",
        "put */ where it ends",
    ),
}
"""What is written, what the advice leads to, the finding, and a part of the advice."""


@pytest.mark.parametrize("habit", HABITS)
def test_a_habit_from_another_language_is_one_finding_with_true_advice(habit, tmp_path):
    wrong, right, message, advice = HABITS[habit]
    (finding,) = list_findings(MODEL.format(member=wrong), tmp_path)
    assert finding[0] == message
    assert advice in finding[1]
    assert list_diagnostics(MODEL.format(member=right)) == []


@pytest.mark.parametrize("mark", ["#", "--", "%"])
def test_notes_in_the_marks_of_another_language_hide_no_declaration(mark, tmp_path):
    text = f"{mark} the plant and its parts\npackage P {{ {mark} a part of it\n part def A; }}\n"
    findings = [message for message, _ in list_findings(text, tmp_path)]
    place = ["1:1", "2:13"]
    assert findings == [f"{at} unexpected '{mark[0]}'; expected '//'" for at in place]


def test_what_a_foreign_keyword_declares_is_known(tmp_path):
    text = "package P { class A { private int n; } enumeration E { a; b } part x : A; part y : E; }"
    messages = [message for message, _ in list_findings(text, tmp_path)]
    assert [message for message in messages if "unknown name" in message] == []


def test_a_tab_and_a_byte_order_mark_are_blanks(tmp_path):
    assert list_findings("\ufeffpackage P {\n\tpart def A;\n\tpart a : A;\r\n}\n", tmp_path) == []


def test_a_feature_that_redefines_an_inherited_one_is_no_assignment(tmp_path):
    text = """package P { attribute n : ScalarValues::Integer; action def C { in attribute n; }
    action c : C { in n = 3; } action d : C { attribute n redefines C::n = 4; } }"""
    assert [m for m, _ in list_findings(text, tmp_path) if "new feature" in m] == []


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("part a : import B;", "write the import in a body: private import A::*;"),
        ("attribute a : := 3;", "':=' gives an initial value, '=' binds for good, "),
        ("part a, b;", "members end with ';', they are not separated by commas"),
        ("part def A extends B;", "write ':>' or 'specializes' before a general type"),
        ("part a is B;", "write ':>' or 'specializes' before a general type, and ':' before "),
        ("requirement r id 'R5';", "write the short name after the keyword: requirement <'R5'> "),
        ("connect a with b;", "ends of a connection are joined by 'to': connect a to b"),
        ("transition first a when c then b;", "write 'accept when c' for a change, 'if c' for "),
    ],
)
def test_an_unexpected_token_has_advice_wherever_it_stands(text, advice):
    sink = Sink()
    parse(text, "m.sysml", "sysml", sink)
    assert next(iter(sink)).help.startswith(advice)


@pytest.mark.parametrize(
    ("member", "code"), [("part a : end;", "SM192"), ("part a : Öl;", "SM194"), ("foo", "SM195")]
)
def test_a_word_with_a_syntax_error_is_not_an_unknown_name_too(member, code):
    sink = Sink()
    resolve([parse(f"part def P {{ {member} }}", "m.sysml", "sysml", sink)], load_core(), sink)
    assert [diagnostic.rule.code for diagnostic in sink] == [code]


FOREIGN_WORDS = """
    activity assoc association behavior block class component connector datatype decision elif
    elseif enumeration equation extends feature final foreach full func function id initial
    input let link method model module namespace note operation output parameter predicate
    property proxy readonly set signal static stereotype stream struct switch text timeout type
    typedef usecase using val value valuetype var variable virtual void wait
"""


@pytest.mark.parametrize("word", FOREIGN_WORDS.split())
def test_the_first_word_of_a_member_of_another_language_is_explained(word):
    sink = Sink()
    parse(f"part p {{ {word} x; }}", "m.sysml", "sysml", sink)
    advice = next(iter(sink)).help
    assert advice.startswith(f"'{word}' is not a keyword: ")
    assert "did you mean" not in advice
