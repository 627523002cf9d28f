"""Patterns that are compiled late do what patterns do."""

import re

import pytest

from sysmlc.patterns import pattern

ASKED = [
    ("match", ("ab12",)),
    ("fullmatch", ("ab",)),
    ("search", ("12ab",)),
    ("sub", ("-", "ab cd")),
    ("subn", ("-", "ab cd")),
    ("split", ("1ab2",)),
    ("findall", ("ab cd",)),
]


@pytest.mark.parametrize(("method", "given"), ASKED)
def test_as_compiled_at_once(method, given):
    late, compiled = pattern(r"[A-Z]+", re.IGNORECASE), re.compile(r"[A-Z]+", re.IGNORECASE)
    for _ in range(2):
        assert _plain(getattr(late, method)(*given)) == _plain(getattr(compiled, method)(*given))
    assert (late.pattern, late.groups) == (compiled.pattern, compiled.groups)


def _plain(answer):
    return (answer.span(), answer.groups()) if isinstance(answer, re.Match) else answer


def test_bytes_and_groups():
    late = pattern(rb"(?P<name>\w+)=")
    assert [found["name"] for found in late.finditer(b"a=1, b=2")] == [b"a", b"b"]
    assert dict(late.groupindex) == {"name": 1}


def test_a_wrong_text_is_told_when_it_is_used():
    late = pattern("(")
    with pytest.raises(re.error, match="missing"):
        late.match("")
