"""A small model under construction: elements that any topic may refer to, and helpers."""

from random import Random

from dialects.papyrus import PRIMITIVES, Element, PapyrusDocument, add_body
from dialects.random_structure import PLANT

NAMES = ("Gate", "Robot arm", "Größe", "x/y", "it's", "part", "in", "a<b & c", "A::B", "1.5")
PRIMITIVE_TYPES = ("Integer", "Real", "Boolean", "String", "UnlimitedNatural")


class Draft:
    """A document with pools of blocks, signals and types; every choice comes from *random*."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.document = PapyrusDocument("Legal model", profiles={"Plant": PLANT})
        self.add = self.document.add
        self.set = self.document.set
        self.apply = self.document.apply
        self._number = 0
        self.packages = [self.document.model]
        for _ in range(random.randint(0, 2)):
            self.packages.append(self.add_packaged("Package", "Package"))
        self.block = self.add_block("Machine")
        self.item = self.add_block("Pallet")
        self.signal = self.add_packaged("Signal", "Start")

    def maybe(self, chance: float = 0.5) -> bool:
        return self.random.random() < chance

    def choose(self, *values):
        return self.random.choice(values)

    def make_name(self, word: str = "") -> str:
        """Return a name that no other element has; some are unusual, but every string is legal."""
        self._number += 1
        word = word if word and self.maybe(0.9) else self.random.choice(NAMES)
        return f"{word} {self._number}" if self.maybe(0.2) else f"{word}{self._number}"

    def make_word(self, word: str) -> str:
        """Return a name that an expression can refer to."""
        self._number += 1
        return f"{word}{self._number}"

    def add_packaged(self, metaclass: str, word: str = "", **features) -> Element:
        """Add an element with a name to any package."""
        owner = self.random.choice(self.packages)
        return self.add(owner, "packagedElement", metaclass, self.make_name(word), **features)

    def add_block(self, word: str, owner: Element | None = None) -> Element:
        if owner is None:
            block = self.add_packaged("Class", word)
        else:
            block = self.add(owner, "nestedClassifier", "Class", self.make_name(word))
        self.apply("Blocks:Block", block)
        return block

    def set_type(self, element: Element, primitive: str) -> None:
        """Set the type to one of UML's primitive types, in another file."""
        self.document.add_reference(element, "type", "PrimitiveType", PRIMITIVES + primitive)

    def add_value(self, owner: Element, word: str, primitive: str) -> Element:
        """Add an attribute of a primitive type, whose name an expression can use."""
        attribute = self.add(owner, "ownedAttribute", "Property", self.make_word(word))
        self.set_type(attribute, primitive)
        return attribute

    def add_part(self, owner: Element, type_: Element, aggregation: str = "composite") -> Element:
        part = self.add(owner, "ownedAttribute", "Property", self.make_name("part"), type=type_)
        if aggregation != "none":
            self.set(part, aggregation=aggregation)
        return part

    def add_association(self, whole: Element, part: Element, type_: Element) -> Element:
        """Add the association of a part, with an end of its own for the whole."""
        association = self.add_packaged("Association", "A_")
        end = self.add(association, "ownedEnd", "Property", self.make_name("whole"), type=whole)
        self.set(end, association=association)
        self.set(part, association=association, type=type_)
        self.set(association, memberEnd=[part, end])
        return association

    def add_text(self, owner: Element, feature: str, body: str, language: str = "OCL") -> Element:
        """Add an opaque expression."""
        return self.document.add_expression(owner, feature, body, language)

    def add_rule(self, owner: Element, body: str, feature: str = "ownedRule") -> Element:
        """Add a constraint with a text in OCL."""
        rule = self.add(owner, feature, "Constraint", self.make_name("rule"))
        self.add_text(rule, "specification", body)
        return rule

    def add_behaviour(self, owner: Element, feature: str, body: str, language: str) -> Element:
        """Add an opaque behaviour."""
        behaviour = self.add(owner, feature, "OpaqueBehavior", self.make_name("behaviour"))
        add_body(behaviour, body, language)
        return behaviour

    def set_bounds(self, element: Element) -> None:
        """Set one of the multiplicities that UML allows."""
        bounds = self.choose((0, "1"), (0, "*"), (1, "*"), (2, "2"), (3, "7"), (1, "1"))
        self.document.set_bounds(element, *bounds)
        if bounds[1] != "1" and self.maybe(0.4):
            self.set(element, isOrdered=True)
        if bounds[1] != "1" and self.maybe(0.3):
            self.set(element, isUnique=False)
