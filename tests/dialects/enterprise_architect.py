"""Writes a Papyrus document again as Enterprise Architect exports the same model (XMI 2.5.1).

The differences are those of the dialect table in the project's notes on XMI: windows-1252, ids
made of GUIDs (ends of associations and connectors from the id of what they end), types and lists
as child elements, ``-1`` for unlimited, defaults written out, stereotypes without ids after an
extension that repeats them, mangled names of stereotypes, notes in the extension only. Its SysML
follows the pattern of its other profiles: no such file was there to learn from.
"""

import hashlib
from collections.abc import Iterator

from lxml import etree

from dialects.magicdraw import LISTS, LISTS_OF, standard
from dialects.papyrus import SYSML as PAPYRUS_SYSML
from dialects.papyrus import UML as PAPYRUS_UML
from dialects.papyrus import XMI, Element, id_of

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
"""What Enterprise Architect writes and Papyrus leaves out."""

_WRITTEN_AS = {"uml:MessageOccurrenceSpecification": "uml:OccurrenceSpecification"}
"""Metaclasses for which it writes a more general one."""


def write_xmi(papyrus: bytes) -> bytes:
    """The document as Enterprise Architect exports it."""
    writer = _Writer(etree.fromstring(papyrus))
    etree.indent(writer.root, space="\t")
    return etree.tostring(writer.root, xml_declaration=True, encoding="windows-1252")


def ids_of(papyrus: bytes) -> dict[str, str]:
    """The ids that the elements of a Papyrus document get in Enterprise Architect's files."""
    return _ids(etree.fromstring(papyrus))


