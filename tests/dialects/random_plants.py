"""Random AutomationML of CAEX 3.0: valid, with everything that the schema knows.

Ids are unique; names are odd at times, and references lead nowhere at times.
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
    """A CAEX 3.0 document."""
    return Plant(random).document()


class Plant:
    """The document while it is made; classes and interfaces are known by path and id."""

    def __init__(self, random):
        self.random = random
        self.number = 0
        self.classes = {"AttributeType": [], "InterfaceClass": [], "RoleClass": []}
        self.classes["SystemUnitClass"] = []
        self.attributes = {}
        self.inside = {}
        self.ports = {}
        self.masters = []

    def document(self):
        root = etree.Element(f"{{{NAMESPACE}}}CAEXFile", nsmap={None: NAMESPACE})
        root.set("SchemaVersion", "3.0")
        root.set("FileName", "plant.aml")
        self.head(root)
        origin = {"OriginName": "us", "OriginID": "u", "OriginVersion": "1"}
        add(root, "SourceDocumentInformation", LastWritingDateTime="2024-01-01T00:00:00Z", **origin)
        made = {tag: [] for tag in self.classes}
        for tag in made:
            for _ in range(self.random.randint(1, 2)):
                library = etree.Element(f"{{{NAMESPACE}}}{tag}Lib", Name=self.name(f"{tag} lib"))
                self.head(library)
                self.fill_library(library, tag)
                made[tag].append(library)
        for _ in range(self.random.randint(0, 2)):
            self.hierarchy(add(root, "InstanceHierarchy", Name=self.name("Plant")))
        for tag in ("InterfaceClass", "RoleClass", "SystemUnitClass", "AttributeType"):
            root.extend(made[tag])
        return etree.tostring(root, xml_declaration=True, encoding="UTF-8")

    # -- names -----------------------------------------------------------------------------

    def name(self, word=""):
        self.number += 1
        return f"{word or self.random.choice(NAMES)} {self.number}"

    def id(self):
        self.number += 1
        return f"{self.random.getrandbits(128):032x}-{self.number}"

    def chance(self, of):
        return self.random.random() < of

    def head(self, node):
        if self.chance(0.2):
            add(node, "Description").text = self.random.choice(("says", "two\nlines", "é <&>"))
        if self.chance(0.1):
            add(node, "Version").text = "1.0"
        if self.chance(0.05):
            revision = add(node, "Revision")
            add(revision, "RevisionDate").text = "2024-01-01T00:00:00Z"
            add(revision, "AuthorName").text = "A"
        if self.chance(0.05):
            add(node, "Copyright").text = "us"
        if self.chance(0.1):
            add(add(node, "AdditionalInformation", Tool="t"), "Inner", Key="k").text = "text"
        if self.chance(0.05):
            add(node, "SourceObjectInformation", OriginID="u", SourceObjID="7")

    # -- classes ---------------------------------------------------------------------------

    def fill_library(self, library, tag):
        for _ in range(self.random.randint(1, 4)):
            self.add_class(library, tag, [library.get("Name")], 0)

    def add_class(self, above, tag, path, depth):
        name = self.name()
        node = add(above, tag, Name=name)
        here = [*path, name]
        base = self.pick(tag) if self.chance(0.4) else ""
        key = "RefAttributeType" if tag == "AttributeType" else "RefBaseClassPath"
        if base:
            node.set(key, base)
        if self.chance(0.1):
            node.set("ID", self.id())
        self.head(node)
        path_text = written(here)
        self.attributes[path_text] = list(self.attributes.get(base, ()))
        self.ports[path_text] = list(self.ports.get(base, ()))
        self.inside[path_text] = list(self.inside.get(base, ()))
        if tag == "AttributeType":
            values = self.measure(node)
            for kind in ("DefaultValue", "Value"):
                if self.chance(0.2):
                    add(node, kind).text = self.random.choice(values)
            self.constraints(node)
        self.members(node, path_text, tag)
        if tag == "SystemUnitClass":
            self.roles(node, "SupportedRoleClass", "RefRoleClassPath")
            self.links(node)
        self.classes[tag].append(path_text)
        if depth < 2 and self.chance(0.3):
            self.add_class(node, tag, here, depth + 1)

    def pick(self, tag):
        if self.chance(0.05):
            return "Gone/Class"
        return self.random.choice(self.classes[tag]) if self.classes[tag] else ""

    def members(self, node, path, tag):
        for _ in range(self.random.randint(0, 3)):
            self.attributes[path].append(self.attribute(node, 0))
        if tag == "AttributeType":
            return
        for _ in range(self.random.randint(0, 2)):
            self.ports[path].append(self.interface(node, 0))
        if tag == "SystemUnitClass":
            for _ in range(self.random.randint(0, 2)):
                self.inside[path].append(self.element(node, 1))

    # -- attributes and interfaces -----------------------------------------------------------

    def measure(self, node):
        type_ = self.random.choice(TYPES)
        if type_:
            node.set("AttributeDataType", type_)
        unit = self.random.choice(UNITS)
        if unit:
            node.set("Unit", unit)
        return VALUES.get(type_, ("", "text", " spaces ", "7"))

    def attribute(self, above, depth):
        node = add(above, "Attribute", Name=self.name())
        if self.chance(0.3):
            node.set("RefAttributeType", self.pick("AttributeType"))
        values = self.measure(node)
        self.head(node)
        for tag in ("DefaultValue", "Value"):
            if self.chance(0.4):
                add(node, tag).text = self.random.choice(values)
        for _ in range(self.random.randint(0, 1)):
            path = self.random.choice(("IRDI:1", "ListType", "OrderedListType"))
            add(node, "RefSemantic", CorrespondingAttributePath=path)
        self.constraints(node)
        if depth < 2 and self.chance(0.2):
            for _ in range(self.random.randint(1, 2)):
                self.attribute(node, depth + 1)
        return node

    def constraints(self, node):
        for _ in range(self.random.choice((0, 0, 0, 1, 2))):
            made = add(node, "Constraint", Name=self.name())
            scale = self.random.choice(("OrdinalScaledType", "NominalScaledType", "UnknownType"))
            one = add(made, scale)
            if scale == "OrdinalScaledType":
                for tag in ("RequiredMaxValue", "RequiredValue", "RequiredMinValue"):
                    if self.chance(0.6):
                        add(one, tag).text = self.random.choice(("1", "2.5", "many"))
            elif scale == "NominalScaledType":
                for _ in range(self.random.randint(0, 3)):
                    add(one, "RequiredValue").text = self.random.choice(("a", "b c", '"', "4"))
            else:
                add(one, "Requirements").text = self.random.choice(("x > y", "", "any"))

    def interface(self, above, depth):
        node = add(above, "ExternalInterface", Name=self.name(), ID=self.id())
        if self.chance(0.7):
            node.set("RefBaseClassPath", self.pick("InterfaceClass"))
        self.head(node)
        if self.chance(0.4):
            value(node, "Direction", self.random.choice(("In", "Out", "InOut", "both")))
        if self.chance(0.2):
            made = add(node, "Attribute", Name="Cardinality")
            value(made, "MinOccur", self.random.choice("01"))
            value(made, "MaxOccur", self.random.choice("12"))
        if self.chance(0.2):
            value(node, "Category", "Plug")
        if self.chance(0.3):
            value(node, "colour", "red")
        if depth < 1 and self.chance(0.2):
            self.interface(node, depth + 1)
        return node

    # -- elements ----------------------------------------------------------------------------

    def element(self, above, depth):
        node = add(above, "InternalElement", Name=self.name(), ID=self.id())
        path = self.pick("SystemUnitClass") if self.chance(0.6) else ""
        if self.masters and self.chance(0.1):
            node.set("RefBaseSystemUnitPath", self.random.choice(self.masters))
            return node
        if path:
            node.set("RefBaseSystemUnitPath", path)
        self.head(node)
        self.content(node, path, depth)
        self.masters.append(node.get("ID"))
        return node

    def content(self, node, path, depth):
        own = [[], [], []]
        for kept, known in zip(own, self.known(path), strict=True):
            kept += [one for one in known if self.chance(0.5)]
        for one in own[0]:
            repeated = add(node, "Attribute", Name=one.get("Name"))
            add(repeated, "Value").text = self.random.choice(("12", "yes", "text"))
        for _ in range(self.random.choice((0, 0, 1))):
            self.attribute(node, 0)
        for one in own[1]:
            made = add(node, "ExternalInterface", Name=one.get("Name"), ID=self.id())
            made.set("RefBaseClassPath", one.get("RefBaseClassPath", ""))
            if self.chance(0.3):
                value(made, "colour", "blue")
        for _ in range(self.random.choice((0, 0, 1))):
            self.interface(node, 0)
        if depth < 4:
            for one in own[2]:
                inner = add(node, "InternalElement", Name=one.get("Name"), ID=self.id())
                inner.set("RefBaseSystemUnitPath", one.get("RefBaseSystemUnitPath", ""))
                if one.get("RefBaseSystemUnitPath") not in self.masters:
                    self.content(inner, one.get("RefBaseSystemUnitPath", ""), depth + 1)
            for _ in range(self.random.choice((0, 0, 1, 2))):
                self.element(node, depth + 1)
        if depth < 2:
            self.links(node)
        self.roles(node, "RoleRequirements", "RefBaseRoleClassPath")

    def known(self, path):
        return [table.get(path, ()) for table in (self.attributes, self.ports, self.inside)]

    def hierarchy(self, node):
        self.head(node)
        for _ in range(self.random.randint(0, 3)):
            self.element(node, 0)
        if self.masters and self.chance(0.3):
            group = add(node, "InternalElement", Name=self.name(), ID=self.id())
            master = self.random.choice(self.masters)
            mirror = {"Name": self.name(), "ID": self.id(), "RefBaseSystemUnitPath": master}
            add(group, "InternalElement", **mirror)
            add(group, "RoleRequirements", RefBaseRoleClassPath=f"{BASE}/Group")

    def roles(self, node, tag, attribute):
        for _ in range(self.random.choice((0, 0, 1, 2))):
            path = self.pick("RoleClass")
            role = add(node, tag, **{attribute: path})
            own = [c.get("Name") for c in node.iterchildren("{*}Attribute")]
            of_role = [c.get("Name") for c in self.attributes.get(path, ())]
            if own and of_role and self.chance(0.5):
                names = {
                    "SystemUnitAttributeName": self.random.choice(own),
                    "RoleAttributeName": self.random.choice(of_role),
                }
                add(add(role, "MappingObject"), "AttributeNameMapping", **names)

    def links(self, node):
        """Between interfaces of the element and of those directly in it; some lead nowhere."""
        below = [node, *node.iterchildren("{*}InternalElement")]
        ids = [p.get("ID") for one in below for p in one.iter("{*}ExternalInterface")]
        for _ in range(self.random.choice((0, 1, 2)) if ids else 0):
            sides = [self.random.choice([*ids, *ids, "", "nowhere"]) for _ in range(2)]
            a, b = {"RefPartnerSideA": sides[0]}, {"RefPartnerSideB": sides[1]}
            add(node, "InternalLink", Name=self.name("link"), **a, **b)


def add(above, tag, **attributes):
    """A new child in the namespace of CAEX."""
    return etree.SubElement(above, f"{{{NAMESPACE}}}{tag}", attributes)


def value(above, name, text):
    """A new attribute with a value."""
    add(add(above, "Attribute", Name=name), "Value").text = text


def written(names):
    """A class path; every name in brackets when one needs them."""
    if any(set(name) & set("/@[]") for name in names):
        names = [f"[{name}]" for name in names]
    return "/".join(names)
