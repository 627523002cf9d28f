"""Compares what the toolkit finds in texts with what their graphs have."""

from expected import expected
from toolkit import load
from writing import written


def judged(graph):
    """Complaints of the toolkit, differences in names, metaclasses and types, and their number."""
    files, _ = written(graph)
    loaded = load(files)
    wanted = expected(graph)
    return loaded.complaints, differences(loaded, wanted, ()), len(wanted)


def judged_together(graphs):
    """The same for many small models in one session: each stands in a package of its own.

    A text that begins names at the root (``$::``) cannot: it is judged alone.
    """
    files, together, alone = {}, [], []
    for graph in graphs:
        made, _ = written(graph)
        text = made.pop("model.sysml")
        (alone if "$::" in text else together).append(graph)
        if "$::" not in text:
            files |= made | {f"m{len(together)}.sysml": f"package m{len(together)} {{\n{text}}}\n"}
    loaded = load(files)
    complaints, found, count = loaded.complaints, [], 0
    for graph in alone:
        more, different, number = judged(graph)
        complaints, found, count = complaints + more, found + different, count + number
    for number, graph in enumerate(together, 1):
        wanted = expected(graph)
        count += len(wanted)
        found += differences(loaded, wanted, (f"m{number}",))
    return complaints, found, count


def differences(loaded, wanted, above):
    """What the toolkit does not find as the graph has it, below packages with these names."""
    found = []
    for path, (metaclasses, type_) in wanted.items():
        path = (*above, *path)
        known = loaded.elements.get(path)
        if known is None:
            found.append(f"{'::'.join(path)} is missing")
        elif not metaclasses & set(known):
            found.append(f"{'::'.join(path)} is {set(known)}")
        elif type_ is not None and type_ not in loaded.types[path]:
            found.append(f"{'::'.join(path)} has not the type {type_}")
    return found
