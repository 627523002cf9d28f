"""``sysmlc explain`` and ``sysmlc show``."""

import sys


def test_explain_shows_a_wrong_and_a_right_model(workspace):
    lines = workspace.sysmlc("explain", "test-nameless-port").stdout.splitlines()
    assert lines[0] == "SM942 test-nameless-port (error)"
    assert lines[2] == "  a port of '<owner>' has no name"
    assert lines[-6:] == [
        '  Class gate "Gate"',
        ">   Port gate.in",
        "",
        "Right:",
        '  Class gate "Gate"',
        '>   Port gate.in "in"',
    ]
    assert workspace.sysmlc("explain", "sm942").stdout.splitlines() == lines
    assert workspace.sysmlc("explain", "SM942").stdout.splitlines() == lines


def test_explain_without_a_code_lists_all_rules_in_order(workspace):
    codes = [line.split()[0] for line in workspace.sysmlc("explain").stdout.splitlines()]
    assert codes == sorted(codes)
    assert {"SM170", "SM176", "SM900"} <= set(codes)


def test_explain_notes_a_back_end_that_cannot_be_imported(workspace, monkeypatch):
    complete = workspace.sysmlc("explain").stdout
    monkeypatch.setitem(sys.modules, "sysmlc.backends.ecore", None)
    result = workspace.sysmlc("explain")
    assert result.exit_code == 0
    assert result.stdout == complete
    assert "note: the rules of sysmlc.backends.ecore are missing" in result.stderr


def test_show_prints_a_graph_that_can_be_compiled_again(workspace):
    text = workspace.sysmlc("show", "plant.ir").stdout
    workspace.write("again.ir", text)
    assert workspace.sysmlc("show", "again.ir").stdout == text


def test_show_finds_an_element_by_qualified_name_name_or_id(workspace):
    outputs = {
        workspace.sysmlc("show", "plant.ir", "-e", name).stdout
        for name in ("Plant::Gate", "Gate", "gate")
    }
    assert outputs == {
        'Class gate "Gate" @plant.ir:-1\n'
        '  Port gate.in "in" @plant.ir:-1\n'
        "    -> typed-by pallet\n"
        "  <- owns Plant\n"
    }


def test_show_lists_all_elements_of_an_ambiguous_name(workspace):
    workspace.write("two.ir", 'Package a "A"\n  Class x "X"\nPackage b "B"\n  Class y "X"\n')
    result = workspace.sysmlc("show", "two.ir", "-e", "X")
    assert result.exit_code == 2
    assert "A::X (Class, id x)" in result.stderr
    assert "B::X (Class, id y)" in result.stderr
