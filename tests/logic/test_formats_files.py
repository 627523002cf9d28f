"""Readers of all formats: detection, faults with their locations, and the corpus."""

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

RULES = [rule for code, rule in sorted(catalogue().items()) if "SM580" <= code <= "SM589"]


def read(text, path="spec.txt", format_name=""):
    """Return the contracts, and each diagnostic as code, line, column and message."""
    sink = Sink()
    contracts = formats.read(text, path, sink, format_name)
    places = [diagnostic.subject.place for diagnostic in sink]
    return contracts, [
        (diagnostic.rule.code, place.line, place.column, diagnostic.message)
        for diagnostic, place in zip(sink, places, strict=True)
    ]


def locate(diagnostics):
    """Return diagnostics without their messages."""
    return [diagnostic[:3] for diagnostic in diagnostics]


def print_conjuncts(conjuncts):
    return [(str(conjunct.class_), print_formula(conjunct.formula)) for conjunct in conjuncts]


def test_the_ten_rules_about_formats_are_tested_here():
    assert len(RULES) == 10
    assert rules.UNKNOWN_FORM in RULES


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.code)
def test_the_wrong_example_breaks_the_rule_and_the_right_one_does_not(rule):
    assert rule.code in [code for code, *_ in read(rule.read_page().wrong)[1]]
    assert rule.code not in [code for code, *_ in read(rule.read_page().right)[1]]


