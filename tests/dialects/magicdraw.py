"""Translation of a Papyrus document into a file of MagicDraw 19 (XML, and .mdzip).

MagicDraw writes no xmi:version, OMG namespaces, lists of references as child elements, ids of 41
characters, one SysML namespace with capital Id and Text, bounds of pins and parameters inside
extensions, a path on nearly every connector end, readable names beside references to other files,
and diagrams. It does not repeat flows at their nodes.
"""

import hashlib
import io
import zipfile
from collections.abc import Iterator

from lxml import etree

from dialects.papyrus import SYSML as PAPYRUS_SYSML
from dialects.papyrus import UML as PAPYRUS_UML
from dialects.papyrus import XMI, Element, id_of, is_custom_namespace, type_of

UML = "http://www.omg.org/spec/UML/20131001"
SYSML = "http://www.omg.org/spec/SysML/20150709/SysML"
PROFILE = "http://www.omg.org/spec/UML/20131001/MagicDrawProfile"
CUSTOMISATION = "http://www.magicdraw.com/spec/Customization/180/SysML"
DIAGRAM = "http://www.nomagic.com/ns/magicdraw/core/diagram/1.0"
EXTENDER = "MagicDraw UML 19.0"
ROOT_ID = "eee_1045467100313_135436_1"
MODEL_ENTRY = "com.nomagic.magicdraw.uml_model.model"

_PREFIXES = {
    "uml": UML,
    "xmi": XMI,
    "sysml": SYSML,
    "MagicDraw_Profile": PROFILE,
    "MD_Customization_for_SysML__additional_stereotypes": CUSTOMISATION,
}

LISTS = frozenset(
    (
        "annotatedElement",
        "bodyPart",
        "client",
        "constrainedElement",
        "conveyed",
        "covered",
        "inPartition",
        "informationSource",
        "informationTarget",
        "memberEnd",
        "method",
        "navigableOwnedEnd",
        "raisedException",
        "realizingConnector",
        "redefinedOperation",
        "redefinedPort",
        "redefinedProperty",
        "setupPart",
        "subsettedProperty",
        "supplier",
        "test",
    )
)
"""Features with several references; MagicDraw writes each reference as a child element."""

_NOT_SAVED = frozenset(
    {"incoming", "outgoing", "partition", "base_NamedElement", "base_DirectedRelationship"}
)
"""Features that Papyrus saves and MagicDraw derives."""

LISTS_OF = {
    "uml:ActivityPartition": {"node", "edge"},
    "uml:Clause": {"body"},
    "uml:InstanceSpecification": {"classifier"},
    "uml:InterruptibleActivityRegion": {"node", "interruptingEdge"},
}
"""Features that are lists of references in some metaclasses only."""

_CAPITAL = {("Requirement", "id"): "Id", ("Requirement", "text"): "Text"}

_BOUNDED_IN_EXTENSION = frozenset(
    {"uml:Parameter", "uml:InputPin", "uml:OutputPin", "uml:ValuePin"}
)

_PRIMITIVES = "pathmap://UML_LIBRARIES/UMLPrimitiveTypes.library.uml#"
_LIBRARY = "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML."
_SYSML_PROFILE = "pathmap://SysML16_PROFILES/SysML.profile.uml#"


def write_xml(papyrus: bytes, customised: bool = False) -> bytes:
    """Return the document as MagicDraw saves it in one XML file.

    *customised* adds the stereotypes of MagicDraw's own SysML customisation, which follow from the
    type of a property and add no information.
    """
    source = etree.fromstring(papyrus)
    writer = _Writer(source)
    if customised:
        writer.apply_customisation(source)
    etree.indent(writer.root, space="\t")
    return etree.tostring(writer.root, xml_declaration=True, encoding="UTF-8")


def map_ids(papyrus: bytes) -> dict[str, str]:
    """Map the ids of a Papyrus document to those in MagicDraw's files."""
    return _Writer(etree.fromstring(papyrus)).ids


def write_mdzip(papyrus: bytes) -> bytes:
    """Return the document as a MagicDraw project: a zip with the model among other entries."""
    buffer = io.BytesIO()
    entries = {
        "PROJECT-5d0cf1f2-3c61-4a8a-a4c1-2b4c27c0f3aa": b"",
        "Records.properties": b"#records\n",
        "BINARY-004d58df-51cf-4b9f-bdd8-b12336862a99": b"<diagram xmi:id='unbound prefix'/>",
        MODEL_ENTRY: write_xml(papyrus),
    }
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(zipfile.ZipInfo(name, (2021, 3, 31, 9, 38, 0)), data)
    return buffer.getvalue()


