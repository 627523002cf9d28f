"""Random uses of rarer SysML stereotypes: units, flow ports, nested ends, allocations."""

from dialects.papyrus import Element
from dialects.random_structure import Structure

_UNITS = (
    "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML.package_packagedElement_Libraries"
    ".package_packagedElement_UnitAndQuantityKind.class_packagedElement_"
)


class SysmlStereotypes:
    """Adds a random choice of these stereotypes to a structure; the model stays valid."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.document = structure.document
        self.random = structure.random
        self.add_packaged = structure.add_packaged
        for make in (
            self._add_units,
            self._add_flow_ports,
            self._add_nested_connector,
            self._add_properties,
            self._allocate_partitions,
            self._apply_edge_stereotypes,
            self._add_comments,
            self._add_copied_requirement,
        ):
            if structure.maybe(0.6):
                make()

    def _add_block(self, name: str) -> Element:
        block = self.add_packaged("Class", name)
        self.document.apply("Blocks:Block", block)
        return block

    def _add_part(self, owner: Element, name: str, type_: Element) -> Element:
        return self.document.add(
            owner, "ownedAttribute", "Property", name, type=type_, aggregation="composite"
        )

    def _add_units(self) -> None:
        unit = self.add_packaged("InstanceSpecification", "kilogram")
        kind = self.add_packaged("InstanceSpecification", "mass")
        for instance, name in ((unit, "Unit"), (kind, "QuantityKind")):
            self.document.add_reference(instance, "classifier", "Class", _UNITS + name)
        value_type = self.add_packaged("DataType", "Mass")
        tags = {"unit": unit, "quantityKind": kind} if self.structure.maybe() else {"unit": unit}
        self.document.apply("Blocks:ValueType", value_type, **tags)
        block = self.random.choice(self.structure.blocks).element
        self.document.add(block, "ownedAttribute", "Property", "load", type=value_type)

    def _add_flow_ports(self) -> None:
        owner = self._add_block("Flowing")
        direction = self.random.choice(["in", "out", "inout"])
        port = self.document.add(owner, "ownedAttribute", "Port", "flow", aggregation="composite")
        self.document.set(port, type=self.structure.items[0])
        self.document.apply("DeprecatedElements:FlowPort", port, direction=direction)
        kind = self.add_packaged("Interface", "FlowKind")
        self.document.apply("DeprecatedElements:FlowSpecification", kind)
        item = self.structure.items[0]
        passing = self.document.add(kind, "ownedAttribute", "Property", "passing", type=item)
        self.document.apply("PortsAndFlows:FlowProperty", passing, direction="in")
        wide = self.document.add(owner, "ownedAttribute", "Port", "wide", aggregation="composite")
        self.document.set(wide, type=kind, isConjugated=self.structure.maybe())
        self.document.apply("DeprecatedElements:FlowPort", wide)

    def _add_nested_connector(self) -> None:
        """Add a connector whose path leads through one to four parts to a port nested in a port."""
        inner, outer = self.add_packaged("Class", "Inner"), self.add_packaged("Class", "Outer")
        for interface in (inner, outer):
            self.document.apply("PortsAndFlows:InterfaceBlock", interface)
        nested = self.document.add(outer, "ownedAttribute", "Port", "nested", type=inner)
        holder = self._add_block("Holder")
        door = self.document.add(holder, "ownedAttribute", "Port", "door", type=outer)
        self.document.set(nested, aggregation="composite")
        self.document.set(door, aggregation="composite", isConjugated=self.structure.maybe())
        whole, path = holder, [door]
        for depth in range(self.random.randint(1, 3)):
            container = self._add_block(f"Level{depth}")
            path.insert(0, self._add_part(container, f"step{depth}", whole))
            whole = container
        connector = self.document.add(whole, "ownedConnector", "Connector", "deep")
        neighbour = self._add_part(whole, "beside", self._add_block("Beside"))
        end = self.document.add(
            connector, "end", "ConnectorEnd", role=nested, partWithPort=path[-1]
        )
        self.document.apply("Blocks:NestedConnectorEnd", end, propertyPath=path)
        self.document.add(connector, "end", "ConnectorEnd", role=neighbour)

    def _add_properties(self) -> None:
        owner, item = self._add_block("Rare"), self.structure.items[0]
        part = self._add_part(owner, "part", self._add_block("Inside"))
        only = self.document.add(owner, "ownedAttribute", "Property", "only", type=item)
        self.document.apply("Blocks:BoundReference", only, bindingPath=[part], lower="1", upper="3")
        adjunct = self.document.add(owner, "ownedAttribute", "Property", "adjunct", type=item)
        self.document.apply("Blocks:AdjunctProperty", adjunct, principal=part)
        special = self.add_packaged("Class", "Special part")
        self.document.apply("Blocks:PropertySpecificType", special)
        self.document.apply("Blocks:Block", special, isEncapsulated=True)
        call = self.document.add(owner, "ownedOperation", "Operation", "call")
        direction = self.random.choice(["provided", "required"])
        self.document.apply("PortsAndFlows:DirectedFeature", call, featureDirection=direction)

    def _allocate_partitions(self) -> None:
        for group in list(self.document.model.iter("group")):
            if "ActivityPartition" in str(group.attrib.values()) and group.get("represents"):
                self.document.apply("Allocations:AllocateActivityPartition", group)

    def _apply_edge_stereotypes(self) -> None:
        for edge in list(self.document.model.iter("edge"))[:6]:
            name = self.random.choice(["Continuous", "Discrete", "Probability", "Rate"])
            tags = {"Probability": {"probability": "0.3"}, "Rate": {"rate": "5 per s"}}
            self.document.apply(f"Activities:{name}", edge, **tags.get(name, {}))

    def _add_comments(self) -> None:
        block = self.random.choice(self.structure.blocks).element
        for index, name in enumerate(("Problem", "Rationale", "ElementGroup")):
            self.document.add_comment(block, f"words {index}")
            comment = block.findall("ownedComment")[-1]
            tags = {"criterion": "safety"} if name == "ElementGroup" else {}
            self.document.apply(f"ModelElements:{name}", comment, **tags)

    def _add_copied_requirement(self) -> None:
        slave = self.add_packaged("Class", "Slave")
        text = "Shall be quiet.\nAt night too."
        self.document.apply("Requirements:Requirement", slave, id="S-1", text=text)
        master = self.add_packaged("Class", "Master")
        self.document.apply("Requirements:Requirement", master, id="S-1", text=text)
        copy = self.add_packaged("Abstraction", "copy")
        self.document.set(copy, client=[slave], supplier=[master])
        self.document.apply("Requirements:Copy", copy)
