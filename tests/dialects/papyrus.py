"""Writes UML and SysML documents as Papyrus saves them: UML2 5.0.0, SysML 1.6, stereotypes last."""

import base64
import hashlib
from collections.abc import Sequence

from lxml import etree

Element = etree._Element
Value = str | bool | int | Element | Sequence[Element]

XMI = "http://www.omg.org/spec/XMI/20131001"
XSI = "http://www.w3.org/2001/XMLSchema-instance"
UML = "http://www.eclipse.org/uml2/5.0.0/UML"
ECORE = "http://www.eclipse.org/emf/2002/Ecore"
SYSML = "http://www.eclipse.org/papyrus/sysml/1.6/SysML"
PRIMITIVES = "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#"

_PACKAGES = {
    "Activities": "Activities",
    "Allocations": "Allocations",
    "Blocks": "Blocks",
    "ConstraintBlocks": "ConstraintBlocks",
    "DeprecatedElements": "DeprecatedElements",
    "ModelElements": "ModelElements",
    "PortsAndFlows": "Ports_u0026Flows",
    "Requirements": "Requirements",
}
"""Packages of the SysML profile: the prefix, and the name in the id of the package."""

_ORDER = {
    feature: rank
    for rank, feature in enumerate(
        (
            "ownedComment",
            "packageImport",
            "ownedRule",
            "generalization",
            "packagedElement",
            "ownedLiteral",
            "ownedAttribute",
            "ownedEnd",
            "ownedConnector",
            "interfaceRealization",
            "ownedOperation",
            "ownedReception",
            "ownedBehavior",
            "ownedParameter",
            "edge",
            "structuredNode",
            "group",
            "node",
            "trigger",
            "region",
            "transition",
            "effect",
            "subvertex",
            "doActivity",
            "entry",
            "exit",
            "profileApplication",
        )
    )
}
"""The order in which UML2 saves the features of an element."""