class _Writer:
    """Translates one document from Papyrus to MagicDraw."""

    def __init__(self, source: Element) -> None:
        self.ids = {id_of(element): _make_id(id_of(element)) for element in _iter_with_id(source)}
        custom = {prefix: uri for prefix, uri in source.nsmap.items() if is_custom_namespace(uri)}
        self.root = etree.Element(
            f"{{{XMI}}}XMI",
            nsmap={**_PREFIXES, **custom},
        )
        self._write_head()
        for element in source:
            if element.tag == f"{{{PAPYRUS_UML}}}Model":
                self.ids[id_of(element)] = ROOT_ID
                self._write_model(element)
            else:
                self._write_application(element)
        self._write_end_paths(source)

    def _write_head(self) -> None:
        documentation = etree.SubElement(self.root, f"{{{XMI}}}Documentation")
        etree.SubElement(documentation, f"{{{XMI}}}exporter").text = "MagicDraw UML"
        etree.SubElement(documentation, f"{{{XMI}}}exporterVersion").text = "19.0 v9"
        extension = _add_extension(self.root)
        etree.SubElement(extension, "plugin", pluginName="SysML", pluginVersion="19.0")

    def _write_model(self, source: Element) -> None:
        model = etree.SubElement(self.root, f"{{{UML}}}Model", {f"{{{XMI}}}type": "uml:Model"})
        self._copy_content(source, model)
        self._write_diagram(model)

    def _copy(self, source: Element, owner: Element) -> None:
        tag = etree.QName(source).localname
        if tag == "eAnnotations" or _is_repeated_sysml(source):
            return
        if "href" in source.attrib:
            _write_outside_reference(source, etree.SubElement(owner, tag))
        elif tag in ("lowerValue", "upperValue") and type_of(owner) in _BOUNDED_IN_EXTENSION:
            box = etree.SubElement(_add_extension(owner), "modelExtension")
            self._copy_content(source, etree.SubElement(box, tag))
        else:
            self._copy_content(source, etree.SubElement(owner, tag))

    def _copy_content(self, source: Element, copy: Element) -> None:
        type_ = f"{{{XMI}}}type"
        if type_ in source.attrib:
            copy.set(type_, source.attrib[type_])
        for name, value in source.attrib.items():
            if name != type_ and name not in _NOT_SAVED:
                self._write_feature(copy, str(name), str(value))
        for child in source:
            self._copy(child, copy)
        _copy_text(source, copy)

    def _write_feature(self, copy: Element, name: str, value: str) -> None:
        ids = value.split()
        if name == f"{{{XMI}}}id":
            copy.set(name, self.ids[value])
        elif name in LISTS or name in LISTS_OF.get(type_of(copy), ()):
            for id_ in ids:
                etree.SubElement(copy, name, {f"{{{XMI}}}idref": self.ids.get(id_, id_)})
        elif name not in ("name", "body") and ids and all(id_ in self.ids for id_ in ids):
            copy.set(name, " ".join(self.ids[id_] for id_ in ids))
        else:
            copy.set(name, value)

    def _write_application(self, source: Element) -> None:
        qualified = etree.QName(source)
        namespace = SYSML if str(qualified.namespace).startswith(PAPYRUS_SYSML) else None
        tag = f"{{{namespace or qualified.namespace}}}{qualified.localname}"
        application = etree.SubElement(self.root, tag)
        for name, value in source.attrib.items():
            if name not in _NOT_SAVED:
                capital = _CAPITAL.get((qualified.localname, str(name)), str(name))
                self._write_tag(application, capital, str(value))
        for child in source:
            etree.SubElement(application, etree.QName(child).localname).text = child.text

    def _write_tag(self, application: Element, name: str, value: str) -> None:
        if name in ("Id", "Text"):
            application.set(name, value)
            return
        words = value.split(" ")
        application.set(name, " ".join(self.ids.get(word, word) for word in words))

    def _write_end_paths(self, source: Element) -> None:
        """Write the path of nearly every connector end, as MagicDraw does, even one of one part."""
        ends_with_path = {
            str(e.get("base_ConnectorEnd")) for e in source if "base_ConnectorEnd" in e.attrib
        }
        for end in source.iter("end"):
            if "partWithPort" in end.attrib and id_of(end) not in ends_with_path:
                path = etree.SubElement(self.root, f"{{{SYSML}}}NestedConnectorEnd")
                path.set(f"{{{XMI}}}id", _make_id(id_of(end) + "path"))
                path.set("base_ConnectorEnd", self.ids[id_of(end)])
                path.set("propertyPath", self.ids[str(end.get("partWithPort"))])

    def apply_customisation(self, source: Element) -> None:
        """Apply PartProperty and ValueProperty to typed properties, as MagicDraw does."""
        types = {id_of(element): type_of(element) for element in _iter_with_id(source)}
        for attribute in source.iter("ownedAttribute"):
            kind = types.get(str(attribute.get("type")), "")
            is_part = kind == "uml:Class" and attribute.get("aggregation") == "composite"
            if type_of(attribute) == "uml:Property" and (is_part or kind == "uml:Enumeration"):
                name = "PartProperty" if is_part else "ValueProperty"
                application = etree.SubElement(self.root, f"{{{CUSTOMISATION}}}{name}")
                application.set(f"{{{XMI}}}id", _make_id(id_of(attribute) + name))
                application.set("base_Property", self.ids[id_of(attribute)])

    def _write_diagram(self, model: Element) -> None:
        box = etree.SubElement(_add_extension(model), "modelExtension")
        diagram = etree.SubElement(box, "ownedDiagram", {f"{{{XMI}}}type": "uml:Diagram"})
        diagram.set(f"{{{XMI}}}id", _make_id("diagram"))
        diagram.set("name", "Overview")
        diagram.set("ownerOfDiagram", ROOT_ID)
        representation = etree.SubElement(_add_extension(diagram), "diagramRepresentation")
        contents = etree.SubElement(
            representation, f"{{{DIAGRAM}}}DiagramRepresentationObject", nsmap={"diagram": DIAGRAM}
        )
        contents.set("ID", _make_id("drawn"))
        contents.set("diagramProperties", "3c 3f 78 6d 6c")
        for element in list(model.iter("packagedElement"))[:5]:
            etree.SubElement(contents, "usedObjects", href="#" + id_of(element))
            etree.SubElement(contents, "usedElements").text = id_of(element)
        model.insert(0, box.getparent())


