"""Translation of a Papyrus document into an export of Enterprise Architect (XMI 2.5.1).

Enterprise Architect writes windows-1252, ids made of GUIDs (the id of an end contains the id of
its association or connector), types and lists as child elements, ``-1`` for unlimited, and
attributes with their default values. An extension repeats the stereotypes and holds the notes;
stereotype applications follow it without ids, some under mangled names. The form of its SysML
stereotypes is inferred from its other profiles, because no such export was available.
"""

import hashlib
from collections.abc import Iterator

from lxml import etree

from dialects.magicdraw import LISTS, LISTS_OF, translate_href
from dialects.papyrus import SYSML as PAPYRUS_SYSML
from dialects.papyrus import UML as PAPYRUS_UML
from dialects.papyrus import XMI, Element, id_of, is_custom_namespace, type_of

UML = "http://www.omg.org/spec/UML/20161101"
PROFILES = "http://www.sparxsystems.com/profiles"
SYSML = f"{PROFILES}/SysML1.4/1.4"
CUSTOM = f"{PROFILES}/thecustomprofile/1.0"
SPARX = "http://www.sparxsystems.com"
PLANT = "http://example.org/Plant"

_ID, _TYPE, _IDREF = f"{{{XMI}}}id", f"{{{XMI}}}type", f"{{{XMI}}}idref"
_PREFIXES = {"xmi": XMI, "uml": UML, "thecustomprofile": CUSTOM, "SysML1.4": SYSML}
_NOT_SAVED = frozenset({"partition", "base_NamedElement", "base_DirectedRelationship"})
_TEXTS = frozenset({"name", "body", "symbol"})
_AS_CHILDREN = (LISTS - {"covered"}) | {"type", "incoming", "outgoing"}
_ELEMENT_TAGS = ("packagedElement", "ownedBehavior", "node", "subvertex")
"""Features whose elements the extension describes among its elements."""
_CONNECTORS = frozenset(
    {"uml:Association", "uml:Connector", "uml:Dependency", "uml:Abstraction", "uml:Realization"}
    | {"uml:InformationFlow", "uml:ControlFlow", "uml:ObjectFlow", "uml:Transition"}
)
_FEATURES = {
    "uml:Property": ("attributes", "attribute"),
    "uml:Operation": ("operations", "operation"),
    "uml:Parameter": ("parameters", "parameter"),
}
_DEFAULTS = {
    "uml:Property": {
        "visibility": "public",
        "isStatic": "false",
        "isReadOnly": "false",
        "isDerived": "false",
        "isOrdered": "false",
        "isUnique": "true",
        "isDerivedUnion": "false",
        "aggregation": "none",
    },
    "uml:Class": {"visibility": "public", "isAbstract": "false", "isLeaf": "false"},
    "uml:Operation": {"visibility": "public", "concurrency": "sequential", "isQuery": "false"},
    "uml:Parameter": {"direction": "in"},
    "uml:CallBehaviorAction": {"isSynchronous": "true"},
    "uml:Pseudostate": {"kind": "initial"},
    "uml:Transition": {"kind": "external"},
    "uml:Message": {"messageKind": "complete", "messageSort": "synchCall"},
    "uml:CombinedFragment": {"interactionOperator": "seq"},
    "uml:LiteralBoolean": {"value": "false"},
    "uml:LiteralInteger": {"value": "0"},
}
"""Defaults that Enterprise Architect writes and Papyrus omits."""

_WRITTEN_AS = {"uml:MessageOccurrenceSpecification": "uml:OccurrenceSpecification"}
"""Metaclasses for which Enterprise Architect writes a more general one."""


def write_xmi(papyrus: bytes) -> bytes:
    """Return the document as Enterprise Architect exports it."""
    writer = _Writer(etree.fromstring(papyrus))
    etree.indent(writer.root, space="\t")
    return etree.tostring(writer.root, xml_declaration=True, encoding="windows-1252")


def map_ids(papyrus: bytes) -> dict[str, str]:
    """Map the ids of a Papyrus document to those in Enterprise Architect's export."""
    return _map_ids(etree.fromstring(papyrus))


