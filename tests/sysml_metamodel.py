"""Interchange files of SysML v2, read with pyecore and the official metamodel."""

from pathlib import Path


def count_ids(files: dict[str, str]) -> dict[str, int]:
    """Return how many elements each interchange file has."""
    return {path: text.count("xmi:id=") for path, text in files.items()}


def count_with_metamodel(files: dict[str, str], folder: Path, corpus: Path) -> dict[str, int]:
    """Write the files into *folder* and return how many elements pyecore reads from each.

    pyecore raises an exception for an element or attribute that the metamodel does not have.
    """
    from pyecore.resources import URI, ResourceSet

    resources = ResourceSet()
    metamodel = corpus / "sysml2/interchange/metamodel/SysML.ecore"
    package = resources.get_resource(URI(str(metamodel))).contents[0]
    resources.metamodel_registry[package.nsURI] = package
    counts = {}
    for path, text in files.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        (root,) = resources.get_resource(URI(str(file))).contents
        counts[path] = 1 + sum(1 for _ in root.eAllContents())
    return counts
