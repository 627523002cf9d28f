"""Spectra files as their own tool reads them: imports, arrays, quantifiers, patterns."""

from pathlib import Path

import pytest

from sysmlc.diagnostics import Sink
from sysmlc.logic import formats
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula

PATTERNS = """
module Patterns
/** Response: p is followed by s. */
pattern pRespondsToS(p, s) {
  var {S0, S1} state;
  -- initial assignments: initial state
  state=S0;
  alw ((state=S0 & (!p | s) & next(state=S0)) | (state=S0 & (p & !s) & next(state=S1)) |
       (state=S1 & s & next(state=S0)) | (state=S1 & !s & next(state=S1)));
  alwEv (state=S0);
}
pattern never(p) {
  var { S0, S1, S2} state; var boolean seen;
  state=S0; !seen;
  G (next(seen) <-> (seen | p)); alw (state=S2 -> TRUE); GF (!seen);
}
"""


def read(text: str, path: str = "spec.spectra") -> tuple[tuple[Contract, ...], list[str]]:
    """Return the contracts, and each diagnostic as location and message."""
    sink = Sink()
    contracts = formats.read(text, path, sink)
    return contracts, [
        f"{place.line}:{place.column} {diagnostic.message}"
        for diagnostic in sink
        if (place := diagnostic.subject.place)
    ]


def list_guarantees(text: str) -> list[str]:
    """Return the guarantees of a text without faults."""
    (contract,), faults = read(f"module M\n{text}")
    assert faults == []
    return [
        f"{conjunct.class_} {print_formula(conjunct.formula)}" for conjunct in contract.guarantees
    ]


# -- imports and patterns --------------------------------------------------------------------------


def test_a_pattern_of_an_imported_library_has_an_enumeration_as_its_state(tmp_path: Path):
    (tmp_path / "library").mkdir()
    (tmp_path / "library" / "Patterns.spectra").write_text(PATTERNS, encoding="utf-8")
    (tmp_path / "library" / "All.spectra").write_text(
        'import "Patterns.spectra"\nmodule All\n', encoding="utf-8"
    )
    text = """import "library/All.spectra"
module Door
env boolean call; sys boolean open;
gar pRespondsToS(call, open);
"""
    (contract,), faults = read(text, str(tmp_path / "door.spectra"))
    assert faults == []
    assert contract.component == "Door"
    library = tmp_path / "library" / "Patterns.spectra"
    assert [
        (print_formula(conjunct.formula), conjunct.origin.removeprefix(f"{library}"))
        for conjunct in contract.guarantees
    ] == [
        ("state_1=S0", ":7:3"),
        (
            "state_1=S0 & (!call | open) & state_1'=S0 | state_1=S0 & call & !open & state_1'=S1 |"
            " state_1=S1 & open & state_1'=S0 | state_1=S1 & !open & state_1'=S1",
            ":8:3",
        ),
        ("state_1=S0", ":10:3"),
    ]


@pytest.mark.parametrize("name", ["missing.spectra", "/etc/hostname", "door.txt"])
def test_an_import_that_is_no_spectra_file_is_located(tmp_path: Path, name: str):
    (tmp_path / "door.txt").write_text(PATTERNS, encoding="utf-8")
    text = f'import "{name}"\nmodule Door\nsys boolean open;\n'
    contracts, faults = read(text, str(tmp_path / "door.spectra"))
    assert contracts == ()
    assert faults == [
        f'1:8 the Spectra text is not understood: "{name}" is no Spectra file below the folder of '
        "the specification or of --include"
    ]


def test_an_import_leads_into_no_other_folder(tmp_path: Path):
    project = tmp_path / "project"
    project.mkdir()
    (tmp_path / "secret.spectra").write_text("module Secret\nsys boolean key;\n", encoding="utf-8")
    (project / "link.spectra").symlink_to(tmp_path / "secret.spectra")
    for name in ("../secret.spectra", "link.spectra"):
        text = f'import "{name}"\nmodule Door\nsys boolean open;\n'
        contracts, faults = read(text, str(project / "door.spectra"))
        assert contracts == ()
        assert "is no Spectra file below the folder" in faults[0]