def _iter_with_id(source: Element) -> Iterator[Element]:
    return (element for element in source.iter() if id_of(element))


def _make_id(id_: str) -> str:
    number = int(hashlib.sha256(id_.encode()).hexdigest(), 16)
    stamp, rest = 1_600_000_000_000 + number % 20_000_000_000, number // 20_000_000_000
    return f"_19_0_4_25dc056a_{stamp}_{rest % 1_000_000:06}_{rest // 1_000_000 % 100_000:05}"


def _is_repeated_sysml(source: Element) -> bool:
    """Whether another package of SysML is already applied: MagicDraw applies SysML once."""
    profile = source.find("appliedProfile")
    if profile is None or not str(profile.get("href")).startswith(_SYSML_PROFILE):
        return False
    earlier = source.itersiblings(source.tag, preceding=True)
    return any(
        _SYSML_PROFILE in etree.tostring(application, encoding="unicode") for application in earlier
    )


def _add_extension(owner: Element) -> Element:
    return etree.SubElement(owner, f"{{{XMI}}}Extension", extender=EXTENDER)


def _copy_text(source: Element, copy: Element) -> None:
    if source.text and source.text.strip():
        copy.text = source.text
    if type_of(source) == "uml:Comment":
        body = copy.find("body")
        if body is not None:
            copy.set("body", body.text or "")
            copy.remove(body)


def _write_outside_reference(source: Element, reference: Element) -> None:
    """Write a reference to another file, with the readable path that MagicDraw adds."""
    href, path = translate_href(str(source.get("href")))
    reference.set("href", href)
    detail = {"referentPath": path, "referentType": type_of(source).removeprefix("uml:")}
    etree.SubElement(_add_extension(reference), "referenceExtension", detail)


def translate_href(href: str) -> tuple[str, str]:
    """Return MagicDraw's reference to an element of the standards' files, and its readable path.

    A reference to any other file is unchanged, and its path is empty.
    """
    primitives = "UML Standard Profile::UML2 Metamodel::PrimitiveTypes"
    if href.startswith(_PRIMITIVES):
        name = href.removeprefix(_PRIMITIVES)
        path = primitives if name == "_0" else f"{primitives}::{name}"
        return f"{UML}/PrimitiveTypes.xmi#{name}", path
    names = [step.rpartition("_")[2] for step in href.rpartition("#")[2].split(".")[1:]]
    if href.startswith(_LIBRARY):
        steps = "-".join(f"{name}_PackageableElement" for name in names)
        return f"{SYSML}.xmi#_SysML_{steps}", "::".join(["SysML", *names])
    if href.startswith(_SYSML_PROFILE) and len(names) > 1:
        number = _make_id(names[-1]).removeprefix("_19_0_4")
        return f"{SYSML}.xmi#_11_5EAPbeta{number}", "::".join(["SysML", *names])
    if href.startswith(_SYSML_PROFILE):
        return f"{SYSML}.xmi#_SysML__0", "SysML"
    return href, ""
