"""References out of the saved model, as Papyrus writes those into the standards' libraries."""

from urllib.parse import quote

from sysmlc.backends.uml.metaclasses import metaclass_of
from sysmlc.backends.uml.node import Node
from sysmlc.ir import Element, Graph, Kind

_UML = "http://www.omg.org/spec/UML/20161101/"
_SYSML = "http://www.omg.org/spec/SysML/20181001/SysML.xmi#"
_FILES = {
    f"{_UML}UML.xmi#": "pathmap://UML_METAMODELS/UML.metamodel.uml#",
    f"{_UML}PrimitiveTypes.xmi#": "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#",
    f"{_UML}StandardProfile.xmi#": "pathmap://UML_PROFILES/Standard.profile.uml#",
}
_PROFILE = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML"
_LIBRARY = "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML"
_OURS = "pathmap://SYSMLC_LIBRARIES/"
_STEPS = {
    Kind.STEREOTYPE: "stereotype",
    Kind.DATA_TYPE: "dataType",
    Kind.ENUMERATION: "enumeration",
    Kind.CLASS: "class",
}


def is_outside(element: Element) -> bool:
    """Whether a file that is not part of the unit holds the element."""
    return bool(element.attrs.get("external"))


def href_of(graph: Graph, element: Element) -> str:
    """Where an element outside the unit is; one of our own libraries is named by its path."""
    href = str(element.attrs.get("href", ""))
    if not href:
        above = reversed([element, *graph.ancestors(element)])
        file, *path = [quote(_own_name(one), safe="") for one in above]
        return f"{_OURS}{file}#{'/'.join(path) or file}"
    for ours, theirs in _FILES.items():
        if href.startswith(ours):
            return theirs + href.removeprefix(ours)
    return _sysml(element, href.removeprefix(_SYSML)) if href.startswith(_SYSML) else href


def _own_name(element: Element) -> str:
    """The name; of types for one unit, of which several have one name, the id."""
    return element.id if element.name.endswith("]") else element.name


def _sysml(element: Element, path: str) -> str:
    if path == "_0":
        return _PROFILE
    *packages, last = path.split(".")
    steps = [f"package_packagedElement_{_coded(name)}" for name in packages]
    steps.append(f"{_STEPS.get(element.kind, 'package')}_packagedElement_{_coded(last)}")
    file = _LIBRARY if path.split(".")[0] == "Libraries" else _PROFILE
    return ".".join((file, *steps))


def _coded(name: str) -> str:
    plain = (char if char.isalnum() or char in "-_" else f"_u{ord(char):04x}" for char in name)
    return "".join(plain)


def _shows(href: str, name: str) -> bool:
    """Whether a reader sees the name in the fragment, or in the name of the file."""
    file = href.partition("#")[0].rpartition("/")[2]
    return href.endswith(name) or file.partition(".")[0] == name


def reference(graph: Graph, tag: str, target: Element) -> Node:
    """A child that refers to an element outside the unit.

    A name that the href does not show is written beside it, as MagicDraw does.
    """
    href = href_of(graph, target)
    node = Node(tag, {"xmi:type": f"uml:{metaclass_of(graph, target)[0]}", "href": href})
    if target.kind in (Kind.UNIT, Kind.QUANTITY_KIND):
        del node.attributes["xmi:type"]
    path = str(target.attrs.get("qualified_name", "")) or target.name
    is_told = "qualified_name" not in target.attrs and _shows(href, target.name)
    if path and not is_told and not target.attrs.get("library") and "pathmap:" not in href:
        extension = node.add(Node("xmi:Extension", {"extender": "sysmlc"}))
        extension.add(Node("referenceExtension", {"referentPath": path}))
    return node