def test_an_import_leads_into_the_folders_that_the_user_includes(tmp_path: Path):
    library = tmp_path / "library"
    library.mkdir()
    (library / "Patterns.spectra").write_text(PATTERNS, encoding="utf-8")
    text = """import "Patterns.spectra"
module Door
env boolean call; sys boolean open;
gar pRespondsToS(call, open);
"""
    path = tmp_path / "project" / "door.spectra"
    sink = Sink()
    (contract,) = formats.read(text, str(path), sink, include=(library,))
    assert not list(sink)
    assert contract.guarantees[0].origin.startswith(f"{library}/Patterns.spectra:")


def test_a_long_chain_of_defines_is_read():
    defines = " ".join(f"d{n} := d{n + 1} & !(a & b);" for n in range(1_000))
    text = f"module M env boolean a; sys boolean b; define {defines} d1000 := a; gar G (d0 -> b);"
    (contract,), faults = read(text)
    assert faults == []
    assert print_formula(contract.guarantees[0].formula) == "a & !(a & b) -> b"


@pytest.mark.parametrize(
    ("define", "reason"),
    [
        ("d0 := d1 & a; d1 := !d0;", "'d0' is defined by itself"),
        (
            "".join(f"d{n} := d{n + 1} & a | d{n + 1} & b;" for n in range(20)) + "d20 := a;",
            "with 'd0', more than 20,000 texts of defines, predicates and quantifiers are "
            "inserted; declare a variable for one that is used often",
        ),
    ],
)
def test_defines_that_cannot_be_expanded_are_reported(define: str, reason: str):
    text = f"module M env boolean a; sys boolean b; define {define} gar G (d0 -> b);"
    assert read(text)[1][0].endswith(reason)


TYPED_PREDICATES = """module M
env Int(0..3) a;
sys boolean[3] b;
predicate small(Int(0..3) v): v < 2;
predicate any_of(boolean[3] v): v[0] | v[1] | v[2];
pattern respond(x, y) { G (x -> y); }
"""


def test_parameters_of_predicates_have_ranges_and_are_arrays():
    (contract,), faults = read(TYPED_PREDICATES + "gar G (small(a) -> any_of(b));")
    assert faults == []
    assert print_formula(contract.guarantees[0].formula) == "a<2 -> b_0 | b_1 | b_2"


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        ("gar G any_of(a);", "the parameter 'v' of 'any_of' is an array"),
        ("gar G small(b);", "the parameter 'v' of 'small' is a value and no array"),
        (
            "gar G (respond(a = 1, b[0]));",
            "'respond' is a pattern, which is a statement and no part of a formula; write "
            "'guarantee respond(...);' without G",
        ),
    ],
)
def test_a_wrong_use_is_reported_with_its_reason(statement: str, reason: str):
    assert read(TYPED_PREDICATES + statement)[1][0].endswith(reason)


def test_a_file_that_imports_itself_by_a_longer_path_is_read_once(tmp_path: Path):
    (tmp_path / "sub").mkdir()
    path = tmp_path / "a.spectra"
    path.write_text('import "sub/../a.spectra"\nmodule A\nsys boolean a;\n', encoding="utf-8")
    (contract,), faults = read(path.read_text(encoding="utf-8"), str(path))
    assert faults == []
    assert [variable.name for variable in contract.variables] == ["a"]


def test_files_that_import_each_other_are_read_once(tmp_path: Path):
    for name, other in (("a", "b"), ("b", "a")):
        text = f'import "{other}.spectra"\nmodule {name}\nsys boolean {name};\n'
        (tmp_path / f"{name}.spectra").write_text(text, encoding="utf-8")
    path = tmp_path / "a.spectra"
    (contract,), faults = read(path.read_text(encoding="utf-8"), str(path))
    assert faults == []
    assert [variable.name for variable in contract.variables] == ["a", "b"]


# -- declarations in any order ---------------------------------------------------------------------


def test_types_defines_and_predicates_may_be_used_before_they_are_declared():
    text = """sys Level level;
gar G steady(level);
predicate steady(Level x): next(x) = x | x = LAST;
type Level = Range;
type Range = Int(0..(LAST));
define LAST := 3 - 1;"""
    assert list_guarantees(text) == ["safety level'=level | level=3 - 1"]