class PapyrusDocument:
    """A document that grows element by element; ids come from place and name, never from chance."""

    def __init__(self, name: str, seed: str = "", profiles: dict[str, str] | None = None) -> None:
        namespaces = {"xmi": XMI, "xsi": XSI, **(profiles or {})}
        namespaces |= {package: f"{SYSML}/{package}" for package in _PACKAGES}
        namespaces |= {"ecore": ECORE, "uml": UML}
        self._namespaces = namespaces
        self._ids: set[str] = set()
        self._seed = seed or name
        self.root = etree.Element(f"{{{XMI}}}XMI", {f"{{{XMI}}}version": "20131001"}, namespaces)
        self.model = etree.SubElement(self.root, f"{{{UML}}}Model")
        self.model.set(f"{{{XMI}}}id", self._new_id("model"))
        self.model.set("name", name)

    def add(
        self, owner: Element, feature: str, metaclass: str, name: str = "", **features: Value
    ) -> Element:
        """Add an element as ``feature`` of its owner; elements as values become references."""
        made = etree.SubElement(owner, feature)
        made.set(f"{{{XMI}}}type", f"uml:{metaclass}")
        made.set(f"{{{XMI}}}id", self._new_id(f"{id_of(owner)}/{feature}/{metaclass}/{name}"))
        if name:
            made.set("name", name)
        self.set(made, **features)
        return made

    def set(self, element: Element, **features: Value) -> None:
        """Set features: elements become references, true and numbers their text."""
        for feature, value in features.items():
            element.set(feature.rstrip("_"), _text(value))

    def refer(self, owner: Element, feature: str, metaclass: str, href: str) -> None:
        """Add a reference to an element of another file."""
        made = etree.SubElement(owner, feature)
        made.set(f"{{{XMI}}}type", f"uml:{metaclass}")
        made.set("href", href)

    def opaque(self, owner: Element, feature: str, body: str, language: str = "") -> Element:
        """Add an opaque expression."""
        made = self.add(owner, feature, "OpaqueExpression")
        say(made, body, language)
        return made

    def comment(self, owner: Element, body: str, *annotated: Element) -> None:
        """Add a comment on its owner, or on what is given."""
        made = self.add(owner, "ownedComment", "Comment", annotatedElement=annotated or (owner,))
        etree.SubElement(made, "body").text = body

    def multiplicity(self, element: Element, lower: int, upper: str) -> None:
        """Set the bounds, as children that leave the defaults out."""
        low = self.add(element, "lowerValue", "LiteralInteger")
        if lower:
            low.set("value", str(lower))
        self.add(element, "upperValue", "LiteralUnlimitedNatural", value=upper)

    def apply(self, stereotype: str, base: Element, **tags: Value) -> Element:
        """Apply ``Prefix:Name`` to the element; its metaclass gives the base property."""
        prefix, local = stereotype.split(":")
        made = etree.SubElement(self.root, f"{{{self._namespaces[prefix]}}}{local}")
        made.set(f"{{{XMI}}}id", self._new_id(f"{id_of(base)}/{stereotype}"))
        made.set(f"base_{_BASES.get(local, metaclass_of(base))}", id_of(base))
        self.set(made, **tags)
        return made

    def applied_profile(self, source: str, href: str) -> None:
        """Say that the model applies a profile, the way UML2 notes its Ecore form."""
        made = self.add(self.model, "profileApplication", "ProfileApplication", source)
        del made.attrib["name"]
        note = etree.SubElement(made, "eAnnotations")
        note.set(f"{{{XMI}}}type", "ecore:EAnnotation")
        note.set(f"{{{XMI}}}id", self._new_id(f"{source}/note"))
        note.set("source", "http://www.eclipse.org/uml2/2.0.0/UML")
        reference = etree.SubElement(note, "references")
        reference.set(f"{{{XMI}}}type", "ecore:EPackage")
        reference.set("href", source)
        self.refer(made, "appliedProfile", "Profile", href)

    def apply_sysml(self) -> None:
        """Apply the packages of SysML 1.6."""
        for prefix, package in _PACKAGES.items():
            href = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_"
            self.applied_profile(f"{SYSML}#//{prefix.lower()}", href + package)

    def bytes(self) -> bytes:
        """The document as Papyrus would save it."""
        for element in self.root.iter():
            _link_flow_ends(element)
        for element in self.model.iter():
            element[:] = sorted(element, key=_rank)
        etree.cleanup_namespaces(self.root, keep_ns_prefixes=["xsi", "ecore"])
        etree.indent(self.root)
        text = etree.tostring(self.root, encoding="unicode").replace("&#13;", "&#xD;")
        return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()

    def _new_id(self, role: str) -> str:
        digest = hashlib.sha256(f"{self._seed}|{role}".encode()).digest()[:16]
        id_ = "_" + base64.urlsafe_b64encode(digest).decode().rstrip("=")
        if id_ in self._ids:
            return self._new_id(role + "'")
        self._ids.add(id_)
        return id_


_BASES = {
    "TestCase": "Behavior",
    "ValueType": "DataType",
    "DirectedFeature": "Feature",
    **dict.fromkeys(("Continuous", "Discrete", "Probability", "Rate"), "ActivityEdge"),
}
"""Stereotypes whose base property names a general metaclass."""


def id_of(element: Element) -> str:
    return element.get(f"{{{XMI}}}id", "")


def metaclass_of(element: Element) -> str:
    return element.get(f"{{{XMI}}}type", "uml:Model").removeprefix("uml:")


def say(element: Element, body: str, language: str = "") -> None:
    """Give an opaque element its text."""
    if language:
        etree.SubElement(element, "language").text = language
    etree.SubElement(element, "body").text = body


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str | int):
        return str(value)
    if isinstance(value, Element):
        return id_of(value)
    return " ".join(id_of(element) for element in value)


def _rank(element: Element) -> int:
    return _ORDER.get(str(element.tag), -1)


def _link_flow_ends(element: Element) -> None:
    """Papyrus writes the flows of an activity also at their nodes."""
    if element.tag == "edge" and "source" in element.attrib:
        nodes = {id_of(node): node for node in element.getroottree().getroot().iter()}
        for end, feature in (("source", "outgoing"), ("target", "incoming")):
            node = nodes[element.attrib[end]]
            known = node.get(feature, "").split()
            if id_of(element) not in known:
                node.set(feature, " ".join([*known, id_of(element)]))