class _Writer:
    """Translates one document from Papyrus to Enterprise Architect."""

    def __init__(self, source: Element) -> None:
        self.source = source
        self.ids = _map_ids(source)
        self.notes = {id_of(note.getparent()): note for note in source.iter() if _is_note(note)}
        namespaces = {
            prefix: uri
            for prefix, uri in source.nsmap.items()
            if is_custom_namespace(uri) and not uri.startswith(PLANT)
        }
        if PLANT in source.nsmap.values():
            namespaces["Plant"] = f"{PROFILES}/Plant/1.0"
        self.root = etree.Element(f"{{{XMI}}}XMI", nsmap={**_PREFIXES, **namespaces})
        exporter = {"exporter": "Enterprise Architect", "exporterVersion": "6.5"}
        etree.SubElement(self.root, f"{{{XMI}}}Documentation", exporter)
        model = source.find(f"{{{PAPYRUS_UML}}}Model")
        assert model is not None
        written_model = etree.SubElement(self.root, f"{{{UML}}}Model", {_TYPE: "uml:Model"})
        self._copy_content(model, written_model)
        self._write_extension(model)
        for application in self._list_applications():
            self._write_application(application)

    def _list_applications(self) -> list[Element]:
        return [child for child in self.source if child.tag != f"{{{PAPYRUS_UML}}}Model"]

    # -- the model -----------------------------------------------------------------------------

    def _copy(self, source: Element, owner: Element) -> None:
        tag = etree.QName(source).localname
        if tag == "eAnnotations" or source in self.notes.values():
            return
        if "href" in source.attrib:
            href = _translate_href(str(source.get("href")))
            copy = etree.SubElement(owner, tag, {"href": href})
            if type_of(source):
                copy.set(_TYPE, type_of(source))
        else:
            self._copy_content(source, etree.SubElement(owner, tag))

    def _copy_content(self, source: Element, copy: Element) -> None:
        if _TYPE in source.attrib:
            copy.set(_TYPE, _WRITTEN_AS.get(type_of(source), type_of(source)))
        for name, value in {**_DEFAULTS.get(type_of(source), {}), **source.attrib}.items():
            if name != _TYPE and name not in _NOT_SAVED:
                self._write_feature(copy, str(name), str(value))
        if source.text and source.text.strip():
            copy.text = source.text
        for child in source:
            self._copy(child, copy)
        if type_of(source) in ("uml:Property", "uml:Port"):
            _write_bounds(source, copy, is_short=type_of(source) == "uml:Port")

    def _write_feature(self, copy: Element, name: str, value: str) -> None:
        ids = value.split()
        if name == _ID:
            copy.set(name, self.ids[value])
        elif name in _AS_CHILDREN or name in LISTS_OF.get(type_of(copy), ()):
            for id_ in ids:
                etree.SubElement(copy, name, {_IDREF: self.ids.get(id_, id_)})
        elif name == "value" and type_of(copy) == "uml:LiteralUnlimitedNatural":
            copy.set(name, value.replace("*", "-1"))
        elif name not in _TEXTS and ids and all(id_ in self.ids for id_ in ids):
            copy.set(name, " ".join(self.ids[id_] for id_ in ids))
        else:
            copy.set(name, value)

    # -- stereotypes ---------------------------------------------------------------------------

    def _write_application(self, source: Element) -> None:
        prefix, name = _find_stereotype(source)
        if _is_mangled(source):
            application = etree.SubElement(self.root, f"{{{CUSTOM}}}{prefix}__{name}")
            application.set("__EAStereoName", f"{prefix}::{name}")
        else:
            namespace = f"{PROFILES}/Plant/1.0" if prefix == "Plant" else _find_namespace(source)
            application = etree.SubElement(self.root, f"{{{namespace}}}{name}")
        for key, value in source.attrib.items():
            if key != _ID and key not in _NOT_SAVED:
                application.set(
                    key, " ".join(self.ids.get(word, word) for word in value.split(" "))
                )
        for child in source:
            etree.SubElement(application, etree.QName(child).localname).text = child.text

    # -- the extension -------------------------------------------------------------------------

    def _write_extension(self, model: Element) -> None:
        extender = {"extender": "Enterprise Architect", "extenderID": "6.5"}
        extension = etree.SubElement(self.root, f"{{{XMI}}}Extension", extender)
        elements = etree.SubElement(extension, "elements")
        connectors = etree.SubElement(extension, "connectors")
        etree.SubElement(extension, "primitivetypes")
        for element in filter(id_of, model.iter()):
            is_element = element.tag in _ELEMENT_TAGS or type_of(element) == "uml:Port"
            if element is model or is_element:
                kind = "connector" if type_of(element) in _CONNECTORS else "element"
                self._describe(element, connectors if kind == "connector" else elements, kind)
            elif type_of(element) in _CONNECTORS:
                self._describe(element, connectors, "connector")
        self._write_diagram(extension, model)

    def _describe(self, element: Element, holder: Element, kind: str) -> None:
        description = etree.SubElement(holder, kind, {_IDREF: self.ids[id_of(element)]})
        description.set(_TYPE, type_of(element) or "uml:Model")
        note = self.notes.get(id_of(element))
        text = "" if note is None else note.findtext("body", note.get("body", ""))
        if kind == "element":
            etree.SubElement(
                description, "properties", documentation=text, sType=type_of(element)[4:]
            )
        else:
            etree.SubElement(description, "documentation", value=text)
        etree.SubElement(description, "project", author="sysmlc", version="1.0")
        self._repeat_stereotypes(element, description)
        for child in element:
            if id_of(child) and type_of(child) in _FEATURES:
                plural, singular = _FEATURES[type_of(child)]
                box = description.find(plural)
                box = etree.SubElement(description, plural) if box is None else box
                self._describe(child, box, singular)

    def _repeat_stereotypes(self, element: Element, description: Element) -> None:
        applications = [
            application
            for application in self._list_applications()
            if id_of(element) in _iter_bases(application)
        ]
        tags = etree.SubElement(description, "tags")
        for application in applications:
            for key, value in application.attrib.items():
                if key != _ID and not key.startswith("base_"):
                    etree.SubElement(tags, "tag", name=key, value=value)
        stereotypes = "".join(_format_stereotype(application) for application in applications)
        text = (
            f"$XREFPROP=$NAM=Stereotypes$NAM;$DES={stereotypes}$DES;$ENDXREF;"
            if stereotypes
            else ""
        )
        etree.SubElement(description, "xrefs", value=text)

    def _write_diagram(self, extension: Element, model: Element) -> None:
        diagrams = etree.SubElement(extension, "diagrams")
        diagram = etree.SubElement(diagrams, "diagram", {_ID: "EAID_00000001_DIAGRAM"})
        etree.SubElement(diagram, "model", package=self.ids[id_of(model)])
        etree.SubElement(diagram, "properties", name="Overview", type="Logical")


