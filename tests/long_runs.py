"""Which parameters of a test run in ``make test``, and which only in ``make test-long``."""

from collections.abc import Iterable
from typing import Any

import pytest


def quick_first(values: Iterable[Any], count: int = 1) -> list[Any]:
    """Return *values* as parameters of a test; all but the first *count* are marked ``long``."""
    return [
        value if index < count else pytest.param(value, marks=pytest.mark.long)
        for index, value in enumerate(values)
    ]
