"""Random small structures of SysML v1 with names that need quotes and rare combinations.

``random_models`` draws what the tools write often, under plain names. Here each feature is legal
in UML, but its name, type, order and text may be any: keywords, dots, blanks, quotes.
"""

from collections.abc import Sequence
from random import Random
from typing import TypeVar

from dialects.papyrus import (
    PRIMITIVES,
    Element,
    PapyrusDocument,
    Value,
    add_body,
    id_of,
    metaclass_of,
)

T = TypeVar("T")
NAMES = (
    "Fill.Level", "gear box", "part", "in", "it's", 'the "left" one', "Übergang", "日本", "a::b",
    "x /* y */ z", "back\\slash", "1st", "then", "self", "start", "done", "entry", "end", "result",
    "Items", "Real", "Boolean", "ScalarValues", "base", "Plan", "add", "get()", "a;b", "{x}", "-",
    "action", "state", "accept", "ports", "<<tag>>", "of", "a.b.c", "100 %", "50%20x", "value",
    "subject", "this", "that", "Add", "size", "SysMLC", "all", "#1", "@here", "x//y", "tab\tname",
)  # fmt: skip
CONDITIONS = (
    "x > 3", "", "else", "not ready", "a.b.c == 1", "it's open", "true", "x <= 3 and y", "a; b",
    "}", "/* */", "self.level >= 1", "in", "result = x + 1", 'name = "left"', "f(x)", "日本 > 2",
    "x = y", "oclIsTypeOf(Real)", "5", "'quoted name' > 2", "a := 3", "level[1]", "x +",
)  # fmt: skip
"""Texts of guards, constraints and bodies, readable or not."""
_LANGUAGES = ("", "OCL", "KerML", "English", "C")
_PRIMITIVES = ("Boolean", "Integer", "Real", "String", "UnlimitedNatural")
_LITERALS = (
    ("LiteralBoolean", "true"), ("LiteralInteger", "-3"), ("LiteralReal", "1.5E3"),
    ("LiteralString", 'a "b" \\ c\nd'), ("LiteralUnlimitedNatural", "*"), ("LiteralNull", ""),
)  # fmt: skip
BOUNDS = ((0, "1"), (0, "*"), (1, "*"), (2, "2"), (2, "5"))


