"""The Python API: its names, and the examples of docs/python-api.md with their outputs."""

import json
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import sysmlc

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/python-api.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"<!-- example: (\w+) -->\n```python\n(.*?)```", PAGE, re.DOTALL)
OUTPUTS = dict(re.findall(r"<!-- output: (\w+) -->\n```text\n(.*?)```", PAGE, re.DOTALL))


@pytest.fixture
def restore_catalogue():
    """Remove the rule that an example defines, after the test."""
    yield
    catalogue = import_module("sysmlc.diagnostics.rule")
    catalogue._rules.pop("ACME003", None)
    catalogue._names.discard("port-prefix")


@pytest.mark.parametrize(("name", "code"), EXAMPLES)
def test_an_example_prints_the_output_on_the_page(
    name, code, restore_catalogue, monkeypatch, capsys
):
    monkeypatch.chdir(ROOT)
    exec(compile(code, name, "exec"), {"__name__": name})
    output = capsys.readouterr().out
    assert output == OUTPUTS.get(name, output)
    assert output


def test_the_examples_have_their_output_on_the_page():
    assert {name for name, _ in EXAMPLES} - set(OUTPUTS) == {"contracts"}


@pytest.mark.parametrize("name", sysmlc.__all__)
def test_every_name_of_the_interface_is_on_the_page(name):
    assert getattr(sysmlc, name) is not None
    assert f"`{name}" in PAGE


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'compile'"):
        sysmlc.compile  # noqa: B018 - the access is the test


def test_importing_the_package_imports_no_module_of_the_compiler():
    program = "import sys, sysmlc; print(sorted(m for m in sys.modules if m.startswith('sysmlc.')))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]"


def test_a_missing_file_is_a_diagnostic(tmp_path):
    compilation = sysmlc.compile_model(tmp_path / "plant.uml")
    assert [diagnostic.rule.code for diagnostic in compilation.diagnostics] == ["SM170"]


def test_outputs_are_not_written_to_files(tmp_path):
    model = tmp_path / "plant.ir"
    model.write_text('Class gate "Gate"\n')
    compilation = sysmlc.compile_model([model], emit=["ir"])
    assert [artefact.path for artefact in compilation.artefacts] == ["graph.ir"]
    assert list(tmp_path.iterdir()) == [model]


GATE = """package Plant {
    part def Gate { attribute open : ScalarValues::Boolean; part bolt : Bolt; }
}
"""
LAMP = """package Plant {
    part def Lamp {
        in attribute wanted : ScalarValues::Boolean;
        out attribute lit : ScalarValues::Boolean;
    }
    requirement def Shines {
        subject lamp : Lamp;
        require constraint { language "ltl" /* G (wanted -> X lit) */ }
    }
}
"""


def test_findings_of_texts_in_memory_have_locations():
    compilation = sysmlc.compile_texts({"gate.sysml": GATE})
    (finding,) = sysmlc.list_findings(compilation)
    assert finding.where == "gate.sysml:2:73"
    assert "unknown name 'Bolt'" in finding.diagnostic.message
    text = sysmlc.format_findings([finding], "concise")
    assert "error[SM205 unresolved-name]" in text
    region = json.loads(sysmlc.format_findings([finding], "sarif"))["runs"][0]["results"][0][
        "locations"
    ][0]["physicalLocation"]["region"]
    assert region == {"startLine": 2, "startColumn": 73, "endLine": 2, "endColumn": 77}
    imported = GATE.replace("part bolt : Bolt;", "part bolt : Parts::Bolt;")
    fixed = {"gate.sysml": imported, "parts.sysml": "package Parts { part def Bolt; }"}
    assert sysmlc.list_findings(sysmlc.compile_texts(fixed)) == []


def test_texts_in_memory_may_have_any_name_and_any_characters():
    texts = {"/home/a.sysml": "package A;", "../a.sysml": "package B;", "a.sysml": "package C;"}
    compilation = sysmlc.compile_texts(texts, emit="sysml")
    assert sysmlc.list_findings(compilation) == []
    assert [artefact.path for artefact in compilation.artefacts] == [
        "sysml/%2E%2E/a.sysml",
        "sysml/%2F/home/a.sysml",
        "sysml/a.sysml",
    ]
    assert sysmlc.compile_texts({"a.sysml": "package \ud800;"}).exit_code() == 1


def test_a_text_and_the_uml_made_from_it_form_one_unit():
    text = "package Plant { part def Gate { attribute width; } attribute height; }"
    (uml,) = sysmlc.compile_texts({"gate.sysml": text}, emit="uml").artefacts
    compilation = sysmlc.compile_texts({"gate.sysml": text, "gate.uml": uml.text})
    assert compilation.exit_code() == 0
    assert [element.name for element in compilation.graph.of_kind(sysmlc.Kind.CLASS)] == [
        "Gate",
        "Gate",
    ]


