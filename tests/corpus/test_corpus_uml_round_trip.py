"""Real models are saved as UML and read back; every difference has a reason."""

from collections import Counter

import pytest

from dialects.comparison import DIALECT_ATTRIBUTES, is_dialect_difference
from dialects.metamodel import Metamodel
from examples.compiling import compile_example, compile_text
from graph_differences import diff

pytestmark = pytest.mark.corpus

FOLDERS = ("ea", "magicdraw", "md-eclipse-export", "papyrus")
LARGE = 4_000_000
"""Size in bytes from which a file is skipped, because it takes too long."""
SNAPSHOT = "content of used libraries is referred to, not copied"
STEREOTYPE = "the generals of stereotypes in used libraries are unknown without the libraries"
ROLE = "roles given by stereotypes of used libraries are expressed by SysML's stereotypes"
SPELLING = "tags of SysML are spelled as in Papyrus"
NAME = "names of stereotypes are those of their XML tags"
UNSUPPORTED = "UML has no such attribute (SM722)"


@pytest.mark.long
def test_every_difference_after_reading_back_has_a_reason(corpus, tmp_path, golden):
    lines = []
    for path in list_small_files(corpus):
        reasons = Counter(find_reason(*change) for change in iter_changes(path, tmp_path))
        lines_of_reasons = [f"  {count} {reason}" for reason, count in sorted(reasons.items())]
        lines += [f"{path.parent.name}/{path.name}: {sum(reasons.values())}", *lines_of_reasons]
    assert len([line for line in lines if line.startswith("papyrus/")]) > 15
    assert [line for line in lines if line.startswith("papyrus/") and line[-3:] != ": 0"] == []
    assert [line for line in lines if "without a reason" in line] == []
    golden.check("uml", {"corpus.txt": "\n".join(lines) + "\n"})


@pytest.mark.long
def test_saved_papyrus_models_conform_to_the_metamodel(corpus):
    metamodel = Metamodel(corpus / "xmi" / "metamodel" / "uml.ecore")
    for path in sorted((corpus / "xmi" / "papyrus").glob("*.uml")):
        violations = Counter(metamodel.find_violations(save_model(path).encode()))
        assert violations - Counter(metamodel.find_violations(path.read_bytes())) == Counter(), (
            path.name
        )


def list_small_files(corpus):
    paths = (path for folder in FOLDERS for path in (corpus / "xmi" / folder).iterdir())
    return sorted(path for path in paths if path.is_file() and path.stat().st_size < LARGE)


def save_model(path):
    return find_uml(compile_example(path, "uml"))


def find_uml(compilation):
    """Return the saved model, which is also written if the model has errors."""
    return next(
        artefact.text for artefact in compilation.list_published() if artefact.backend == "uml"
    )


def iter_changes(path, folder):
    original = compile_example(path, "uml")
    saved = compile_text(folder, "model.uml", find_uml(original).encode(), "uml")
    for change in diff(original.graph, saved.graph, {"id", "source", "trace", *DIALECT_ATTRIBUTES}):
        if not is_dialect_difference(change):
            yield change, list_external_names(original.graph) | list_external_names(saved.graph)


def list_external_names(graph):
    """Return the names of elements outside the unit, and the bare ids that stand for them."""
    return {graph.qualified_name(element) for element in graph if element.attrs.get("external")}


def find_reason(change, outside):
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
    return UNSUPPORTED if key == "ns_prefix:" else f"without a reason: {change}"


def test_an_unexplained_difference_has_no_reason(corpus, tmp_path):
    path = corpus / "xmi" / "papyrus" / "INCOSE.uml"
    original = compile_example(path, "uml")
    text = find_uml(original).replace('name="', 'name="x', 1)
    changed = compile_text(tmp_path, "model.uml", text.encode(), "uml")
    differences = diff(original.graph, changed.graph, {"id", "source", "trace"})
    assert differences
    assert "without a reason" in find_reason(differences[-1], frozenset())
