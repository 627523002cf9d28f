"""Files of every form: how they are told apart, what is said of bad ones, and the corpus."""

import os
import random
from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.diagnostics.rule import catalogue
from sysmlc.logic import formats
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formula import Const, Var
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.printing import print_formula

RULES = [one for code, one in sorted(catalogue().items()) if "SM580" <= code <= "SM589"]


def read(text, path="spec.txt", form=""):
    sink = Sink()
    found = formats.read(text, path, sink, form)
    return found, [
        (one.rule.code, one.subject.place.line, one.subject.place.column, one.message)
        for one in sink
    ]


def said(conjuncts):
    return [(str(one.class_), print_formula(one.formula)) for one in conjuncts]


def test_the_rules_are_those_of_this_module():
    assert len(RULES) == 9
    assert rules.UNKNOWN_FORM in RULES


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.code)
def test_the_wrong_example_has_the_fault_and_the_right_one_nearly(rule):
    assert rule.code in [code for code, *_ in read(rule.read_page().wrong)[1]]
    assert rule.code not in [code for code, *_ in read(rule.read_page().right)[1]]


@pytest.mark.parametrize(
    ("text", "faults"),
    [
        ("ENV: x;\nSYS: y;\nSYSGOAL: []<>(y & z);\n", ("SM583", 3, 19)),
        ("ENV: x;\nSYS: y;\nSYSGOAL: [](y);\n", ("SM586", 3, 10)),
        ("ENV: x;\nSYS: x [0,3];\n", ("SM584", 2, 6)),
        ("[INPUT]\na\n[OUTPUT]\nb\n[SYS_TRANS]\n  a' -> c\n", ("SM583", 6, 9)),
        ("[INPUT]\na\n[OUTPUTS]\nb\n", ("SM581", 3, 1)),
        ("[INPUT]\nn:5...3\n", ("SM581", 2, 1)),
        ("NAME: A;\nCONTRACT C:\n input real variable x;\n", ("SM585", 3, 8)),
        (
            "NAME: A;\nCONTRACT C:\n input boolean variable x;\n Assumptions:\n  G F(x));\n",
            ("SM583", 5, 9),
        ),
        ("MODULE main\nVAR\n x : boolean;\n", ("SM581", 3, 2)),
        ("MODULE main\nVAR x : 3..1; -- input\n", ("SM581", 2, 9)),
        ("MODULE main\nASSIGN\n next(x) := y;\n", ("SM585", 2, 1)),
        ("G (a -> b)\n.inputs a\n", ("SM583", 1, 9)),
        ("[](a -> b || c && d)\n", ("SM583", 1, 11)),
        ("INFO { SEMANTICS: Moore }\nMAIN { }\n", ("SM585", 1, 18)),
        ("INFO { SEMANTICS: Mealy,Finite }\nMAIN { }\n", ("SM585", 1, 18)),
        ("INFO { }\nGLOBAL { DEFINITIONS { S = {1, 2}; } }\nMAIN { }\n", ("SM581", 2, 28)),
        ("INFO { }\nMAIN { INPUTS { a; } GUARANTEE { a U; } }\n", ("SM583", 2, 37)),
        (
            "INFO { }\nGLOBAL { DEFINITIONS { f(i) = f(i + 1); } }\n"
            "MAIN { INPUTS { b[2]; }\nASSUME { b[f(0)]; } }\n",
            ("SM583", 2, 31),
        ),
        ("INFO { }\nMAIN { INPUTS { b[2]; }\nASSUME { b[2]; } }\n", ("SM583", 3, 12)),
        ("module M\nsys boolean a;\ngar G a &;\n", ("SM583", 3, 10)),
        ("module M\nsys boolean[3] a;\n", ("SM585", 2, 12)),
        ("module M\nsys boolean a;\ngar PREV next(a);\n", ("SM583", 3, 5)),
        ('{"inputs": {"x": "real"}, "outputs": {}}', ("SM585", 1, 19)),
        ('{"inputs": {}, "guarantees": ["x"]}', ("SM583", 1, 32)),
        ('{"variables": {"x": {"owner": "env", "type": [3, 1]}}}', ("SM582", 1, 21)),
        ('{"variables": {"x": {"owner": "env", "type": "bool"}},', ("SM581", 1, 55)),
        (
            '{"variables": {"x": {"owner": "env", "type": "bool"}},\n'
            ' "guarantees": {"safety": ["x \\u0026 \\n y"]}}',
            ("SM583", 2, 41),
        ),
        ("G a\n.inputs a b-c\n", ("SM581", 2, 11)),
        ("nothing that is known", ("SM580", 1, 1)),
        ('{"variables": ' + "[" * 100_000, ("SM581", 1, 1)),
    ],
)
def test_a_fault_is_told_with_its_place(text, faults):
    found, told = read(text)
    assert faults in [one[:3] for one in told], told
    assert found == ()