def test_elements_are_found_by_qualified_name():
    graph = sysmlc.compile_texts({"gate.sysml": GATE.replace("part bolt : Bolt;", "")}).graph
    assert graph.find("Plant::Gate::open").name == "open"
    assert graph.find("Plant::open") is None
    assert graph["Plant::Gate::open"].name == "open"
    with pytest.raises(KeyError, match="Plant::open"):
        graph["Plant::open"]


def test_a_controller_is_synthesised_and_written_outputs_stay_as_they_are(tmp_path):
    compilation = sysmlc.compile_texts({"lamp.sysml": LAMP}, emit=["contracts"])
    (contract,) = compilation.graph.derived(sysmlc.Contract)
    assert sysmlc.synthesise(contract).machine is not None
    checks = sysmlc.check_contracts(compilation)
    assert [result.verdict.is_realizable for result in checks.contracts] == [True]
    with pytest.raises(ValueError, match="did you mean 'Plant::Lamp'"):
        sysmlc.check_contracts(compilation, "Plant::Lamb")
    assert "manifest.json" in sysmlc.write(compilation, tmp_path / "out").changed
    assert sysmlc.write(compilation, tmp_path / "out").changed == ()


def test_a_scenario_is_played():
    machine = "exhibit state s { entry; then off; state off; accept Go then on; state on; }"
    text = f"package Plant {{ item def Go; part def Lamp {{ {machine} }} }}"
    steps = "[{expect: {state: off}, inputs: {event: Go}}, {expect: {state: on}}]"
    scenarios = f"name: Go lights the lamp\ncomponent: Lamp\nsteps: {steps}\n"
    sink = sysmlc.Sink()
    report = sysmlc.simulate(sysmlc.compile_texts({"lamp.sysml": text}), scenarios, sink)
    assert [diagnostic.message for diagnostic in sink] == []
    assert report.passed


def test_two_models_are_compared(tmp_path):
    for name, text in (("old", GATE), ("new", GATE.replace("open", "opened"))):
        (tmp_path / f"{name}.sysml").write_text(text)
    changes = sysmlc.diff(tmp_path / "old.sysml", tmp_path / "new.sysml")
    assert [(change.what, change.before, change.after) for change in changes] == [
        ("renamed", "open", "opened")
    ]
    with pytest.raises(ValueError, match="there is no file or folder"):
        sysmlc.diff("lost.sysml", tmp_path / "new.sysml")


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"config": 3}, TypeError, "'config' must be Config or str or PathLike or None, not int"),
        ({"config": "lost.toml"}, sysmlc.ConfigError, "lost.toml"),
        ({"emitt": "uml"}, TypeError, "has no argument 'emitt'; did you mean 'emit'?"),
        ({"emit": 1}, TypeError, "'emit' must be str or Iterable, not int"),
        ({"emit": [1]}, TypeError, "expected a back end, but 1 has no member 'name' of type str"),
        ({"emit": "umll"}, sysmlc.BackendError, "did you mean 'uml'?"),
        ({"passes": ["ports"]}, TypeError, "expected a pass, but 'ports' has no member 'name'"),
        ({"rules": ["untyped-port"]}, TypeError, "'rules' must be Mapping, not list"),
        ({"rules": {"untyped-prt": "off"}}, sysmlc.ConfigError, "did you mean 'untyped-port'?"),
        ({"rules": {"untyped-port": "of"}}, sysmlc.ConfigError, "did you mean 'off'?"),
        ({"rules": {"untyped-port": 5}}, sysmlc.ConfigError, "unknown severity '5'"),
        ({"rules": {5: "off"}}, sysmlc.ConfigError, "unknown rule '5'"),
        (
            {"config": sysmlc.Config(rules={"untyped-prt": None})},
            sysmlc.ConfigError,
            "did you mean 'untyped-port'?",
        ),
    ],
)
def test_a_wrong_option_is_refused_with_what_is_expected(options, error, message):
    with pytest.raises(error, match=re.escape(message)):
        sysmlc.compile_texts({"a.sysml": "package A;"}, **options)


