"""By which names files of SysML v2 and KerML refer to one another (KerML 1.0, 8.2.3.5.5).

The root namespaces of all files of a unit form the global namespace: a file sees the elements of
another one by the names of its root members, and of those only.
"""

from collections.abc import Iterable

from sysmlc.diagnostics import Sink
from sysmlc.frontends.base import FileNames
from sysmlc.frontends.sysml.detect import is_description
from sysmlc.frontends.sysml.reading import parse_document
from sysmlc.language.tree import Node, Reference
from sysmlc.sources import Source, SourceError

_GLOBAL_SCOPE = "$"


def read_names(source: Source) -> FileNames:
    """Return the names of the root members and of all elements, and the heads of qualified names.

    A file is a library when every root member is a library package.
    """
    root = _parse(source)
    nodes = list(root.walk())
    references = (relation.reference for node in nodes for relation in node.relations)
    return FileNames(
        is_library=all(member.kind == "LibraryPackage" for member in root.members),
        declared=_list_names(root.members),
        local=_list_names(nodes),
        used=frozenset(_head(reference) for reference in references),
    )


def _list_names(nodes: Iterable[Node]) -> frozenset[str]:
    return frozenset(name for node in nodes for name in (node.name, node.short_name) if name)


def _head(reference: Reference) -> str:
    """Return the first segment of the name, or the second one behind the global scope ``$``."""
    names = reference.chain[0]
    return names[1] if names[0] == _GLOBAL_SCOPE and len(names) > 1 else names[0]


def _parse(source: Source) -> Node:
    """Return the root namespace of the file; its faults are reported when the unit is read."""
    if is_description(source):
        return Node("Namespace")
    try:
        return parse_document(source, Sink()).root
    except SourceError:
        return Node("Namespace")