def test_a_formula_alone_does_not_say_who_decides():
    (contract,), told = read("[](req -> <>{state==Busy})\n", "x.spin.ltl")
    assert [one[:3] for one in told] == [("SM587", 1, 1)]
    assert [(one.name, one.owner.value) for one in contract.variables] == [
        ("state", "sys"),
        ("req", "sys"),
    ]


def test_names_of_slugs_and_tlsf_become_names_of_all_forms():
    slugs = "[INPUT]\nx@0.0.7\n[OUTPUT]\n[ENV_TRANS]\n! x@0.0.7'\n"
    (contract,), told = read(slugs, "a.slugsin")
    assert (told, said(contract.assumptions)) == ([], [("safety", "!x_0_0_7'")])
    (contract,), told = read("INFO { }\nMAIN { OUTPUTS { a'; } GUARANTEE { G a'; } }\n")
    assert (told, said(contract.guarantees)) == ([], [("safety", "a_")])


def test_a_contract_of_ours_comes_back_with_origins_and_words():
    variable = Variable("go", Owner.ENVIRONMENT, BooleanDomain(), "id-1")
    conjunct = Conjunct(Var("go"), Class.INIT, "id-2", "It \u00e4 'goes'.")
    contract = Contract("Plant::Gate", "id-0", (variable,), (conjunct,), ())
    assert read(formats.write(contract, "contract"))[0] == (contract,)


def test_only_the_contract_with_the_fault_is_missing():
    head = (
        "NAME: A;\nCONTRACT One:\n output boolean variable x;\n Guarantees:\n  G(x y);\n  G(z);\n"
    )
    found, told = read(head + "CONTRACT Two:\n output boolean variable x;\n Guarantees:\n  G(x);\n")
    assert [one.component for one in found] == ["A.Two"]
    assert [one[:3] for one in told] == [("SM583", 5, 7), ("SM583", 6, 5)]


def test_conjuncts_say_where_they_come_from():
    (contract,), _ = read("ENV: x;\nSYS: y;\nSYSTRANS: [](x -> y')\n  & [](y);\n", "a/b.spc")
    assert [one.origin for one in contract.guarantees] == ["a/b.spc:3:11", "a/b.spc:4:5"]
    assert contract.component == "b"


def test_parameters_and_definitions_of_tlsf_are_unfolded():
    text = """INFO { TITLE: "a
    b" SEMANTICS: Mealy,Strict }
GLOBAL { PARAMETERS { n = 3; }
  DEFINITIONS { half(i) = i / 2; least(bus, i) = i >= SIZEOF bus : true
      otherwise : !bus[i] && least(bus, i + 1); } }
MAIN { OUTPUTS { g[n]; } INPUTS { r; }
  PRESET { least(g, half(2)); }
  ASSERT { &&[0 <= i < n - 1] (g[i] -> X g[i + 1]); r -> ||[0 <= i < n] X g[i]; }
  GUARANTEE { G F g[0]; r U g[1]; } }"""
    (contract,), told = read(text)
    assert told == []
    assert [one.name for one in contract.variables] == ["g_0", "g_1", "g_2", "r"]
    assert said(contract.guarantees) == [
        ("init", "!g_1"),
        ("init", "!g_2"),
        ("safety", "g_0 -> g_1'"),
        ("safety", "g_1 -> g_2'"),
        ("safety", "r -> g_0' | g_1' | g_2'"),
        ("liveness", "g_0"),
        ("other", "r U g_1"),
    ]


