"""What SysML's less usual stereotypes say: units, flow ports, deep ends, allocations and more."""

from dialects.papyrus import Element
from dialects.random_structure import Structure

_UNITS = (
    "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML.package_packagedElement_Libraries"
    ".package_packagedElement_UnitAndQuantityKind.class_packagedElement_"
)


class Meanings:
    """Adds a random choice of them to a structure; the model stays valid."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        for make in (
            self._units,
            self._flow_ports,
            self._deep_connector,
            self._properties,
            self._allocate_partitions,
            self._edges,
            self._comments,
            self._requirement_kinds,
        ):
            if structure.maybe(0.6):
                make()

    def _packaged(self, metaclass: str, name: str) -> Element:
        owner = self.random.choice(self.structure.packages)
        return self.document.add(owner, "packagedElement", metaclass, name)

    def _block(self, name: str) -> Element:
        made = self._packaged("Class", name)
        self.document.apply("Blocks:Block", made)
        return made

    def _part(self, owner: Element, name: str, type_: Element) -> Element:
        return self.document.add(
            owner, "ownedAttribute", "Property", name, type=type_, aggregation="composite"
        )

    def _units(self) -> None:
        unit = self._packaged("InstanceSpecification", "kilogram")
        kind = self._packaged("InstanceSpecification", "mass")
        for one, name in ((unit, "Unit"), (kind, "QuantityKind")):
            self.document.refer(one, "classifier", "Class", _UNITS + name)
        made = self._packaged("DataType", "Mass")
        tags = {"unit": unit, "quantityKind": kind} if self.structure.maybe() else {"unit": unit}
        self.document.apply("Blocks:ValueType", made, **tags)
        block = self.random.choice(self.structure.blocks).element
        self.document.add(block, "ownedAttribute", "Property", "load", type=made)

    def _flow_ports(self) -> None:
        owner = self._block("Flowing")
        direction = self.random.choice(["in", "out", "inout"])
        port = self.document.add(owner, "ownedAttribute", "Port", "flow", aggregation="composite")
        self.document.set(port, type=self.structure.items[0])
        self.document.apply("DeprecatedElements:FlowPort", port, direction=direction)
        kind = self._packaged("Interface", "FlowKind")
        self.document.apply("DeprecatedElements:FlowSpecification", kind)
        item = self.structure.items[0]
        passing = self.document.add(kind, "ownedAttribute", "Property", "passing", type=item)
        self.document.apply("PortsAndFlows:FlowProperty", passing, direction="in")
        deep = self.document.add(owner, "ownedAttribute", "Port", "wide", aggregation="composite")
        self.document.set(deep, type=kind, isConjugated=self.structure.maybe())
        self.document.apply("DeprecatedElements:FlowPort", deep)

    def _deep_connector(self) -> None:
        """Ends through one to four parts, at a port nested in a port."""
        inner, outer = self._packaged("Class", "Inner"), self._packaged("Class", "Outer")
        for one in (inner, outer):
            self.document.apply("PortsAndFlows:InterfaceBlock", one)
        nested = self.document.add(outer, "ownedAttribute", "Port", "nested", type=inner)
        holder = self._block("Holder")
        door = self.document.add(holder, "ownedAttribute", "Port", "door", type=outer)
        self.document.set(nested, aggregation="composite")
        self.document.set(door, aggregation="composite", isConjugated=self.structure.maybe())
        whole, path = holder, [door]
        for depth in range(self.random.randint(1, 3)):
            above = self._block(f"Level{depth}")
            path.insert(0, self._part(above, f"step{depth}", whole))
            whole = above
        made = self.document.add(whole, "ownedConnector", "Connector", "deep")
        other = self._part(whole, "beside", self._block("Beside"))
        end = self.document.add(made, "end", "ConnectorEnd", role=nested, partWithPort=path[-1])
        self.document.apply("Blocks:NestedConnectorEnd", end, propertyPath=path)
        self.document.add(made, "end", "ConnectorEnd", role=other)

    def _properties(self) -> None:
        owner, item = self._block("Rare"), self.structure.items[0]
        part = self._part(owner, "part", self._block("Inside"))
        only = self.document.add(owner, "ownedAttribute", "Property", "only", type=item)
        self.document.apply("Blocks:BoundReference", only, bindingPath=[part], lower="1", upper="3")
        adjunct = self.document.add(owner, "ownedAttribute", "Property", "adjunct", type=item)
        self.document.apply("Blocks:AdjunctProperty", adjunct, principal=part)
        special = self._packaged("Class", "Special part")
        self.document.apply("Blocks:PropertySpecificType", special)
        self.document.apply("Blocks:Block", special, isEncapsulated=True)
        call = self.document.add(owner, "ownedOperation", "Operation", "call")
        direction = self.random.choice(["provided", "required"])
        self.document.apply("PortsAndFlows:DirectedFeature", call, featureDirection=direction)

    def _allocate_partitions(self) -> None:
        for group in list(self.document.model.iter("group")):
            if "ActivityPartition" in str(group.attrib.values()) and group.get("represents"):
                self.document.apply("Allocations:AllocateActivityPartition", group)

    def _edges(self) -> None:
        for edge in list(self.document.model.iter("edge"))[:6]:
            name = self.random.choice(["Continuous", "Discrete", "Probability", "Rate"])
            tags = {"Probability": {"probability": "0.3"}, "Rate": {"rate": "5 per s"}}
            self.document.apply(f"Activities:{name}", edge, **tags.get(name, {}))

    def _comments(self) -> None:
        block = self.random.choice(self.structure.blocks).element
        for index, name in enumerate(("Problem", "Rationale", "ElementGroup")):
            self.document.comment(block, f"words {index}")
            comment = block.findall("ownedComment")[-1]
            tags = {"criterion": "safety"} if name == "ElementGroup" else {}
            self.document.apply(f"ModelElements:{name}", comment, **tags)

    def _requirement_kinds(self) -> None:
        made = self._packaged("Class", "Slave")
        text = "Shall be quiet.\nAt night too."
        self.document.apply("Requirements:Requirement", made, id="S-1", text=text)
        master = self._packaged("Class", "Master")
        self.document.apply("Requirements:Requirement", master, id="S-1", text=text)
        copy = self._packaged("Abstraction", "copy")
        self.document.set(copy, client=[made], supplier=[master])
        self.document.apply("Requirements:Copy", copy)
