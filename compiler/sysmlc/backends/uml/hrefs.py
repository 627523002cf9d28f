"""References to elements outside the saved model, in the form that Papyrus writes."""

from functools import cache
from urllib.parse import quote

from lxml import etree

from sysmlc.backends.uml.metaclasses import find_metaclass
from sysmlc.backends.uml.node import Node
from sysmlc.ir import Element, Graph, Kind
from sysmlc.support import resources

_UML = "http://www.omg.org/spec/UML/20161101/"
_SYSML = "http://www.omg.org/spec/SysML/20181001/SysML.xmi#"
_FILES = {
    f"{_UML}UML.xmi#": "pathmap://UML_METAMODELS/UML.metamodel.uml#",
    f"{_UML}PrimitiveTypes.xmi#": "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#",
    f"{_UML}StandardProfile.xmi#": "pathmap://UML_PROFILES/Standard.profile.uml#",
}
"""The files of the OMG, and those of Eclipse with the same fragments."""
_PROFILE = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML"
_LIBRARY = "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML"
_OWN_LIBRARIES = "pathmap://SYSMLC_LIBRARIES/"
_SHIPPED_LIBRARIES = frozenset({"DIN8580", "Floors", "LineMachines"})
"""Libraries of SysML v2 that ``metamodels`` also has for SysML v1."""
_STEPS = {
    Kind.STEREOTYPE: "stereotype",
    Kind.DATA_TYPE: "dataType",
    Kind.ENUMERATION: "enumeration",
    Kind.CLASS: "class",
}
"""Words for elements in the ids of Papyrus's SysML profile; others are packages."""


def is_external(element: Element) -> bool:
    """Whether the element is a stub for one outside the compile unit."""
    return bool(element.attrs.get("external"))


def list_shipped_libraries(graph: Graph) -> list[str]:
    """Return the names of the shipped libraries that the model uses and hrefs lead into."""
    return sorted(
        root.name for root in graph.roots() if is_external(root) and root.name in _SHIPPED_LIBRARIES
    )


@cache
def _read_library_ids(library: str) -> dict[tuple[str, ...], str]:
    """Return the ids in a shipped library for SysML v1 by the names on the path to the element."""
    ids: dict[tuple[str, ...], str] = {}
    root = etree.parse(resources.path("metamodels", f"{library}.uml")).getroot()
    stack: list[tuple[etree._Element, tuple[str, ...]]] = [(root, ())]
    while stack:
        node, path = stack.pop()
        if "name" in node.attrib:
            path = (*path, str(node.attrib["name"]))
            ids[path] = str(node.get("{http://www.omg.org/spec/XMI/20131001}id", ""))
        stack.extend((child, path) for child in node)
    return ids


def _make_library_href(graph: Graph, element: Element) -> str:
    """Return the href of an element of our own libraries: its id in the file, or its path."""
    path = list(reversed([element, *graph.ancestors(element)]))
    library = path[0].name
    names = tuple(step.name for step in path)
    id = _read_library_ids(library).get(names, "") if library in _SHIPPED_LIBRARIES else ""
    if id:
        return f"libraries/{library}.uml#{id}"
    file, *steps = [quote(_find_unique_name(step), safe="") for step in path]
    return f"{_OWN_LIBRARIES}{file}#{'/'.join(steps) or file}"


def make_href(graph: Graph, element: Element) -> str:
    """Return the href of an external stub."""
    href = str(element.attrs.get("href", ""))
    if not href:
        return _make_library_href(graph, element)
    for prefix, replacement in _FILES.items():
        if href.startswith(prefix):
            return replacement + href.removeprefix(prefix)
    if href.startswith(_SYSML):
        return _make_sysml_href(element, href.removeprefix(_SYSML))
    return href


def _find_unique_name(element: Element) -> str:
    """Return the name, or the id of a type with a unit: several of these have the same name."""
    return element.id if element.name.endswith("]") else element.name


def _make_sysml_href(element: Element, path: str) -> str:
    """Return Papyrus's href of a SysML element that the OMG's file has under a dotted path."""
    if path == "_0":
        return _PROFILE
    *packages, name = path.split(".")
    steps = [f"package_packagedElement_{_escape_name(package)}" for package in packages]
    steps.append(f"{_STEPS.get(element.kind, 'package')}_packagedElement_{_escape_name(name)}")
    file = _LIBRARY if path.split(".")[0] == "Libraries" else _PROFILE
    return ".".join((file, *steps))


def _escape_name(name: str) -> str:
    """Write special characters as Papyrus does: ``Ports&Flows`` is ``Ports_u0026Flows``."""
    return "".join(c if c.isalnum() or c in "-_" else f"_u{ord(c):04x}" for c in name)


def _contains_name(href: str, name: str) -> bool:
    """Whether a reader finds the name at the end of the href, or as the name of its file."""
    file = href.partition("#")[0].rpartition("/")[2]
    return href.endswith(name) or file.partition(".")[0] == name


def make_reference(graph: Graph, tag: str, target: Element) -> Node:
    """Return a child that refers to an element outside the unit.

    A name that the href does not contain stands in an extension, as MagicDraw writes it.
    """
    href = make_href(graph, target)
    node = Node(tag, {"xmi:type": f"uml:{find_metaclass(graph, target)[0]}", "href": href})
    if target.kind in (Kind.UNIT, Kind.QUANTITY_KIND):
        # Without a type, the front end takes the kind from the feature: unit or quantityKind.
        del node.attributes["xmi:type"]
    path = str(target.attrs.get("qualified_name", "")) or target.name
    is_in_href = "qualified_name" not in target.attrs and _contains_name(href, target.name)
    is_standard = bool(target.attrs.get("library")) or "pathmap:" in href
    if path and not is_in_href and not is_standard:
        extension = node.add(Node("xmi:Extension", {"extender": "sysmlc"}))
        extension.add(Node("referenceExtension", {"referentPath": path}))
    return node
