"""Comparison of the elements that the OpenMBEE toolkit finds in a text with those of the graph."""

from expected_elements import list_expected
from sysml_texts import write
from toolkit import load


def compare(graph):
    """Return the complaints of the toolkit, the differences, and the number of elements."""
    files, _ = write(graph)
    loaded = load(files)
    expected = list_expected(graph)
    return loaded.complaints, find_differences(loaded, expected, ()), len(expected)


def compare_together(graphs):
    """Compare many small models in one session, each in a package of its own.

    A text with names from the root (``$::``) needs a session of its own.
    """
    files, together, alone = {}, [], []
    for graph in graphs:
        texts, _ = write(graph)
        text = texts.pop("model.sysml")
        if "$::" in text:
            alone.append(graph)
            continue
        together.append(graph)
        name = f"m{len(together)}"
        files |= texts | {f"{name}.sysml": f"package {name} {{\n{text}}}\n"}
    loaded = load(files)
    complaints, differences, count = loaded.complaints, [], 0
    for graph in alone:
        new_complaints, new_differences, new_count = compare(graph)
        complaints, differences = complaints + new_complaints, differences + new_differences
        count += new_count
    for number, graph in enumerate(together, 1):
        expected = list_expected(graph)
        count += len(expected)
        differences += find_differences(loaded, expected, (f"m{number}",))
    return complaints, differences, count


def find_differences(loaded, expected, packages):
    """Return the expected elements that the toolkit lacks or finds with another kind or type."""
    differences = []
    for path, (metaclasses, type_) in expected.items():
        path = (*packages, *path)
        name = "::".join(path)
        metaclass_counts = loaded.elements.get(path)
        if metaclass_counts is None:
            differences.append(f"{name} is missing")
        elif not metaclasses & set(metaclass_counts):
            differences.append(f"{name} is {set(metaclass_counts)}")
        elif type_ is not None and type_ not in loaded.types[path]:
            differences.append(f"{name} has not the type {type_}")
    return differences
