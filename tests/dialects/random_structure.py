"""Random structure: types, blocks, ports, connectors, flows, requirements, stereotypes."""

from dataclasses import dataclass, field
from random import Random

from dialects.papyrus import PRIMITIVES, Element, PapyrusDocument, id_of

PLANT = "http://example.org/Plant"
"""Namespace of the custom profile that random models apply."""

_LIBRARY = (
    "pathmap://SysML16_LIBRARIES/SysML-Standard-Library.uml#SysML.package_packagedElement_Libraries"
    ".package_packagedElement_PrimitiveValueTypes.dataType_packagedElement_"
)
_BLOCKS = (
    "pathmap://SysML16_PROFILES/SysML.profile.uml#SysML.package_packagedElement_Blocks"
    ".stereotype_packagedElement_Block"
)


@dataclass(slots=True)
class Block:
    """A block of the model, with the features that later steps choose from."""

    element: Element
    booleans: list[Element] = field(default_factory=list)
    integers: list[Element] = field(default_factory=list)
    enumerations: list[tuple[Element, Element, list[Element]]] = field(default_factory=list)
    ports: list[Element] = field(default_factory=list)
    parts: list[tuple[Element, "Block"]] = field(default_factory=list)
    operations: list[Element] = field(default_factory=list)


class Structure:
    """Fills a document with structure; every choice comes from ``random``."""

    def __init__(self, document: PapyrusDocument, random: Random, size: int) -> None:
        self.document = document
        self.random = random
        self.size = size
        self.packages = [document.model]
        self._add_packages()
        self.enumerations = [self._add_enumeration(i) for i in range(random.randint(1, 2))]
        self.value_types = [self._add_value_type(i) for i in range(random.randint(0, 2))]
        self.signals = [self.add_packaged("Signal", f"signal{i}") for i in range(size)]
        self.items = [self._add_block(f"Item{i}").element for i in range(random.randint(1, 2))]
        self.interfaces = [self._add_interface(i) for i in range(random.randint(1, 2))]
        self.blocks: list[Block] = []
        for index in range(random.randint(1, size + 1)):
            self._add_machine(index)
        self._add_requirements()
        self._add_custom_stereotypes()

    def maybe(self, chance: float = 0.5) -> bool:
        """Return True with the given probability."""
        return self.random.random() < chance

    # -- packages and types --------------------------------------------------------------------

    def _add_packages(self) -> None:
        for index in range(self.random.randint(0, 3)):
            owner = self.random.choice(self.packages)
            name = f"Package {index} é" if self.maybe(0.3) else f"Package{index}"
            self.packages.append(self.document.add(owner, "packagedElement", "Package", name))

    def add_packaged(self, metaclass: str, name: str) -> Element:
        owner = self.random.choice(self.packages)
        return self.document.add(owner, "packagedElement", metaclass, name)

    def _add_enumeration(self, index: int) -> tuple[Element, list[Element]]:
        enumeration = self.add_packaged("Enumeration", f"Mode{index}")
        names = [f"mode{index}_{i}" for i in range(self.random.randint(1, 3))]
        add = self.document.add
        return enumeration, [
            add(enumeration, "ownedLiteral", "EnumerationLiteral", name) for name in names
        ]

    def _add_value_type(self, index: int) -> Element:
        value_type = self.add_packaged("DataType", f"Quantity{index}")
        self.document.apply("Blocks:ValueType", value_type)
        if self.maybe():
            general = self.document.add(value_type, "generalization", "Generalization")
            kind = self.random.choice(["Real", "Integer"])
            self.document.add_reference(general, "general", "DataType", _LIBRARY + kind)
        return value_type

    def _add_block(self, name: str) -> Block:
        block = self.add_packaged("Class", name)
        self.document.apply("Blocks:Block", block)
        if self.maybe(0.2):
            self.document.set(block, isAbstract=True)
        if self.maybe(0.2):
            self.document.add_comment(block, f"about {name}: a < b & c\nsecond line")
        return Block(block)

    def _add_interface(self, index: int) -> Element:
        interface = self.add_packaged("Class", f"Interface{index}")
        self.document.apply("PortsAndFlows:InterfaceBlock", interface)
        for number in range(self.random.randint(0, 2)):
            item = self.random.choice(self.items)
            name = f"flow{number}"
            flow = self.document.add(interface, "ownedAttribute", "Property", name, type=item)
            tags = {"direction": self.random.choice(["in", "out"])} if self.maybe(0.7) else {}
            self.document.apply("PortsAndFlows:FlowProperty", flow, **tags)
        return interface

    # -- blocks --------------------------------------------------------------------------------

    def _add_machine(self, index: int) -> None:
        block = self._add_block(f"Machine{index}")
        if self.blocks and self.maybe(0.3):
            general = self.random.choice(self.blocks).element
            self.document.add(block.element, "generalization", "Generalization", general=general)
        self._add_values(block)
        self._add_ports(block)
        self._add_parts(block)
        self._add_operations(block)
        self._add_connectors(block)
        self._add_constraint(block)
        self.blocks.append(block)

    def _add_values(self, block: Block) -> None:
        add, owner = self.document.add, block.element
        for index in range(self.random.randint(0, 2)):
            attribute = add(owner, "ownedAttribute", "Property", f"b{index}")
            self.document.add_reference(attribute, "type", "PrimitiveType", PRIMITIVES + "Boolean")
            if self.maybe():
                default = add(attribute, "defaultValue", "LiteralBoolean")
                if self.maybe():
                    self.document.set(default, value=True)
            block.booleans.append(attribute)
        for index in range(self.random.randint(0, 1)):
            attribute = add(owner, "ownedAttribute", "Property", f"n{index}", visibility="private")
            self.document.add_reference(attribute, "type", "PrimitiveType", PRIMITIVES + "Integer")
            add(attribute, "defaultValue", "LiteralInteger", value="2")
            block.integers.append(attribute)
        for index in range(self.random.randint(0, 2)):
            self._add_enumeration_value(block, index)
        for index, kind in enumerate(self.value_types):
            attribute = add(owner, "ownedAttribute", "Property", f"q{index}", type=kind)
            if self.maybe():
                self.document.set_bounds(attribute, self.random.randint(0, 1), "*")

    def _add_enumeration_value(self, block: Block, index: int) -> None:
        kind, literals = self.random.choice(self.enumerations)
        add = self.document.add
        attribute = add(block.element, "ownedAttribute", "Property", f"e{index}", type=kind)
        if self.maybe():
            literal = self.random.choice(literals)
            add(attribute, "defaultValue", "InstanceValue", instance=literal)
        block.enumerations.append((attribute, kind, literals))

    def _add_ports(self, block: Block) -> None:
        for index in range(self.random.randint(0, 3)):
            port = self.document.add(
                block.element, "ownedAttribute", "Port", f"p{index}", aggregation="composite"
            )
            if self.maybe(0.9):
                self.document.set(port, type=self.random.choice(self.interfaces))
            if self.maybe(0.4):
                self.document.set(port, isConjugated=True)
            if self.maybe(0.8):
                kind = self.random.choice(["ProxyPort", "FullPort"])
                self.document.apply(f"PortsAndFlows:{kind}", port)
            block.ports.append(port)

    def _add_parts(self, block: Block) -> None:
        for index, kind in enumerate(self.blocks):
            if self.maybe(0.6):
                part = self.document.add(
                    block.element, "ownedAttribute", "Property", f"part{index}", type=kind.element
                )
                if self.maybe(0.8):
                    self.document.set(part, aggregation="composite")
                self._add_association(block, part, index)
                block.parts.append((part, kind))

    def _add_association(self, block: Block, part: Element, index: int) -> None:
        if self.maybe():
            name = f"{block.element.get('name')}_part{index}"
            association = self.add_packaged("Association", name)
            end = self.document.add(
                association, "ownedEnd", "Property", "whole", type=block.element
            )
            self.document.set(association, memberEnd=[part, end])
            self.document.set(end, association=association)
            self.document.set(part, association=association)

    def _add_operations(self, block: Block) -> None:
        for index in range(self.random.randint(0, 2)):
            operation = self.document.add(
                block.element, "ownedOperation", "Operation", f"do{index}"
            )
            for number in range(self.random.randint(0, 2)):
                item = self.random.choice(self.items)
                parameter = self.document.add(
                    operation, "ownedParameter", "Parameter", f"x{number}", type=item
                )
                direction = self.random.choice(["in", "out", "inout"])
                if direction != "in":
                    self.document.set(parameter, direction=direction)
                if self.maybe(0.3):
                    self.document.set_bounds(parameter, 0, "1")
            block.operations.append(operation)

    def _add_constraint(self, block: Block) -> None:
        if block.integers and self.maybe(0.4):
            subject = block.integers[0]
            constraint = self.document.add(
                block.element, "ownedRule", "Constraint", "limit", constrainedElement=[subject]
            )
            self.document.add_expression(
                constraint, "specification", f"{subject.get('name')} <= 9", "OCL"
            )

    # -- connectors and flows ------------------------------------------------------------------

    def _add_connectors(self, block: Block) -> None:
        ends = [(port, ()) for port in block.ports]
        for part, kind in block.parts:
            ends += [(port, (part,)) for port in kind.ports]
            ends += [(port, (part, inner)) for inner, deep in kind.parts for port in deep.ports[:1]]
        for index in range(min(len(ends) // 2, 3)):
            self._add_connector(block, index, self.random.sample(ends, 2))

    def _add_connector(
        self, block: Block, index: int, ends: list[tuple[Element, tuple[Element, ...]]]
    ) -> None:
        name = f"wire{index}" if self.maybe(0.8) else ""
        connector = self.document.add(block.element, "ownedConnector", "Connector", name)
        for port, path in ends:
            end = self.document.add(connector, "end", "ConnectorEnd", role=port)
            if path:
                self.document.set(end, partWithPort=path[-1])
            if len(path) > 1:
                self.document.apply("Blocks:NestedConnectorEnd", end, propertyPath=list(path))
        if self.maybe():
            self._add_item_flow(connector, ends[0][0], ends[1][0])

    def _add_item_flow(self, connector: Element, source: Element, target: Element) -> None:
        name = f"flow of {connector.get('name', 'wire')}"
        flow = self.add_packaged("InformationFlow", name)
        item = self.random.choice(self.items)
        self.document.set(flow, conveyed=[item], informationSource=[source])
        self.document.set(flow, informationTarget=[target], realizingConnector=[connector])
        self.document.apply("PortsAndFlows:ItemFlow", flow)

    # -- requirements and stereotypes ----------------------------------------------------------

    def _add_requirements(self) -> None:
        requirements: list[Element] = []
        for index in range(self.random.randint(0, self.size)):
            requirement = self.add_packaged("Class", f"Requirement{index}")
            text = f'Shall "{index}" & more than <{index}>.'
            self.document.apply(
                "Requirements:Requirement",
                requirement,
                base_NamedElement=requirement,
                id=f"R-{index}",
                text=text,
            )
            if requirements:
                self._add_abstraction(
                    "Requirements:DeriveReqt", requirement, self.random.choice(requirements)
                )
            block = self.random.choice(self.blocks).element
            kinds = ["Requirements:Satisfy", "Requirements:Trace", "Allocations:Allocate", ""]
            self._add_abstraction(self.random.choice(kinds), block, requirement)
            requirements.append(requirement)

    def _add_abstraction(self, stereotype: str, client: Element, supplier: Element) -> None:
        relation = self.add_packaged(
            "Abstraction", f"{client.get('name')} to {supplier.get('name')}"
        )
        self.document.set(relation, client=[client], supplier=[supplier])
        if stereotype:
            self.document.apply(stereotype, relation)

    def _add_custom_stereotypes(self) -> None:
        if self.maybe():
            return
        add = self.document.add
        profile = add(self.document.model, "packagedElement", "Profile", "Plant")
        cell = add(profile, "packagedElement", "Stereotype", "Cell")
        general = add(cell, "generalization", "Generalization")
        self.document.add_reference(general, "general", "Stereotype", _BLOCKS)
        robot = add(profile, "packagedElement", "Stereotype", "Robot")
        add(robot, "generalization", "Generalization", general=cell)
        for name in ("axes", "maker"):
            add(robot, "ownedAttribute", "Property", name)
        application = add(self.document.model, "profileApplication", "ProfileApplication")
        self.document.set(application, appliedProfile=profile)
        for block in self.blocks:
            if self.maybe():
                tags = {"axes": "6", "maker": f"Maker & {id_of(cell)[:3]}"}
                self.document.apply("Plant:Robot", block.element, **tags)
