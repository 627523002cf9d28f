"""The back end ``contracts``: its files for the gate and for token graphs, and their schema."""

import json

import jsonschema
import pytest

from machine_samples import arrow, machine
from sysmlc.backends.base import EmitOptions
from sysmlc.backends.contracts import BACKEND
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import (
    BooleanDomain,
    Contract,
    EnumerationDomain,
    IntegerDomain,
)
from sysmlc.logic.infix import parse_formula
from sysmlc.passes import pipeline
from sysmlc.support import resources
from sysmlc.support.output import Output

GATE = machine(
    arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"),
    arrow("b", "a", after="after 3 s"),
)


def emit_contracts(text, templates=None):
    graph, sink, output = parse_text(text), Sink(), Output()
    pipeline.run(graph, sink, verify_each=True)
    BACKEND.emit(graph, output, sink, EmitOptions(templates=templates))
    return graph, {artefact.path: artefact for artefact in output.artefacts()}, sink


def schema():
    return json.loads(resources.read_text("metamodels", "sysmlc-contract.schema.json"))


def domain_of(type_):
    if type_ == "bool":
        return BooleanDomain()
    return IntegerDomain(*type_) if isinstance(type_[0], int) else EnumerationDomain(tuple(type_))


def test_json_is_laid_out_as_the_library_does():
    """Some classes of conjuncts are empty, some are not; texts have quotes and umlauts."""
    _, files, _ = emit_contracts(GATE.replace('"Gate"', '"Gä\\"te"'))
    (text,) = [file.text for path, file in files.items() if path.endswith(".json")]
    assert '"liveness": []' in text
    assert 'Gä\\"te' in text
    assert text == json.dumps(json.loads(text), ensure_ascii=False, indent=2) + "\n"


def test_three_files_a_contract():
    _, files, _ = emit_contracts(GATE)
    assert list(files) == [
        "contracts/Plant.Gate.contract.json",
        "contracts/Plant.Gate.md",
        "contracts/Plant.Gate.spin.ltl",
    ]


def test_the_json_keeps_to_its_schema_and_can_be_read_back():
    graph, files, _ = emit_contracts(GATE)
    document = json.loads(files["contracts/Plant.Gate.contract.json"].text)
    jsonschema.Draft202012Validator.check_schema(schema())
    jsonschema.validate(document, schema())
    (contract,) = graph.derived(Contract)
    domains = {name: domain_of(v["type"]) for name, v in document["variables"].items()}
    assert domains == {v.name: v.domain for v in contract.variables}
    read = [
        (parse_formula(conjunct["formula"], domains), conjunct["class"], conjunct["origin"])
        for conjuncts in document["guarantees"].values()
        for conjunct in conjuncts
    ]
    assert read == [(c.formula, c.class_, c.origin) for c in contract.guarantees]


@pytest.mark.parametrize(
    ("change", "path"),
    [
        (lambda d: d.pop("origin"), []),
        (lambda d: d["variables"]["level"].update(type="int"), ["variables", "level", "type"]),
        (lambda d: d["guarantees"]["init"][0].pop("formula"), ["guarantees", "init", 0]),
    ],
)
def test_the_schema_refuses_what_is_no_contract(change, path):
    document = json.loads(emit_contracts(GATE)[1]["contracts/Plant.Gate.contract.json"].text)
    change(document)
    with pytest.raises(jsonschema.ValidationError) as caught:
        jsonschema.validate(document, schema())
    assert list(caught.value.absolute_path) == path


def test_the_explanation_names_elements_in_words():
    text = emit_contracts(GATE)[1]["contracts/Plant.Gate.md"].text
    assert text.startswith("# Contract of Plant::Gate\n")
    assert "| `level` | 0..9 | property 'level' of 'Gate' |" in text
    assert (
        "- In 'A', when 'start' occurs and [level < 9]: the next state is 'B', "
        "'level' becomes level + 1, 'send_opened' is done. *(transition 'A' to 'B')*\n"
        "  `state=A & event=start & level<9 -> state'=B & level'=level + 1 & send_opened'`\n"
    ) in text


def test_a_fault_in_an_effect_withholds_the_contract():
    _, files, sink = emit_contracts(machine(arrow("a", "b", "start", effect="level := 77")))
    (error,) = [diagnostic for diagnostic in sink if diagnostic.is_error]
    assert error.rule.code == "SM414"
    assert all(error.subject.id in file.trace for file in files.values())


def test_a_formula_with_too_many_values_is_reported_and_the_rest_is_written():
    text = machine(arrow("a", "b", "start", "level * fixed * size > 3"))
    text = text.replace("readonly=true", "").replace("<= 9", "<= 99")
    _, files, sink = emit_contracts(text)
    assert list(files) == ["contracts/Plant.Gate.contract.json", "contracts/Plant.Gate.md"]
    assert "SM520" in [diagnostic.rule.code for diagnostic in sink]
    assert len(emit_contracts(text.replace(" * size", ""))[1]) == 3


def test_own_templates_replace_ours_and_their_faults_are_reported(tmp_path):
    (tmp_path / "contract.md.j2").write_text("Mine: {{ page.component }}\n", encoding="utf-8")
    assert (
        emit_contracts(GATE, tmp_path)[1]["contracts/Plant.Gate.md"].text == "Mine: Plant::Gate\n"
    )
    (tmp_path / "contract.md.j2").write_text("{{ page.nothing }}", encoding="utf-8")
    _, files, sink = emit_contracts(GATE, tmp_path)
    assert "contracts/Plant.Gate.md" not in files
    assert [diagnostic.rule.code for diagnostic in sink] == ["SM521"]
