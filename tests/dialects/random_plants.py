"""Random AutomationML: valid documents of CAEX 3.0 with all constructs of the schema.

Ids are unique. Some names are unusual, and some references name nothing.
"""

from lxml import etree

NAMESPACE = "http://www.dke.de/CAEX"
BASE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
NAMES = ("Gate", "Belt", "Arm", "Cell", "In out", "a/b", "x@y", "[z]", "Größe", "p:q", "1.2", "<&>")
TYPES = ("xs:double", "xs:integer", "xs:boolean", "xs:string", "xs:anyURI", "")
VALUES = {
    "xs:double": ("1.5", "0", "-2e3", "often"),
    "xs:integer": ("7", "0", "-3"),
    "xs:boolean": ("true", "false", "perhaps"),
}
UNITS = ("m", "m/s", "kPa", "furlong", "")


def random_plant(random):
    """Return a random document of CAEX 3.0."""
    return PlantBuilder(random).build()


class PlantBuilder:
    """Builds a document; has tables of its classes by path and of its masters by id."""

    def __init__(self, random):
        self.random = random
        self.number = 0
        self.classes = {"AttributeType": [], "InterfaceClass": [], "RoleClass": []}
        self.classes["SystemUnitClass"] = []
        self.attributes = {}
        self.parts = {}
        self.ports = {}
        self.masters = []

    def build(self):
        root = etree.Element(f"{{{NAMESPACE}}}CAEXFile", nsmap={None: NAMESPACE})
        root.set("SchemaVersion", "3.0")
        root.set("FileName", "plant.aml")
        self.add_header(root)
        origin = {"OriginName": "us", "OriginID": "u", "OriginVersion": "1"}
        add_child(
            root, "SourceDocumentInformation", LastWritingDateTime="2024-01-01T00:00:00Z", **origin
        )
        libraries = {tag: [] for tag in self.classes}
        for tag in libraries:
            for _ in range(self.random.randint(1, 2)):
                library = etree.Element(
                    f"{{{NAMESPACE}}}{tag}Lib", Name=self.make_name(f"{tag} lib")
                )
                self.add_header(library)
                self.add_classes(library, tag)
                libraries[tag].append(library)
        for _ in range(self.random.randint(0, 2)):
            self.add_elements(add_child(root, "InstanceHierarchy", Name=self.make_name("Plant")))
        for tag in ("InterfaceClass", "RoleClass", "SystemUnitClass", "AttributeType"):
            root.extend(libraries[tag])
        return etree.tostring(root, xml_declaration=True, encoding="UTF-8")

    # -- names -----------------------------------------------------------------------------

    def make_name(self, word=""):
        self.number += 1
        return f"{word or self.random.choice(NAMES)} {self.number}"

    def make_id(self):
        self.number += 1
        return f"{self.random.getrandbits(128):032x}-{self.number}"

    def maybe(self, probability):
        return self.random.random() < probability

    def add_header(self, node):
        if self.maybe(0.2):
            add_child(node, "Description").text = self.random.choice(
                ("says", "two\nlines", "é <&>")
            )
        if self.maybe(0.1):
            add_child(node, "Version").text = "1.0"
        if self.maybe(0.05):
            revision = add_child(node, "Revision")
            add_child(revision, "RevisionDate").text = "2024-01-01T00:00:00Z"
            add_child(revision, "AuthorName").text = "A"
        if self.maybe(0.05):
            add_child(node, "Copyright").text = "us"
        if self.maybe(0.1):
            add_child(
                add_child(node, "AdditionalInformation", Tool="t"), "Inner", Key="k"
            ).text = "text"
        if self.maybe(0.05):
            add_child(node, "SourceObjectInformation", OriginID="u", SourceObjID="7")

    # -- classes ---------------------------------------------------------------------------

    def add_classes(self, library, tag):
        for _ in range(self.random.randint(1, 4)):
            self.add_class(library, tag, [library.get("Name")], 0)

    def add_class(self, owner, tag, path, depth):
        name = self.make_name()
        node = add_child(owner, tag, Name=name)
        path_here = [*path, name]
        base = self.choose_class(tag) if self.maybe(0.4) else ""
        key = "RefAttributeType" if tag == "AttributeType" else "RefBaseClassPath"
        if base:
            node.set(key, base)
        if self.maybe(0.1):
            node.set("ID", self.make_id())
        self.add_header(node)
        path_text = format_path(path_here)
        self.attributes[path_text] = list(self.attributes.get(base, ()))
        self.ports[path_text] = list(self.ports.get(base, ()))
        self.parts[path_text] = list(self.parts.get(base, ()))
        if tag == "AttributeType":
            values = self.set_type_and_unit(node)
            for kind in ("DefaultValue", "Value"):
                if self.maybe(0.2):
                    add_child(node, kind).text = self.random.choice(values)
            self.add_constraints(node)
        self.add_members(node, path_text, tag)
        if tag == "SystemUnitClass":
            self.add_roles(node, "SupportedRoleClass", "RefRoleClassPath")
            self.add_links(node)
        self.classes[tag].append(path_text)
        if depth < 2 and self.maybe(0.3):
            self.add_class(node, tag, path_here, depth + 1)

    def choose_class(self, tag):
        if self.maybe(0.05):
            return "Gone/Class"
        return self.random.choice(self.classes[tag]) if self.classes[tag] else ""

    def add_members(self, node, path, tag):
        for _ in range(self.random.randint(0, 3)):
            self.attributes[path].append(self.add_attribute(node, 0))
        if tag == "AttributeType":
            return
        for _ in range(self.random.randint(0, 2)):
            self.ports[path].append(self.add_interface(node, 0))
        if tag == "SystemUnitClass":
            for _ in range(self.random.randint(0, 2)):
                self.parts[path].append(self.add_element(node, 1))

    # -- attributes and interfaces -----------------------------------------------------------

    def set_type_and_unit(self, node):
        type_ = self.random.choice(TYPES)
        if type_:
            node.set("AttributeDataType", type_)
        unit = self.random.choice(UNITS)
        if unit:
            node.set("Unit", unit)
        return VALUES.get(type_, ("", "text", " spaces ", "7"))

    def add_attribute(self, owner, depth):
        node = add_child(owner, "Attribute", Name=self.make_name())
        if self.maybe(0.3):
            node.set("RefAttributeType", self.choose_class("AttributeType"))
        values = self.set_type_and_unit(node)
        self.add_header(node)
        for tag in ("DefaultValue", "Value"):
            if self.maybe(0.4):
                add_child(node, tag).text = self.random.choice(values)
        for _ in range(self.random.randint(0, 1)):
            path = self.random.choice(("IRDI:1", "ListType", "OrderedListType"))
            add_child(node, "RefSemantic", CorrespondingAttributePath=path)
        self.add_constraints(node)
        if depth < 2 and self.maybe(0.2):
            for _ in range(self.random.randint(1, 2)):
                self.add_attribute(node, depth + 1)
        return node

    def add_constraints(self, node):
        for _ in range(self.random.choice((0, 0, 0, 1, 2))):
            constraint = add_child(node, "Constraint", Name=self.make_name())
            scale = self.random.choice(("OrdinalScaledType", "NominalScaledType", "UnknownType"))
            scaled = add_child(constraint, scale)
            if scale == "OrdinalScaledType":
                for tag in ("RequiredMaxValue", "RequiredValue", "RequiredMinValue"):
                    if self.maybe(0.6):
                        add_child(scaled, tag).text = self.random.choice(("1", "2.5", "many"))
            elif scale == "NominalScaledType":
                for _ in range(self.random.randint(0, 3)):
                    add_child(scaled, "RequiredValue").text = self.random.choice(
                        ("a", "b c", '"', "4")
                    )
            else:
                add_child(scaled, "Requirements").text = self.random.choice(("x > y", "", "any"))

    def add_interface(self, owner, depth):
        node = add_child(owner, "ExternalInterface", Name=self.make_name(), ID=self.make_id())
        if self.maybe(0.7):
            node.set("RefBaseClassPath", self.choose_class("InterfaceClass"))
        self.add_header(node)
        if self.maybe(0.4):
            add_value(node, "Direction", self.random.choice(("In", "Out", "InOut", "both")))
        if self.maybe(0.2):
            cardinality = add_child(node, "Attribute", Name="Cardinality")
            add_value(cardinality, "MinOccur", self.random.choice("01"))
            add_value(cardinality, "MaxOccur", self.random.choice("12"))
        if self.maybe(0.2):
            add_value(node, "Category", "Plug")
        if self.maybe(0.3):
            add_value(node, "colour", "red")
        if depth < 1 and self.maybe(0.2):
            self.add_interface(node, depth + 1)
        return node

    # -- elements ----------------------------------------------------------------------------

    def add_element(self, owner, depth):
        node = add_child(owner, "InternalElement", Name=self.make_name(), ID=self.make_id())
        path = self.choose_class("SystemUnitClass") if self.maybe(0.6) else ""
        if self.masters and self.maybe(0.1):
            node.set("RefBaseSystemUnitPath", self.random.choice(self.masters))
            return node
        if path:
            node.set("RefBaseSystemUnitPath", path)
        self.add_header(node)
        self.add_content(node, path, depth)
        self.masters.append(node.get("ID"))
        return node

    def add_content(self, node, path, depth):
        attributes, ports, parts = (
            [member for member in members if self.maybe(0.5)]
            for members in self.list_inherited(path)
        )
        for attribute in attributes:
            repeated = add_child(node, "Attribute", Name=attribute.get("Name"))
            add_child(repeated, "Value").text = self.random.choice(("12", "yes", "text"))
        for _ in range(self.random.choice((0, 0, 1))):
            self.add_attribute(node, 0)
        for port in ports:
            copy = add_child(node, "ExternalInterface", Name=port.get("Name"), ID=self.make_id())
            copy.set("RefBaseClassPath", port.get("RefBaseClassPath", ""))
            if self.maybe(0.3):
                add_value(copy, "colour", "blue")
        for _ in range(self.random.choice((0, 0, 1))):
            self.add_interface(node, 0)
        if depth < 4:
            for part in parts:
                copy = add_child(node, "InternalElement", Name=part.get("Name"), ID=self.make_id())
                copy.set("RefBaseSystemUnitPath", part.get("RefBaseSystemUnitPath", ""))
                if part.get("RefBaseSystemUnitPath") not in self.masters:
                    self.add_content(copy, part.get("RefBaseSystemUnitPath", ""), depth + 1)
            for _ in range(self.random.choice((0, 0, 1, 2))):
                self.add_element(node, depth + 1)
        if depth < 2:
            self.add_links(node)
        self.add_roles(node, "RoleRequirements", "RefBaseRoleClassPath")

    def list_inherited(self, path):
        return [table.get(path, ()) for table in (self.attributes, self.ports, self.parts)]

    def add_elements(self, node):
        self.add_header(node)
        for _ in range(self.random.randint(0, 3)):
            self.add_element(node, 0)
        if self.masters and self.maybe(0.3):
            group = add_child(node, "InternalElement", Name=self.make_name(), ID=self.make_id())
            master = self.random.choice(self.masters)
            mirror = {
                "Name": self.make_name(),
                "ID": self.make_id(),
                "RefBaseSystemUnitPath": master,
            }
            add_child(group, "InternalElement", **mirror)
            add_child(group, "RoleRequirements", RefBaseRoleClassPath=f"{BASE}/Group")

    def add_roles(self, node, tag, attribute):
        for _ in range(self.random.choice((0, 0, 1, 2))):
            path = self.choose_class("RoleClass")
            role = add_child(node, tag, **{attribute: path})
            own_names = [child.get("Name") for child in node.iterchildren("{*}Attribute")]
            role_names = [child.get("Name") for child in self.attributes.get(path, ())]
            if own_names and role_names and self.maybe(0.5):
                names = {
                    "SystemUnitAttributeName": self.random.choice(own_names),
                    "RoleAttributeName": self.random.choice(role_names),
                }
                add_child(add_child(role, "MappingObject"), "AttributeNameMapping", **names)

    def add_links(self, node):
        """Add links between interfaces of the element and its direct parts; some name nothing."""
        elements = [node, *node.iterchildren("{*}InternalElement")]
        ids = [
            port.get("ID") for element in elements for port in element.iter("{*}ExternalInterface")
        ]
        for _ in range(self.random.choice((0, 1, 2)) if ids else 0):
            sides = [self.random.choice([*ids, *ids, "", "nowhere"]) for _ in range(2)]
            side_a, side_b = {"RefPartnerSideA": sides[0]}, {"RefPartnerSideB": sides[1]}
            add_child(node, "InternalLink", Name=self.make_name("link"), **side_a, **side_b)


def add_child(owner, tag, **attributes):
    """Add a child in the namespace of CAEX."""
    return etree.SubElement(owner, f"{{{NAMESPACE}}}{tag}", attributes)


def add_value(owner, name, text):
    """Add an attribute with a value."""
    add_child(add_child(owner, "Attribute", Name=name), "Value").text = text


def format_path(names):
    """Return the path of a class, with every name in brackets if one name needs them."""
    if any(set(name) & set("/@[]") for name in names):
        names = [f"[{name}]" for name in names]
    return "/".join(names)