@pytest.mark.parametrize(
    ("text", "fault"),
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
        ("module M\nsys boolean[0] a;\n", ("SM581", 2, 13)),
        ("module M\nsys boolean a;\ngar ONCE next(a);\n", ("SM583", 3, 5)),
        ('{"inputs": {"x": "real"}, "outputs": {}}', ("SM585", 1, 18)),
        ('{"inputs": {}, "guarantees": ["x"]}', ("SM583", 1, 32)),
        ('{"variables": {"x": {"owner": "env", "type": [3, 1]}}}', ("SM582", 1, 46)),
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
def test_a_fault_is_reported_with_its_location(text, fault):
    contracts, diagnostics = read(text)
    assert fault in locate(diagnostics), diagnostics
    assert contracts == ()


def test_variables_without_owner_are_outputs_and_reported():
    (contract,), diagnostics = read("[](req -> <>{state==Busy})\n", "x.spin.ltl")
    assert locate(diagnostics) == [("SM587", 1, 1)]
    owners = [(variable.name, variable.owner.value) for variable in contract.variables]
    assert owners == [("state", "sys"), ("req", "sys")]


def test_signs_in_names_of_slugs_and_tlsf_become_underscores():
    slugs = "[INPUT]\nx@0.0.7\n[OUTPUT]\n[ENV_TRANS]\n! x@0.0.7'\n"
    (contract,), diagnostics = read(slugs, "a.slugsin")
    assert diagnostics == []
    assert print_conjuncts(contract.assumptions) == [("safety", "!x_0_0_7'")]
    (contract,), diagnostics = read("INFO { }\nMAIN { OUTPUTS { a'; } GUARANTEE { G a'; } }\n")
    assert diagnostics == []
    assert print_conjuncts(contract.guarantees) == [("safety", "a_")]


def test_sysmlc_contract_preserves_origins_and_texts():
    variable = Variable("go", Owner.ENVIRONMENT, BooleanDomain(), "id-1")
    conjunct = Conjunct(Var("go"), Class.INIT, "id-2", "It \u00e4 'goes'.")
    contract = Contract("Plant::Gate", "id-0", (variable,), (conjunct,), ())
    assert read(formats.write(contract, "contract"))[0] == (contract,)


def test_only_the_contract_with_the_fault_is_missing():
    head = (
        "NAME: A;\nCONTRACT One:\n output boolean variable x;\n Guarantees:\n  G(x y);\n  G(z);\n"
    )
    contracts, diagnostics = read(
        head + "CONTRACT Two:\n output boolean variable x;\n Guarantees:\n  G(x);\n"
    )
    assert [contract.component for contract in contracts] == ["A.Two"]
    assert locate(diagnostics) == [("SM583", 5, 7), ("SM583", 6, 5)]


def test_the_origin_of_a_conjunct_is_its_location():
    (contract,), _ = read("ENV: x;\nSYS: y;\nSYSTRANS: [](x -> y')\n  & [](y);\n", "a/b.spc")
    origins = [conjunct.origin for conjunct in contract.guarantees]
    assert origins == ["a/b.spc:3:11", "a/b.spc:4:5"]
    assert contract.component == "b"


def test_parameters_and_definitions_of_tlsf_are_evaluated():
    text = """INFO { TITLE: "a
    b" SEMANTICS: Mealy,Strict }
GLOBAL { PARAMETERS { n = 3; }
  DEFINITIONS { half(i) = i / 2; least(bus, i) = i >= SIZEOF bus : true
      otherwise : !bus[i] && least(bus, i + 1); } }
MAIN { OUTPUTS { g[n]; } INPUTS { r; }
  PRESET { least(g, half(2)); }
  ASSERT { &&[0 <= i < n - 1] (g[i] -> X g[i + 1]); r -> ||[0 <= i < n] X g[i]; }
  GUARANTEE { G F g[0]; r U g[1]; } }"""
    (contract,), diagnostics = read(text)
    assert diagnostics == []
    names = [variable.name for variable in contract.variables]
    assert names == ["g_0", "g_1", "g_2", "r"]
    assert print_conjuncts(contract.guarantees) == [
        ("init", "!g_1"),
        ("init", "!g_2"),
        ("safety", "g_0 -> g_1'"),
        ("safety", "g_1 -> g_2'"),
        ("safety", "r -> g_0' | g_1' | g_2'"),
        ("liveness", "g_0"),
        ("other", "r U g_1"),
    ]


def test_past_patterns_monitors_and_counters_of_spectra_become_variables():
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
    (contract,), diagnostics = read(text)
    assert diagnostics == []
    assert print_conjuncts(contract.assumptions) == [("liveness", "done_1")]
    assert print_conjuncts(contract.guarantees) == [
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


def test_slugs_lines_are_prefix_with_memory_or_infix():
    text = (
        "[INPUT]\na\nn:0...3\n[OUTPUT]\nb\n[SYS_TRANS]\n$ 2 & a b' ! ? 0\nn + 1 > 2 ^ a'\n^ a b\n"
    )
    (contract,), diagnostics = read(text)
    assert diagnostics == []
    assert print_conjuncts(contract.guarantees) == [
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
"""Numbers of files and of contracts by family."""


def read_corpus(pattern):
    root = os.environ["SYSMLC_CORPUS"]
    files = sorted(Path(root, "gr1").glob(pattern))
    return [(file.name, file.read_text(encoding="utf-8", errors="replace")) for file in files]


@pytest.mark.corpus
@pytest.mark.parametrize(("pattern", "numbers"), FAMILIES.items(), ids=list(FAMILIES))
def test_the_corpus_is_read(pattern, numbers):
    files = read_corpus(pattern)
    results = [read(text, name) for name, text in files]
    assert (len(files), sum(len(contracts) for contracts, _ in results)) == numbers
    if not pattern.startswith("chase"):
        codes = [code for _, diagnostics in results for code, *_ in diagnostics]
        assert set(codes) <= {"SM588"}


@pytest.mark.corpus
def test_the_fault_in_the_published_arm_and_the_probability_are_located():
    results = {name: read(text, name)[1] for name, text in read_corpus("chase/*.ltl")}
    assert {name: locate(diagnostics) for name, diagnostics in results.items() if diagnostics} == {
        "robotic_arm.ltl": [("SM583", 15, 20)],
        "test_1.ltl": [("SM583", 13, 11)],
    }


@pytest.mark.corpus
def test_only_the_lifts_are_reported_as_not_strict():
    results = {name: read(text, name)[1] for name, text in read_corpus("tlsf_syntcomp/*.tlsf")}
    codes = {name: [code for code, *_ in diagnostics] for name, diagnostics in results.items()}
    assert {name: listed for name, listed in codes.items() if listed} == {
        "lift_gr1.tlsf": ["SM588"],
        "lift_wrong_physics_unreal.tlsf": ["SM588"],
    }


@pytest.mark.corpus
@pytest.mark.parametrize(
    "format_name", ["gr1c", "slugsin", "structured", "tlsf", "spot", "smv", "chase"]
)
def test_din_8580_is_written_and_read_again_in_every_format(format_name):
    for name, text in read_corpus("din8580/*.json"):
        ((contract,), _) = read(text, name)
        if format_name == "gr1c" and name == "turn_mixed_init.json":
            with pytest.raises(formats.NotExpressibleError, match="each side speaks of its own"):
                formats.write(contract, format_name)
            continue
        written = formats.write(contract, format_name)
        ((again,), diagnostics) = read(written, "x", format_name)
        assert diagnostics == []
        if format_name not in ("slugsin", "tlsf", "spot"):
            assert formats.write(again, format_name) == written


PIECES = [*"(){}[];'!&=+-UGFX\"^:,0", "->", "next(", "PREV", "9" * 30, "\x00", "\ud800", "$ 3"]
PIECES += ["? 1", "..", "define", "pattern", "CONTRACT", "INPUTS", "[SYS_TRANS]", "SIZEOF"]


def damage(text, draw):
    """Remove, insert or repeat characters at random, or cut the text."""
    for _ in range(draw.randint(1, 4)):
        start, end = sorted((draw.randrange(len(text) + 1), draw.randrange(len(text) + 1)))
        piece = draw.choice(PIECES) * draw.choice([1, 1, 1, 300])
        text = draw.choice(
            [
                text[:start] + text[start + draw.randint(1, 8) :],
                text[:start] + piece + text[start:],
                text[:start] + text[start : min(end, start + 200)] + text[start:],
                text[:start],
            ]
        )
    return text


@pytest.mark.corpus
def test_damaged_files_are_reported_without_exceptions():
    files = [file for pattern in FAMILIES for file in read_corpus(pattern)]
    small_files = [(name, text) for name, text in files if len(text) < 9_000]
    draw = random.Random(6)
    for _ in range(900):
        name, text = draw.choice(small_files)
        contracts, diagnostics = read(damage(text, draw), name)
        assert contracts or diagnostics
        for contract in contracts:
            neutral = formats.write(contract, "neutral")
            assert read(neutral, format_name="neutral")[1] == []
        assert all(line > 0 and column > 0 and message for _, line, column, message in diagnostics)


def test_a_literal_with_the_name_of_a_variable_gets_an_underscore():
    domain = EnumerationDomain(("red", "blue"))
    variables = tuple(Variable(name, Owner.SYSTEM, domain) for name in ("colour", "red"))
    literal, variable = Const("red"), Var("red")
    conjuncts = tuple(
        Conjunct(f.eq(Var("colour"), value), Class.INIT, "") for value in (literal, variable)
    )
    contract = Contract("C", "", variables, (), conjuncts)
    for format_name in ("contract", "neutral", "smv"):
        written = formats.write(contract, format_name)
        (again,), diagnostics = read(written, "C.txt", format_name)
        assert diagnostics == []
        texts = [print_formula(conjunct.formula) for conjunct in again.guarantees]
        assert texts == ["colour=red_", "colour=red"]


def test_a_name_on_both_sides_is_the_variable_and_its_value():
    domains = {"state": EnumerationDomain(("state", "busy"))}
    assert parse_formula("state=state", domains) == f.eq(Var("state"), Const("state"))