def test_a_type_that_contains_itself_is_located():
    assert read("module M\ntype A = B;\ntype B = A;\nsys A a;\n") == (
        (),
        [
            "3:10 the Spectra text is not understood: 'A' is defined by itself",
            "4:5 the Spectra text is not understood: 'A' is defined by itself",
        ],
    )


def test_the_previous_step_may_be_about_two_states():
    text = "sys Int(0..3) n; gar G PREV (next(n) - n = 1) -> n = 2;"
    assert list_guarantees(text) == [
        "safety did_1 -> n=2",
        "init !did_1",
        "safety did_1' <-> n' - n=1",
    ]


# -- arrays, quantifiers, case distinctions --------------------------------------------------------


def test_an_element_of_an_array_is_a_variable():
    text = "sys Int(0..5)[2] b; define N := 2; gar G next(b[N - 1]) = b[0] + 1;"
    assert list_guarantees(text) == ["safety b_1'=b_0 + 1"]


def test_an_index_that_is_a_variable_distinguishes_the_elements():
    text = (
        "sys Int(0..5)[2] b; sys boolean[2] c; sys Int(0..1) i; gar G b[i] = 3; gar G next(c[i]);"
    )
    assert list_guarantees(text) == [
        "safety i=0 & b_0=3 | i=1 & b_1=3",
        "safety i'=0 & c_0' | i'=1 & c_1'",
    ]


def test_dimensions_of_a_named_type_follow_those_of_the_variable():
    text = "type Row = boolean[3]; sys Row[2] g; gar g[1][2]; gar !g[0][0];"
    assert list_guarantees(text) == ["init g_1_2", "init !g_0_0"]


def test_an_index_outside_of_the_array_is_located():
    contracts, faults = read("module M\nsys boolean[3] a;\ngar a[3];\n")
    assert contracts == ()
    assert [fault.partition(": ")[::2] for fault in faults] == [
        (
            "3:7 the formula among the init guarantees is not understood",
            "the index 3 is not below 3",
        )
    ]


def test_quantifiers_are_read_once_for_each_value():
    text = """sys boolean[3] g; env {RED, BLUE} c;
gar alw forall i in Int(0..1). g[i] -> !g[i + 1];
gar GF exists k in {RED, BLUE}. (c = k & g[0]);
gar each{Int(1..2) i}: GF g[i];"""
    assert list_guarantees(text) == [
        "safety (g_0 -> !g_1) & (g_1 -> !g_2)",
        "liveness c=RED & g_0 | c=BLUE & g_0",
        "liveness g_1",
        "liveness g_2",
    ]


def test_functions_of_all_elements_defined_arrays_and_lists_of_values():
    text = """sys Int(0..3)[2] n; sys boolean[2] b; sys {A, B, C} c; define W[2] := {1, 2};
gar n.sum <= W[1]; gar b.all | b.any; gar n.max = 3; gar c in {A, C}; gar n[0] not in {1, 2-3};
gar ite(b[0], n[0], n[1]) = 0;"""
    assert list_guarantees(text) == [
        "init n_0 + n_1<=2",
        "init b_0 & b_1 | b_0 | b_1",
        "init n_0>=n_0 & n_0>=n_1 & n_0=3 | n_1>=n_0 & n_1>=n_1 & n_1=3",
        "init c=A | c=C",
        "init !(n_0=1 | n_0=2 | n_0=3)",
        "init b_0 & n_0=0 | !b_0 & n_1=0",
    ]


# -- what is not read ------------------------------------------------------------------------------


def test_a_weight_is_reported_and_changes_nothing():
    (contract,), faults = read("module M\nsys boolean on;\nweight cost: -2 on;\ngar GF on;\n")
    assert faults == [
        "3:1 the weight is not used: it ranks controllers, and does not change whether one exists"
    ]
    assert len(contract.guarantees) == 1


@pytest.mark.parametrize("statement", ["gar GE a;", "gar trig r |=> s;", "regexp r := [a]*;"])
def test_regular_expressions_and_existential_guarantees_are_located(statement: str):
    contracts, faults = read(f"module M\nsys boolean a;\n{statement}\n")
    assert contracts == ()
    assert [fault.rpartition(" is not ")[2] for fault in faults] == [
        "in the supported part of Spectra"
    ]