class Draft:
    """A document with the elements that later ones refer to; choices come from ``random``."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.document = PapyrusDocument(random.choice(NAMES), "small")
        self.packages = [self.document.model]
        self.types: list[Element] = []
        self.features: dict[Element, list[Element]] = {}
        """Classifiers with their own attributes and ports."""
        self.operations: list[Element] = []
        self.signals: list[Element] = []
        self.behaviours: list[Element] = []

    def choose(self, values: Sequence[T]) -> T:
        """Return one of the values."""
        return self.random.choice(values)

    def is_drawn(self, probability: float = 0.5) -> bool:
        """Return true with this probability."""
        return self.random.random() < probability

    def list_types(self, *metaclasses: str) -> list[Element]:
        """Return the types of these metaclasses."""
        return [type_ for type_ in self.types if metaclass_of(type_) in metaclasses]

    def add(
        self, owner: Element, feature: str, metaclass: str, name: str | None = None, **tags: Value
    ) -> Element:
        """Add an element; without a given name it has one that no sibling has."""
        if name is None:
            taken = {child.get("name") for child in owner} | {owner.get("name")}
            free = [candidate for candidate in NAMES if candidate not in taken]
            name = self.choose(free) if free else f"n{len(owner)}"
        return self.document.add(owner, feature, metaclass, name, **tags)

    def add_packaged(self, metaclass: str, *stereotypes: str, **tags: Value) -> Element:
        """Add an element to one of the packages and apply stereotypes."""
        element = self.add(self.choose(self.packages), "packagedElement", metaclass, **tags)
        for stereotype in stereotypes:
            self.document.apply(stereotype, element)
        return element

    def set_type(self, element: Element, *metaclasses: str) -> None:
        """Set a type of the model, a primitive type, or none."""
        types = self.list_types(*metaclasses) if metaclasses else self.types
        kind = self.choose(["model", "model", "primitive", "none"])
        if kind == "model" and types:
            self.document.set(element, type=self.choose(types))
        elif kind == "primitive":
            href = PRIMITIVES + self.choose(_PRIMITIVES)
            self.document.add_reference(element, "type", "PrimitiveType", href)

    def set_value(self, owner: Element, feature: str) -> None:
        """Add a literal or an expression."""
        if self.is_drawn(0.3):
            self.add_condition(owner, feature)
            return
        metaclass, value = self.choose(_LITERALS)
        literal = self.document.add(owner, feature, metaclass)
        if value:
            self.document.set(literal, value=value)

    def add_condition(self, owner: Element, feature: str) -> None:
        """Add an expression: one of the texts, or one about a feature of the model."""
        text = self.choose(CONDITIONS)
        features = [feature for features in self.features.values() for feature in features]
        if features and self.is_drawn():
            name = self.choose(features).get("name", "")
            if not name.isidentifier():
                name = "'" + name.replace("\\", "\\\\").replace("'", "\\'") + "'"
            text = name + self.choose(["", " > 3", " == 'a b'", " and ready", ".size <= 2"])
        self.document.add_expression(owner, feature, text, self.choose(_LANGUAGES))

    def add_behaviour_body(self, owner: Element, feature: str) -> Element:
        """Add an opaque behaviour with one of the texts."""
        behaviour = self.add(owner, feature, "OpaqueBehavior")
        add_body(behaviour, self.choose(CONDITIONS), self.choose(_LANGUAGES))
        return behaviour

    def set_bounds(self, element: Element) -> None:
        """Set bounds of a multiplicity in some cases."""
        if self.is_drawn(0.3):
            self.document.set_bounds(element, *self.choose(BOUNDS))


class Structure:
    """Draws types with their features, relations between them, instances and requirements."""

    def __init__(self, draft: Draft) -> None:
        self.draft = draft
        self.document = draft.document
        for _ in range(draft.random.randint(0, 2)):
            owner = draft.choose(draft.packages)
            draft.packages.append(draft.add(owner, "packagedElement", "Package"))
        drawers = (
            self._draw_enumeration,
            self._draw_value_type,
            self._draw_signal,
            self._draw_interface,
            self._draw_block,
            self._draw_block,
            self._draw_block,
            self._draw_constraint_block,
        )
        for _ in range(draft.random.randint(3, 7)):
            draft.choose(drawers)()
        relations = (
            self._draw_association,
            self._draw_instance,
            self._draw_requirement,
            self._draw_connector,
            self._draw_import,
        )
        for _ in range(draft.random.randint(0, 4)):
            draft.choose(relations)()

    # -- types ---------------------------------------------------------------------------------

    def _draw_enumeration(self) -> None:
        enumeration = self._add_type("Enumeration")
        for _ in range(self.draft.random.randint(1, 3)):
            self.draft.add(enumeration, "ownedLiteral", "EnumerationLiteral")

    def _draw_value_type(self) -> None:
        metaclass = self.draft.choose(["DataType", "PrimitiveType"])
        value_type = self._add_type(metaclass, *self.draft.choose([[], ["Blocks:ValueType"]]))
        if self.draft.is_drawn(0.4):
            self._add_attribute(value_type)

    def _draw_signal(self) -> None:
        signal = self._add_type("Signal")
        self.draft.signals.append(signal)
        for _ in range(self.draft.random.randint(0, 2)):
            self._add_attribute(signal)

    def _draw_interface(self) -> None:
        if self.draft.is_drawn():
            interface = self._add_type("Interface")
        else:
            interface = self._add_type("Class", "PortsAndFlows:InterfaceBlock")
        for _ in range(self.draft.random.randint(0, 4)):
            drawers = [self._add_operation, self._add_reception, self._add_attribute]
            drawers += [self._add_flow_property, self._add_port]
            self.draft.choose(drawers)(interface)

    def _draw_block(self) -> None:
        stereotypes = self.draft.choose([["Blocks:Block"], ["Blocks:Block"], []])
        block = self._add_type("Class", *stereotypes)
        drawers = [self._add_attribute, self._add_attribute, self._add_port, self._add_operation]
        drawers += [self._add_reception, self._add_rule, self._add_part, self._redefine]
        for _ in range(self.draft.random.randint(0, 6)):
            self.draft.choose(drawers)(block)

    def _draw_constraint_block(self) -> None:
        law = self._add_type("Class", "ConstraintBlocks:ConstraintBlock")
        for _ in range(self.draft.random.randint(0, 3)):
            drawers = [self._add_attribute, self._add_attribute, self._add_port, self._add_part]
            self.draft.choose(drawers)(law)
        for _ in range(self.draft.choose([0, 1, 1, 2])):
            self._add_rule(law)

    def _add_type(self, metaclass: str, *stereotypes: str) -> Element:
        type_ = self.draft.add_packaged(metaclass, *stereotypes)
        if self.draft.is_drawn(0.15):
            self.document.set(type_, isAbstract=True)
        generals = [
            general
            for general in self.draft.list_types(metaclass)
            if self._list_stereotypes(general) == self._list_stereotypes(type_)
        ]
        if generals and self.draft.is_drawn(0.4):
            general = self.draft.choose(generals)
            self.document.add(type_, "generalization", "Generalization", general=general)
        if self.draft.is_drawn(0.2):
            self.document.add_comment(type_, 'text with */ and "quotes"\nof two lines')
        self.draft.types.append(type_)
        self.draft.features[type_] = []
        return type_

    def _list_stereotypes(self, element: Element) -> list[str]:
        id = id_of(element)
        return sorted(
            str(application.tag)
            for application in self.document.root
            if id in application.attrib.values() and application is not element
        )

    # -- features ------------------------------------------------------------------------------

    def _add_attribute(self, owner: Element, metaclass: str = "Property") -> Element:
        feature = self.draft.add(owner, "ownedAttribute", metaclass)
        self.draft.set_type(feature)
        self.draft.set_bounds(feature)
        for flag in ("isReadOnly", "isDerived", "isStatic", "isOrdered"):
            if self.draft.is_drawn(0.1):
                self.document.set(feature, **{flag: True})
        if self.draft.is_drawn(0.1):
            self.document.set(feature, visibility=self.draft.choose(["private", "protected"]))
        if self.draft.is_drawn(0.3):
            self.draft.set_value(feature, "defaultValue")
        self.draft.features[owner].append(feature)
        return feature

    def _add_part(self, owner: Element) -> None:
        part = self._add_attribute(owner)
        self.document.set(part, aggregation=self.draft.choose(["composite", "shared"]))

    def _add_port(self, owner: Element) -> None:
        port = self._add_attribute(owner, "Port")
        self.document.set(port, aggregation="composite", isConjugated=self.draft.is_drawn(0.3))
        stereotype = self.draft.choose(["", "ProxyPort", "FullPort"])
        if stereotype:
            self.document.apply(f"PortsAndFlows:{stereotype}", port)

    def _add_flow_property(self, owner: Element) -> None:
        flow = self._add_attribute(owner)
        direction = self.draft.choose(["in", "out", "inout"])
        self.document.apply("PortsAndFlows:FlowProperty", flow, direction=direction)

    def _add_operation(self, owner: Element) -> None:
        operation = self.draft.add(owner, "ownedOperation", "Operation")
        directions = ["in", "out", "inout", *self.draft.choose([[], ["return"]])]
        self.draft.random.shuffle(directions)
        for direction in directions[: self.draft.random.randint(0, 4)]:
            parameter = self.draft.add(
                operation, "ownedParameter", "Parameter", direction=direction
            )
            self.draft.set_type(parameter)
            self.draft.set_bounds(parameter)
            if self.draft.is_drawn(0.2):
                self.draft.set_value(parameter, "defaultValue")
        if self.draft.is_drawn(0.2):
            rule = self.draft.add(operation, "ownedRule", "Constraint")
            self.draft.add_condition(rule, "specification")
            self.document.set(operation, precondition=rule)
        self.draft.operations.append(operation)

    def _add_reception(self, owner: Element) -> None:
        if self.draft.signals:
            signal = self.draft.choose(self.draft.signals)
            name = self.draft.choose([None, signal.get("name", ""), ""])
            self.draft.add(owner, "ownedReception", "Reception", name, signal=signal)

    def _add_rule(self, owner: Element) -> None:
        name = self.draft.choose([None, ""])
        rule = self.draft.add(owner, "ownedRule", "Constraint", name)
        if self.draft.is_drawn(0.9):
            self.draft.add_condition(rule, "specification")

    def _redefine(self, owner: Element) -> None:
        """Redefine or subset a feature of a general."""
        general = owner.find("generalization")
        if general is None:
            return
        id = general.get("general")
        features = [
            feature
            for type_, features in self.draft.features.items()
            if id_of(type_) == id
            for feature in features
        ]
        if not features:
            return
        inherited = self.draft.choose(features)
        name = self.draft.choose([inherited.get("name"), None])
        metaclass = metaclass_of(inherited)
        feature = self.draft.add(owner, "ownedAttribute", metaclass, name)
        relation = self.draft.choose(["redefinedProperty", "subsettedProperty"])
        self.document.set(feature, **{relation: [inherited]})
        for tag in ("type", "aggregation"):
            value = inherited.get(tag)
            if value and self.draft.is_drawn(0.7):
                self.document.set(feature, **{tag: value})
        self.draft.features[owner].append(feature)

    # -- relations -----------------------------------------------------------------------------

    def _draw_import(self) -> None:
        owner, target = (
            self.draft.choose(self.draft.packages),
            self.draft.choose(self.draft.packages),
        )
        if owner is not target:
            self.document.add(owner, "packageImport", "PackageImport", importedPackage=target)

    def _draw_association(self) -> None:
        classes = self.draft.list_types("Class", "Interface", "DataType", "Signal")
        if not classes:
            return
        metaclass = self.draft.choose(["Association", "Association", "AssociationClass"])
        association = self.draft.add_packaged(metaclass)
        ends = []
        for _ in range(2):
            owner, type_ = self.draft.choose(classes), self.draft.choose(classes)
            name = self.draft.choose([None, None, ""])
            is_owned = self.draft.is_drawn()
            end = self.draft.add(
                association if is_owned else owner,
                "ownedEnd" if is_owned else "ownedAttribute",
                "Property",
                name,
                type=type_,
                association=association,
            )
            self.draft.set_bounds(end)
            ends.append(end)
        self.document.set(association, memberEnd=ends)

    def _draw_instance(self) -> None:
        types = [type_ for type_ in self.draft.types if self.draft.features[type_]]
        instance = self.draft.add_packaged("InstanceSpecification")
        if not types:
            return
        classifier = self.draft.choose(types)
        self.document.set(instance, classifier=[classifier])
        for feature in self.draft.features[classifier]:
            if self.draft.is_drawn(0.6):
                slot = self.document.add(instance, "slot", "Slot", definingFeature=feature)
                self.draft.set_value(slot, "value")

    def _draw_requirement(self) -> None:
        requirement = self.draft.add_packaged("Class")
        self.document.apply(
            "Requirements:Requirement",
            requirement,
            base_NamedElement=requirement,
            id=self.draft.choose(["R.1", "", "1", "R 1", "it's"]),
            text=self.draft.choose(CONDITIONS),
        )
        if self.draft.is_drawn(0.3):
            nested = self.draft.add(requirement, "nestedClassifier", "Class")
            self.document.apply("Requirements:Requirement", nested, id="R.1.1", text="*/ inner")
        others = [*self.draft.types, *self.draft.operations, *self.draft.packages[1:]]
        others += [feature for features in self.draft.features.values() for feature in features]
        others += list(self.document.model.iter("ownedLiteral", "ownedBehavior"))
        for _ in range(self.draft.random.randint(0, 2)):
            if not others:
                continue
            client, supplier = self.draft.choose(others), requirement
            if self.draft.is_drawn(0.3):
                client, supplier = supplier, client
            relation = self.draft.add_packaged("Abstraction", client=[client], supplier=[supplier])
            kinds = ["Satisfy", "DeriveReqt", "Verify", "Trace", "Refine", "Copy", "Allocate"]
            kind = self.draft.choose(kinds)
            package = "Allocations" if kind == "Allocate" else "Requirements"
            self.document.apply(f"{package}:{kind}", relation)

    def _draw_connector(self) -> None:
        owners = [type_ for type_ in self.draft.list_types("Class") if self.draft.features[type_]]
        if not owners:
            return
        owner = self.draft.choose(owners)
        ends: list[tuple[Element, Element | None]] = [
            (feature, None) for feature in self.draft.features[owner]
        ]
        for feature in self.draft.features[owner]:
            for type_, inner in self.draft.features.items():
                if id_of(type_) == feature.get("type"):
                    ends += [(role, feature) for role in inner]
        connector = self.draft.add(
            owner, "ownedConnector", "Connector", self.draft.choose([None, ""])
        )
        if self.draft.is_drawn(0.3):
            self.document.apply("Blocks:BindingConnector", connector)
        for _ in range(2):
            role, part = self.draft.choose(ends)
            end = self.document.add(connector, "end", "ConnectorEnd", role=role)
            if part is not None:
                self.document.set(end, partWithPort=part)
