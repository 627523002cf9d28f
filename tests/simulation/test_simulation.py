"""Scenarios of activities on the reference interpreter: results, reports and faults."""

from xml.etree import ElementTree

import pytest

from sysmlc.analyses.activities import Activities
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text
from sysmlc.simulation import run_scenarios
from sysmlc.sources import Source

GATE = """
Class gate "Gate"
  Property angle "angle" default=90
    -> typed-by int
  Constraint c body="0 <= angle and angle <= 180"
  Activity pass "pass"
    Control i "" subkind="initial"
    Action read "read" subkind="opaque"
    Control d "wide?" subkind="decision"
    Action pull "pull" subkind="opaque"
    Action release "release" subkind="opaque"
    Control m "" subkind="merge"
    Control f "" subkind="final"
    ControlFlow f1
      -> flow-source i
      -> flow-target read
    ControlFlow f2
      -> flow-source read
      -> flow-target d
    ControlFlow f3 guard="angle >= 45"
      -> flow-source d
      -> flow-target pull
    ControlFlow f4 guard="else"
      -> flow-source d
      -> flow-target release
    ControlFlow f5
      -> flow-source pull
      -> flow-target m
    ControlFlow f6
      -> flow-source release
      -> flow-target m
    ControlFlow f7
      -> flow-source m
      -> flow-target f
DataType int "Integer"
"""

PULLS = """
name: a wide gate pulls
component: Gate.pass
steps:
  - expect: {run_read: true}
  - inputs: {done_read: true}
    expect: {run_read: true}
  - expect: {run_read: false, run_pull: false, angle: 90}
  - inputs: {done_pull: true}
    expect: {run_pull: true, run_release: false}
"""


def simulate(text: str, model: str = GATE):
    graph = parse_text(model)
    Activities().run(graph, Sink())
    sink = Sink()
    return run_scenarios(graph, Source("s.yaml", text.encode()), sink), sink


def test_a_scenario_that_follows_the_diagram_passes():
    report, sink = simulate(PULLS)
    assert list(sink) == []
    assert report.passed
    assert report.as_text() == (
        "passed  Gate.pass: a wide gate pulls (4 steps)\n1 of 1 scenario passed\n"
    )


def test_properties_keep_their_value_and_done_inputs_last_one_step():
    narrow = PULLS.replace("- expect: {run_read: true}", "- inputs: {angle: 30}", 1)
    report, _ = simulate(narrow.replace("angle: 90", "angle: 30, done_read: false"))
    assert str(report.results[0].difference) == "step 4: run_pull is false, expected true"


def test_the_first_difference_is_reported_with_its_line():
    report, _ = simulate(PULLS.replace("run_pull: true", "run_pull: false"))
    assert not report.passed
    assert report.as_text() == (
        "FAILED  Gate.pass: a wide gate pulls\n"
        "        s.yaml:10: step 4: run_pull is true, expected false\n"
        "0 of 1 scenario passed\n"
    )


def test_junit_has_a_case_for_each_scenario():
    two_scenarios = "scenarios:\n" + "".join(
        "  - " + "\n    ".join(text.strip().splitlines()) + "\n"
        for text in (PULLS, PULLS.replace("run_pull: true", "run_pull: false"))
    )
    report, _ = simulate(two_scenarios)
    root = ElementTree.fromstring(report.as_junit())
    assert root.attrib == {"tests": "2", "failures": "1", "errors": "0"}
    good, bad = root.iter("testcase")
    assert (good.get("classname"), good.get("name")) == ("Gate.pass", "a wide gate pulls")
    assert [(case.get("file"), case.get("line")) for case in (good, bad)] == [
        ("s.yaml", "3"),
        ("s.yaml", "12"),
    ]
    assert good.find("failure") is None
    assert bad.find("failure").get("message") == "step 4: run_pull is true, expected false"
    assert report.as_junit() == simulate(two_scenarios)[0].as_junit()


def test_the_failing_run_is_drawn_with_a_message_for_each_change():
    report, _ = simulate(PULLS.replace("run_pull: true", "run_pull: false"))
    assert report.sequence_diagram() == (
        "@startuml\n"
        "title a wide gate pulls\n"
        "hide footbox\n"
        "participant environment\n"
        'participant "Gate.pass" as component\n'
        "== step 1 ==\n"
        "environment -> component : angle = 90\n"
        "component -> environment : running(read) = true\n"
        "== step 2 ==\n"
        "environment -> component : finished(read) = true\n"
        "== step 3 ==\n"
        "environment -> component : finished(read) = false\n"
        "component -> environment : running(read) = false\n"
        "component -> environment : at_read_to_wide = true\n"
        "== step 4 ==\n"
        "environment -> component : finished(pull) = true\n"
        "component -> environment : running(pull) = true\n"
        "component -> environment : at_read_to_wide = false\n"
        "note over component #FFDDDD\n"
        "  run_pull is true\n"
        "  expected: false\n"
        "end note\n"
        "@enduml\n"
    )