def test_the_past_patterns_monitors_and_counters_of_spectra_become_variables():
    text = """module M
type Speed = Int(0..3);
env boolean up; sys Speed v; sys boolean a;
define fast := v > 2;
predicate near(Speed x, Speed y): x - y < 2;
monitor boolean seen { ini seen = up; G next(seen) = (seen | next(up)); }
counter c(0..5) { reset: a; inc: up; overflow: keep; }
asm respondsTo(up, !up);
gar limit: G near(v, next(v));
gar alw a <-> ONCE fast;
gar G next(a) = !a;
pattern respondsTo(trigger, response) { var boolean done; done;
  G (next(done) iff (response or done and !trigger)); GF (done); }
"""
    (contract,), told = read(text)
    assert told == []
    assert said(contract.assumptions) == [("liveness", "done_1")]
    assert said(contract.guarantees) == [
        ("init", "seen=up"),
        ("safety", "seen'=(seen | up')"),
        ("init", "c=0"),
        ("safety", "a -> c'=0"),
        ("safety", "!a & (up <-> false) -> c'=c"),
        ("safety", "!a & up & !c=5 -> c'=c + 1"),
        ("safety", "!a & up & c=5 -> c'=5"),
        ("init", "done_1"),
        ("safety", "done_1' <-> !up | done_1 & !up"),
        ("safety", "v - v'<2"),
        ("safety", "a <-> v>2 | since_1"),
        ("safety", "a'=(!a)"),
        ("init", "!since_1"),
        ("safety", "since_1' <-> v>2 | since_1"),
    ]


def test_slugs_lines_may_be_prefix_or_infix_and_remember():
    text = (
        "[INPUT]\na\nn:0...3\n[OUTPUT]\nb\n[SYS_TRANS]\n$ 2 & a b' ! ? 0\nn + 1 > 2 ^ a'\n^ a b\n"
    )
    (contract,), told = read(text)
    assert told == []
    assert said(contract.guarantees) == [
        ("safety", "!(a & b')"),
        ("safety", "!(n + 1>2 <-> a')"),
        ("safety", "!(a <-> b)"),
    ]


# -- the corpus ----------------------------------------------------------------------------------

FAMILIES = {
    "din8580/*.json": (33, 33),
    "robots/*.json": (34, 34),
    "gr1c/*.spc": (6, 6),
    "slugs/*slugs*": (11, 11),
    "tlsf_syntcomp/*.tlsf": (10, 10),
    "spectra/SYNTECH15/**/*.spectra": (78, 78),
    "spectra/forklift/**/*.spectra": (29, 29),
    "chase/*.ltl": (9, 27),
}
"""Files of each family, and contracts in them."""


def corpus(pattern):
    root = os.environ.get("SYSMLC_CORPUS")
    if not root:
        pytest.skip("SYSMLC_CORPUS is not set")
    files = sorted(Path(root, "gr1").glob(pattern))
    return [(file.name, file.read_text(encoding="utf-8", errors="replace")) for file in files]


@pytest.mark.corpus
@pytest.mark.parametrize(("pattern", "numbers"), FAMILIES.items(), ids=list(FAMILIES))
def test_the_corpus_is_read(pattern, numbers):
    files = corpus(pattern)
    found = [read(text, name) for name, text in files]
    told = [one for _, told in found for one in told if one[0] != "SM588"]
    assert (len(files), sum(len(contracts) for contracts, _ in found)) == numbers
    if not pattern.startswith("chase"):
        assert told == []


