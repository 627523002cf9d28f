"""Elements of libraries, and those of them that the model uses."""

from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.classifiers import has_stereotype

_NO_USES = (Kind.IMPORT, Kind.APPLICATION)


def find_unused_library_elements(graph: Graph) -> frozenset[str]:
    """Return the ids of the elements of libraries to which no element of the model leads.

    Libraries are content of other units, and library packages (in SysML v1 «ModelLibrary») beside
    other content of the unit. An element is used if relations lead to it, directly or through other
    library elements. They lead from an element to its members, but not from a package; an import
    or an applied stereotype is no use.
    """
    external = {element.id for element in graph if element.attrs.get("external")}
    library = external | {
        element.id
        for package in graph.of_kind(Kind.PACKAGE)
        if package.subkind == "library" or has_stereotype(graph, package, "ModelLibrary")
        for element in graph.subtree(package)
    }
    if library.issuperset(item.id for item in graph if item.kind is not Kind.APPLICATION):
        library = external
    worklist = [
        graph[target]
        for _, source, target in graph.edges()
        if target in library and source not in library and graph[source].kind not in _NO_USES
    ]
    used: set[str] = set()
    while worklist:
        element = worklist.pop()
        if element.id in library and element.id not in used:
            used.add(element.id)
            if element.kind is not Kind.PACKAGE:
                worklist += (item for edge in Edge for item in graph.targets(element, edge))
    return frozenset(library - used)
