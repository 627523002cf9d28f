"""Real models that are saved as UML and read back: what is not the same, and why."""

from collections import Counter

import pytest

from dialects.comparison import DIALECT_ATTRIBUTES, is_dialect_difference
from dialects.metamodel import Metamodel
from examples.compiling import compile_example, compile_text
from graph_differences import diff

pytestmark = pytest.mark.corpus

FOLDERS = ("ea", "magicdraw", "md-eclipse-export", "papyrus")
LARGE = 4_000_000
"""Bytes of the largest file that is worth the time."""
SNAPSHOT = "content of used libraries is referred to, not copied"
STEREOTYPE = "what the stereotypes of such libraries specialise is not known without them"
ROLE = "roles that only such stereotypes give are said by SysML's"
SPELLING = "tags of SysML are spelt as Papyrus does"
NAME = "names of stereotypes are as XML tags show them"
UNSAID = "UML has no such attribute (SM722)"


@pytest.mark.long
def test_every_difference_has_a_reason(corpus, tmp_path, golden):
    lines = []
    for path in models(corpus):
        found = Counter(reason(*change) for change in changes(path, tmp_path))
        told = [f"  {count} {why}" for why, count in sorted(found.items())]
        lines += [f"{path.parent.name}/{path.name}: {sum(found.values())}", *told]
    assert len([line for line in lines if line.startswith("papyrus/")]) > 15
    assert [line for line in lines if line.startswith("papyrus/") and line[-3:] != ": 0"] == []
    assert [line for line in lines if "without a reason" in line] == []
    golden.check("uml", {"corpus.txt": "\n".join(lines) + "\n"})


@pytest.mark.long
def test_papyrus_models_keep_to_the_metamodel(corpus):
    metamodel = Metamodel(corpus / "xmi" / "metamodel" / "uml.ecore")
    for path in sorted((corpus / "xmi" / "papyrus").glob("*.uml")):
        made = Counter(metamodel.find_violations(saved(path).encode()))
        assert made - Counter(metamodel.find_violations(path.read_bytes())) == Counter(), path.name


def models(corpus):
    found = (path for folder in FOLDERS for path in (corpus / "xmi" / folder).iterdir())
    return sorted(path for path in found if path.is_file() and path.stat().st_size < LARGE)


def saved(path):
    return uml(compile_example(path, "uml"))


def uml(compilation):
    """The saved model; it is written also when the model has errors."""
    return next(one.text for one in compilation.list_published() if one.backend == "uml")


def changes(path, folder):
    one = compile_example(path, "uml")
    two = compile_text(folder, "model.uml", uml(one).encode(), "uml")
    for change in diff(one.graph, two.graph, {"id", "source", "trace", *DIALECT_ATTRIBUTES}):
        if not is_dialect_difference(change):
            yield change, libraries(one.graph) | libraries(two.graph)


def libraries(graph):
    """Names of what is outside, and of the bare ids that stand for it."""
    return {graph.qualified_name(one) for one in graph if one.attrs.get("external")}


def reason(change, outside):
    key, _, rest = change.detail.partition(" ")
    is_edge = change.what.startswith("edge")
    if change.element in outside or change.element.rpartition("::")[0] in outside:
        return SNAPSHOT
    if key in ("lineage:", "instance-of"):
        return STEREOTYPE
    if (is_edge and rest in outside) or "#" in rest:
        return SNAPSHOT
    if change.what == "added" and change.detail == "Application":
        return NAME if "_" in change.element.rpartition("::")[2] else ROLE
    if change.what == "removed" and change.detail == "Application":
        return NAME if " " in change.element.rpartition("::")[2] else "without a reason"
    if key.startswith("tag."):
        return SPELLING
    return UNSAID if key == "ns_prefix:" else f"without a reason: {change}"


def test_a_difference_that_nothing_explains_has_no_reason(corpus, tmp_path):
    path = corpus / "xmi" / "papyrus" / "INCOSE.uml"
    graph = compile_example(path, "uml")
    text = uml(graph).replace('name="', 'name="x', 1)
    other = compile_text(tmp_path, "model.uml", text.encode(), "uml")
    found = diff(graph.graph, other.graph, {"id", "source", "trace"})
    assert found
    assert "without a reason" in reason(found[-1], frozenset())
