"""Random models that the standards allow have no error, and only warnings that are true."""

from random import Random

import pytest
from lxml import etree

from dialects.comparison import WRITERS
from dialects.metamodel import Metamodel
from examples.compiling import compile_text, format_diagnostics, outputs
from legal.plants import draw_plant
from legal.random_models import TOPICS, draw_model
from long_runs import quick_first
from sysmlc.diagnostics import Severity

TRUE_WARNINGS = {
    "SM111": "the value that is the parameter of a template of a package is not read",
    "SM417": "the time at which an absolute time event occurs is no number of steps",
    "SM420": "no contract is derived from the construct",
    "SM422": "two transitions of one state have the same trigger, and the guards may both hold",
    "SM428": "an effect counts without bound, but a contract has a range",
    "SM434": "an event that a state accepts occurs in the step in which the state completes",
    "SM450": "a test case whose activity has only a parameter node for its verdict does nothing",
    "SM452": "the clause behind a clause whose test is the literal true is never tested",
    "SM454": "an accept action without incoming flows accepts again while its token still waits",
    "SM459": "no contract is derived from a flow that takes all tokens at once",
    "SM488": "a condition before or after an action restricts it, but is not in its contract",
    "SM491": "a value that overrides an inherited one may lie outside its scale",
    "SM467": "no contract is derived from a join with a specification",
}
"""Warnings of legal models, with the fact that each states."""

SCHEMAS = {"3.0": "CAEX_ClassModel_V.3.0.xsd", "2.15": "CAEX_ClassModel_V2.15.xsd"}


def check_compilation(compilation):
    """Check the findings and outputs of a legal model."""
    findings = format_diagnostics(compilation)
    severities = {diagnostic.severity for diagnostic in compilation.diagnostics}
    assert Severity.ERROR not in severities, findings
    warnings = [d for d in compilation.diagnostics if d.severity is Severity.WARNING]
    assert [d.message for d in warnings if d.rule.code not in TRUE_WARNINGS] == []
    diagrams = {path: text for path, text in outputs(compilation).items() if ".puml" in path}
    assert all(text.startswith("@startuml") for text in diagrams.values())
    assert all(len(text.splitlines()) > 2 for text in diagrams.values())


@pytest.mark.parametrize("seed", quick_first(range(120), 15))
def test_a_legal_model_has_no_error_in_the_files_of_three_tools(seed, tmp_path):
    papyrus = draw_model(Random(seed))
    check_compilation(compile_text(tmp_path, "model.uml", papyrus))
    for dialect in ("xml", "xmi"):
        text = WRITERS[dialect](papyrus)
        check_compilation(compile_text(tmp_path, f"model.{dialect}", text))


@pytest.mark.parametrize("version", ["2.15", "3.0"])
@pytest.mark.parametrize("seed", quick_first(range(120), 15))
def test_a_legal_plant_has_no_error(seed, version, tmp_path):
    check_compilation(compile_text(tmp_path, "plant.aml", draw_plant(Random(seed), version)))


def test_all_topics_are_drawn():
    """The test of models would pass too if a topic were never part of one."""
    random = Random(0)
    drawn = [random.sample(TOPICS, random.randint(1, 4)) for _ in range(120)]
    assert {topic for topics in drawn for topic in topics} == set(TOPICS)


@pytest.mark.corpus
def test_legal_models_conform_to_the_metamodel(corpus):
    metamodel = Metamodel(corpus / "xmi" / "metamodel" / "uml.ecore")
    for seed in range(60):
        assert metamodel.find_violations(draw_model(Random(seed))) == []


@pytest.mark.corpus
@pytest.mark.parametrize("version", SCHEMAS)
def test_legal_plants_conform_to_the_schema(version, corpus):
    schema = etree.XMLSchema(etree.parse(corpus / "aml" / "schema" / SCHEMAS[version]))
    for seed in range(60):
        document = etree.fromstring(draw_plant(Random(seed), version))
        assert schema.validate(document), (seed, schema.error_log)
