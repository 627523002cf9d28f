"""How much of a test runs in ``make test``, and how much only in ``make test-long``."""

import os
from collections.abc import Iterable
from typing import Any

import pytest


def quick_first(values: Iterable[Any], count: int = 1) -> list[Any]:
    """Return *values* as parameters of a test; all but the first *count* are marked ``long``."""
    return [
        value if index < count else pytest.param(value, marks=pytest.mark.long)
        for index, value in enumerate(values)
    ]


def examples(count: int) -> int:
    """Return how many examples hypothesis tries: *count* in a long run, else a sixth of them."""
    return count if os.environ.get("SYSMLC_LONG") else max(5, count // 6)
