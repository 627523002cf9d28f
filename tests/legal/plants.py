"""Small random plants in CAEX 2.15 and 3.0 that the schemas and AutomationML allow."""

from itertools import pairwise
from random import Random

from lxml import etree

from legal.plant_values import Values

NAMESPACE = "http://www.dke.de/CAEX"
ROLES = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
INTERFACES = "AutomationMLInterfaceClassLib/AutomationMLBaseInterface"
TYPES = "AutomationMLBaseAttributeTypeLib"
LINKABLE = ("Port", "Order", "Communication", "PPRConnector", "Communication/SignalInterface")
NAMES = ("Gate", "Arm 1", "Größe", "In.out", "p:q", "a/b", "x@y", "[z]", "<&>", "it's", "1.2")
SEMANTICS = ("ECLASS:0173-1#02-BAA020#007", "IEC:0112/2///62683#ACE102")

Element = etree._Element


class Plant:
    """Builds one document; has tables of its classes by path and of its elements by id."""

    def __init__(self, random: Random, version: str) -> None:
        self.random = random
        self.values = Values(random)
        self.version = version
        self.is_new = version == "3.0"
        self._number = 0
        self.nodes: dict[str, Element] = {}
        self.paths: dict[str, list[str]] = {
            tag: [] for tag in ("AttributeType", "InterfaceClass", "RoleClass", "SystemUnitClass")
        }
        self.bases: dict[str, str] = {}
        self.elements: list[Element] = []

    # -- the document ----------------------------------------------------------------------------

    def build(self) -> bytes:
        """Draw all libraries and hierarchies, and return the document in one of its forms."""
        root = self._make("CAEXFile", FileName="plant.aml", SchemaVersion=self.version)
        self._add_document_header(root)
        tags = [tag for tag in self.paths if self.is_new or tag != "AttributeType"]
        libraries = {tag: self._add_libraries(tag) for tag in tags}
        for index in range(self.random.randint(1, 2)):
            hierarchy = self._add(root, "InstanceHierarchy", Name=self.make_name("Plant"))
            self._add_header(hierarchy)
            for _ in range(self.random.randint(index == 0, 3)):
                self._add_element(hierarchy, 0)
            self._add_links(hierarchy)
        for tag in ("InterfaceClass", "RoleClass", "SystemUnitClass", "AttributeType"):
            root.extend(libraries.get(tag, ()))
        return self._serialise(root)

    def _add_document_header(self, root: Element) -> None:
        if self.is_new:
            self._add(root, "SuperiorStandardVersion").text = "AutomationML 2.10"
            origin = {"OriginName": "sysmlc", "OriginID": "1", "OriginVersion": "1.0"}
            when = {"LastWritingDateTime": "2024-01-01T00:00:00Z"}
            self._add(root, "SourceDocumentInformation", **origin, **when)
        else:
            self._add(root, "AdditionalInformation", AutomationMLVersion="2.0")
            header = self._add(self._add(root, "AdditionalInformation"), "WriterHeader")
            self._add(header, "WriterName").text = "sysmlc"

    def _serialise(self, root: Element) -> bytes:
        if self.is_new and self.maybe(0.2):
            return etree.tostring(root, xml_declaration=True, encoding="UTF-16")
        if self.maybe(0.3):
            etree.indent(root)
        text = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
        return b"\xef\xbb\xbf" + text if self.maybe(0.2) else text

    def _make(self, tag: str, **attributes: str) -> Element:
        if not self.is_new:
            return etree.Element(tag, attributes)
        nsmap = {self.random.choice((None, None, "caex")): NAMESPACE}
        return etree.Element(f"{{{NAMESPACE}}}{tag}", attributes, nsmap)

    def _add(self, owner: Element, tag: str, **attributes: str) -> Element:
        name = f"{{{NAMESPACE}}}{tag}" if self.is_new else tag
        return etree.SubElement(owner, name, attributes)

    def maybe(self, chance: float = 0.5) -> bool:
        return self.random.random() < chance

    def make_name(self, word: str = "") -> str:
        """Return a name that no other element has."""
        self._number += 1
        return f"{word or self.random.choice(NAMES)} {self._number}"

    def make_id(self) -> str:
        digits = f"{self.random.getrandbits(128):032x}"
        steps = (0, 8, 12, 16, 20, 32)
        guid = "-".join(digits[a:b] for a, b in pairwise(steps))
        return f"{{{guid}}}" if self.maybe(0.3) else guid

    def _add_header(self, node: Element) -> None:
        """Add descriptions, versions and tool data in the order of the schema."""
        if self.maybe(0.2):
            text = self.random.choice(("says", "two\nlines", "é <&>"))
            self._add(node, "Description").text = text
        if self.maybe(0.1):
            self._add(node, "Version").text = "1.0.0"
        if self.maybe(0.1):
            revision = self._add(node, "Revision")
            self._add(revision, "RevisionDate").text = "2024-01-01T00:00:00Z"
            self._add(revision, "OldVersion").text = "0.9"
            self._add(revision, "NewVersion").text = "1.0.0"
            self._add(revision, "AuthorName").text = "A. Author"
            self._add(revision, "Comment").text = "first"
        if self.maybe(0.05):
            self._add(node, "Copyright").text = "(c) us"
        if self.maybe(0.1):
            extra = self._add(node, "AdditionalInformation", Tool="t")
            etree.SubElement(extra, "{http://example.org/tool}Inner", Key="k").text = "text"
        if self.is_new and self.maybe(0.05):
            self._add(node, "SourceObjectInformation", OriginID="1", SourceObjID="7")
        if self.maybe(0.05):
            node.set("ChangeMode", self.random.choice(("state", "create", "change")))

    # -- classes ---------------------------------------------------------------------------------

    def _add_libraries(self, tag: str) -> list[Element]:
        libraries = []
        for _ in range(self.random.randint(1, 2)):
            library = self._make(f"{tag}Lib", Name=self.make_name(f"{tag}Lib"))
            self._add_header(library)
            for _ in range(self.random.randint(0, 3)):
                self._add_class(library, tag, [library.get("Name")], "")
            libraries.append(library)
        return libraries

    def _add_class(self, owner: Element, tag: str, names: list[str], parent: str) -> None:
        name = self.make_name()
        node = self._add(owner, tag, Name=name)
        if tag == "SystemUnitClass" or self.maybe(0.1):
            node.set("ID", self.make_id())
        path = format_path([*names, name])
        self.nodes[path] = node
        base = self._choose_base(tag, parent)
        if base:
            key = "RefAttributeType" if tag == "AttributeType" else "RefBaseClassPath"
            is_short = base == parent and tag != "AttributeType" and not set(base) & set("[]@")
            node.set(key, base.rpartition("/")[2] if is_short and self.maybe(0.3) else base)
        self.bases[path] = base
        self._add_header(node)
        if tag == "AttributeType":
            self._fill_attribute(node, 0)
        else:
            self._add_members(node, path, tag)
        self.paths[tag].append(path)
        if len(names) < 3 and self.maybe(0.3):
            self._add_class(node, tag, [*names, name], path)

    def _choose_base(self, tag: str, parent: str) -> str:
        standard = {
            "RoleClass": [ROLES, *(f"{ROLES}/{n}" for n in ("Resource", "Product", "Structure"))],
            "InterfaceClass": [INTERFACES, *(f"{INTERFACES}/{name}" for name in LINKABLE)],
        }.get(tag, [""])
        choices = [*standard, *self.paths[tag]]
        if parent and self.maybe():
            return parent
        return self.random.choice(choices)

    def _add_members(self, node: Element, path: str, tag: str) -> None:
        inherited = self.list_inherited(self.bases[path], "Attribute")
        for attribute in inherited:
            if self.maybe(0.2):
                self._repeat_attribute(node, attribute)
        for _ in range(self.random.randint(0, 2)):
            self._add_attribute(node, 0)
        if tag != "InterfaceClass" or self.is_new:
            for _ in range(self.random.randint(0, 1 if tag == "InterfaceClass" else 2)):
                self._add_interface(node, 1)
        if tag == "SystemUnitClass":
            for _ in range(self.random.randint(0, 2)):
                self._add_element(node, 2)
            self._add_roles(node, "SupportedRoleClass", "RefRoleClassPath")
            self._add_links(node)

    def list_inherited(self, path: str, tag: str) -> list[Element]:
        """Return the members of a class and of its general classes; overridden ones once."""
        members: dict[str, Element] = {}
        while path in self.nodes:
            for member in self.nodes[path].iterchildren(f"{{*}}{tag}"):
                members.setdefault(str(member.get("Name")), member)
            path = self.bases[path]
        return list(members.values())

    # -- attributes ------------------------------------------------------------------------------

    def _add_attribute(self, owner: Element, depth: int) -> Element:
        node = self._add(owner, "Attribute", Name=self.make_name())
        if self.is_new and self.paths["AttributeType"] and self.maybe(0.3):
            path = self.random.choice(self.paths["AttributeType"])
            node.set("RefAttributeType", path)
            type_ = self._find_type(path)
            node.set("AttributeDataType", type_) if type_ else None
            self._add_header(node)
            self._add(node, "Value").text = self.values.choose_value(type_)
            return node
        self._add_header(node)
        self._fill_attribute(node, depth)
        return node

    def _find_type(self, path: str) -> str:
        while path in self.nodes:
            type_ = self.nodes[path].get("AttributeDataType", "")
            if type_:
                return type_
            path = self.bases[path]
        return ""

    def _fill_attribute(self, node: Element, depth: int) -> None:
        """Give an attribute or attribute type its data type, values, constraints and parts."""
        path = node.get("RefAttributeType", "")
        type_ = self._find_type(path) or self.values.choose_type()
        if type_:
            node.set("AttributeDataType", type_)
        unit = self.values.choose_unit(type_)
        if unit and not path:
            node.set("Unit", unit)
        value = self.values.choose_value(type_)
        if self.maybe(0.3):
            self._add(node, "DefaultValue").text = value
        if self.maybe():
            self._add(node, "Value").text = value
        if self.maybe(0.15):
            semantic = self.random.choice(SEMANTICS)
            self._add(node, "RefSemantic", CorrespondingAttributePath=semantic)
        if self.maybe(0.25):
            scale, texts = self.values.choose_constraint(type_, value)
            constraint = self._add(node, "Constraint", Name=self.make_name("limit"))
            scaled = self._add(constraint, scale)
            for tag, text in texts:
                self._add(scaled, tag).text = text
        if depth < 2 and self.maybe(0.2):
            for _ in range(self.random.randint(1, 2)):
                self._add_attribute(node, depth + 1)

    def _repeat_attribute(self, owner: Element, attribute: Element) -> None:
        """Override an inherited attribute by one of its name."""
        node = self._add(owner, "Attribute", Name=str(attribute.get("Name")))
        for key in ("AttributeDataType", "Unit", "RefAttributeType"):
            if attribute.get(key):
                node.set(key, str(attribute.get(key)))
        type_ = node.get("AttributeDataType", "")
        self._add(node, "Value").text = self.values.choose_value(type_)

    # -- interfaces and elements -----------------------------------------------------------------

    def _add_interface(self, owner: Element, depth: int) -> Element:
        node = self._add(owner, "ExternalInterface", Name=self.make_name(), ID=self.make_id())
        standard = [f"{INTERFACES}/{name}" for name in LINKABLE]
        path = self.random.choice([*standard, *self.paths["InterfaceClass"]])
        node.set("RefBaseClassPath", path)
        self._add_header(node)
        if path == standard[0]:
            self._add_port_attributes(node)
        elif self.maybe(0.3):
            self._add_attribute(node, 1)
        if self.is_new and depth < 2 and self.maybe(0.2):
            self._add_interface(node, depth + 1)
        return node

    def _add_port_attributes(self, node: Element) -> None:
        typed = {"RefAttributeType": f"{TYPES}/Direction"} if self.is_new else {}
        if self.maybe(0.7):
            features = {"Name": "Direction", "AttributeDataType": "xs:string", **typed}
            direction = self._add(node, "Attribute", **features)
            is_linked = "Class" not in str(node.getparent().tag) or "SystemUnit" in str(
                node.getparent().tag
            )
            choices = ("InOut",) if is_linked else ("In", "Out", "InOut")
            self._add(direction, "Value").text = self.random.choice(choices)
        if self.maybe(0.4):
            cardinality = self._add(node, "Attribute", Name="Cardinality")
            for name, text in (("MinOccur", "0"), ("MaxOccur", "3")):
                features = {"Name": name, "AttributeDataType": "xs:unsignedInt"}
                self._add(self._add(cardinality, "Attribute", **features), "Value").text = text
        if self.maybe(0.3):
            features = {"Name": "Category", "AttributeDataType": "xs:string"}
            self._add(self._add(node, "Attribute", **features), "Value").text = "MaterialFlow"

    def _add_element(self, owner: Element, depth: int) -> None:
        node = self._add(owner, "InternalElement", Name=self.make_name(), ID=self.make_id())
        classes = self.paths["SystemUnitClass"]
        path = self.random.choice(classes) if classes and self.maybe(0.6) else ""
        if path:
            node.set("RefBaseSystemUnitPath", path)
        elif self.elements and depth < 2 and self.maybe(0.15):
            node.set("RefBaseSystemUnitPath", str(self.random.choice(self.elements).get("ID")))
            return
        self._add_header(node)
        for attribute in self.list_inherited(path, "Attribute"):
            if self.maybe(0.7):
                self._repeat_attribute(node, attribute)
        for _ in range(self.random.randint(0, 1)):
            self._add_attribute(node, 0)
        for interface in self.list_inherited(path, "ExternalInterface"):
            if self.maybe(0.7):
                self._copy_interface(node, interface)
        for _ in range(self.random.randint(0, 2)):
            self._add_interface(node, 0)
        if depth < 2:
            for _ in range(self.random.randint(0, 2)):
                self._add_element(node, depth + 1)
        self._add_roles(node, "SupportedRoleClass", "RefRoleClassPath") if self.maybe(0.2) else None
        self._add_links(node)
        self._add_roles(node, "RoleRequirements", "RefBaseRoleClassPath")
        if depth < 2:
            self.elements.append(node)

    def _copy_interface(self, owner: Element, interface: Element) -> None:
        """Repeat an interface of the class in its instance, with an ID of its own."""
        features = {key: str(interface.get(key)) for key in ("Name", "RefBaseClassPath")}
        self._add(owner, "ExternalInterface", **features, ID=self.make_id())

    # -- roles and links -------------------------------------------------------------------------

    def _add_roles(self, node: Element, tag: str, key: str) -> None:
        count = self.random.randint(1, 2 if self.is_new or tag == "SupportedRoleClass" else 1)
        standard = [ROLES, *(f"{ROLES}/{name}" for name in ("Resource", "Process", "Product"))]
        roles = self.random.sample([*standard, *self.paths["RoleClass"]], count)
        for path in roles:
            role = self._add(node, tag, **{key: path})
            offered = self.list_inherited(path, "Attribute")
            if offered and tag == "RoleRequirements" and self.maybe(0.3):
                self._repeat_attribute(role, self.random.choice(offered))
            is_at_element = tag == "RoleRequirements" and not self.is_new
            if self.maybe():
                self._add_mapping(node if is_at_element else role, node, path)

    def _add_mapping(self, owner: Element, node: Element, path: str) -> None:
        """Map an attribute and an interface to those of the role, if there is one of its type."""
        attributes = self._pair_members(
            node, path, "Attribute", "AttributeDataType", "RefAttributeType"
        )
        interfaces = self._pair_members(node, path, "ExternalInterface", "RefBaseClassPath")
        if not attributes and not interfaces:
            return
        mapping = self._add(owner, "MappingObject")
        for own, offered in attributes:
            names = {
                "SystemUnitAttributeName": str(own.get("Name")),
                "RoleAttributeName": str(offered.get("Name")),
            }
            self._add(mapping, "AttributeNameMapping", **names)
        key = "ID" if self.is_new else "Name"
        for own, offered in interfaces:
            features = {
                f"SystemUnitInterface{key}": str(own.get(key)),
                f"RoleInterface{key}": str(offered.get(key)),
            }
            self._add(mapping, f"Interface{key}Mapping", **features)

    def _pair_members(
        self, node: Element, path: str, tag: str, *keys: str
    ) -> list[tuple[Element, Element]]:
        """Return one member of the node with a member of the role that equals it in *keys*."""
        offered = self.list_inherited(path, tag)
        pairs = [
            (own, member)
            for own in node.iterchildren(f"{{*}}{tag}")
            for member in offered
            if all(own.get(key) == member.get(key) for key in keys)
        ]
        return self.random.sample(pairs, min(1, len(pairs)))

    def _add_links(self, node: Element) -> None:
        """Add links between interfaces of the same kind, of the node and its inner elements."""
        owners = [node, *node.iterchildren("{*}InternalElement")]
        ends: dict[str, list[tuple[Element, Element]]] = {}
        for owner in owners:
            for interface in owner.iterchildren("{*}ExternalInterface"):
                path = str(interface.get("RefBaseClassPath"))
                ends.setdefault(path, []).append((owner, interface))
        for same in ends.values():
            if len(same) > 1 and "InstanceHierarchy" not in node.tag and self.maybe():
                sides = [self._format_side(*end) for end in self.random.sample(same, 2)]
                features = {"RefPartnerSideA": sides[0], "RefPartnerSideB": sides[1]}
                self._add(node, "InternalLink", Name=self.make_name("link"), **features)

    def _format_side(self, owner: Element, interface: Element) -> str:
        if self.is_new:
            return str(interface.get("ID"))
        return f"{owner.get('ID')}:{interface.get('Name')}"


def draw_plant(random: Random, version: str) -> bytes:
    """Return a random document of CAEX *version*, 2.15 or 3.0."""
    return Plant(random, version).build()


def format_path(names: list[str]) -> str:
    """Return the path of a class, with every name in brackets if one name needs them."""
    if any(set(name) & set("/@[]") for name in names):
        names = [f"[{name}]" for name in names]
    return "/".join(names)
