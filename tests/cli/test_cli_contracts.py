"""``sysmlc contracts check``: one line for each contract, diagnostics, exit codes."""

from sysmlc.synthesis import composition_check, contract_checks, rules


def test_a_realizable_contract_is_one_line(workspace):
    workspace.write("lamp.gr1.json", rules.NO_FAIRNESS.read_page().right)
    result = workspace.sysmlc("contracts", "check", "lamp.gr1.json")
    assert [result.exit_code, result.stdout] == [0, "lamp: realizable\n"]


def test_a_vacuous_contract_is_a_warning(workspace):
    workspace.write("lamp.gr1.json", rules.IDLE.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "lamp.gr1.json")
    assert result.exit_code == 0
    assert "warning[SM541 vacuous-win]: 'lamp' satisfies its contract without ever" in result.stderr


def test_an_unrealizable_contract_is_an_error(workspace):
    workspace.write("lamp.gr1.json", rules.NO_FAIRNESS.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "lamp.gr1.json")
    assert [result.exit_code, result.stdout] == [1, "lamp: unrealizable\n"]
    assert "for instance if 'go' recurred" in result.stderr


def test_a_behaviour_that_violates_a_requirement_is_an_error_with_a_run(workspace, all_passes):
    workspace.write("lamp.ir", contract_checks.BREAKS.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "lamp.ir")
    assert result.exit_code == 1
    assert "Plant::Gate: realizable, violates its requirements\n" in result.stdout
    assert "error[SM560 behaviour-breaks-requirement]" in result.stderr
    assert "step 2: event=stop, state=B" in result.stderr


def test_one_component_can_be_selected(workspace, all_passes):
    workspace.write("lamp.ir", contract_checks.BREAKS.read_page().right)
    result = workspace.sysmlc("contracts", "check", "lamp.ir", "-c", "Plant::Gate.requirements")
    assert result.stdout == "Plant::Gate.requirements: realizable\n"
    result = workspace.sysmlc("contracts", "check", "lamp.ir", "-c", "Plant::Gat")
    assert [result.exit_code, result.stdout] == [2, ""]


def test_a_selected_component_is_compared_with_its_requirements(workspace, all_passes):
    workspace.write("lamp.ir", contract_checks.BREAKS.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "lamp.ir", "-c", "Plant::Gate")
    assert [result.exit_code, result.stdout] == [
        1,
        "Plant::Gate: realizable, violates its requirements\n"
        "  Stays on: broken: G (state=B -> state'=B)\n",
    ]


def test_parts_of_a_block_are_composed_and_violating_runs_are_drawn(workspace, all_passes):
    workspace.write("cell.sysml", composition_check.OPEN.read_page().wrong)
    result = workspace.sysmlc("contracts", "check", "cell.sysml", "-c", "Line::Cell", "-o", "out")
    assert result.exit_code == 1
    assert result.stdout == (
        "Line::Cell: realizable\nLine::Cell: its 2 parts together violate its contract\n"
    )
    assert "error[SM595 part-assumption-open]: part 'picker' of 'Line::Cell'" in result.stderr
    assert workspace.list_files("out") == ["Line.Cell.run1.puml", "Line.Cell.run2.puml"]


def test_errors_of_the_model_are_reported_when_it_has_no_contracts(workspace, all_passes):
    workspace.write(
        "cell.sysml",
        composition_check.OPEN.read_page().wrong.replace("import ScalarValues::*", "import Units"),
    )
    result = workspace.sysmlc("contracts", "check", "cell.sysml")
    assert result.exit_code == 2
    assert "SM205 unresolved-name" in result.stderr