def test_a_text_with_half_a_character_is_a_finding():
    sink = sysmlc.Sink()
    (lamp,) = sysmlc.read_contracts("G lit\n.outputs lit\n", sysmlc.Sink(), "spot")
    assert sysmlc.accept_run(lamp, "lit\n\ud800\n", sink) is None
    sysmlc.simulate(sysmlc.compile_texts({}), "\ud800", sink)
    assert [diagnostic.rule.code for diagnostic in sink] == ["SM591", "SM550"]


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: sysmlc.compile_texts([1]), TypeError, "'texts' must be Mapping, not list"),
        (lambda: sysmlc.compile_texts({"a": 1}), TypeError, "the text of 'a' must be str or bytes"),
        (lambda: sysmlc.compile_model(3), TypeError, "'paths' must be Request or str or PathLike"),
        (lambda: sysmlc.format_findings([], "jsn"), ValueError, "did you mean 'json'?"),
        (lambda: sysmlc.check_contracts({}), TypeError, "must be Compilation, not dict"),
        (lambda: sysmlc.synthesise(None), TypeError, "'contract' must be Contract, not None"),
        (lambda: sysmlc.read_contracts("", sysmlc.Sink(), "sptt"), ValueError, "no format 'sptt'"),
        (lambda: sysmlc.diff("a", "b", ignor="id"), TypeError, "did you mean 'ignore'?"),
    ],
)
def test_a_wrong_argument_is_refused_with_what_is_expected(call, error, message):
    with pytest.raises(error, match=re.escape(message)):
        call()


def test_rules_are_values_and_paths_name_texts():
    untyped = sysmlc.Rule("ACME9", "untyped", sysmlc.Severity.ERROR, "'{port}' has no type")

    class PortTypes:
        name, after = "port-types", ("classify",)

        def run(self, graph, sink):
            for port in graph.of_kind(sysmlc.Kind.PORT):
                sink.report(untyped, graph.subject(port), port=port.name)

    texts = {Path("gate.sysml"): "package Plant { part def Gate { port inlet; } }"}
    for severity, expected in ((None, []), ("info", ["info"]), ("error", ["error"])):
        compilation = sysmlc.compile_texts(texts, passes=[PortTypes()], rules={untyped: severity})
        findings = sysmlc.list_findings(compilation)
        chosen = [f for f in findings if f.diagnostic.rule is untyped]
        assert [finding.diagnostic.severity for finding in chosen] == expected
        for form in ("json", "sarif"):
            assert ("ACME9" in sysmlc.format_findings(chosen, form)) is bool(expected)


@pytest.mark.parametrize(
    ("name", "text", "rule", "end"),
    [
        ("a.sysml", "package P { part a : Lost; }", "unresolved-name", (1, 26)),
        ("a.sysml", "package P { part a : 'L b'; }", "unresolved-name", (1, 27)),
        ("a.sysml", "package P {\n  part é : Lost::B;\n}", "unresolved-name", (2, 16)),
    ],
)
def test_findings_end_behind_the_word_at_which_they_start(name, text, rule, end):
    findings = sysmlc.list_findings(sysmlc.compile_texts({name: text}))
    ends = [(f.end_line, f.end_column) for f in findings if rule in f.diagnostic.rule.name]
    assert ends[:1] == [end]


def test_a_finding_about_an_xml_element_ends_behind_its_start_tag():
    (uml,) = sysmlc.compile_texts({"lamp.sysml": LAMP}, emit="uml").artefacts
    broken = uml.text.replace("<packagedElement", "<packagedElement\n lost='>'", 1)
    findings = sysmlc.list_findings(sysmlc.compile_texts({"lamp.uml": broken}))
    assert findings
    for finding in findings:
        line = broken.splitlines()[finding.end_line - 1]
        assert line[finding.end_column - 2] == ">"


def test_an_unrealizable_contract_is_explained():
    sink = sysmlc.Sink()
    text = "G (lit <-> X wanted)\n.inputs wanted\n.outputs lit\n"
    (contract,) = sysmlc.read_contracts(text, sink, name="Lamp")
    synthesis = sysmlc.synthesise(contract)
    assert synthesis.machine is None
    (diagnostic,) = synthesis.diagnostics
    assert diagnostic.message == "no system can satisfy the contract of 'Lamp'"
    with pytest.raises(ValueError, match="no format 'spectra' is written"):
        sysmlc.write_contract(contract, "spectra")
    verdict = sysmlc.accept_run(contract, '[{"wanted": true, "lit": false}]', sink)
    assert verdict.text() == "Lamp: 1 step, no check is broken"
    assert sysmlc.accept_run(contract, "wanted;lit\n1;2", sink) is None


def test_a_request_can_be_compiled(tmp_path):
    model = tmp_path / "plant.ir"
    model.write_text('Class gate "Gate"\n')
    compilation = sysmlc.compile_model(sysmlc.Request((model,)))
    assert [element.name for element in compilation.graph] == ["Gate"]