@pytest.mark.corpus
def test_the_fault_in_the_published_arm_and_the_probability_have_their_places():
    told = {name: read(text, name)[1] for name, text in corpus("chase/*.ltl")}
    assert {name: [one[:3] for one in found] for name, found in told.items() if found} == {
        "robotic_arm.ltl": [("SM583", 15, 20)],
        "test_1.ltl": [("SM583", 13, 11)],
    }


@pytest.mark.corpus
def test_the_lifts_are_not_strict():
    told = {name: read(text, name)[1] for name, text in corpus("tlsf_syntcomp/*.tlsf")}
    assert {name: [one[0] for one in found] for name, found in told.items() if found} == {
        "lift_gr1.tlsf": ["SM588"],
        "lift_wrong_physics_unreal.tlsf": ["SM588"],
    }


@pytest.mark.corpus
@pytest.mark.parametrize("form", ["gr1c", "slugsin", "structured", "tlsf", "spot", "smv", "chase"])
def test_din_8580_is_written_and_read_again_in_every_form(form):
    for name, text in corpus("din8580/*.json"):
        ((contract,), _) = read(text, name)
        if form == "gr1c" and name == "turn_mixed_init.json":
            with pytest.raises(formats.NotExpressibleError, match="each side speaks of its own"):
                formats.write(contract, form)
            continue
        written = formats.write(contract, form)
        ((again,), told) = read(written, "x", form)
        assert told == []
        assert formats.write(again, form) == written or form in ("slugsin", "tlsf", "spot")


PIECES = [*"(){}[];'!&=+-UGFX\"^:,0", "->", "next(", "PREV", "9" * 30, "\x00", "\ud800", "$ 3"]
PIECES += ["? 1", "..", "define", "pattern", "CONTRACT", "INPUTS", "[SYS_TRANS]", "SIZEOF"]


def spoiled(text, draw):
    for _ in range(draw.randint(1, 4)):
        at, to = sorted((draw.randrange(len(text) + 1), draw.randrange(len(text) + 1)))
        piece = draw.choice(PIECES) * draw.choice([1, 1, 1, 300])
        text = draw.choice(
            [
                text[:at] + text[at + draw.randint(1, 8) :],
                text[:at] + piece + text[at:],
                text[:at] + text[at : min(to, at + 200)] + text[at:],
                text[:at],
            ]
        )
    return text


@pytest.mark.corpus
def test_spoiled_files_are_told_and_never_fail():
    files = [one for pattern in FAMILIES for one in corpus(pattern) if len(one[1]) < 9_000]
    draw = random.Random(6)
    for _ in range(900):
        name, text = draw.choice(files)
        found, told = read(spoiled(text, draw), name)
        assert found or told
        for contract in found:
            assert read(formats.write(contract, "neutral"), form="neutral")[1] == []
        assert all(line > 0 and column > 0 and message for _, line, column, message in told)


def test_a_literal_that_is_called_like_a_variable_gets_an_underscore():
    domain = EnumerationDomain(("red", "blue"))
    variables = tuple(Variable(name, Owner.SYSTEM, domain) for name in ("colour", "red"))
    said = tuple(
        Conjunct(f.eq(Var("colour"), right), Class.INIT, "") for right in (Const("red"), Var("red"))
    )
    contract = Contract("C", "", variables, (), said)
    for form in ("contract", "neutral", "smv"):
        sink = Sink()
        (again,) = formats.read(formats.write(contract, form), "C.txt", sink, form)
        texts = [print_formula(one.formula) for one in again.guarantees]
        assert (list(sink), texts) == ([], ["colour=red_", "colour=red"])


def test_a_name_on_both_sides_is_the_variable_and_its_value():
    known = {"state": EnumerationDomain(("state", "busy"))}
    assert parse_formula("state=state", known) == f.eq(Var("state"), Const("state"))
