"""One guarding process for all tests of this folder."""

import pytest

from fuzz.answers import GeneralizationQueries
from fuzz.guard import Guard


@pytest.fixture(scope="session")
def guard():
    with Guard() as made:
        yield made


@pytest.fixture
def asked(guard, tmp_path):
    """An empty folder and the process that answers."""
    return GeneralizationQueries(guard, tmp_path)
