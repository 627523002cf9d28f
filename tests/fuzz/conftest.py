"""One fork server for all tests of this folder."""

import pytest

from fuzz.checker import Checker
from fuzz.fork_server import ForkServer


@pytest.fixture(scope="session")
def fork_server():
    with ForkServer() as server:
        yield server


@pytest.fixture
def checker(fork_server, tmp_path):
    """Return a checker that works in an empty folder."""
    return Checker(fork_server, tmp_path)
