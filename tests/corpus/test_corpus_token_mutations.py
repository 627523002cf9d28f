"""Each changed token of a valid SysML v2 model is a difference, a finding, or a reviewed case."""

import re

import pytest

from corpus.token_mutations import draw_mutations, find_imported, is_noticed, look_at

pytestmark = pytest.mark.corpus
_REVIEWED = {
    "a flow is from its first end with and without the word (SysML 2.0, 8.2.2.16)": (
        r"'from' -> '' \| (then )?(succession )?flow .* to .*"
    ),
    "a directed usage is a reference anyway (SysML 2.0, 8.2.2.6.2, note 1)": (
        r"'ref' -> '' \| (in|out|inout) .*"
    ),
    "a usage without a keyword is a reference (SysML 2.0, 8.2.2.6.3)": (
        r"'ref' -> '' \| (:>>|:>|\w+ ?[:;=]).*"
    ),
    "a member that is no import is public unless it states another visibility": (
        r"'public' -> '' \| (?!import).*"
    ),
    "a member of an enumeration definition is an enumerated value (SysML 2.0, 8.2.2.8)": (
        r"'enum' -> '' \| \w+;?( .*)?"
    ),
    "a default value is written with and without the sign (KerML 1.0, 8.2.5.10)": (
        r"'=' -> '' \| .* default .*"
    ),
}
"""Patterns of changes that do not change the model, by the reason for it."""


def find_unnoticed(folder, count, seed):
    """Return the mutations that the compiler does not notice and that no reason explains."""
    paths = sorted(folder.rglob("*.sysml"))
    texts = {path.relative_to(folder).as_posix(): path.read_text() for path in paths}
    views, unnoticed = {}, []
    for mutation in draw_mutations(texts, count, seed):
        path = mutation.path
        if path not in views:
            imported = find_imported(path, texts)
            views[path] = imported, look_at(path, texts[path], imported)
        imported, view = views[path]
        if not is_noticed(view, look_at(path, mutation.text, imported)):
            unnoticed.append(mutation)
    return unnoticed


@pytest.mark.parametrize(
    ("count", "seed"),
    [
        (30, 26),
        pytest.param(500, 26, marks=pytest.mark.long),
        pytest.param(500, 7, marks=pytest.mark.long),
    ],
)
def test_a_changed_token_is_noticed_or_reviewed(corpus, count, seed):
    unnoticed = find_unnoticed(corpus / "sysml2" / "omg-release" / "training", count, seed)
    unexplained = [
        mutation.line
        for mutation in unnoticed
        if not any(re.search(f": {reason}$", mutation.line) for reason in _REVIEWED.values())
    ]
    assert unexplained == []
    # 3 of 1,000 when this test was written.
    assert len(unnoticed) <= max(1, count // 100)
