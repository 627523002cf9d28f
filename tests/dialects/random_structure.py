"""Structure at random: types, blocks, ports, connectors, flows, requirements, stereotypes."""

from dataclasses import dataclass, field
from random import Random

from dialects.papyrus import PRIMITIVES, Element, PapyrusDocument, id_of

PLANT = "http://example.org/Plant"
"""Namespace of the custom profile that the random models carry."""

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
    """A block on the drawing board, with what later steps need to know of it."""

    element: Element
    booleans: list[Element] = field(default_factory=list)
    integers: list[Element] = field(default_factory=list)
    enumerated: list[tuple[Element, Element, list[Element]]] = field(default_factory=list)
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
        self._make_packages()
        self.enumerations = [self._enumeration(i) for i in range(random.randint(1, 2))]
        self.value_types = [self._value_type(i) for i in range(random.randint(0, 2))]
        self.signals = [self._add_packaged("Signal", f"signal{i}") for i in range(size)]
        self.items = [self._block(f"Item{i}").element for i in range(random.randint(1, 2))]
        self.interfaces = [self._interface(i) for i in range(random.randint(1, 2))]
        self.blocks: list[Block] = []
        for index in range(random.randint(1, size + 1)):
            self._machine(index)
        self._requirements()
        self._custom_stereotypes()

    def maybe(self, chance: float = 0.5) -> bool:
        """True with the given probability."""
        return self.random.random() < chance

    # -- packages and types --------------------------------------------------------------------

    def _make_packages(self) -> None:
        for index in range(self.random.randint(0, 3)):
            owner = self.random.choice(self.packages)
            name = f"Package {index} é" if self.maybe(0.3) else f"Package{index}"
            self.packages.append(self.document.add(owner, "packagedElement", "Package", name))

    def _add_packaged(self, metaclass: str, name: str) -> Element:
        owner = self.random.choice(self.packages)
        return self.document.add(owner, "packagedElement", metaclass, name)

    def _enumeration(self, index: int) -> tuple[Element, list[Element]]:
        made = self._add_packaged("Enumeration", f"Mode{index}")
        names = [f"mode{index}_{i}" for i in range(self.random.randint(1, 3))]
        add = self.document.add
        return made, [add(made, "ownedLiteral", "EnumerationLiteral", name) for name in names]

    def _value_type(self, index: int) -> Element:
        made = self._add_packaged("DataType", f"Quantity{index}")
        self.document.apply("Blocks:ValueType", made)
        if self.maybe():
            general = self.document.add(made, "generalization", "Generalization")
            kind = self.random.choice(["Real", "Integer"])
            self.document.refer(general, "general", "DataType", _LIBRARY + kind)
        return made

    def _block(self, name: str) -> Block:
        made = self._add_packaged("Class", name)
        self.document.apply("Blocks:Block", made)
        if self.maybe(0.2):
            self.document.set(made, isAbstract=True)
        if self.maybe(0.2):
            self.document.comment(made, f"about {name}: a < b & c\nsecond line")
        return Block(made)

    def _interface(self, index: int) -> Element:
        made = self._add_packaged("Class", f"Interface{index}")
        self.document.apply("PortsAndFlows:InterfaceBlock", made)
        for number in range(self.random.randint(0, 2)):
            item = self.random.choice(self.items)
            name = f"flow{number}"
            flow = self.document.add(made, "ownedAttribute", "Property", name, type=item)
            tags = {"direction": self.random.choice(["in", "out"])} if self.maybe(0.7) else {}
            self.document.apply("PortsAndFlows:FlowProperty", flow, **tags)
        return made

    # -- blocks --------------------------------------------------------------------------------

    def _machine(self, index: int) -> None:
        block = self._block(f"Machine{index}")
        if self.blocks and self.maybe(0.3):
            general = self.random.choice(self.blocks).element
            self.document.add(block.element, "generalization", "Generalization", general=general)
        self._values(block)
        self._ports(block)
        self._parts(block)
        self._operations(block)
        self._connectors(block)
        self._constraint(block)
        self.blocks.append(block)

    def _values(self, block: Block) -> None:
        add, owner = self.document.add, block.element
        for index in range(self.random.randint(0, 2)):
            made = add(owner, "ownedAttribute", "Property", f"b{index}")
            self.document.refer(made, "type", "PrimitiveType", PRIMITIVES + "Boolean")
            if self.maybe():
                default = add(made, "defaultValue", "LiteralBoolean")
                if self.maybe():
                    self.document.set(default, value=True)
            block.booleans.append(made)
        for index in range(self.random.randint(0, 1)):
            made = add(owner, "ownedAttribute", "Property", f"n{index}", visibility="private")
            self.document.refer(made, "type", "PrimitiveType", PRIMITIVES + "Integer")
            add(made, "defaultValue", "LiteralInteger", value="2")
            block.integers.append(made)
        for index in range(self.random.randint(0, 2)):
            self._enumerated(block, index)
        for index, kind in enumerate(self.value_types):
            made = add(owner, "ownedAttribute", "Property", f"q{index}", type=kind)
            if self.maybe():
                self.document.multiplicity(made, self.random.randint(0, 1), "*")

    def _enumerated(self, block: Block, index: int) -> None:
        kind, literals = self.random.choice(self.enumerations)
        add = self.document.add
        made = add(block.element, "ownedAttribute", "Property", f"e{index}", type=kind)
        if self.maybe():
            literal = self.random.choice(literals)
            add(made, "defaultValue", "InstanceValue", instance=literal)
        block.enumerated.append((made, kind, literals))

    def _ports(self, block: Block) -> None:
        for index in range(self.random.randint(0, 3)):
            made = self.document.add(
                block.element, "ownedAttribute", "Port", f"p{index}", aggregation="composite"
            )
            if self.maybe(0.9):
                self.document.set(made, type=self.random.choice(self.interfaces))
            if self.maybe(0.4):
                self.document.set(made, isConjugated=True)
            if self.maybe(0.8):
                kind = self.random.choice(["ProxyPort", "FullPort"])
                self.document.apply(f"PortsAndFlows:{kind}", made)
            block.ports.append(made)

    def _parts(self, block: Block) -> None:
        for index, kind in enumerate(self.blocks):
            if self.maybe(0.6):
                made = self.document.add(
                    block.element, "ownedAttribute", "Property", f"part{index}", type=kind.element
                )
                if self.maybe(0.8):
                    self.document.set(made, aggregation="composite")
                self._association(block, made, index)
                block.parts.append((made, kind))

    def _association(self, block: Block, part: Element, index: int) -> None:
        if self.maybe():
            name = f"{block.element.get('name')}_part{index}"
            made = self._add_packaged("Association", name)
            end = self.document.add(made, "ownedEnd", "Property", "whole", type=block.element)
            self.document.set(made, memberEnd=[part, end])
            self.document.set(end, association=made)
            self.document.set(part, association=made)

    def _operations(self, block: Block) -> None:
        for index in range(self.random.randint(0, 2)):
            made = self.document.add(block.element, "ownedOperation", "Operation", f"do{index}")
            for number in range(self.random.randint(0, 2)):
                item = self.random.choice(self.items)
                one = self.document.add(
                    made, "ownedParameter", "Parameter", f"x{number}", type=item
                )
                direction = self.random.choice(["in", "out", "inout"])
                if direction != "in":
                    self.document.set(one, direction=direction)
                if self.maybe(0.3):
                    self.document.multiplicity(one, 0, "1")
            block.operations.append(made)

    def _constraint(self, block: Block) -> None:
        if block.integers and self.maybe(0.4):
            subject = block.integers[0]
            made = self.document.add(
                block.element, "ownedRule", "Constraint", "limit", constrainedElement=[subject]
            )
            self.document.opaque(made, "specification", f"{subject.get('name')} <= 9", "OCL")

    # -- connectors and flows ------------------------------------------------------------------

    def _connectors(self, block: Block) -> None:
        places = [(port, ()) for port in block.ports]
        for part, kind in block.parts:
            places += [(port, (part,)) for port in kind.ports]
            places += [
                (port, (part, inner)) for inner, deep in kind.parts for port in deep.ports[:1]
            ]
        for index in range(min(len(places) // 2, 3)):
            self._connector(block, index, self.random.sample(places, 2))

    def _connector(
        self, block: Block, index: int, places: list[tuple[Element, tuple[Element, ...]]]
    ) -> None:
        name = f"wire{index}" if self.maybe(0.8) else ""
        made = self.document.add(block.element, "ownedConnector", "Connector", name)
        for port, path in places:
            end = self.document.add(made, "end", "ConnectorEnd", role=port)
            if path:
                self.document.set(end, partWithPort=path[-1])
            if len(path) > 1:
                self.document.apply("Blocks:NestedConnectorEnd", end, propertyPath=list(path))
        if self.maybe():
            self._item_flow(made, places[0][0], places[1][0])

    def _item_flow(self, connector: Element, source: Element, target: Element) -> None:
        name = f"flow of {connector.get('name', 'wire')}"
        flow = self._add_packaged("InformationFlow", name)
        item = self.random.choice(self.items)
        self.document.set(flow, conveyed=[item], informationSource=[source])
        self.document.set(flow, informationTarget=[target], realizingConnector=[connector])
        self.document.apply("PortsAndFlows:ItemFlow", flow)

    # -- requirements and stereotypes ----------------------------------------------------------

    def _requirements(self) -> None:
        made: list[Element] = []
        for index in range(self.random.randint(0, self.size)):
            one = self._add_packaged("Class", f"Requirement{index}")
            text = f'Shall "{index}" & more than <{index}>.'
            self.document.apply(
                "Requirements:Requirement", one, base_NamedElement=one, id=f"R-{index}", text=text
            )
            if made:
                self._relate("Requirements:DeriveReqt", one, self.random.choice(made))
            block = self.random.choice(self.blocks).element
            kinds = ["Requirements:Satisfy", "Requirements:Trace", "Allocations:Allocate", ""]
            self._relate(self.random.choice(kinds), block, one)
            made.append(one)

    def _relate(self, stereotype: str, client: Element, supplier: Element) -> None:
        made = self._add_packaged("Abstraction", f"{client.get('name')} to {supplier.get('name')}")
        self.document.set(made, client=[client], supplier=[supplier])
        if stereotype:
            self.document.apply(stereotype, made)

    def _custom_stereotypes(self) -> None:
        if self.maybe():
            return
        add = self.document.add
        profile = add(self.document.model, "packagedElement", "Profile", "Plant")
        cell = add(profile, "packagedElement", "Stereotype", "Cell")
        general = add(cell, "generalization", "Generalization")
        self.document.refer(general, "general", "Stereotype", _BLOCKS)
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
