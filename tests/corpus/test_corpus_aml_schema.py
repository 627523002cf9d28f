"""Real plants against the published schemas: as ``measured.json``, which lxml alone made."""

import json

import pytest

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locations import locate
from sysmlc.sources import load
from sysmlc.sources.user_schemas import load_schemas

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def measured(corpus):
    rows = json.loads((corpus / "aml" / "measured.json").read_text())
    return {row["file"]: row["valid"] for row in rows if "valid" in row}


def test_the_files_that_violate_their_schema_are_those_that_were_measured(corpus, measured):
    schemas = load_schemas(corpus / "aml" / "schema")
    seen = {True: 0, False: 0}
    for name, is_valid in sorted(measured.items()):
        path = corpus / "aml" / name
        if path.suffix != ".aml":
            continue
        (source,) = load(path, path.name)
        schema, found = schemas.find_violations(source)
        assert schema is not None, name
        assert (found == []) == is_valid, (name, found[:2])
        places = [Place(source.name, ordinal=one.ordinal) for one in found]
        located = locate([source], places) if places else {}
        assert all(located[place].line > 0 for place in places), name
        assert all(one.element and one.problem for one in found), name
        assert not any("{http" in one.problem for one in found), name
        seen[is_valid] += 1
    assert seen[True] > 25
    assert seen[False] >= 5


@pytest.mark.parametrize(
    ("name", "element", "problem"),
    [
        (
            "bad/i40_wrong_order.aml",
            "Conveyors::BASIC_36-12-04-01 Conveyor::Conveyor2::PortLink",
            "'InternalLink' stands where 'MappingObject' should",
        ),
        (
            "dev/pyaml_hybrid_215.aml",
            "Testbed::ControlSystem::MES::Configuration",
            "'Attribute' must not have the attribute 'RefAttributeType'",
        ),
        ("dev/mirror_30.aml", "PPRExampleInstanceHierarchy", "'InstanceHierarchy' stands where"),
    ],
)
def test_a_violation_is_told_in_the_words_of_the_file(name, element, problem, corpus):
    path = corpus / "aml" / name
    (source,) = load(path, path.name)
    _, (first, *_) = load_schemas(corpus / "aml" / "schema").find_violations(source)
    assert first.element == element
    assert first.problem.startswith(problem)
