"""Real plants violate the published schemas as in ``measured.json``, which lxml alone produced."""

import json

import pytest

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locations import locate
from sysmlc.sources import load
from sysmlc.sources.user_schemas import load_schemas

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def expected_validity(corpus):
    rows = json.loads((corpus / "aml" / "measured.json").read_text())
    return {row["file"]: row["valid"] for row in rows if "valid" in row}


def test_files_violate_their_schema_as_measured(corpus, expected_validity):
    schemas = load_schemas(corpus / "aml" / "schema")
    counts = {True: 0, False: 0}
    for name, is_valid in sorted(expected_validity.items()):
        path = corpus / "aml" / name
        if path.suffix != ".aml":
            continue
        (source,) = load(path, path.name)
        schema, violations = schemas.find_violations(source)
        assert schema is not None, name
        assert (violations == []) == is_valid, (name, violations[:2])
        places = [Place(source.name, ordinal=violation.ordinal) for violation in violations]
        located = locate([source], places) if places else {}
        assert all(located[place].line > 0 for place in places), name
        assert all(violation.element and violation.problem for violation in violations), name
        assert not any("{http" in violation.problem for violation in violations), name
        counts[is_valid] += 1
    assert counts[True] > 25
    assert counts[False] >= 5


@pytest.mark.parametrize(
    ("name", "element", "problem"),
    [
        (
            "bad/i40_wrong_order.aml",
            "Conveyors::BASIC_36-12-04-01 Conveyor::Conveyor2::PortLink",
            "unexpected element 'InternalLink'; expected 'MappingObject'",
        ),
        (
            "dev/pyaml_hybrid_215.aml",
            "Testbed::ControlSystem::MES::Configuration",
            "'Attribute' must not have the attribute 'RefAttributeType'",
        ),
        (
            "dev/mirror_30.aml",
            "PPRExampleInstanceHierarchy",
            "unexpected element 'InstanceHierarchy'; expected",
        ),
    ],
)
def test_a_violation_names_elements_as_the_file_does(name, element, problem, corpus):
    path = corpus / "aml" / name
    (source,) = load(path, path.name)
    _, (first, *_) = load_schemas(corpus / "aml" / "schema").find_violations(source)
    assert first.element == element
    assert first.problem.startswith(problem)
