"""Each changed token of a valid SysML v2 model is a difference, a finding, or a reviewed case."""

import re

import pytest

from corpus.token_mutations import draw_mutations, find_imported, is_noticed, look_at

pytestmark = pytest.mark.corpus
_SEED = 26
_REVIEWED = {
    "the import of a library only makes names visible; its verdict is external": (
        r".*\| (private|public|protected) import .*"
    ),
    "a keyword that another word of the declaration implies": (
        r"'(from|flow|ref|enum|use|abstract|library|doc|def)' -> ''.*"
    ),
    "documentation and a comment of its owner have the same meaning": (r"'doc' -> 'comment'.*"),
    "a usage without a keyword is a reference, or has the kind of what it redefines": (
        r"'(attribute|part|item|port|occurrence|action)' -> ''.*"
    ),
    "a feature in a place where the graph has another kind of element, or none": (
        r"'(attribute|part|item|port|action|occurrence)' -> "
        r"'(attribute|part|item|ref|port|calc|state)'.*"
    ),
    "a feature that specialises a definition has the type of one that it types": (r"':' -> ':>'.*"),
    "redefinition or subsetting of a feature of a library, of which the graph keeps the types": (
        r"'(:>>|:>|redefines|subsets)' -> '.*"
    ),
    "the name of a subject, actor, event, end or parameter that the graph does not represent": (
        r"'\w+' -> '(\w+x)?' \| ("
        r"(then )?(subject|actor|event|end|in|out|include|message|objective)\b"
        r"|from |to |\w+ ::>|part  :).*"
    ),
    "the kind of a value that the graph does not represent: of subjects, actors, messages": (
        r"'=' -> ':='.*"
    ),
    "the direction of a parameter of a constraint, which is an input unless it is stated": (
        r"'in' -> ('out'|'inout'|'').*"
    ),
    "a condition of an objective, which SM481 reports as not read": (
        r".*\| (vehicle\.|fuelEconomyResult).*"
    ),
    "an attribute of a usage outside of a definition, which has no multiplicity in the graph": (
        r"'(nonunique|ordered)' -> ''.*"
    ),
    "whether a constraint is assumed or required, which the graph does not represent yet": (
        r"'(assume|require)' -> '.*"
    ),
    "the multiplicity of an actor or an event": (r".*\| (actor|event) .*"),
}
"""Patterns of changes without a difference and a finding, by the reason why they have none."""


def find_unnoticed(folder, count):
    """Return the mutations that the compiler does not notice and that no reason explains."""
    paths = sorted(folder.rglob("*.sysml"))
    texts = {path.relative_to(folder).as_posix(): path.read_text() for path in paths}
    views, unnoticed = {}, []
    for mutation in draw_mutations(texts, count, _SEED):
        path = mutation.path
        if path not in views:
            imported = find_imported(path, texts)
            views[path] = imported, look_at(path, texts[path], imported)
        imported, view = views[path]
        if not is_noticed(view, look_at(path, mutation.text, imported)):
            unnoticed.append(mutation)
    return unnoticed


@pytest.mark.parametrize("count", [30, pytest.param(1_000, marks=pytest.mark.long)])
def test_a_changed_token_is_noticed_or_reviewed(corpus, count):
    unnoticed = find_unnoticed(corpus / "sysml2" / "omg-release" / "training", count)
    unexplained = [
        mutation.line
        for mutation in unnoticed
        if not any(re.search(f"(^|: ){reason}$", mutation.line) for reason in _REVIEWED.values())
    ]
    # The list covers the drawn mutations of the quick suite; some 5 of 1,000 have no reason yet.
    assert unexplained[count // 50 :] == []
    assert len(unnoticed) <= count // 10
