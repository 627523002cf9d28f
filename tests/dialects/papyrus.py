"""Builder of UML and SysML documents as Papyrus saves them (UML2 5.0.0, SysML 1.6)."""

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
"""Packages of the SysML profile: their prefixes, and their names in the ids of the profile."""

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
    """A document built element by element; ids are derived from owner and name, never random."""

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
        """Add an element as *feature* of its owner; values that are elements become references."""
        element = etree.SubElement(owner, feature)
        element.set(f"{{{XMI}}}type", f"uml:{metaclass}")
        element.set(f"{{{XMI}}}id", self._new_id(f"{id_of(owner)}/{feature}/{metaclass}/{name}"))
        if name:
            element.set("name", name)
        self.set(element, **features)
        return element

    def set(self, element: Element, **features: Value) -> None:
        """Set features; elements become references, booleans and numbers their text."""
        for feature, value in features.items():
            element.set(feature.rstrip("_"), _format_value(value))

    def add_reference(self, owner: Element, feature: str, metaclass: str, href: str) -> None:
        """Add a reference to an element of another file."""
        reference = etree.SubElement(owner, feature)
        reference.set(f"{{{XMI}}}type", f"uml:{metaclass}")
        reference.set("href", href)

    def add_expression(
        self, owner: Element, feature: str, body: str, language: str = ""
    ) -> Element:
        """Add an opaque expression."""
        expression = self.add(owner, feature, "OpaqueExpression")
        add_body(expression, body, language)
        return expression

    def add_comment(self, owner: Element, body: str, *annotated: Element) -> None:
        """Add a comment about its owner, or about the *annotated* elements."""
        comment = self.add(owner, "ownedComment", "Comment", annotatedElement=annotated or (owner,))
        etree.SubElement(comment, "body").text = body

    def set_bounds(self, element: Element, lower: int, upper: str) -> None:
        """Add the bounds as children, which omit default values."""
        lower_value = self.add(element, "lowerValue", "LiteralInteger")
        if lower:
            lower_value.set("value", str(lower))
        self.add(element, "upperValue", "LiteralUnlimitedNatural", value=upper)

    def apply(self, stereotype: str, base: Element, **tags: Value) -> Element:
        """Apply stereotype ``Prefix:Name`` to *base*, whose metaclass names the base property."""
        prefix, local = stereotype.split(":")
        application = etree.SubElement(self.root, f"{{{self._namespaces[prefix]}}}{local}")
        application.set(f"{{{XMI}}}id", self._new_id(f"{id_of(base)}/{stereotype}"))
        application.set(f"base_{_BASES.get(local, metaclass_of(base))}", id_of(base))
        self.set(application, **tags)
        return application

    def add_profile_application(self, source: str, href: str) -> None:
        """Apply a profile to the model, with UML2's annotation that refers to its Ecore form."""
        application = self.add(self.model, "profileApplication", "ProfileApplication", source)
        del application.attrib["name"]
        note = etree.SubElement(application, "eAnnotations")
        note.set(f"{{{XMI}}}type", "ecore:EAnnotation")
        note.set(f"{{{XMI}}}id", self._new_id(f"{source}/note"))
        note.set("source", "http://www.eclipse.org/uml2/2.0.0/UML")
        reference = etree.SubElement(note, "references")
        reference.set(f"{{{XMI}}}type", "ecore:EPackage")
        reference.set("href", source)
        self.add_reference(application, "appliedProfile", "Profile", href)

    def apply_sysml(self) -> None:
        """Apply the packages of SysML 1.6."""
        for prefix, package in _PACKAGES.items():
            href = "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_"
            self.add_profile_application(f"{SYSML}#//{prefix.lower()}", href + package)

    def as_bytes(self) -> bytes:
        """Return the document as Papyrus would save it."""
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
    **dict.fromkeys(("NoBuffer", "Overwrite"), "ObjectNode"),
}
"""Stereotypes whose base property names a more general metaclass."""


def id_of(element: Element) -> str:
    return element.get(f"{{{XMI}}}id", "")


def type_of(element: Element) -> str:
    """Return the ``xmi:type`` of an element, or the empty string."""
    return element.get(f"{{{XMI}}}type", "")


def is_custom_namespace(uri: str) -> bool:
    """Whether a namespace belongs to a custom profile, not to UML, SysML, XMI or XML."""
    return not uri.startswith((SYSML, UML, XMI, "http://www.w3.org", "http://www.eclipse.org/emf"))


def metaclass_of(element: Element) -> str:
    return element.get(f"{{{XMI}}}type", "uml:Model").removeprefix("uml:")


def add_body(element: Element, body: str, language: str = "") -> None:
    """Add the text of an opaque element."""
    if language:
        etree.SubElement(element, "language").text = language
    etree.SubElement(element, "body").text = body


def _format_value(value: Value) -> str:
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
    """Repeat a flow of an activity at its nodes, as Papyrus does."""
    if element.tag == "edge" and "source" in element.attrib:
        nodes = {id_of(node): node for node in element.getroottree().getroot().iter()}
        for end, feature in (("source", "outgoing"), ("target", "incoming")):
            node = nodes[element.attrib[end]]
            edges = node.get(feature, "").split()
            if id_of(element) not in edges:
                node.set(feature, " ".join([*edges, id_of(element)]))
