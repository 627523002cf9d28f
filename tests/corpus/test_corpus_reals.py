"""The oracle of conditions over reals: properties with answers that were found without sysmlc."""

import json

import pytest
from click.testing import CliRunner

from contract_oracle import combine_verdicts, group_entries, list_models, require
from sysmlc.cli import group

MODELS = list_models("reals")
UNDECIDED = 2
"""Properties that may have no answer."""

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def documents(tmp_path_factory):
    """The documents of ``contracts check`` about the models, by the name of the model."""
    folder, documents = tmp_path_factory.mktemp("reals"), {}
    for model in MODELS:
        path = folder / model.path.name
        path.write_text(require(model), "utf-8")
        arguments = ["contracts", "check", "--format", "json", str(path)]
        result = CliRunner().invoke(group.sysmlc, arguments, catch_exceptions=False)
        documents[model.path.stem] = json.loads(result.stdout)
    return documents


def test_no_property_has_a_wrong_answer_and_few_have_none(documents):
    answers, expected = {}, {}
    for model in MODELS:
        entries = group_entries(documents[model.path.stem])
        for item in model.properties:
            key = model.path.stem, item.name
            is_vacuous = any(entry["vacuous"] for entry in entries[item.name])
            answers[key] = combine_verdicts(entries[item.name]), is_vacuous
            expected[key] = item.verdict, item.vacuous
    undecided = [key for key, (verdict, _) in answers.items() if verdict == "not-decided"]
    wrong = {key: answer for key, answer in answers.items() if answer != expected[key]}
    assert {key: wrong[key] for key in wrong.keys() - undecided} == {}
    assert len(undecided) <= UNDECIDED, undecided


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.path.stem)
def test_states_that_no_numbers_reach_are_reported(model, documents):
    document = documents[model.path.stem]
    (behaviour,) = (
        entry for entry in document["behaviours"] if entry["component"] == model.component
    )
    assert behaviour["unreachable"] == model.unreachable
    assert behaviour["write_conflicts"] == model.write_conflicts
    conditions = {"SM411", "SM522"}
    assert not conditions & {diagnostic["code"] for diagnostic in document["diagnostics"]}
