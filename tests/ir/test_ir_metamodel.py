"""The metamodel: ``kinds.py`` is up to date, and ``verify`` finds violations of its constraints."""

from sysmlc.ir import parse_text, verify
from sysmlc.ir.generate import generate
from sysmlc.support import resources


def test_the_generated_module_is_up_to_date():
    written = resources.find_root() / "compiler" / "sysmlc" / "ir" / "kinds.py"
    assert "".join(generate().split()) == "".join(written.read_text().split())


def test_verify_finds_a_flow_with_two_sources():
    graph = parse_text(
        "Activity a\n  Action x\n  Action y\n  ControlFlow f\n    -> flow-source x y\n"
    )
    assert verify(graph) == ["<ControlFlow f> (f) has several flow-source edges"]


def test_verify_finds_a_wrong_owner_and_an_unknown_origin():
    graph = parse_text('Class c\n  Region r\n  Action a origin="gone"\n')
    assert verify(graph) == [
        "<Region r> (r) must not be owned by <Class c>",
        "<Action a> (a) names an origin that does not exist",
    ]