REPEATED = """
component: Gate.pass
steps:
  - repeat: 4
trace:
  - {run_read: true, run_pull: false}
  - {run_read: true}
  - {run_read: true}
"""


def test_the_run_of_a_repeated_step_is_compared_with_the_expected_trace():
    report, _ = simulate(REPEATED)
    assert report.passed
    assert len(report.results[0].trace) == 4


def test_a_component_is_named_with_its_class():
    report, _ = simulate(REPEATED.replace("Gate.pass", "pass"))
    assert not report.results[0].is_valid


CHOICE = """
Activity a "a"
  Control i "" subkind="initial"
  Control d "" subkind="decision"
  Action x "x" subkind="opaque"
  Action y "y" subkind="opaque"
  ControlFlow f1
    -> flow-source i
    -> flow-target d
  ControlFlow f2
    -> flow-source d
    -> flow-target x
  ControlFlow f3
    -> flow-source d
    -> flow-target y
"""


@pytest.mark.parametrize(
    ("last", "passes"), [("run_x: true", True), ("run_y: true", True), ("run_x: 0", False)]
)
def test_one_of_the_runs_that_a_choice_allows_is_enough(last, passes):
    report, _ = simulate(f"component: a\nsteps: [{{}}, {{}}, {{expect: {{ {last} }} }}]\n", CHOICE)
    assert report.passed is passes
    report, _ = simulate(
        "component: a\nsteps: [{}, {}, {expect: {run_x: true, run_y: true}}]\n", CHOICE
    )
    assert not report.passed


@pytest.mark.parametrize(
    ("text", "code", "message", "line"),
    [
        ("component: [Gate\nsteps: []", "SM550", "the scenario is not YAML", 2),
        ("- 1", "SM551", "in the scenario at the top: [1] is not of type 'object'", 1),
        ("component: Gate.pass\n", "SM551", "at the top: lacks 'steps'", 1),
        (
            "component: Gate.pass\nsteps:\n - input: {}\n",
            "SM551",
            "at 'steps[1]': unknown key 'input'",
            3,
        ),
        ("component: Gat\nsteps: [{}]\n", "SM552", "known are: Gate.pass", 1),
        (
            "component: Gate.pass\nsteps:\n - expect: {run_raed: true}\n",
            "SM553",
            "has no variable 'run_raed'; did you mean 'run_read'?",
            3,
        ),
        (
            "component: Gate.pass\nsteps:\n - expect:\n     angle: 190\n",
            "SM554",
            "190 is not a value of 'angle', which takes 0..180",
            4,
        ),
        (
            "component: Gate.pass\nsteps:\n - inputs: {run_read: true}\n",
            "SM555",
            "'run_read' is decided by 'Gate.pass'",
            3,
        ),
        ("component: Gate.pass\nsteps: [{}]\ntrace: [{}, {}]\n", "SM556", "has 2 entries", 3),
        ("&x {component: *x, steps: []}", "SM550", "contains itself", 1),
        ("\x00", "SM550", "the scenario is not YAML", 1),
    ],
)
def test_a_fault_of_a_scenario_is_reported_at_its_line(text, code, message, line):
    report, sink = simulate(text)
    (diagnostic,) = sink
    assert diagnostic.rule.code == code
    assert message in diagnostic.message
    assert diagnostic.subject.place.line == line
    assert not report.passed


@pytest.mark.parametrize(
    "rule", [rule for code, rule in catalogue().items() if "SM550" <= code <= "SM556"], ids=str
)
def test_each_rule_about_scenarios_has_a_wrong_and_a_right_example(rule):
    model = GATE.replace('Class gate "Gate"', 'Class gate "Gate"\n  -> classifier-behavior pass')
    _, sink = simulate(rule.read_page().wrong, model)
    assert [diagnostic.rule.code for diagnostic in sink] == [rule.code]
    report, sink = simulate(rule.read_page().right, model)
    assert list(sink) == []
    assert report.results
