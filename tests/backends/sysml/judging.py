"""Compares the elements that the toolkit finds in a text with those of the graph."""

from expected import list_expected
from toolkit import load
from writing import write


def judge(graph):
    """Return the complaints of the toolkit, the differences, and the number of elements."""
    files, _ = write(graph)
    loaded = load(files)
    wanted = list_expected(graph)
    return loaded.complaints, find_differences(loaded, wanted, ()), len(wanted)


def judge_together(graphs):
    """Judge many small models in one session, each in a package of its own.

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
        own_complaints, own_differences, own_count = judge(graph)
        complaints, differences = complaints + own_complaints, differences + own_differences
        count += own_count
    for number, graph in enumerate(together, 1):
        wanted = list_expected(graph)
        count += len(wanted)
        differences += find_differences(loaded, wanted, (f"m{number}",))
    return complaints, differences, count


def find_differences(loaded, wanted, packages):
    """Return the expected elements that the toolkit lacks or finds with another kind or type."""
    differences = []
    for path, (metaclasses, type_) in wanted.items():
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
