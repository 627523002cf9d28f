"""A model and the graph of its SysML v2 text differ only where a reviewed reason says why.

Both graphs have run the same passes; the comparison is that of ``sysmlc diff`` without ids.
"""

import pytest
from reading_corpus import XMI_FOLDERS, XMI_SUFFIXES, list_models, lower
from text_difference_reasons import REASONS
from text_differences import RoundTrip

from examples.compiling import EXAMPLES, compile_example
from sysmlc.backends.sysml import LIBRARY, write_document
from sysmlc.backends.sysml.printing import print_lines
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir.compare import compare
from sysmlc.sources import Source
from sysmlc.support import resources

PASSES = ("resolve", "inherit", "classify", "ports", "flows")
TASKS = next(path for path in EXAMPLES if path.stem == "four-tasks")


def read_text(lines, uses_library):
    """Return the graph of a text, read together with the library if the text uses it.

    Fails if the text has errors.
    """
    sources = [Source("model.sysml", print_lines(lines).encode())]
    if uses_library:
        sources.append(Source(LIBRARY, resources.read_text("metamodels", LIBRARY).encode()))
    graph, sink = lower(sources, PASSES, FRONTEND)
    assert [f"{error.rule.code} {error.message}" for error in sink if error.is_error] == []
    return graph


def explain_model(path):
    """Return the number of elements, the counts of reasons, and the unexplained differences."""
    graph = compile_example(path, "ir").graph
    writer, lines = write_document(graph)
    text_graph = read_text(lines, writer.uses_library)
    trip = RoundTrip(graph, text_graph, writer.losses.by_element)
    return (len(graph), *trip.explain(compare(graph, text_graph, ("id",)), REASONS))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_differences_of_the_examples_have_reasons(path):
    assert explain_model(path)[2] == []


def test_a_difference_without_a_reason_is_not_explained():
    graph = compile_example(TASKS, "ir").graph
    writer, lines = write_document(graph)
    text_graph = read_text(lines, writer.uses_library)
    port = next(element for element in text_graph if element.kind == "Port")
    text_graph.rename(port, "another name")
    trip = RoundTrip(graph, text_graph, writer.losses.by_element)
    assert len(trip.explain(compare(graph, text_graph, ("id",)), REASONS)[1]) == 1


def check_models(golden, name, models):
    """Compare the counts of the reasons with a golden file; fail if a difference has no reason."""
    lines, without_reason = [], []
    for path in models:
        elements, counts, unexplained = explain_model(path)
        without_reason += [f"{path.name}: {difference}" for difference in unexplained]
        number = sum(counts.values()) + len(unexplained)
        lines.append(f"{path.parent.name}/{path.name}: {elements} elements, {number} differences")
        sentences = [reason.sentence for reason in REASONS if reason.sentence in counts]
        lines += [f"  {counts[sentence]} {sentence}" for sentence in sentences]
    assert without_reason == []
    golden.check(name, {"differences.txt": "\n".join(lines) + "\n"})


@pytest.mark.long
@pytest.mark.corpus
def test_differences_of_real_models_have_reasons(golden):
    models = [
        *list_models(*(f"xmi/{folder}" for folder in XMI_FOLDERS), suffixes=XMI_SUFFIXES),
        *list_models("aml/baygate", "aml/dev", suffixes=(".aml", ".amlx")),
    ]
    check_models(golden, "sysml-text", models)


@pytest.mark.long
@pytest.mark.corpus
def test_differences_of_the_telescope_have_reasons(golden):
    """The export of MTIP has 94 MB and 56,780 elements; the comparison takes about a minute."""
    check_models(golden, "sysml-text-telescope", list_models("xmi/huds", suffixes=(".zip",)))