class _Writer:
    """One document on its way from Papyrus to Enterprise Architect."""

    def __init__(self, source: Element) -> None:
        self.source = source
        self.ids = _ids(source)
        self.notes = {id_of(note.getparent()): note for note in source.iter() if _is_note(note)}
        own = {prefix: uri for prefix, uri in source.nsmap.items() if _is_custom(uri)}
        if PLANT in source.nsmap.values():
            own["Plant"] = f"{PROFILES}/Plant/1.0"
        self.root = etree.Element(f"{{{XMI}}}XMI", nsmap={**_PREFIXES, **own})
        exporter = {"exporter": "Enterprise Architect", "exporterVersion": "6.5"}
        etree.SubElement(self.root, f"{{{XMI}}}Documentation", exporter)
        model = source.find(f"{{{PAPYRUS_UML}}}Model")
        assert model is not None
        made = etree.SubElement(self.root, f"{{{UML}}}Model", {_TYPE: "uml:Model"})
        self._copy_content(model, made)
        self._extension(model)
        for application in self._applications():
            self._application(application)

    def _applications(self) -> list[Element]:
        return [one for one in self.source if one.tag != f"{{{PAPYRUS_UML}}}Model"]

    # -- the model -----------------------------------------------------------------------------

    def _copy(self, source: Element, owner: Element) -> None:
        tag = etree.QName(source).localname
        if tag == "eAnnotations" or source in self.notes.values():
            return
        if "href" in source.attrib:
            href = _standard(str(source.get("href")))
            made = etree.SubElement(owner, tag, {"href": href})
            if _type(source):
                made.set(_TYPE, _type(source))
        else:
            self._copy_content(source, etree.SubElement(owner, tag))

    def _copy_content(self, source: Element, made: Element) -> None:
        if _TYPE in source.attrib:
            made.set(_TYPE, _WRITTEN_AS.get(_type(source), _type(source)))
        for name, value in {**_DEFAULTS.get(_type(source), {}), **source.attrib}.items():
            if name != _TYPE and name not in _NOT_SAVED:
                self._feature(made, str(name), str(value))
        if source.text and source.text.strip():
            made.text = source.text
        for child in source:
            self._copy(child, made)
        if _type(source) in ("uml:Property", "uml:Port"):
            _write_bounds(source, made, is_short=_type(source) == "uml:Port")

    def _feature(self, made: Element, name: str, value: str) -> None:
        ids = value.split()
        if name == _ID:
            made.set(name, self.ids[value])
        elif name in _AS_CHILDREN or name in LISTS_OF.get(_type(made), ()):
            for id_ in ids:
                etree.SubElement(made, name, {_IDREF: self.ids.get(id_, id_)})
        elif name == "value" and _type(made) == "uml:LiteralUnlimitedNatural":
            made.set(name, value.replace("*", "-1"))
        elif name not in _TEXTS and ids and all(id_ in self.ids for id_ in ids):
            made.set(name, " ".join(self.ids[id_] for id_ in ids))
        else:
            made.set(name, value)

    # -- stereotypes ---------------------------------------------------------------------------

    def _application(self, source: Element) -> None:
        prefix, name = _stereotype(source)
        if _is_mangled(source):
            made = etree.SubElement(self.root, f"{{{CUSTOM}}}{prefix}__{name}")
            made.set("__EAStereoName", f"{prefix}::{name}")
        else:
            namespace = f"{PROFILES}/Plant/1.0" if prefix == "Plant" else _namespace(source)
            made = etree.SubElement(self.root, f"{{{namespace}}}{name}")
        for key, value in source.attrib.items():
            if key != _ID and key not in _NOT_SAVED:
                made.set(key, " ".join(self.ids.get(word, word) for word in value.split(" ")))
        for child in source:
            etree.SubElement(made, etree.QName(child).localname).text = child.text

    # -- the extension -------------------------------------------------------------------------

    def _extension(self, model: Element) -> None:
        extender = {"extender": "Enterprise Architect", "extenderID": "6.5"}
        extension = etree.SubElement(self.root, f"{{{XMI}}}Extension", extender)
        elements = etree.SubElement(extension, "elements")
        connectors = etree.SubElement(extension, "connectors")
        etree.SubElement(extension, "primitivetypes")
        for one in filter(id_of, model.iter()):
            is_element = one.tag in ("packagedElement", "ownedBehavior", "node", "subvertex")
            if one is model or is_element or _type(one) == "uml:Port":
                kind = "connector" if _type(one) in _CONNECTORS else "element"
                self._describe(one, connectors if kind == "connector" else elements, kind)
            elif _type(one) in _CONNECTORS:
                self._describe(one, connectors, "connector")
        self._diagram(extension, model)

    def _describe(self, one: Element, holder: Element, kind: str) -> None:
        made = etree.SubElement(holder, kind, {_IDREF: self.ids[id_of(one)]})
        made.set(_TYPE, _type(one) or "uml:Model")
        note = self.notes.get(id_of(one))
        text = "" if note is None else note.findtext("body", note.get("body", ""))
        if kind == "element":
            etree.SubElement(made, "properties", documentation=text, sType=_type(one)[4:])
        else:
            etree.SubElement(made, "documentation", value=text)
        etree.SubElement(made, "project", author="sysmlc", version="1.0")
        self._repeat_stereotypes(one, made)
        for child in one:
            if id_of(child) and _type(child) in _FEATURES:
                plural, singular = _FEATURES[_type(child)]
                box = made.find(plural)
                box = etree.SubElement(made, plural) if box is None else box
                self._describe(child, box, singular)

    def _repeat_stereotypes(self, one: Element, made: Element) -> None:
        applied = [a for a in self._applications() if id_of(one) in _bases(a)]
        tags = etree.SubElement(made, "tags")
        for application in applied:
            for key, value in application.attrib.items():
                if key != _ID and not key.startswith("base_"):
                    etree.SubElement(tags, "tag", name=key, value=value)
        told = "".join(_told(application) for application in applied)
        text = f"$XREFPROP=$NAM=Stereotypes$NAM;$DES={told}$DES;$ENDXREF;" if told else ""
        etree.SubElement(made, "xrefs", value=text)

    def _diagram(self, extension: Element, model: Element) -> None:
        diagrams = etree.SubElement(extension, "diagrams")
        diagram = etree.SubElement(diagrams, "diagram", {_ID: "EAID_00000001_DIAGRAM"})
        etree.SubElement(diagram, "model", package=self.ids[id_of(model)])
        etree.SubElement(diagram, "properties", name="Overview", type="Logical")