def _write_bounds(source: Element, copy: Element, is_short: bool) -> None:
    """Write the bounds, also those that Papyrus omits; ports have them as attributes."""
    bounds = {"lower": "1", "upper": "1"}
    for name in bounds:
        value = copy.find(f"{name}Value")
        if value is not None and is_short:
            bounds[name] = value.get("value", "0")
            copy.remove(value)
        elif value is None and not is_short:
            number = _make_guid(f"{id_of(source)}{name}")
            kind = "uml:LiteralInteger" if name == "lower" else "uml:LiteralUnlimitedNatural"
            details = {_TYPE: kind, _ID: f"EAID_LI{number[2:]}", "value": "1"}
            etree.SubElement(copy, f"{name}Value", details)
    if is_short:
        for name, bound in bounds.items():
            copy.set(name, bound)


def _map_ids(source: Element) -> dict[str, str]:
    ids = {}
    for element in source.iter():
        id_ = id_of(element)
        if id_:
            kind = "EAPK" if type_of(element) in ("", "uml:Package", "uml:Model") else "EAID"
            ids[id_] = f"{kind}_{_make_guid(id_)}"
    for link in source.iter():
        ends = [str(end) for end in link.get("memberEnd", "").split()]
        for end, side in zip(ends, ("src", "dst"), strict=False):
            ids[end] = f"EAID_{side}{ids[id_of(link)].removeprefix('EAID_')[2:]}"
    return ids


def _make_guid(id_: str) -> str:
    digest = hashlib.sha256(id_.encode()).hexdigest()
    parts = (digest[:8].upper(), digest[8:12].upper(), digest[12:16], digest[16:20].upper())
    return "_".join((*parts, digest[20:32].upper()))


def _find_stereotype(source: Element) -> tuple[str, str]:
    """Return prefix and name in Enterprise Architect's profiles; SysML's begin in lower case."""
    name = etree.QName(source).localname
    if _find_namespace(source) == SYSML:
        return "SysML1.4", name[:1].lower() + name[1:]
    return str(source.prefix), name


def _find_namespace(source: Element) -> str:
    namespace = str(etree.QName(source).namespace)
    return SYSML if namespace.startswith(PAPYRUS_SYSML) else namespace


def _is_mangled(source: Element) -> bool:
    """Whether the export mangles the stereotype: half of the custom profile's applications."""
    return _find_namespace(source) == PLANT and int(_make_guid(id_of(source))[:8], 16) % 2 == 0


def _format_stereotype(application: Element) -> str:
    prefix, name = _find_stereotype(application)
    return f"@STEREO;Name={name};FQName={prefix}::{name};@ENDSTEREO;"


def _iter_bases(application: Element) -> Iterator[str]:
    return (str(v) for k, v in application.attrib.items() if str(k).startswith("base_"))


def _is_note(element: Element) -> bool:
    """Whether a comment becomes a note in the extension: the only one of its owner, about it."""
    owner = element.getparent()
    if type_of(element) != "uml:Comment" or owner is None or not _is_described(owner):
        return False
    is_only_comment = len(owner.findall("ownedComment")) == 1
    return is_only_comment and element.get("annotatedElement") == id_of(owner)


def _is_described(element: Element) -> bool:
    described_types = {"uml:Port", "uml:Property", "uml:Operation", *_CONNECTORS}
    return element.tag in _ELEMENT_TAGS or type_of(element) in described_types


def _translate_href(href: str) -> str:
    """Return Enterprise Architect's reference to an element of the standards' files."""
    if "SysML.profile.uml#" in href:
        return f"{SYSML}#{href.rpartition('_')[2]}"
    return translate_href(href)[0]
