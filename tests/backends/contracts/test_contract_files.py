"""The files of the back end ``contracts``: JSON with its schema, an explanation, and SPIN text."""

import json

import jsonschema
import pytest

from backend_runs import refine_and_emit
from machine_samples import arrow, machine
from sysmlc.backends.contracts import BACKEND
from sysmlc.logic.contract import (
    BooleanDomain,
    Contract,
    EnumerationDomain,
    IntegerDomain,
)
from sysmlc.logic.infix import parse_formula
from sysmlc.support import resources

GATE = machine(
    arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"),
    arrow("b", "a", after="after 3 s"),
)


SCHEMA = json.loads(resources.read_text("metamodels", "sysmlc-contract.schema.json"))


def emit_contracts(text, templates=None):
    """Return the graph, the files by path, and the diagnostics."""
    return refine_and_emit(BACKEND, text, templates)


def read_domain(type_):
    """Return the domain that the type of a variable in the JSON file means."""
    if type_ == "bool":
        return BooleanDomain()
    return IntegerDomain(*type_) if isinstance(type_[0], int) else EnumerationDomain(tuple(type_))


def test_the_layout_of_the_json_is_that_of_the_standard_library_of_python():
    """Some classes of conjuncts are empty, some are not; texts have quotes and umlauts."""
    _, files, _ = emit_contracts(GATE.replace('"Gate"', '"Gä\\"te"'))
    (text,) = [file.text for path, file in files.items() if path.endswith(".json")]
    assert '"liveness": []' in text
    assert 'Gä\\"te' in text
    assert text == json.dumps(json.loads(text), ensure_ascii=False, indent=2) + "\n"


def test_a_contract_has_three_files():
    _, files, _ = emit_contracts(GATE)
    assert list(files) == [
        "contracts/Plant.Gate.contract.json",
        "contracts/Plant.Gate.md",
        "contracts/Plant.Gate.spin.ltl",
    ]


def test_the_json_follows_its_schema_and_is_read_back():
    graph, files, _ = emit_contracts(GATE)
    document = json.loads(files["contracts/Plant.Gate.contract.json"].text)
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(document, SCHEMA)
    (contract,) = graph.derived(Contract)
    domains = {
        name: read_domain(variable["type"]) for name, variable in document["variables"].items()
    }
    assert domains == {variable.name: variable.domain for variable in contract.variables}
    guarantees = [
        (parse_formula(conjunct["formula"], domains), conjunct["class"], conjunct["origin"])
        for conjuncts in document["guarantees"].values()
        for conjunct in conjuncts
    ]
    assert guarantees == [
        (conjunct.formula, conjunct.class_, conjunct.origin) for conjunct in contract.guarantees
    ]


@pytest.mark.parametrize(
    ("change", "path"),
    [
        (lambda document: document.pop("origin"), []),
        (
            lambda document: document["variables"]["level"].update(type="int"),
            ["variables", "level", "type"],
        ),
        (
            lambda document: document["guarantees"]["init"][0].pop("formula"),
            ["guarantees", "init", 0],
        ),
    ],
)
def test_the_schema_rejects_faulty_files(change, path):
    document = json.loads(emit_contracts(GATE)[1]["contracts/Plant.Gate.contract.json"].text)
    change(document)
    with pytest.raises(jsonschema.ValidationError) as caught:
        jsonschema.validate(document, SCHEMA)
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
    _, files, diagnostics = emit_contracts(machine(arrow("a", "b", "start", effect="level := 77")))
    (error,) = [diagnostic for diagnostic in diagnostics if diagnostic.is_error]
    assert error.rule.code == "SM414"
    assert all(error.subject.id in file.trace for file in files.values())


def test_a_formula_with_too_many_values_is_reported_and_the_rest_is_written():
    text = machine(arrow("a", "b", "start", effect="level := level + 1"))
    text = text.replace("<= 9", "<= 99999")
    _, files, diagnostics = emit_contracts(text)
    assert list(files) == ["contracts/Plant.Gate.contract.json", "contracts/Plant.Gate.md"]
    assert "SM520" in [diagnostic.rule.code for diagnostic in diagnostics]
    assert len(emit_contracts(text.replace("<= 99999", "<= 999"))[1]) == 3


def test_a_template_of_the_user_replaces_the_shipped_one_and_its_fault_is_reported(tmp_path):
    (tmp_path / "contract.md.j2").write_text("Mine: {{ page.component }}\n", encoding="utf-8")
    assert (
        emit_contracts(GATE, tmp_path)[1]["contracts/Plant.Gate.md"].text == "Mine: Plant::Gate\n"
    )
    (tmp_path / "contract.md.j2").write_text("{{ page.nothing }}", encoding="utf-8")
    _, files, diagnostics = emit_contracts(GATE, tmp_path)
    assert "contracts/Plant.Gate.md" not in files
    assert [diagnostic.rule.code for diagnostic in diagnostics] == ["SM521"]