def _write_bounds(source: Element, made: Element, is_short: bool) -> None:
    """Bounds that Papyrus leaves out are written; those of ports as attributes."""
    bounds = {"lower": "1", "upper": "1"}
    for name in bounds:
        value = made.find(f"{name}Value")
        if value is not None and is_short:
            bounds[name] = value.get("value", "0")
            made.remove(value)
        elif value is None and not is_short:
            number = _guid(f"{id_of(source)}{name}")
            kind = "uml:LiteralInteger" if name == "lower" else "uml:LiteralUnlimitedNatural"
            details = {_TYPE: kind, _ID: f"EAID_LI{number[2:]}", "value": "1"}
            etree.SubElement(made, f"{name}Value", details)
    if is_short:
        for name, bound in bounds.items():
            made.set(name, bound)


def _ids(source: Element) -> dict[str, str]:
    ids = {}
    for element in source.iter():
        id_ = id_of(element)
        if id_:
            kind = "EAPK" if _type(element) in ("", "uml:Package", "uml:Model") else "EAID"
            ids[id_] = f"{kind}_{_guid(id_)}"
    for link in source.iter():
        ends = [str(end) for end in link.get("memberEnd", "").split()]
        for end, side in zip(ends, ("src", "dst"), strict=False):
            ids[end] = f"EAID_{side}{ids[id_of(link)].removeprefix('EAID_')[2:]}"
    return ids


def _guid(id_: str) -> str:
    digest = hashlib.sha256(id_.encode()).hexdigest()
    parts = (digest[:8].upper(), digest[8:12].upper(), digest[12:16], digest[16:20].upper())
    return "_".join((*parts, digest[20:32].upper()))


def _stereotype(source: Element) -> tuple[str, str]:
    """Prefix and name in Enterprise Architect's profiles: SysML's begin in lower case."""
    name = etree.QName(source).localname
    if _namespace(source) == SYSML:
        return "SysML1.4", name[:1].lower() + name[1:]
    return str(source.prefix), name


def _namespace(source: Element) -> str:
    namespace = str(etree.QName(source).namespace)
    return SYSML if namespace.startswith(PAPYRUS_SYSML) else namespace


def _is_mangled(source: Element) -> bool:
    """Every second application of a custom profile is one that the tool does not know."""
    return _namespace(source) == PLANT and int(_guid(id_of(source))[:8], 16) % 2 == 0


def _told(application: Element) -> str:
    prefix, name = _stereotype(application)
    return f"@STEREO;Name={name};FQName={prefix}::{name};@ENDSTEREO;"


def _bases(application: Element) -> Iterator[str]:
    return (str(v) for k, v in application.attrib.items() if str(k).startswith("base_"))


def _is_note(element: Element) -> bool:
    """Whether it is the only comment of its owner and about it: a note, told in the extension."""
    owner = element.getparent()
    if _type(element) != "uml:Comment" or owner is None or not _is_described(owner):
        return False
    alone = len(owner.findall("ownedComment")) == 1
    return alone and element.get("annotatedElement") == id_of(owner)


def _is_described(element: Element) -> bool:
    is_element = element.tag in ("packagedElement", "ownedBehavior", "node", "subvertex")
    known = {"uml:Port", "uml:Property", "uml:Operation", *_CONNECTORS}
    return is_element or _type(element) in known


def _standard(href: str) -> str:
    """Where Enterprise Architect finds an element of the standards' files."""
    if "SysML.profile.uml#" in href:
        return f"{SYSML}#{href.rpartition('_')[2]}"
    return standard(href)[0]


def _is_custom(uri: str) -> bool:
    known = (PAPYRUS_SYSML, PAPYRUS_UML, XMI, "http://www.w3.org", "http://www.eclipse.org/emf")
    return not uri.startswith((*known, PLANT))


def _type(element: Element) -> str:
    return element.get(_TYPE, "")
